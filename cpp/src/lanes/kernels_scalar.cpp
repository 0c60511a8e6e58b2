// SPDX-License-Identifier: BSD-3-Clause
#include "lanes/kernels.hpp"
#include "lanes/lane_kernel.hpp"

namespace iksel {
namespace lanes {

const LaneKernels kernels_scalar = make_kernels<double>("scalar");

}  // namespace lanes
}  // namespace iksel
