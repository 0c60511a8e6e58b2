# SPDX-License-Identifier: BSD-3-Clause
"""Which configurations of an arm are free of collisions between its links."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import InvalidArgumentError, UnknownNameError

from iksel._base.arrays import as_floats
from iksel.collision._arm_links import ArmLinks, read_urdf
from iksel.collision._cache_files import file_name, key_of
from iksel.collision._pairs import srdf_pairs, srdf_text
from iksel.collision._search import METHOD, PairSearch, load_verdicts, save_verdicts
from iksel.collision._shapes import Shapes, import_coal, place, read_shapes
from iksel.formats._urdf_xml import read_xml

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Iterable, Iterator, Mapping

    import numpy.typing as npt
    from iksel_cpp import Robot

    from iksel._base.arrays import BoolArray, FloatArray
    from iksel.collision._pairs import Pair
    from iksel.collision._shapes import Placed

_FROM_SRDF = "srdf: "  # before the reason that an SRDF gives


class SelfCollision:
    """Says which configurations of an arm are free of collisions between its links.

    Not all pairs of links are looked at; `ignored` lists the others with the reason:

    - "fixed": the arm does not move the links against each other.
    - "adjacent": one joint connects them; links without geometry between them belong to
      the joint.
    - "srdf: ...": the SRDF disables the pair, with its reason.
    - "apart": one or two joints move them against each other, and wherever these are,
      the links stay clear of each other; that is certain.
    - "always": they touch in all samples.
    - "never": they stay clear of each other in all samples. Samples can miss a
      collision that is rare; an SRDF or `samples=0` ignores none for that reason.
    - "ignore": the argument `ignore` names them.

    Pairs that touch in some samples, but are within the margin in all of them, are held
    to a margin of 0. Safe to ask from many threads at once.
    """

    def __init__(
        self,
        urdf: str | os.PathLike[str],
        robot: Robot,
        *,
        srdf: str | os.PathLike[str] | None = None,
        margin: float = 0.0,
        ignore: Iterable[tuple[str, str]] = (),
        keep: Iterable[tuple[str, str]] = (),
        samples: int = 5_000,
        seed: int = 0,
        other_joints: Mapping[str, float] | None = None,
        packages: Mapping[str, str | os.PathLike[str]] | None = None,
        xacro_args: Mapping[str, str] | None = None,
        trusted: bool = False,
        cache: str | os.PathLike[str] | None = None,
        progress: Callable[[int, int], Any] | None = None,
    ) -> None:
        """Read the collision geometry of all links and find the pairs to look at.

        Args:
            urdf: Path of the URDF or xacro, or URDF text. Boxes, cylinders, spheres
                and meshes.
            robot: The arm whose joint values are asked about, from the same URDF.
            srdf: Path of an SRDF, or its text, whose disable_collisions are ignored,
                for example one that `save_srdf` wrote.
            margin: Links nearer than this collide [m].
            ignore: Pairs of links that may touch.
            keep: Pairs that are looked at whatever else is found.
            samples: Configurations in which to look for pairs that always touch and,
                without an SRDF, for those that never do. 0: neither.
            seed: Of the samples.
            other_joints: Values of joints that are not the arm's [rad or m]; those that
                the arm holds are known, others are 0 if not given.
            packages: Folders of package:// names of meshes; others are looked for
                around the file, in $ROS_PACKAGE_PATH and $AMENT_PREFIX_PATH.
            xacro_args: Values of a xacro file's arguments.
            trusted: Whether a xacro file may run whatever Python it contains.
            cache: Folder, such as the database's, that keeps what was found of the
                pairs, in a file named after the robot and a hash of all that it depends
                on. None: they are looked at anew.
            progress: Called with the number of looks at pairs done and in all: each is
                looked at for a proof, and in samples.

        Raises:
            InvalidArgumentError: coal is missing, margin or samples is negative, a pair
                is both in `ignore` and in `keep`, or the cache cannot be written.
            UrdfError: The URDF, the SRDF or a mesh cannot be read, there is no
                collision geometry, or joints mimic each other in a circle.
            UnknownNameError: The URDF lacks a joint of the arm or of a mimic tag, or
                what `ignore`, `keep` or `other_joints` names; or `packages` lacks a
                folder.
        """
        if not 0 <= margin < np.inf:
            raise InvalidArgumentError(f"margin: {margin} m is not 0 or more")
        if samples < 0:
            raise InvalidArgumentError(f"samples: {samples} is not 0 or more")
        coal = import_coal()
        root, folder = read_urdf(
            urdf, packages or {}, xacro_args, robot.base_link, trusted=trusted
        )
        shapes = read_shapes(coal, root, folder, packages or {})
        self._dof = robot.dof
        self._name = root.get("name", "")
        self._links = ArmLinks(root, robot, other_joints or {})
        self._shapes = Shapes(coal, shapes, self._links)
        self._kept = self._read_pairs("keep", keep)
        self._ignored: dict[Pair, str] = {}
        self._ignore_listed(srdf, self._read_pairs("ignore", ignore))
        pairs = [pair for pair in self._left() if frozenset(pair) not in self._kept]
        search = PairSearch(margin, samples, seed, never=srdf is None)
        file = None
        if cache is not None:
            joints = (robot.chain_hash, robot.lower.tolist(), robot.upper.tolist())
            others = sorted((other_joints or {}).items())
            made_of = (joints, others, pairs, search)
            key = key_of(METHOD, root, folder, packages or {}, made_of)
            file = Path(cache) / file_name(robot.name, key, "pairs.json")
        found = load_verdicts(file, pairs) if file is not None else None
        if found is None:
            found = search.run(self._shapes, self._links, robot, pairs, progress)
            if file is not None:
                save_verdicts(file, found)
        close = {pair for pair, verdict in found.items() if verdict == "close"}
        self._ignored |= {p: why for p, why in found.items() if p not in close}
        # Close ones cannot keep the margin.
        self._margins = {p: 0.0 if p in close else margin for p in self._left()}
        self._list_parts()

    @property
    def pairs(self) -> list[tuple[str, str]]:
        """The pairs of links that are looked at."""
        return list(self._margins)

    @property
    def ignored(self) -> dict[tuple[str, str], str]:
        """The pairs of links that are not looked at, with the reason."""
        return dict(self._ignored)

    def save_srdf(self, path: str | os.PathLike[str]) -> None:
        """Write an SRDF that disables the ignored pairs.

        Read by `srdf=` it spares the sampling, and it can be edited.

        Args:
            path: The file to write.
        """
        reasons = {
            pair: reason.removeprefix(_FROM_SRDF)
            for pair, reason in self._ignored.items()
        }
        Path(path).write_text(srdf_text(self._name, reasons), encoding="utf-8")

    def __call__(self, q: npt.ArrayLike) -> BoolArray:
        """Say which configurations are free.

        Args:
            q: Joint values, (n, dof) [rad or m].

        Returns:
            (n,) truth values.

        Raises:
            InvalidArgumentError: Wrong shape or dtype, or a number that is not finite.
        """
        values = as_floats("q", q, (self._dof,))
        found = self._first_colliding(values.reshape(-1, self._dof))
        free = np.array([pair is None for pair in found], dtype=bool)
        return free.reshape(values.shape[:-1])

    def colliding_links(self, q: npt.ArrayLike) -> tuple[str, str] | None:
        """The first pair of links that collide at q, (dof,), or None."""
        return self._first_colliding(as_floats("q", q, (self._dof,)).reshape(1, -1))[0]

    def place(self, q: FloatArray) -> Iterator[Placed]:
        """Place all shapes at configurations (n, dof), some of them at a time."""
        return place(self._shapes, self._links, q)

    @property
    def moves(self) -> BoolArray:
        """Which shapes the arm moves against its base, (shapes,)."""
        return self._shapes.moving

    def geometry(self, shape: int) -> Any:
        """Coal's geometry of a shape."""
        return self._shapes.geometry(shape)

    def _first_colliding(self, q: FloatArray) -> list[Pair | None]:
        found: list[Pair | None] = []
        for placed in place(self._shapes, self._links, q):
            near = placed.near(self._part_shapes, self._part_margins)
            found += [
                self._first_touching(placed, n, row) for n, row in enumerate(near)
            ]
        return found

    def _first_touching(self, placed: Placed, n: int, near: BoolArray) -> Pair | None:
        for k in np.flatnonzero(near):
            pair, margin, part = self._parts[k]
            if self._shapes.touch(placed, n, part, margin):
                return pair
        return None

    def _read_pairs(self, argument: str, pairs: Iterable[Pair]) -> set[frozenset[str]]:
        found = set()
        for pair in pairs:
            for link in pair:
                if link not in self._links.links:
                    raise UnknownNameError(
                        f"{argument}: the URDF has no link {link!r}; it has: "
                        f"{', '.join(self._links.links)}"
                    )
            found.add(frozenset(pair))
        return found

    def _ignore_listed(
        self, srdf: str | os.PathLike[str] | None, ignore: set[frozenset[str]]
    ) -> None:
        """Ignore what is known without samples."""
        for pair in ignore & self._kept:
            raise InvalidArgumentError(
                f"ignore: {' and '.join(sorted(pair))} are in keep too"
            )
        disabled = {}
        if srdf is not None:
            disabled = srdf_pairs(read_xml("srdf", srdf)[0], self._links.links)
        adjacent = self._links.neighbours(self._shapes.links)
        body = self._links.body
        for a, b in self._left():
            pair = frozenset((a, b))
            if pair in self._kept:
                continue
            if pair in ignore:
                self._ignored[a, b] = "ignore"
            elif body[a] == body[b]:
                self._ignored[a, b] = "fixed"
            elif pair in adjacent:
                self._ignored[a, b] = "adjacent"
            elif pair in disabled:
                self._ignored[a, b] = f"{_FROM_SRDF}{disabled[pair]}"

    def _left(self) -> list[Pair]:
        """The pairs that are not ignored so far."""
        pairs = combinations(self._shapes.links, 2)
        return [pair for pair in pairs if pair not in self._ignored]

    def _list_parts(self) -> None:
        """Lay out the pairs of shapes that are looked at, and what they belong to."""
        of_link = self._shapes.of_link
        self._parts = [
            (pair, margin, (i, j))
            for pair, margin in self._margins.items()
            for i in of_link[pair[0]]
            for j in of_link[pair[1]]
        ]
        shapes = [part for _, _, part in self._parts]
        self._part_shapes = np.array(shapes, dtype=int).reshape(-1, 2)
        self._part_margins = np.array([margin for _, margin, _ in self._parts])
