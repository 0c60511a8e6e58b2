# SPDX-License-Identifier: BSD-3-Clause
"""What means hide: the slowest calls, the first ones, and calls beside other work."""
