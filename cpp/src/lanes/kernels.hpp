// SPDX-License-Identifier: BSD-3-Clause
// The lane kernels by instruction set, and the choice among them.
#pragma once

#include "lanes/lane_types.hpp"

namespace iksel {
namespace lanes {

extern const LaneKernels kernels_scalar;
#if defined(IKSEL_X86)
extern const LaneKernels kernels_sse2;
extern const LaneKernels kernels_avx2;
extern const LaneKernels kernels_avx512;
#elif defined(IKSEL_NEON)
extern const LaneKernels kernels_neon;
#endif

/// The widest that this processor has, or what the environment variable IKSEL_SIMD asks for. Throws
/// InvalidArgumentError if that is unknown or not to be had here.
const LaneKernels& choose_kernels();

}  // namespace lanes
}  // namespace iksel
