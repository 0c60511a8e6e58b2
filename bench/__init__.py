# SPDX-License-Identifier: BSD-3-Clause
"""The evidence: the paper's tables and the rivals side by side.

    python -m bench report [--quick]     # everything, into bench/RESULTS.md
    python -m bench guard                # speed and success against bench/guard.json

Only public interfaces of IKSel are used here. Lengths are metres, angles radians, times
microseconds unless a name says otherwise.
"""
