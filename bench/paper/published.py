# SPDX-License-Identifier: BSD-3-Clause
"""The numbers that were published, as data.

Source: Yuan, Wan, Harada, "IKSel: Selecting Good Seed Joint Values for Fast Numerical
Inverse Kinematics Iterations", 2025, by the labels of its tables. Success in percent of
10,000 targets; times in ms, in Python on an Intel i7-13700KF. Columns: C0, C1, UR3,
IRB, the order of ROBOTS.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

ROBOTS = ("cvr038", "cvrb1213", "ur3_wrs", "irb14050")

TARGETS = 10_000
"""Of each row."""

Four = tuple[float, float, float, float]


class Times(NamedTuple):
    """Times of one robot [ms], failures included."""

    mean: float
    std: float
    least: float
    most: float


@dataclass(frozen=True)
class Row:
    """One row of a table."""

    success: Four
    """Percent, in the order of ROBOTS."""
    times: tuple[Times, Times, Times, Times]
    """The same order."""


def _row(success: Four, *times: tuple[float, float, float, float]) -> Row:
    c0, c1, ur3, irb = (Times(*values) for values in times)
    return Row(success, (c0, c1, ur3, irb))


MEDIUM = _row(
    (87.59, 86.75, 73.17, 95.67),
    (1.56, 0.68, 0.86, 5.13),
    (2.01, 0.86, 0.88, 6.68),
    (1.99, 0.81, 0.84, 5.13),
    (1.56, 0.58, 0.98, 5.40),
)
"""The default setting, a row of each of the three ablations."""

ABLATION_1 = {
    "small": _row(
        (81.61, 83.49, 35.30, 93.99),
        (1.74, 0.75, 0.86, 4.99),
        (2.22, 0.99, 0.88, 7.99),
        (3.39, 1.04, 0.87, 6.65),
        (1.68, 0.69, 0.97, 5.61),
    ),
    "medium": MEDIUM,
    "large": _row(
        (88.43, 91.09, 87.19, 96.42),
        (1.54, 0.68, 0.89, 6.38),
        (1.89, 0.73, 0.93, 6.91),
        (1.79, 0.87, 0.90, 7.09),
        (1.55, 0.53, 1.03, 6.92),
    ),
}
"""Table "ablation1": size of the database."""

ABLATION_2 = {
    "dls": MEDIUM,
    "pinv": _row(
        (87.40, 86.43, 73.03, 95.39),
        (1.60, 0.71, 0.86, 6.12),
        (2.09, 0.89, 0.91, 8.15),
        (2.05, 0.85, 0.87, 7.16),
        (1.60, 0.60, 0.78, 6.39),
    ),
    "pinv_rr": _row(
        (79.76, 76.69, 71.94, 94.67),
        (2.08, 1.24, 0.89, 7.29),
        (2.79, 1.24, 1.08, 7.87),
        (2.79, 1.31, 0.91, 7.07),
        (1.83, 0.96, 1.05, 8.36),
    ),
    "cwln": _row(
        (91.24, 88.95, 80.34, 96.63),
        (1.95, 1.32, 0.87, 9.10),
        (2.44, 1.34, 0.92, 9.05),
        (2.83, 1.54, 0.90, 8.93),
        (1.70, 0.97, 0.99, 5.87),
    ),
    "cwpi": _row(
        (87.97, 85.75, 73.65, 95.57),
        (1.78, 0.91, 0.92, 7.37),
        (2.27, 0.97, 0.98, 8.79),
        (2.25, 0.96, 0.95, 7.27),
        (1.71, 0.60, 1.08, 7.04),
    ),
}
"""Table "ablation2": scheme of iteration."""

ABLATION_3 = {
    "Eq. (2)": _row(
        (61.29, 76.74, 51.21, 83.15),
        (2.00, 0.87, 0.84, 5.75),
        (1.89, 0.77, 0.84, 5.53),
        (2.05, 1.06, 0.83, 5.45),
        (1.84, 0.73, 0.95, 5.38),
    ),
    "Eq. (5)": MEDIUM,
    "#ReA 3": _row(
        (92.35, 93.84, 85.17, 98.24),
        (1.84, 1.34, 0.86, 9.31),
        (2.34, 1.56, 0.89, 9.47),
        (2.58, 1.63, 0.87, 11.81),
        (1.69, 1.04, 0.99, 9.60),
    ),
    "#ReA 5": _row(
        (93.63, 95.70, 87.80, 98.82),
        (2.05, 2.02, 0.86, 14.05),
        (2.53, 2.15, 0.88, 13.93),
        (2.94, 2.41, 0.87, 14.00),
        (1.73, 1.34, 0.98, 15.45),
    ),
    "#ReA 10": _row(
        (94.59, 97.80, 90.94, 99.38),
        (2.49, 3.57, 0.86, 31.32),
        (2.81, 3.31, 0.89, 25.35),
        (3.63, 4.15, 0.87, 25.02),
        (1.81, 1.93, 0.98, 27.07),
    ),
    "#ReA 20": _row(
        (95.10, 99.03, 92.85, 99.68),
        (3.12, 6.18, 0.86, 46.17),
        (3.09, 4.62, 0.88, 46.13),
        (4.62, 7.23, 0.86, 48.38),
        (1.89, 2.72, 0.99, 49.27),
    ),
}
"""Table "ablation3": ranking, and number of re-selections."""

DATABASE_SIZES = {
    "small": ((12_000, 0.8), (48_000, 3.3)),
    "medium": ((40_320, 2.8), (201_600, 13.6)),
    "large": ((151_200, 10.8), (604_800, 43.3)),
}
"""Table "kdtree-sizes": samples and "query file size" in MB, of C0, C1 and UR3 each,
and of IRB."""

TRAC_IK = _row(
    (54.48, 69.95, 56.37, 71.85),
    (2.07, 0.61, 0.86, 4.53),
    (2.07, 0.53, 0.87, 3.16),
    (2.09, 0.57, 0.86, 3.14),
    (2.11, 0.70, 1.01, 5.53),
)
"""Table "trad_ik", TRAC-IK. In the authors' log of that month these numbers, times
included, stand under the label of the unsorted baseline."""

TRAC_IK_LOG: Four = (55.62, 69.82, 57.03, 72.06)
"""Success under the label of TRAC-IK in that log."""

BESIDE_TRAC_IK = _row(
    (89.74, 88.18, 77.93, 96.79),
    (2.17, 1.54, 0.93, 10.49),
    (2.71, 1.52, 0.99, 9.20),
    (3.19, 1.85, 0.95, 16.46),
    (1.93, 1.14, 1.06, 13.68),
)
"""Table "trad_ik", the proposed method, with one re-selection."""

PINV_RR_LOG: Four = (80.82, 82.19, 71.75, 94.79)
"""The authors' own log of a run of pinv_rr as its reference implementation reads."""

PINV_RR_C1_RUNS = (76.7, 88.1)
"""Least and most success of pinv_rr on C1 in the authors' runs of one day."""

IK_GEO = {
    "direct": {"cvr038": (94.06, 8.70), "cvrb1213": (98.54, 15.33)},
    "as seed": {"cvr038": (93.61, 9.64), "cvrb1213": (98.47, 21.63)},
}
"""Table "ikgeo": success and mean ms; 1-D search over joint 4 in 36 divisions."""

IK_GEO_ERRORS = {
    "cvr038": {
        "position_mm": (6.96, 8.99, 0.00, 2.89, 8.93, 133.56),
        "rotation_deg": (1.67, 5.93, 0.00, 0.12, 1.13, 88.84),
    },
    "cvrb1213": {
        "position_mm": (31.56, 46.80, 0.00, 11.55, 35.38, 495.95),
        "rotation_deg": (2.90, 8.14, 0.00, 0.18, 2.04, 87.46),
    },
}
"""The same table, direct search: mean, deviation, least, quartiles 1 and 3, most."""

NEWER_COMMIT = "96c863f1"
"""Of https://github.com/wanweiwei07/one, which has the authors' newer selection."""

NEWER_TITLE = "fixed ik sel issues, reduced t to 3ms"
"""Of its commit f807469 of 2026-05-13."""

NEWER_MS = 3.0
"""All that it says of success or time, by that title: of Python, on which robot and
machine is not said."""

NEWER_RUN = ((98.96, 1.79), (98.86, 1.93), (99.88, 1.43), (97.26, 2.62))
"""Success and mean attempts of that code itself, in the order of ROBOTS: run by hand on
the chains and the first NEWER_TARGETS targets of the benchmark, tip link and all, one
solution asked for, over a database that it made itself."""
NEWER_TARGETS = 5_000
NEWER_WHEN = "November 2026"

CVT_ATTEMPTS = (2, 6, 21)
CVT = {
    "cvr038": (90.1, 97.7, 98.9),
    "cvrb1213": (90.3, 97.9, 99.1),
    "ur3_wrs": (88.6, 97.4, 98.4),
    "irb14050": (93.8, 99.0, 99.6),
}
"""The authors' own runs for the revision, CVT with the medium grid's counts: success
after CVT_ATTEMPTS attempts, seeds in the order of Eq. (5) (no farthest-first)."""
