# SPDX-License-Identifier: BSD-3-Clause
"""The paper's table "learning" as data: success of 2,000 targets, errors, times."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class LearnedRow:
    """One model on one robot.

    The models are not public; those that are trained here have their own sizes.
    """

    direct_ms: float
    """Mean time of a batch of outputs; of the one that an MDN has."""
    position_mm: float
    """Mean over targets of the mean position error of a batch."""
    rotation_deg: float
    """The same of rotations."""
    first_ms: float
    """Mean time of the first output and the iteration from it."""
    first: float
    """Percent solved from it in one attempt."""
    best_ms: float | None = None
    """The same from the best of 32."""
    best: float | None = None


LEARNED = {
    "mdn": {
        "cvr038": LearnedRow(0.39, 17.77, 7.79, 1.60, 87.80),
        "cvrb1213": LearnedRow(0.43, 141.89, 87.15, 2.52, 59.30),
        "ur3_wrs": LearnedRow(0.42, 140.67, 118.70, 3.05, 25.35),
        "irb14050": LearnedRow(0.40, 68.04, 19.14, 1.70, 92.90),
    },
    "flow": {
        "cvr038": LearnedRow(3.74, 7.58, 4.65, 4.65, 88.98, 14.06, 96.72),
        "cvrb1213": LearnedRow(4.53, 50.67, 31.48, 5.12, 82.51, 14.13, 95.10),
        "ur3_wrs": LearnedRow(4.06, 90.89, 101.91, 7.23, 42.61, 16.27, 88.46),
        "irb14050": LearnedRow(4.04, 26.13, 7.98, 4.61, 90.66, 14.05, 98.56),
    },
    "diffusion": {
        "cvr038": LearnedRow(7.72, 8.77, 3.63, 9.25, 94.22, 15.65, 95.95),
        "cvrb1213": LearnedRow(15.77, 18.74, 6.74, 16.34, 90.06, 24.44, 96.50),
        "ur3_wrs": LearnedRow(8.12, 28.49, 25.52, 9.78, 80.70, 16.32, 94.62),
        "irb14050": LearnedRow(7.88, 21.88, 7.35, 10.23, 90.81, 17.16, 97.59),
    },
}
"""By model and robot; "flow" is the paper's IKFlow, "diffusion" its IKDP."""

Spread = tuple[float, float, float, float]
"""Of a batch's errors min, max, Q1 and Q3, each the mean over the targets."""

SPREADS: dict[str, dict[str, tuple[Spread, Spread]]] = {
    "mdn": {},
    "flow": {
        "cvr038": ((1.18, 40.51, 3.15, 8.57), (0.77, 25.89, 2.01, 5.11)),
        "cvrb1213": ((6.51, 355.34, 18.42, 51.90), (1.74, 143.01, 7.27, 41.41)),
        "ur3_wrs": ((10.43, 393.33, 37.70, 113.38), (15.86, 175.70, 63.69, 141.90)),
        "irb14050": ((2.98, 155.21, 8.63, 28.41), (0.94, 54.84, 2.62, 8.07)),
    },
    "diffusion": {
        "cvr038": ((4.22, 18.66, 6.73, 10.26), (1.71, 8.65, 2.77, 4.17)),
        "cvrb1213": ((3.95, 97.11, 9.32, 20.92), (0.72, 62.81, 1.83, 5.58)),
        "ur3_wrs": ((2.65, 251.16, 7.38, 23.82), (1.40, 143.93, 4.58, 28.84)),
        "irb14050": ((2.57, 149.21, 7.41, 21.88), (0.68, 67.79, 1.87, 6.07)),
    },
}
"""Positions [mm] and rotations [degrees]; of an MDN, which has one output, none."""
