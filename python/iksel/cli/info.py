# SPDX-License-Identifier: BSD-3-Clause
"""iksel info: one robot's chain, joints and limits."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from iksel.cli._angles import Angles, turning
from iksel.cli._output import (
    add_json,
    number,
    numbers,
    print_json,
    print_pairs,
    print_table,
)
from iksel.cli._robot import default_tip, is_built_in, load, load_tree
from iksel.cli._robot_flags import add_robot
from iksel.pose import euler_from_pose
from iksel.robots import robot_info
from iksel.srdf import Srdf

if TYPE_CHECKING:
    import argparse

    from iksel_cpp import CoupledLimit, LinkTree, MimicCurve, Robot

    from iksel._base.arrays import FloatArray

EXAMPLES = """\
examples:
  iksel info ur3
  iksel info panda --tip panda_link7 --json
  iksel info ur3 --tree
  iksel info arm.urdf
  iksel info arm.urdf --base base_link --tip tool0 --lock wrist=0.5
  iksel info arm.urdf --coupled-limit "-1.2 <= joint_2 + joint_3 <= 2"
  iksel info arm.urdf --srdf arm.srdf --group manipulator
  iksel info arm.urdf.xacro --xacro-arg prefix=left_
  iksel info scene.xml --tip hand
  iksel info rd:panda_description --tip panda_hand

Without --tip or --group, a file that ends in several links is drawn as a tree, with
the links to choose from.
"""

LIMIT_FIELDS = ("lower", "upper", "soft_lower", "soft_upper", "velocity_limit")
LIMIT_HEADER = ("lower", "upper", "velocity")
HEADER = ("joint", "type", *LIMIT_HEADER, "unit", *LIMIT_HEADER, "unit")
SOURCE_FIELDS = ("maker", "licence", "source", "note")


def add_parser(commands: Any) -> None:
    """Add the command."""
    parser = commands.add_parser(
        "info",
        usage="iksel info ROBOT [options]",
        help="show a robot's joints, limits and reach",
        description="Show a robot's links, tool, reach, joints and their limits, and "
        "whether it is solved in closed form, by a sweep over one joint or by search.",
        epilog=EXAMPLES,
    )
    add_robot(parser)
    parser.add_argument(
        "--tree",
        action="store_true",
        help="draw the tree of all links, and list the possible tips",
    )
    add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Show the robot."""
    chosen = arguments.tip or arguments.srdf or arguments.group
    if arguments.tree or not (chosen or is_built_in(arguments.robot)):
        tree = load_tree(arguments)
        several = len(tree.tips) > 1 and default_tip(arguments) is None
        if arguments.tree or several:
            show_tree(tree, arguments)
            return 0
    robot = load(arguments)
    origin = {}
    if is_built_in(arguments.robot):
        info = robot_info(arguments.robot)
        origin = {field: getattr(info, field) for field in SOURCE_FIELDS}
    angles = Angles(arguments)
    srdf = _srdf_facts(robot, arguments.srdf, angles)
    if arguments.json:
        print_json(as_dict(robot, angles) | origin | srdf)
        return 0
    print_pairs(
        [
            ("robot", f"{robot.name}, {robot.dof} degrees of freedom"),
            *_chain_rows(robot),
            *(("coupled limit", str(limit)) for limit in robot.coupled_limits),
            *(("curve", _curve_text(curve)) for curve in robot.mimic_curves),
            ("chain hash", f"{robot.chain_hash:016x}"),
            *((field, text) for field, text in origin.items() if text),
            *((field, ", ".join(names)) for field, names in srdf.items()),
        ]
    )
    print()
    print_table(HEADER, _rows(robot))
    return 0


def _chain_rows(robot: Robot) -> list[tuple[str, str]]:
    """What there is to say of each chain, and of what they share."""
    rows = []
    for tip, link in enumerate(robot.tip_links):
        chain = robot.chain(tip)
        reach = f"{number(chain.reach, 4)} m around {_point(chain.reach_centre)}"
        rows += [
            ("chain", f"{robot.base_link} -> {link}"),
            ("tcp", pose_text(chain.tcp)),
            ("reach", reach),
            ("structure", chain.structure.description),
        ]
    if robot.tips > 1:
        names = [robot.joint_names[joint] for joint in robot.shared_joints]
        rows.append(("shared", ", ".join(names) or "none"))
    return rows


def _srdf_facts(robot: Robot, path: str | None, angles: Angles) -> dict[str, Any]:
    """Groups of an SRDF, and its states that give all joints, in the unit."""
    if path is None:
        return {}
    srdf = Srdf(path)
    states = srdf.states(robot)
    shown = {name: angles.show(robot, q) for name, q in states.items()}
    return {"groups": srdf.groups, "states": shown}


def show_tree(tree: LinkTree, arguments: argparse.Namespace) -> None:
    """Show the links to choose a tip from."""
    if arguments.json:
        fields = ("name", "type", "parent_link", "child_link")
        print_json(
            {
                "name": tree.robot_name,
                "links": tree.links,
                "joints": [{f: getattr(j, f) for f in fields} for j in tree.joints],
                "tips": dict(tree.tips),
            }
        )
        return
    print(tree)
    print()
    print("Links without children; any link may be chosen by --tip and --base:")
    print_table(
        ("tip", "moving joints"), [(link, str(moving)) for link, moving in tree.tips]
    )


def as_dict(robot: Robot, angles: Angles) -> dict[str, Any]:
    """All about a robot as plain data and arrays [m, and rad or deg]."""
    columns = zip(
        robot.joint_names,
        (kind.name for kind in robot.joint_types),
        *(angles.show(robot, array).tolist() for array in _limits(robot)),
        strict=True,
    )
    names = ("name", "type", *LIMIT_FIELDS)
    chains = [_chain_as_dict(robot.chain(tip)) for tip in range(robot.tips)]
    shared = [robot.joint_names[joint] for joint in robot.shared_joints]
    of_chains = {"chains": chains, "shared_joints": shared}
    return {
        "name": robot.name,
        "base_link": robot.base_link,
        "dof": robot.dof,
        "angle_unit": angles.unit,
        **(chains[0] if robot.tips == 1 else of_chains),
        "chain_hash": f"{robot.chain_hash:016x}",
        "coupled_limits": [_limit_as_dict(limit) for limit in robot.coupled_limits],
        "mimic_curves": [_curve_as_dict(curve) for curve in robot.mimic_curves],
        "joints": [dict(zip(names, joint, strict=True)) for joint in columns],
    }


def _chain_as_dict(chain: Robot) -> dict[str, Any]:
    """What is of the chain to one tip."""
    structure = chain.structure
    return {
        "tip_link": chain.tip_link,
        "tcp": chain.tcp,
        "reach": chain.reach,
        "reach_centre": chain.reach_centre,
        "structure": {
            "kind": structure.kind.name,
            "description": structure.description,
        },
    }


def _limit_as_dict(limit: CoupledLimit) -> dict[str, Any]:
    """A coupled limit, always [rad or m]; None for no end."""
    ends = {"lower": limit.lower, "upper": limit.upper}
    return {
        "coefficients": limit.coefficients,
        **{end: x if math.isfinite(x) else None for end, x in ends.items()},
    }


def _curve_text(curve: MimicCurve) -> str:
    return (
        f"{curve.joint} follows {curve.follows} ({len(curve.q)} points, "
        f"{curve.q[0]:.4g} to {curve.q[-1]:.4g})"
    )


def _curve_as_dict(curve: MimicCurve) -> dict[str, Any]:
    """A curve, always [rad or m]; slopes are None where a spline has them."""
    names = ("joint", "follows", "q", "values", "slopes")
    return {name: getattr(curve, name) for name in names}


def pose_text(pose: FloatArray) -> str:
    """A pose in words: position and roll, pitch, yaw."""
    if np.array_equal(pose, np.eye(4)):
        return "none"
    rpy = euler_from_pose(pose)
    return (
        f"xyz {numbers(pose[:3, 3])} m\n"
        f"rpy {numbers(rpy)} rad ({numbers(np.degrees(rpy), 3)} deg)"
    )


def _limits(robot: Robot) -> list[FloatArray]:
    return [getattr(robot, field) for field in LIMIT_FIELDS]


def _rows(robot: Robot) -> list[tuple[str, ...]]:
    """One row per joint; angles in radians and in degrees."""
    rows = []
    for i, (name, turns) in enumerate(
        zip(robot.joint_names, turning(robot), strict=True)
    ):
        values = (robot.lower[i], robot.upper[i], robot.velocity_limit[i])
        degrees = [number(math.degrees(v), 2) if turns else "" for v in values]
        rows.append(
            (
                name,
                robot.joint_types[i].name,
                *(number(v, 4) for v in values),
                "rad" if turns else "m",
                *degrees,
                "deg" if turns else "",
            )
        )
    return rows


def _point(position: FloatArray) -> str:
    return f"({', '.join(number(x, 4) for x in position)})"
