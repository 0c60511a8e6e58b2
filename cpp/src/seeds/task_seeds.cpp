// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/task_seeds.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"
#include "base/rotation.hpp"

namespace iksel {
namespace {

/// Uniform over all rotations (Shoemake: "Uniform random rotations", Graphics Gems III, 1992).
Eigen::Matrix3d random_rotation(Random& random) {
  const double u = random.uniform();
  const double a = random.uniform(-kPi, kPi);
  const double b = random.uniform(-kPi, kPi);
  const double root = std::sqrt(1 - u);
  return Eigen::Quaterniond(std::sqrt(u) * std::cos(b), root * std::sin(a), root * std::cos(a),
                            std::sqrt(u) * std::sin(b))
      .toRotationMatrix();
}

}  // namespace

TaskSeeds::TaskSeeds(const ChainModel& model, const DatabaseData& data,
                     const SolverOptions& options, Selection& selection)
    : model_(model),
      data_(data),
      options_(options),
      selection_(selection),
      is_tried_(data.size, false) {
  tried_.reserve(data.size);
}

void TaskSeeds::begin(const Goal& goal, std::size_t neighbours, int per_stage, Work& work,
                      StageClock& clock) {
  goal_ = &goal;
  neighbours_ = neighbours;
  per_stage_ = per_stage;
  work_ = &work;
  clock_ = &clock;
  round_ = 0;
  random_ = Random(options_.seed);
  for (const std::uint32_t sample : tried_) is_tried_[sample] = false;
  tried_.clear();
}

JointVector TaskSeeds::next() {
  const bool restart = round_ % 4 == 3;
  JointVector seed = restart ? random_configuration() : seed_for(allowed_pose());
  ++round_;
  return seed;
}

JointVector TaskSeeds::random_configuration() {
  JointVector q(model_.dof);
  model_.joints.sample(random_, q);
  return q;
}

Pose TaskSeeds::allowed_pose() {
  const Pose& target = goal_->target();
  const TaskSpace& task = goal_->task();
  Vector6 d = Vector6::Zero().cwiseMax(task.lower()).cwiseMin(task.upper());
  if (round_ == 0) return task.pose_at(target, d);
  // What is free is drawn from any pose in the ball that the arm can reach at all; what is within
  // bounds, from between them.
  const double reach = model_.reach + Eigen::Vector3d(model_.tcp.translation()).norm();
  Pose any = Pose::Identity();
  any.linear() = random_rotation(random_);
  for (int i = 0; i < 3; ++i) {
    any.translation()[i] = model_.reach_centre[i] + random_.uniform(-reach, reach);
  }
  const Vector6 drawn = task.deviation(target, any);
  for (int i = 0; i < 6; ++i) {
    const double width = task.upper()[i] - task.lower()[i];
    if (std::isfinite(width)) {
      d[i] = random_.uniform(task.lower()[i], task.upper()[i]);
    } else {
      d[i] = std::min(std::max(drawn[i], task.lower()[i]), task.upper()[i]);
    }
  }
  Pose pose = task.pose_at(target, d);
  if (task.rotation_is_free()) pose.linear() = any.linear();
  return pose;
}

JointVector TaskSeeds::seed_for(const Pose& allowed) {
  // Some poses have the same neighbours: a spin about the last joint is not in a reduced key.
  const std::size_t found =
      selection_.nearest_seeds(allowed * Pose(model_.tcp_inverse), neighbours_ + tried_.size());
  std::size_t best = found;
  double least = kInfinity;
  for (std::size_t i = 0; i < found; ++i) {
    if (is_tried_[selection_.nearest_sample(i)]) continue;
    double position = 0;
    double rotation = 0;
    goal_->task().measure(goal_->target(), model_.fk(selection_.nearest_seed(i)), position,
                          rotation);
    const double error = std::hypot(position, data_.weight * rotation);
    if (error < least) {
      least = error;
      best = i;
    }
  }
  if (best == found) return random_configuration();
  is_tried_[selection_.nearest_sample(best)] = true;
  tried_.push_back(selection_.nearest_sample(best));
  return Eigen::Map<const Eigen::VectorXd>(selection_.nearest_seed(best), model_.dof);
}

}  // namespace iksel
