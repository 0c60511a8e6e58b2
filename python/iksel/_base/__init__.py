# SPDX-License-Identifier: BSD-3-Clause
"""What all parts of iksel use: arrays, files, errors of extras, rotations."""
