// SPDX-License-Identifier: BSD-3-Clause
#include "lanes/kernels.hpp"
#include "lanes/lane_kernel.hpp"

namespace iksel::lanes {

const LaneKernels kKernelsScalar = make_kernels<double, float>("scalar");

}  // namespace iksel::lanes
