# SPDX-License-Identifier: BSD-3-Clause
"""The paper's tables and figures: the published numbers, and how to get them again."""
