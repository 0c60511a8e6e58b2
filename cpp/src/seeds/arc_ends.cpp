// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/arc_ends.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"

namespace iksel {

ArcEnds::ArcEnds(const ChainModel& whole, const LockedArms& arms, double position_tolerance,
                 double rotation_tolerance, const lanes::LaneKernels& kernels)
    : joints_(whole.joints), are_all_(arms.are_all), are_closed_(arms.are_closed) {
  const auto make_end = [&](const LockedArm& arm) {
    const ChainModel& model = *arm.model;
    End end;
    end.arm = &arm;
    end.base_inverse = to_pose(model.kernel.base).inverse();
    end.tip_inverse = to_pose(model.kernel.tip).inverse();
    if (arm.pose) {
      end.branches.emplace(model, *arm.pose, /*is_nominal=*/true, position_tolerance,
                           rotation_tolerance, kernels);
    }
    if (arm.residual) {
      const double tolerance =
          std::max(position_tolerance / arm.residual->unit, rotation_tolerance);
      end.roots.emplace(model, *arm.residual, /*is_nominal=*/true, tolerance, kernels);
    }
    return end;
  };
  ends_.reserve(arms.arms.size());
  // Memory is taken here, and as a rule none while solving.
  constexpr std::size_t kRoom = 128;
  found_.reserve(kRoom * kCurveJoints);
  for (const LockedArm& arm : arms.arms) ends_.push_back(make_end(arm));
  if (arms.crossing) {
    const Pose base = to_pose(whole.kernel.base);
    crossing_.emplace(Crossing{&arms.crossing->elbow, make_end(arms.crossing->first), base,
                               base.inverse(), to_pose(whole.kernel.tip).inverse()});
  }
}

bool ArcEnds::find(std::size_t i, const Pose& T_base_tcp) {
  if (i >= size()) return find_crossings(i - size(), T_base_tcp);
  return solve(ends_[i], ends_[i].arm->value, T_base_tcp);
}

bool ArcEnds::find_crossings(std::size_t side, const Pose& T_base_tcp) {
  const Crossing& crossing = *crossing_;
  const Pose from_first = crossing.base_inverse * T_base_tcp;
  const double lower = joints_.lower[0] - kSameAnswer;
  const double upper = joints_.upper[0] + kSameAnswer;
  double value = crossing.elbow->first_joint_to_plane(from_first * crossing.tip_inverse);
  if (side == 1) value += kPi;
  if (joints_.type(0) != JointType::continuous) {
    value += kTwoPi * std::ceil((lower - value) / kTwoPi);
    if (value > upper) return true;
    value = std::min(std::max(value, joints_.lower[0]), joints_.upper[0]);
  }
  // With the first joint locked elsewhere, the target turns instead.
  const double turn = crossing.first.arm->value - value;
  const Eigen::AngleAxisd back(turn, Eigen::Vector3d::UnitZ());
  return solve(crossing_->first, value, crossing.base * (back * from_first));
}

bool ArcEnds::solve(End& end, double locked, const Pose& T_base_tcp) {
  const Pose Y = end.base_inverse * T_base_tcp * end.tip_inverse;
  const auto find = [&](BranchList& solutions, bool wants_all) {
    solutions.find(Y, wants_all);
    return solutions.is_certain_but_for_limits();
  };
  const bool by_branches = end.branches && find(*end.branches, /*wants_all=*/true);
  const bool by_roots = !by_branches && end.roots && find(*end.roots, /*wants_all=*/false);
  const BranchList& solutions = end.roots && !by_branches
                                    ? static_cast<const BranchList&>(*end.roots)
                                    : static_cast<const BranchList&>(*end.branches);
  for (int k = 0; k < solutions.size(); ++k) {
    const double* others = solutions.q(k);
    found_.insert(found_.end(), others, others + end.arm->joint);
    found_.push_back(locked);
    found_.insert(found_.end(), others + end.arm->joint, others + kPoseJoints);
  }
  return by_branches || by_roots;
}

}  // namespace iksel
