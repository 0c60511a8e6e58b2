# SPDX-License-Identifier: BSD-3-Clause
"""The parts of RESULTS.md, each from the results alone."""
