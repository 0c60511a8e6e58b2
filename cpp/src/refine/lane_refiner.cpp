// SPDX-License-Identifier: BSD-3-Clause
#include "refine/lane_refiner.hpp"

#include <algorithm>

namespace iksel {
namespace {

/// `options` solve in lanes.
lanes::LaneOptions make_lane_options(const ChainModel& model, const SolverOptions& options) {
  lanes::LaneOptions lanes{};
  const double position = options.position_tolerance / model.unit;
  const double rotation = options.rotation_tolerance;
  const Frame& tip = model.kernel.tip;
  lanes.damping = std::get<Lanes>(options.strategy).damping;
  lanes.least_damping = 1e-18;
  // |error at the TCP| <= |position error| + lever * |rotation error|, and the square of a sum of
  // two is at most twice the sum of their squares.
  const double lever[3] = {tip.p[0] / model.unit, tip.p[1] / model.unit, tip.p[2] / model.unit};
  lanes.lever2 = lever[0] * lever[0] + lever[1] * lever[1] + lever[2] * lever[2];
  lanes.position2 = 0.5 * position * position;
  lanes.rotation2 = 0.998 * rotation * rotation;
  // The error after a Newton step is about half the second derivative of FK times the squared step;
  // that derivative is at most the reach for positions and 1 for rotations, and mostly less.
  lanes.last_step2 = std::min(position / std::max(model.reach / model.unit, 1e-3), rotation);
  // Nor is a lane that is there already to wait for an error as small as that.
  lanes.last_error2 = std::max(16 * lanes.last_step2, position * position + rotation * rotation);
  return lanes;
}

}  // namespace

LaneRefiner::LaneRefiner(const ChainModel& model, const SolverOptions& options,
                         const lanes::LaneKernels& kernels)
    : kernels_(kernels),
      packs_(&kernels.narrow),
      max_iterations_(options.max_iterations),
      joints_(model.joints),
      base_inverse_(to_pose(model.kernel.base).inverse()),
      tip_(to_pose(model.kernel.tip)),
      per_metre_(1 / model.unit),
      chain_(make_lane_chain(model, model.unit)),
      options_(make_lane_options(model, options)),
      task_options_(options_),
      pack_{} {
  // A task's error is measured at the TCP.
  task_options_.lever2 = 0;
  task_options_.position2 *= 2;
}

void LaneRefiner::begin(const TaskSpace& task, const Patience& patience, Width width) {
  packs_ = width == Width::narrow ? &kernels_.narrow : &kernels_.wide;
  task_ = task.is_full_pose() ? nullptr : &task;
  if (task_ != nullptr) make_task(task);
  patience_ = patience;
  patience_.far_off = std::min(patience.far_off, max_iterations_);
  patience_.most = std::min(patience.most, max_iterations_);
}

void LaneRefiner::make_task(const TaskSpace& task) {
  for (int i = 0; i < 6; ++i) {
    const double in_unit = i < 3 ? per_metre_ : 1;
    lane_task_.lower[i] = task.aim_lower()[i] * in_unit;
    lane_task_.upper[i] = task.aim_upper()[i] * in_unit;
    lane_task_.fixed[i] = task.lower()[i] == task.upper()[i];
    lane_task_.open[i] = task.lower()[i] == -kInfinity && task.upper()[i] == kInfinity;
  }
  lane_task_.twist = task.twist_axis();
  for (int i = 0; i < 3; ++i) lane_task_.tcp[i] = tip_(i, 3) * per_metre_;
}

template <typename Write>
void LaneRefiner::make_rows(const Pose& Y, const Pose& T_base_tcp, const Write& write) const {
  if (task_ == nullptr) return visit_rows(Y, per_metre_, write);
  const auto write_columns = [&](int at, const Eigen::Matrix3d& columns) {
    for (int k = 0; k < 9; ++k) write(at + k, columns(k % 3, k / 3));
  };
  const Pose X = base_inverse_ * T_base_tcp;
  const bool in_tool = task_->task().frame == TaskFrame::tool;
  const Eigen::Matrix3d W = (in_tool ? X : base_inverse_).linear();
  for (int i = 0; i < 3; ++i) write(i, X(i, 3) * per_metre_);
  write_columns(3, W);
  write_columns(12, tip_.linear() * X.linear().transpose() * W);
}

void LaneRefiner::set_target(const Pose& Y, const Pose& T_base_tcp) {
  make_rows(Y, T_base_tcp,
            [&](int row, double value) { std::fill_n(pack_.target[row], lanes::kWidth, value); });
}

void LaneRefiner::set_target(int lane, const Pose& Y, const Pose& T_base_tcp) {
  make_rows(Y, T_base_tcp, [&](int row, double value) { pack_.target[row][lane] = value; });
}

void LaneRefiner::load_seed(int lane, const double* q) {
  load(lane, [&](int j) {
    const lanes::LaneVariable& variable = chain_.variable[j];
    return variable.limited ? std::min(std::max(q[j], chain_.from_lane(j, variable.lower)),
                                       chain_.from_lane(j, variable.upper))
                            : q[j];
  });
}

void LaneRefiner::hold_sums(int lane) {
  JointVector seed = q(lane);
  if (joints_.contains_sums(seed.data())) return;
  joints_.wrap(seed.data());
  seed = joints_.clamp(seed);
  for (int j = 0; j < chain_.n; ++j) pack_.q[j][lane] = chain_.to_lane(j, seed[j]);
}

int LaneRefiner::advance(unsigned busy) {
  arrived_ = there_ & busy;
  there_ = 0;
  if (arrived_ != 0) return 0;
  int budget = patience_.look > 0 ? std::min(patience_.look, patience_.most) : patience_.most;
  for (int lane = 0; lane < width(); ++lane) {
    if ((busy >> static_cast<unsigned>(lane) & 1U) == 0) continue;
    const bool hasty = patience_.look == 0 && age_[lane] < patience_.far_off;
    budget = std::min(budget, (hasty ? patience_.far_off : patience_.most) - age_[lane]);
  }
  const lanes::PackResult result =
      task_ == nullptr
          ? packs_->advance(chain_, options_, nullptr, busy, budget, pack_)
          : packs_->advance_task(chain_, task_options_, &lane_task_, busy, budget, pack_);
  arrived_ = result.done;
  for (int lane = 0; lane < width(); ++lane) age_[lane] += result.iterations;
  return result.iterations;
}

}  // namespace iksel
