// SPDX-License-Identifier: BSD-3-Clause
// Compiled for this instruction set alone: see lane_math.hpp for what must stay out of here.
#include "simd/kernels.hpp"
#include "simd/lane_kernel.hpp"

namespace iksel::lanes {

using Arch = xsimd::fma3<xsimd::avx2>;
using Doubles = xsimd::batch<double, Arch>;
const LaneKernels kKernelsAvx2 = make_kernels<Doubles, Doubles, xsimd::batch<float, Arch>>("avx2");

}  // namespace iksel::lanes
