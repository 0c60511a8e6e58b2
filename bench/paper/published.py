# SPDX-License-Identifier: BSD-3-Clause
"""The numbers that were published, as data.

Source: Yuan, Wan, Harada, "IKSel: Selecting Good Seed Joint Values for Fast Numerical
Inverse Kinematics Iterations", 2025, by the labels of its tables. Success in percent of
10,000 targets; mean time in ms, in Python on an Intel i7-13700KF. Columns: C0, C1, UR3,
IRB, the order of ROBOTS.
"""

from __future__ import annotations

from dataclasses import dataclass

ROBOTS = ("cvr038", "cvrb1213", "ur3_wrs", "irb14050")

Four = tuple[float, float, float, float]


@dataclass(frozen=True)
class Row:
    """One row of a table."""

    success: Four
    """Percent, in the order of ROBOTS."""
    mean_ms: Four | None = None
    """Mean time, failures included."""


ABLATION_1 = {
    "small": Row((81.61, 83.49, 35.30, 93.99), (1.74, 2.22, 3.39, 1.68)),
    "medium": Row((87.59, 86.75, 73.17, 95.67), (1.56, 2.01, 1.99, 1.56)),
    "large": Row((88.43, 91.09, 87.19, 96.42), (1.54, 1.89, 1.79, 1.55)),
}
"""Table "ablation1": size of the database."""

ABLATION_2 = {
    "dls": Row((87.59, 86.75, 73.17, 95.67), (1.56, 2.01, 1.99, 1.56)),
    "pinv": Row((87.40, 86.43, 73.03, 95.39), (1.60, 2.09, 2.05, 1.60)),
    "pinv_rr": Row((79.76, 76.69, 71.94, 94.67), (2.08, 2.79, 2.79, 1.83)),
    "cwln": Row((91.24, 88.95, 80.34, 96.63), (1.95, 2.44, 2.83, 1.70)),
    "cwpi": Row((87.97, 85.75, 73.65, 95.57), (1.78, 2.27, 2.25, 1.71)),
}
"""Table "ablation2": scheme of iteration."""

ABLATION_3 = {
    "Eq. (2)": Row((61.29, 76.74, 51.21, 83.15), (2.00, 1.89, 2.05, 1.84)),
    "Eq. (5)": Row((87.59, 86.75, 73.17, 95.67), (1.56, 2.01, 1.99, 1.56)),
    "#ReA 3": Row((92.35, 93.84, 85.17, 98.24), (1.84, 2.34, 2.58, 1.69)),
    "#ReA 5": Row((93.63, 95.70, 87.80, 98.82), (2.05, 2.53, 2.94, 1.73)),
    "#ReA 10": Row((94.59, 97.80, 90.94, 99.38), (2.49, 2.81, 3.63, 1.81)),
    "#ReA 20": Row((95.10, 99.03, 92.85, 99.68), (3.12, 3.09, 4.62, 1.89)),
}
"""Table "ablation3": ranking, and number of re-selections."""

TRAC_IK = Row((54.48, 69.95, 56.37, 71.85), (2.07, 2.07, 2.09, 2.11))
"""Table "trad_ik", TRAC-IK."""

BESIDE_TRAC_IK = Row((89.74, 88.18, 77.93, 96.79), (2.17, 2.71, 3.19, 1.93))
"""Table "trad_ik", the proposed method, with one re-selection."""

IK_GEO = {
    "direct": {"cvr038": (94.06, 8.70), "cvrb1213": (98.54, 15.33)},
    "as seed": {"cvr038": (93.61, 9.64), "cvrb1213": (98.47, 21.63)},
}
"""Table "ikgeo": success and mean ms; 1-D search over joint 4 in 36 divisions."""

CVT_ATTEMPTS = (2, 6, 21)
CVT = {
    "cvr038": (90.1, 97.7, 98.9),
    "cvrb1213": (90.3, 97.9, 99.1),
    "ur3_wrs": (88.6, 97.4, 98.4),
    "irb14050": (93.8, 99.0, 99.6),
}
"""The authors' own runs for the revision, CVT with the medium grid's counts: success
after CVT_ATTEMPTS attempts."""
