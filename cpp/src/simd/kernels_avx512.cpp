// SPDX-License-Identifier: BSD-3-Clause
// Compiled for this instruction set alone: see lane_math.hpp for what must stay out of here.
#include "simd/kernels.hpp"
#include "simd/lane_kernel.hpp"

namespace iksel::lanes {

using Whole = xsimd::avx512f;
/// Packs of half the width with the registers of AVX-512: a type of its own, lest the linker take
/// what is compiled here for the kernels of AVX2.
struct Half : xsimd::fma3<xsimd::avx2> {};

}  // namespace iksel::lanes

namespace xsimd::types {

XSIMD_DECLARE_SIMD_REGISTER_ALIAS(iksel::lanes::Half, avx2);

}  // namespace xsimd::types

namespace iksel::lanes {

const LaneKernels kKernelsAvx512 =
    make_kernels<xsimd::batch<double, Half>, xsimd::batch<double, Whole>,
                 xsimd::batch<float, Whole>>("avx512");

}  // namespace iksel::lanes
