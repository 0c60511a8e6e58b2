# SPDX-License-Identifier: BSD-3-Clause
"""The paper's tables and figures: what was published, and the runs that make it again."""
