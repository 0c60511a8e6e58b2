# SPDX-License-Identifier: BSD-3-Clause
"""The command line as `python -m iksel`."""

import sys

from iksel.cli import main

sys.exit(main())
