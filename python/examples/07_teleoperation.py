# SPDX-License-Identifier: BSD-3-Clause
"""A control loop at 1 kHz: a Panda's hand follows a target that someone moves.

Now and then it moves faster than the joints can, and out of the workspace and back. The
seconds it runs may be given as argument. How late the answers came goes to stderr;
cpp/examples/07_teleoperation.cpp prints the same otherwise.
"""

import math
import sys
import time

import numpy as np

import iksel

DT = 0.001


def move_target(target, start, tick):
    """Stand for the operator's device: 0.3 m to the front and 0.2 m to the sides."""
    angle = 2 * DT * tick
    target[:3, 3] = start[:3, 3]
    target[0, 3] += 0.15 * (1 - math.cos(angle))
    target[1, 3] += 0.2 * math.sin(angle)
    target[2, 3] += 0.05 * math.sin(2 * angle)


def show_times(name, us):
    quantiles = "median {:.1f}, 99 % {:.1f}, 99.9 % {:.1f}, worst {:.1f}".format(
        *np.quantile(us, [0.5, 0.99, 0.999, 1])
    )
    print(f"{name} [us]: {quantiles}", file=sys.stderr)


robot = iksel.load_robot("panda")
solver = iksel.Solver(robot)
here = np.array([0.0, -0.4, 0.0, -2.2, 0.0, 1.8, 0.8])

tracker = solver.tracker(here)
start = robot.fk(here)
target = start.copy()
ticks = max(1, round(float(sys.argv[1] if len(sys.argv) > 1 else 3) / DT))
solve_us, late_us = np.empty((2, ticks))
there = on_the_way = held = 0
lost = None  # the first target without a continuation
top_speed = 0.0  # of a joint, relative to its limit

begin = time.monotonic()
for tick in range(1, ticks + 1):
    # Ticks lie on a grid of their own: being late once moves none of those that follow.
    due = begin + tick * DT
    time.sleep(max(0, due - time.monotonic()))
    move_target(target, start, tick)
    before = tracker.q
    woken = time.monotonic()
    result = tracker.track(target, DT)
    # Here tracker.q would go to the joints: it is where they can be by the next tick.
    now = time.monotonic()
    solve_us[tick - 1] = 1e6 * (now - woken)
    late_us[tick - 1] = 1e6 * (now - due)

    if result.success:
        there += 1
    elif result.status == iksel.Status.too_fast:
        on_the_way += 1
    else:
        if held == 0:
            lost = target.copy()
        held += 1
    speed = np.max(abs(tracker.q - before) / DT / robot.velocity_limit)
    top_speed = max(top_speed, speed)

show_times("solving", solve_us)
show_times("tick to answer", late_us)
missed = sum(late_us > 1e6 * DT)
print(f"answers after the next tick: {missed} of {ticks}", file=sys.stderr)

print(f"ticks {ticks}: {there} on the target, {on_the_way} on the way, {held} held")
# Searching for the reason takes milliseconds: not for the loop.
if held > 0:
    print(f"first held: {solver.diagnose(lost).cause.name}")
print(f"top speed {top_speed:.3f} of the limit, ends at q", end="")
print("".join(f" {q:.4f}" for q in tracker.q))
