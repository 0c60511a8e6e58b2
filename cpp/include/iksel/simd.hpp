// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "iksel/export.hpp"

namespace iksel {

/// The instruction set whose lanes solve on this machine: avx512, avx2, sse2, neon or scalar. The
/// environment variable IKSEL_SIMD forces one. Throws InvalidArgumentError if it is not to be had.
IKSEL_EXPORT const char* simd_level();

}  // namespace iksel
