# SPDX-License-Identifier: BSD-3-Clause
"""Rotations in their four notations, over leading axes and without checks.

Each formula keeps full precision everywhere: near the angles 0 and pi, and where the
pitch is +-pi/2.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from iksel._base.arrays import FloatArray


def from_quaternion(q: FloatArray) -> FloatArray:
    """Rotation matrices (..., 3, 3) of unit quaternions (w, x, y, z), (..., 4)."""
    w, x, y, z = np.moveaxis(q, -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return _stack(rows)


def quaternion_from_vector(vector: FloatArray) -> FloatArray:
    """Unit quaternions (w, x, y, z), (..., 4), of rotation vectors (..., 3) [rad]."""
    x, y, z = np.moveaxis(vector, -1, 0)
    half = np.hypot(np.hypot(x, y), z) / 2
    # np.sinc(t) = sin(pi t) / (pi t), which has its limit at 0 built in.
    imaginary = vector * (np.sinc(half / np.pi) / 2)[..., None]
    return np.concatenate([np.cos(half)[..., None], imaginary], axis=-1)


def vector_from_quaternion(q: FloatArray) -> FloatArray:
    """Rotation vectors (..., 3) [rad] of unit quaternions with w >= 0, (..., 4)."""
    w, imaginary = q[..., 0], q[..., 1:]
    sine = np.linalg.norm(imaginary, axis=-1)
    tiny = sine < 1e-8
    # Below 1e-8 the quotient angle / sine is 2 to the last bit.
    factor = 2 * np.arctan2(sine, w) / np.where(tiny, 1.0, sine)
    return np.asarray(imaginary * np.where(tiny, 2.0, factor)[..., None])


def quaternion_from_matrix(r: FloatArray) -> FloatArray:
    """Unit quaternions (w, x, y, z), w >= 0, (..., 4), of rotations (..., 3, 3)."""
    xx, yy, zz = r[..., 0, 0], r[..., 1, 1], r[..., 2, 2]
    wx = r[..., 2, 1] - r[..., 1, 2]
    wy = r[..., 0, 2] - r[..., 2, 0]
    wz = r[..., 1, 0] - r[..., 0, 1]
    xy = r[..., 1, 0] + r[..., 0, 1]
    xz = r[..., 0, 2] + r[..., 2, 0]
    yz = r[..., 2, 1] + r[..., 1, 2]
    # 4 q q^T; its row with the largest diagonal element is q up to a factor.
    outer = _stack(
        [
            [1 + xx + yy + zz, wx, wy, wz],
            [wx, 1 + xx - yy - zz, xy, xz],
            [wy, xy, 1 - xx + yy - zz, yz],
            [wz, xz, yz, 1 - xx - yy + zz],
        ]
    )
    best = np.argmax(np.diagonal(outer, axis1=-2, axis2=-1), axis=-1)
    q = np.take_along_axis(outer, best[..., None, None], axis=-2)[..., 0, :]
    q = q / np.linalg.norm(q, axis=-1, keepdims=True)
    leading = np.argmax(q != 0, axis=-1)
    sign = np.sign(np.take_along_axis(q, leading[..., None], axis=-1))
    return np.asarray(q * sign + 0.0)


def from_euler(rpy: FloatArray) -> FloatArray:
    """Rotation matrices (..., 3, 3) Rz(y) Ry(p) Rx(r) of (r, p, y), (..., 3) [rad]."""
    (sr, sp, sy), (cr, cp, cy) = (np.moveaxis(f(rpy), -1, 0) for f in (np.sin, np.cos))
    rows = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    return _stack(rows)


def euler_from_matrix(r: FloatArray) -> FloatArray:
    """Roll, pitch and yaw (..., 3) [rad] with R = Rz(y) Ry(p) Rx(r)."""
    yaw = np.arctan2(r[..., 1, 0], r[..., 0, 0])
    sine, cosine = np.sin(yaw), np.cos(yaw)
    # With the yaw taken out, what is left is Ry(p) Rx(r). Whatever yaw rounding gives
    # at a pitch of +-pi/2, the roll makes up for it.
    pitch = np.arctan2(-r[..., 2, 0], cosine * r[..., 0, 0] + sine * r[..., 1, 0])
    roll = np.arctan2(
        sine * r[..., 0, 2] - cosine * r[..., 1, 2],
        cosine * r[..., 1, 1] - sine * r[..., 0, 1],
    )
    return np.stack([roll, pitch, yaw], axis=-1)


def _stack(rows: list[list[FloatArray]]) -> FloatArray:
    """Matrices (..., n, m) of their elements (...)."""
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
