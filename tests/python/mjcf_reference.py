# SPDX-License-Identifier: BSD-3-Clause
"""MJCF files as MuJoCo sees them."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np

import iksel
from iksel.formats._mjcf import compile_bare

if TYPE_CHECKING:
    from pathlib import Path


class MjcfFile:
    """An MJCF file in MuJoCo, with all its geometry if that can be found.

    Attributes:
        parsed: Whether MuJoCo compiles it.
        whole: Whether it does with everything in it; else without geometry.
        tips: Names of the bodies that hold no other and no site with a name, and of
            such sites but the world's, `SITE/site` where a body has the name, too.
    """

    def __init__(self, path: Path) -> None:
        import mujoco  # noqa: PLC0415 (tests skip without it)

        self._mujoco = mujoco
        self.path, self.parsed, self.whole = path, True, True
        self.tips: list[str] = []
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                self._model = mujoco.MjModel.from_xml_path(str(path))
            except (ValueError, RuntimeError, mujoco.FatalError):
                self.whole = False
                self.parsed = self._compile_bare()
        if self.parsed:
            model = self._model
            self._data = mujoco.MjData(model)
            names = [model.body(i).name or f"body{i}" for i in range(model.nbody)]
            self._number = {name: i for i, name in enumerate(names)}
            holding = set(model.body_parentid[1:].tolist())
            self._site: dict[str, int] = {}
            for i in range(model.nsite):
                name, body = model.site(i).name, int(model.site_bodyid[i])
                if name and body:
                    self._site[f"{name}/site" if name in self._number else name] = i
                    holding.add(body)
            self.tips = [n for n, i in self._number.items() if i not in holding]
            self.tips += self._site

    def compare(self, robot: iksel.Robot, seed: int, count: int = 5) -> None:
        """Check that poses of a robot of this file, from the world, are MuJoCo's."""
        q = robot.random_configurations(count, seed=seed)
        where = f"{self.path} to {robot.tip_link}, seed {seed}"
        expected = self.poses(robot, q)
        np.testing.assert_allclose(
            robot.fk(q), expected, rtol=0, atol=1e-9, err_msg=where
        )

    def poses(self, robot: iksel.Robot, q: np.ndarray) -> np.ndarray:
        """MuJoCo's T_base_tip (n, 4, 4) at joint values (n, dof)."""
        model, data = self._model, self._data
        poses = np.empty((len(q), 4, 4))
        addresses = [self._address(name) for name in robot.joint_names]
        for i, row in enumerate(q):
            data.qpos[:] = model.qpos0
            data.qpos[addresses] = row
            self._mujoco.mj_kinematics(model, data)
            base, tip = map(self._pose, (robot.base_link, robot.tip_link))
            poses[i] = np.linalg.solve(base, tip)
        return poses

    def cause(self, tip: str, message: str) -> str | None:
        """Why a chain from the world cannot be used, if the file bears it out."""
        if not self.parsed:
            return "MuJoCo cannot read the file either"
        kinds = self._mujoco.mjtJoint
        types, unlimited = set(), False
        for joint in self._chain(tip):
            kind = kinds(int(self._model.jnt_type[joint]))
            types.add(kind)
            slides = kind == kinds.mjJNT_SLIDE
            unlimited |= slides and not self._model.jnt_limited[joint]
        for kind, word in ((kinds.mjJNT_FREE, "free"), (kinds.mjJNT_BALL, "ball")):
            if kind in types and f"{word} joint of body" in message:
                return f"a {word} joint"
        if "no movable joint" in message and not types:
            return "nothing moves"
        if "limit" in message and unlimited:
            return "a slide without a range"
        return None

    def _chain(self, tip: str) -> list[int]:
        """The joints between the world and a body."""
        model, joints = self._model, []
        of_site = tip in self._site
        body = model.site_bodyid[self._site[tip]] if of_site else self._number[tip]
        while body:
            first, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
            joints += range(first, first + count)
            body = int(model.body_parentid[body])
        return joints

    def _address(self, joint: str) -> int:
        """Where a joint's value is in qpos."""
        found = self._mujoco.mj_name2id(
            self._model, self._mujoco.mjtObj.mjOBJ_JOINT, joint
        )
        number = int(joint.rpartition("/joint")[2]) if found < 0 else found
        return int(self._model.jnt_qposadr[number])

    def _pose(self, name: str) -> np.ndarray:
        """T_world_body or T_world_site."""
        data = self._data
        if name in self._site:
            place, turn = data.site_xpos, data.site_xmat
        else:
            place, turn = data.xpos, data.xmat
        number = self._site.get(name, self._number.get(name))
        pose = np.eye(4)
        pose[:3, :3] = turn[number].reshape(3, 3)
        pose[:3, 3] = place[number]
        return pose

    def _compile_bare(self) -> bool:
        """Compile bodies and joints alone, as IKSel does: meshes may be missing."""
        try:
            spec = self._mujoco.MjSpec.from_file(str(self.path))
            self._model = compile_bare(spec)
        except (ValueError, RuntimeError, TypeError, self._mujoco.FatalError):
            return False
        return True
