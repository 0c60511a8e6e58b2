// SPDX-License-Identifier: BSD-3-Clause
// Of many configurations always the one that lies farthest from those before.
#pragma once

#include <cstddef>
#include <vector>

#include "kinematics/joint_space.hpp"
#include "simd/lane_types.hpp"

namespace iksel {

/// Of `all` configurations, one after another in q [rad or m], the first, and then always the one
/// farthest from those before, by the joint that moves most; `count` of them at most, and none
/// nearer to another than `least`. In single precision: which of two that are equally far is taken
/// matters little.
std::vector<std::size_t> farthest_first(const lanes::LaneKernels& kernels, const JointSpace& joints,
                                        const double* q, std::size_t all, std::size_t count,
                                        double least = 0);

}  // namespace iksel
