// SPDX-License-Identifier: BSD-3-Clause
#include "simd/kernels.hpp"
#include "simd/lane_kernel.hpp"

namespace iksel::lanes {

const LaneKernels kKernelsScalar = make_kernels<double, double, float>("scalar");

}  // namespace iksel::lanes
