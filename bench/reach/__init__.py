# SPDX-License-Identifier: BSD-3-Clause
"""What reachability maps cost, and that every engine writes the same ones."""
