# SPDX-License-Identifier: BSD-3-Clause
"""Seeds from learned models, after the paper's table "learning": MDN, flow, diffusion.

Trained and run with JAX on one CPU thread; `python -m bench learned --help`.
"""

import os

# Read when JAX is first imported: one thread, as every solver of the benchmarks has.
os.environ.setdefault("XLA_FLAGS", "--xla_cpu_multi_thread_eigen=false")
os.environ.setdefault("JAX_PLATFORMS", "cpu")
