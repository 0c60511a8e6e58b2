// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/enumeration.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"
#include "seeds/beyond_limits.hpp"

namespace iksel {
namespace {

/// A target is taken to be off by so many tolerances, to be on the safe side.
constexpr double kMargin = 4;

}  // namespace

bool is_ruled_out(const lanes::BranchPack& pack, int lane) {
  return pack.best[lane] < 0 || pack.outside[lane] > 0;
}

Enumeration::Enumeration(const ChainModel& model, const ClosedFormChain& chain, bool is_nominal,
                         double position_tolerance, double rotation_tolerance,
                         const lanes::LaneKernels& kernels)
    : model_(model),
      chain_(chain),
      kernels_(kernels),
      is_nominal_(is_nominal),
      position_tolerance_(position_tolerance),
      rotation_tolerance_(rotation_tolerance),
      enclosed_error_(chain.error_of_target(model, position_tolerance, rotation_tolerance)) {
  chain_.use_limits(model);
  chain_.form.error =
      kMargin *
      (chain.tolerance_of_target(model, position_tolerance, rotation_tolerance) + chain.deviation);
  are_answers_ = is_nominal && !chain.is_almost();
  has_families_ = chain_.has_families();
  has_all_ = is_nominal && !has_families_;
}

void Enumeration::hold_free_joints(const JointVector* q) {
  // What keeps to a sum is not told joint by joint.
  held_ = model_.joints.sums.empty() ? q : nullptr;
  has_families_ = chain_.has_families() && held_ == nullptr;
}

void Enumeration::solve(const Pose& Y) {
  chain_.set_target(Y, pack_);
  kernels_.solve_branches(chain_.form, pack_);
}

void Enumeration::find(const Pose& Y, bool wants_all) {
  chain_.set_target(Y, pack_);
  kernels_.solve_inside(chain_.form, pack_);
  size_ = 0;
  is_measured_ = false;
  is_enclosed_ = false;
  certain_ = is_nominal_;
  certain_but_for_limits_ = is_nominal_;
  for (int lane = 0; lane < lanes::kWidth; ++lane) take(Y, lane, wants_all);
  for (int lane = 0; chain_.is_almost() && lane < lanes::kWidth; ++lane) take_turned(Y, lane);
}

void Enumeration::copy_joints(int lane, double* q) const {
  chain_.copy_joints(pack_.q, lane, q);
  for (int j = 0; j < model_.dof; ++j) {
    if (!chain_.turns_freely(j)) continue;
    if (held_ != nullptr) q[j] = (*held_)[j];
    if (model_.joints.type(j) == JointType::continuous) continue;
    q[j] = std::clamp(q[j], model_.joints.lower[j], model_.joints.upper[j]);
  }
  model_.joints.wrap_sums(q);
}

void Enumeration::take(const Pose& Y, int lane, bool wants_all) {
  if (is_ruled_out(pack_, lane)) return;
  Joints& q = next();
  copy_joints(lane, q.data());
  const double beyond = pack_.beyond[lane];
  double bound = pack_.error[lane];
  bool is_sure = bound < lanes::kVague && pack_.worst[lane] >= 0;
  if (beyond > 0 || (wants_all && !is_sure)) is_sure = is_regular(lane, bound);
  if (is_sure && beyond > bound) return;
  if (!is_sure && beyond > 0 && is_nominal_ && is_enclosed_outside(lane)) return;
  if (is_sure && beyond > 0 && is_nominal_ && is_beyond(Y, q)) return;
  certain_ = certain_ && is_sure && !(beyond > 0);
  certain_but_for_limits_ = certain_but_for_limits_ && is_sure;
  // Where a square is below 0, its two roots are taken to be the same.
  const auto is_same = [&](const Joints& other) {
    return model_.joints.are_near(q, other, kRounding);
  };
  if (pack_.least[lane] < 0 && std::any_of(q_.begin(), q_.begin() + size_, is_same)) return;
  ++size_;
}

void Enumeration::take_turned(const Pose& Y, int lane) {
  if (is_ruled_out(pack_, lane)) return;
  Joints q{};
  copy_joints(lane, q.data());
  const JointSpace& joints = model_.joints;
  // Any of the joints may be on the wrong side, and others with it.
  std::array<Joints, 1U << kPoseJoints> ways;
  ways[0] = q;
  std::size_t count = 1;
  for (int j = 0; j < model_.dof; ++j) {
    const auto i = static_cast<std::size_t>(j);
    if (joints.is_slide(j) || joints.is_periodic(j)) continue;
    const double turned = q[i] + std::copysign(kTwoPi, joints.middle()[j] - q[i]);
    if (std::max(joints.lower[j] - turned, turned - joints.upper[j]) > kFirstOrder) continue;
    std::copy_n(ways.begin(), count, ways.begin() + count);
    for (std::size_t k = count; k < 2 * count; ++k) ways[k][i] = turned;
    count *= 2;
  }
  for (std::size_t k = 1; k < count; ++k) {
    if (is_beyond(Y, ways[k])) continue;
    certain_ = false;
    if (size_ == kRoom) return;
    next() = ways[k];
    ++size_;
  }
}

bool Enumeration::is_enclosed_outside(int lane) {
  if (!is_enclosed_) {
    lanes::ClosedForm form = chain_.form;
    form.error = enclosed_error_;
    kernels_.enclose_branches(form, pack_, /*half=*/0, room_);
  }
  is_enclosed_ = true;
  return room_[pack_.sign[2][lane] > 0 ? 0 : 1][lane] < 0;
}

bool Enumeration::is_beyond(const Pose& Y, const Joints& q) const {
  // It is known of whole poses only.
  if (chain_.is_completed() || chain_.has_families()) return false;
  const Pose T_base_tcp = to_pose(model_.kernel.base) * Y * to_pose(model_.kernel.tip);
  return is_beyond_limits(model_, T_base_tcp, Eigen::Map<const Eigen::VectorXd>(q.data(), 6),
                          position_tolerance_, rotation_tolerance_);
}

bool Enumeration::is_regular(int lane, double& bound) {
  const lanes::ClosedForm& form = chain_.form;
  if (!is_measured_) kernels_.measure_regularity(form, pack_, regularity_);
  is_measured_ = true;
  if (!(regularity_.off[lane] <= form.error / kMargin)) return false;
  const double moved = form.error * regularity_.inverse_norm[lane];
  if (!(moved < kFirstOrder)) return false;
  bound = moved;
  return true;
}

}  // namespace iksel
