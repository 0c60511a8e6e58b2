// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/task_search.hpp"

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

TaskSearch::TaskSearch(const ChainModel& model, const DatabaseData& data,
                       const SolverOptions& options, Selection& selection)
    : model_(model),
      data_(data),
      options_(options),
      selection_(selection),
      is_tried_(data.size, false) {
  tried_.reserve(data.size);
  if (options.kinematics == Kinematics::kdl) kdl_ = model.make_kdl();
}

void TaskSearch::begin(const Pose& target, const TaskSpace& task, std::size_t neighbours) {
  target_ = &target;
  task_ = &task;
  neighbours_ = neighbours;
  tip_target_ = target * Pose(model_.tcp_inverse);
  left_limits_ = false;
  random_ = Random(options_.seed);
  for (const std::uint32_t sample : tried_) is_tried_[sample] = false;
  tried_.clear();
}

JointVector TaskSearch::random_configuration() {
  JointVector q(model_.dof);
  model_.joints.sample(random_, q);
  return q;
}

Pose TaskSearch::allowed_pose(int round) {
  const Pose& target = *target_;
  const TaskSpace& task = *task_;
  Vector6 d = Vector6::Zero().cwiseMax(task.lower()).cwiseMin(task.upper());
  if (round == 0) return task.pose_at(target, d);
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

JointVector TaskSearch::seed_for(const Pose& allowed) {
  // Some poses have the same neighbours: a spin about the last joint is not in a reduced key.
  const std::size_t found =
      selection_.nearest_seeds(allowed * Pose(model_.tcp_inverse), neighbours_ + tried_.size());
  std::size_t best = found;
  double least = kInfinity;
  for (std::size_t i = 0; i < found; ++i) {
    if (is_tried_[selection_.nearest_sample(i)]) continue;
    double position = 0;
    double rotation = 0;
    task_->measure(*target_, model_.fk(selection_.nearest_seed(i)), position, rotation);
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
