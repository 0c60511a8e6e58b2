// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/task_seeds.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"

namespace iksel {
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
  JointVector seed =
      restart ? random_configuration()
              : seed_for(round_ == 0 ? goal_->nearest_pose() : goal_->random_pose(random_));
  ++round_;
  return seed;
}

JointVector TaskSeeds::random_configuration() {
  JointVector q(model_.dof);
  model_.joints.sample(random_, q);
  return q;
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
