# SPDX-License-Identifier: BSD-3-Clause
"""Files of robots and objects of other libraries: all of them become URDF."""
