// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/enumeration.hpp"

#include <algorithm>

namespace iksel {
namespace {

/// A target is taken to be off by so many tolerances, to be on the safe side.
constexpr double kMargin = 4;
/// An angle off by more says nothing [rad].
constexpr double kVague = 0.3;

}  // namespace

bool is_ruled_out(const lanes::BranchPack& pack, int lane) {
  if (pack.best[lane] < 0) return true;
  // Written so that NaN says nothing either.
  return pack.error[lane] < kVague && pack.beyond[lane] > pack.error[lane];
}

Enumeration::Enumeration(const ChainModel& model, const ClosedFormChain& chain, bool is_nominal,
                         double position_tolerance, double rotation_tolerance,
                         const lanes::LaneKernels& kernels)
    : chain_(chain), kernels_(kernels), is_nominal_(is_nominal) {
  chain_.use_limits(model);
  // A rotation moves what the form sees of a target by the tool's length, and seen from the other
  // end by the arm's.
  const double lever = chain.tail.norm() + to_pose(model.kernel.tip).translation().norm() +
                       (chain.reversed ? model.reach_of_tcp() : 0.0);
  chain_.form.error =
      kMargin * std::max({(position_tolerance + lever * rotation_tolerance) / chain.unit,
                          rotation_tolerance, kStructureTolerance});
}

void Enumeration::find(const Goal& goal, const Pose& Y, bool wants_all) {
  chain_.set_target(Y, pack_);
  kernels_.solve_branches(chain_.form, pack_);
  size_ = 0;
  certain_ = is_nominal_;
  for (int lane = 0; lane < kMost; ++lane) take(goal, lane, wants_all);
}

void Enumeration::take(const Goal& goal, int lane, bool wants_all) {
  if (is_ruled_out(pack_, lane)) return;
  std::array<double, 6>& q = q_[static_cast<std::size_t>(size_)];
  chain_.copy_joints(pack_, lane, q.data());
  const double beyond = pack_.beyond[lane];
  double bound = pack_.error[lane];
  bool is_sure = bound < kVague && pack_.worst[lane] >= 0;
  if (beyond > 0 || (wants_all && !is_sure)) is_sure = is_regular(goal, q, bound);
  if (is_sure && beyond > bound) return;
  certain_ = certain_ && is_sure && !(beyond > 0);
  ++size_;
}

bool Enumeration::is_regular(const Goal& goal, const std::array<double, 6>& q,
                             double& bound) const {
  constexpr double kFarthest = 0.01;
  const JointVector at = Eigen::Map<const Eigen::Matrix<double, 6, 1>>(q.data());
  double position = 0;
  double rotation = 0;
  Jacobian J;
  goal.measure(at, position, rotation, &J);
  if (!goal.is_reached(position, rotation)) return false;
  const TaskSpace& task = goal.task();
  double columns[6][6];
  for (int k = 0; k < 6; ++k) {
    for (int row = 0; row < 6; ++row) {
      columns[k][row] =
          J(row, k) / (row < 3 ? task.position_tolerance() : task.rotation_tolerance());
    }
  }
  const double moved = kMargin * inverse_norm(columns);
  if (!(moved < kFarthest)) return false;
  bound = moved;
  return true;
}

}  // namespace iksel
