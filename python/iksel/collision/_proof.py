# SPDX-License-Identifier: BSD-3-Clause
"""Which pairs of links certainly never collide, whatever the joints do."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from iksel.collision._shapes import place

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from iksel_cpp import Robot

    from iksel._base.arrays import FloatArray
    from iksel.collision._arm_links import ArmLinks
    from iksel.collision._shapes import Placed, Shapes

    Pair = tuple[str, str]

_MOST_JOINTS = 2
"""That move two links against each other; with more, cells would be too many."""
_MOST_CELLS = 20_000
"""Looked at for a pair: what is not proven by then is not worth the time."""
_MOST_TESTS = 100_000
"""Of two hulls, for all pairs together: some seconds, however many links there are."""


class PairProver:
    """Proves that two links stay apart, where two joints at most move them.

    The joints' ranges are divided into cells. In the middle of a cell the links are
    farther apart than any point of them moves inside it, or the cell is divided. With
    two joints, seen from what is between these, each joint moves one of the links, and
    each point of it at most by the angle times its distance from the axis.

    Convex hulls stand for meshes, as what encloses them: how far these are apart is
    known a thousand times as fast.
    """

    def __init__(self, shapes: Shapes, links: ArmLinks, robot: Robot) -> None:
        self._shapes = shapes
        self._links = links
        self._names = robot.joint_names
        # Of a continuous joint one turn is all.
        lower = np.where(np.isfinite(robot.lower), robot.lower, -np.pi)
        upper = np.where(np.isfinite(robot.upper), robot.upper, np.pi)
        self._middle, self._half = (lower + upper) / 2, (upper - lower) / 2
        self._tests = 0  # that may still be made

    def look(self, pairs: Sequence[Pair], margin: float) -> Iterator[tuple[Pair, bool]]:
        """Say of pairs of links whether they certainly stay farther apart than margin.

        Each may use an equal part of the tests that are left.

        Args:
            pairs: Of links.
            margin: Their least distance [m].
        """
        waiting = sum(bool(self._joints_between(pair)) for pair in pairs)
        left = _MOST_TESTS
        for pair in pairs:
            if not self._joints_between(pair):
                yield pair, False
                continue
            own = self._tests = left // waiting
            yield pair, self._are_apart(pair, margin)
            left -= own - self._tests
            waiting -= 1

    def _joints_between(self, pair: Pair) -> list[str]:
        """The joints that move two links; none: too many, or not the arm's."""
        joints = self._links.joints_between(*pair) or []
        return joints if len(joints) <= _MOST_JOINTS else []

    def _are_apart(self, pair: Pair, margin: float) -> bool:
        """Whether two links are, as far as the tests that are left can tell."""
        joints = self._joints_between(pair)
        columns = [self._names.index(name) for name in joints]
        half = self._half[columns]
        # The joint nearest to a link moves this one; a joint alone moves the second.
        moved = pair[-len(joints) :]
        speed = np.array(
            [self._speed(*each) for each in zip(columns, joints, moved, strict=True)]
        )
        cells = self._middle[columns][None]
        looked_at = 0
        while len(cells):
            looked_at += len(cells)
            if looked_at > _MOST_CELLS:
                return False
            left = self._near(pair, columns, cells, margin + float(speed @ half))
            if len(self._near(pair, columns, left[:1], margin)):
                return False
            widest = np.argmax(speed * half)
            half[widest] /= 2
            step = half * (np.arange(len(columns)) == widest)
            cells = np.concatenate([left - step, left + step])
        return True

    def _near(
        self, pair: Pair, columns: list[int], cells: FloatArray, margin: float
    ) -> FloatArray:
        """The cells in whose middles the hulls are within margin, or may be."""
        q = np.repeat(self._middle[None], len(cells), axis=0)
        q[:, columns] = cells
        parts = self._shapes.parts(pair)
        found = [
            any(self._touch(placed, n, parts[k], margin) for k in np.flatnonzero(row))
            for placed in place(self._shapes, self._links, q)
            for n, row in enumerate(placed.near(np.array(parts), margin))
        ]
        near: FloatArray = cells[np.array(found, dtype=bool)]
        return near

    def _touch(
        self, placed: Placed, n: int, part: tuple[int, int], margin: float
    ) -> bool:
        """Whether two hulls are within margin; taken for so once no test is left."""
        if self._tests == 0:
            return True
        self._tests -= 1
        return self._shapes.touch(placed, n, part, margin, hulls=True)

    def _speed(self, column: int, joint: str, link: str) -> float:
        """How far a joint moves any point of a link that it is next to [m per unit]."""
        q = np.stack([self._middle, self._middle])
        q[1, column] += 1.0
        child = self._links.index[self._links.child_of[joint]]
        parent = self._links.index[self._links.parent_of[joint]]
        poses = self._links.poses(q)
        before, after = np.linalg.solve(poses[:, parent], poses[:, child])
        turn = before[:3, :3].T @ after[:3, :3]
        axis = np.array(
            [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]
        )
        length = np.linalg.norm(axis)
        if length < 1e-9:
            return float(np.linalg.norm(after[:3, 3] - before[:3, 3]))
        # The origin of the child's frame is on the axis.
        in_joint = np.linalg.solve(poses[0, child], poses[0, self._links.index[link]])
        points = self._corners(link) @ in_joint[:3, :3].T + in_joint[:3, 3]
        return float(np.linalg.norm(np.cross(axis / length, points), axis=1).max())

    def _corners(self, link: str) -> FloatArray:
        """Points around the link's shapes, in its frame."""
        signs = np.array(list(product((-1, 1), repeat=3)))
        of_link = self._shapes.of_link[link]
        return np.concatenate(
            [
                self._shapes.centre[i] + signs @ self._shapes.half_axes[i].T
                for i in of_link
            ]
        )
