# SPDX-License-Identifier: BSD-3-Clause
"""What sections that have no folder of their own measure: their jobs of cells."""
