# SPDX-License-Identifier: BSD-3-Clause
"""IK-Geo's one-dimensional search, written from its paper."""
