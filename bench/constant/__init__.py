# SPDX-License-Identifier: BSD-3-Clause
"""What a constant of the core does: the core with other values, on random arms."""
