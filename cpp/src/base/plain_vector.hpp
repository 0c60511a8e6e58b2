// SPDX-License-Identifier: BSD-3-Clause
// Vectors as the kernels have them, which know nothing of Eigen.
#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace iksel {

inline void copy_vector(const Eigen::Vector3d& from, double (&to)[3]) {
  std::copy_n(from.data(), 3, to);
}

inline Eigen::Vector3d to_vector(const double (&v)[3]) { return {v[0], v[1], v[2]}; }

}  // namespace iksel
