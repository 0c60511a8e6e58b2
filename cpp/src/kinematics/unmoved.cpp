// SPDX-License-Identifier: BSD-3-Clause
#include "kinematics/unmoved.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "base/constants.hpp"

namespace iksel {

Unmoved::Numbers Unmoved::numbers(const Pose& pose) const {
  Numbers all;
  all << pose.translation() / unit_, pose.linear().reshaped();
  return all;
}

Unmoved::Unmoved(const std::vector<Pose>& poses, double unit)
    : unit_(unit), at_(numbers(poses.front())) {
  Eigen::MatrixXd moves(poses.size(), kNumbers);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    moves.row(static_cast<Eigen::Index>(i)) = numbers(poses[i]) - at_;
  }
  const auto add = [&](Eigen::Index first, Eigen::Index count) {
    Eigen::FullPivLU<Eigen::MatrixXd> factors(moves.middleCols(first, count));
    // More than rounding leaves, and little beside what excludes() allows for it.
    const double least_pivot = 1e-3 * kRounding;
    factors.setThreshold(least_pivot / std::max(factors.maxPivot(), least_pivot));
    if (factors.isInjective()) return;
    const Eigen::MatrixXd kernel = factors.kernel();
    const Eigen::MatrixXd Q = kernel.householderQr().householderQ();
    Part part{first == 0, first + count > 3, {}};
    part.fixed.setZero(kernel.cols(), kNumbers);
    part.fixed.middleCols(first, count) = Q.leftCols(kernel.cols()).transpose();
    parts_.push_back(part);
  };
  // Each by itself has its own tolerance.
  add(0, 3);
  add(3, kNumbers - 3);
  add(0, kNumbers);
}

bool Unmoved::excludes(const Pose& pose, double position, double rotation) const {
  return std::any_of(parts_.begin(), parts_.end(), [&](const Part& part) {
    // A rotation by an angle changes its matrix by one of that length times sqrt(2) at most.
    const double most = std::hypot(part.has_position ? position / unit_ : 0.0,
                                   part.has_rotation ? std::sqrt(2.0) * rotation : 0.0);
    return (part.fixed * (numbers(pose) - at_)).norm() > most + kRounding;
  });
}

}  // namespace iksel
