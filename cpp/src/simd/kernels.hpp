// SPDX-License-Identifier: BSD-3-Clause
// The lane kernels by instruction set, and the choice among them.
#pragma once

#include "simd/lane_types.hpp"

namespace iksel::lanes {

extern const LaneKernels kKernelsScalar;
// Of these, what IKSEL_SIMD_LEVELS of CMake names.
extern const LaneKernels kKernelsSse2;
extern const LaneKernels kKernelsAvx2;
extern const LaneKernels kKernelsAvx512;
extern const LaneKernels kKernelsNeon;

/// The widest that was built and that this processor has, or what the environment variable
/// IKSEL_SIMD asks for. Throws InvalidArgumentError if that is unknown or not to be had here.
const LaneKernels& choose_kernels();

}  // namespace iksel::lanes
