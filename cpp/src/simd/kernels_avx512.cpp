// SPDX-License-Identifier: BSD-3-Clause
// Compiled for this instruction set alone: see lane_math.hpp for what must stay out of here.
#include "simd/kernels.hpp"
#include "simd/lane_kernel.hpp"

namespace iksel::lanes {

using Arch = xsimd::avx512f;
const LaneKernels kKernelsAvx512 =
    make_kernels<xsimd::batch<double, Arch>, xsimd::batch<float, Arch>>("avx512");

}  // namespace iksel::lanes
