// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/arc_ends.hpp"

#include <algorithm>

namespace iksel {

ArcEnds::ArcEnds(const LockedArms& arms, double position_tolerance, double rotation_tolerance,
                 const lanes::LaneKernels& kernels)
    : are_all_(arms.are_all) {
  ends_.reserve(arms.arms.size());
  // Memory is taken here, and none while solving; the last of more gives way.
  constexpr std::size_t kKept = 128;
  kept_.reserve(kKept);
  for (const LockedArm& arm : arms.arms) {
    const ChainModel& model = *arm.model;
    End& end = ends_.emplace_back();
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
  }
}

bool ArcEnds::find(std::size_t i, const Pose& T_base_tcp) {
  End& end = ends_[i];
  last_ = &end;
  const Pose Y = end.base_inverse * T_base_tcp * end.tip_inverse;
  bool is_certain = false;
  if (end.branches) {
    end.branches->find(Y, /*wants_all=*/true);
    by_roots_ = false;
    count_ = end.branches->size();
    is_certain = end.branches->is_certain_but_for_limits();
  }
  if (!is_certain && end.roots) {
    end.roots->find(Y, /*wants_all=*/false);
    by_roots_ = true;
    count_ = end.roots->size();
    is_certain = end.roots->is_certain_but_for_limits();
  }
  return is_certain;
}

const double* ArcEnds::keep(int k) {
  const double* others = by_roots_ ? last_->roots->q(k) : last_->branches->q(k);
  const int joint = last_->arm->joint;
  if (kept_.size() < kept_.capacity()) kept_.emplace_back();
  double* q = kept_.back().data();
  std::copy_n(others, joint, q);
  q[joint] = last_->arm->value;
  std::copy_n(others + joint, 6 - joint, q + joint + 1);
  return q;
}

}  // namespace iksel
