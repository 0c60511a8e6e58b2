# SPDX-License-Identifier: BSD-3-Clause
"""IKSel beside solvers that enumerate: a yes, all branches, the nearest, a no."""
