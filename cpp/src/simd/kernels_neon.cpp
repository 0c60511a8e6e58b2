// SPDX-License-Identifier: BSD-3-Clause
// Compiled for this instruction set alone: see lane_math.hpp for what must stay out of here.
#include "simd/kernels.hpp"
#include "simd/lane_kernel.hpp"

namespace iksel::lanes {

using Arch = xsimd::neon64;
using Doubles = xsimd::batch<double, Arch>;
const LaneKernels kKernelsNeon = make_kernels<Doubles, Doubles, xsimd::batch<float, Arch>>("neon");

}  // namespace iksel::lanes
