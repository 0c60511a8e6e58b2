// SPDX-License-Identifier: BSD-3-Clause
// Compiled for this instruction set alone: see lane_math.hpp for what must stay out of here.
#include "simd/kernels.hpp"
#include "simd/lane_kernel.hpp"

namespace iksel::lanes {

using Arch = xsimd::sse2;
using Doubles = xsimd::batch<double, Arch>;
const LaneKernels kKernelsSse2 = make_kernels<Doubles, Doubles, xsimd::batch<float, Arch>>("sse2");

}  // namespace iksel::lanes
