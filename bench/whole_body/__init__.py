# SPDX-License-Identifier: BSD-3-Clause
"""Robots with a torso and two arms, both hands at once: beside loops."""
