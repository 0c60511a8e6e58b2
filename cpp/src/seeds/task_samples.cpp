// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/task_samples.hpp"

#include <cmath>

#include "base/constants.hpp"

namespace iksel {

TaskSamples::TaskSamples(const ChainModel& model, const DatabaseData& data, Selection& selection)
    : model_(model), data_(data), selection_(selection), is_tried_(data.size, false) {
  tried_.reserve(data.size);
}

bool TaskSamples::find(const Goal& goal, const Pose& allowed, bool is_first) {
  if (is_first) {
    for (const std::uint32_t sample : tried_) is_tried_[sample] = false;
    tried_.clear();
  }
  const std::size_t count =
      selection_.nearest_seeds(allowed * Pose(model_.tcp_inverse), kNeighbours + tried_.size());
  found_ = count;
  double least = kInfinity;
  for (std::size_t i = 0; i < count; ++i) {
    if (is_tried_[selection_.nearest_sample(i)]) continue;
    double position = 0;
    double rotation = 0;
    goal.task().measure(goal.target(), model_.fk(selection_.nearest_seed(i)), position, rotation);
    const double error = std::hypot(position, data_.weight * rotation);
    if (error < least) {
      least = error;
      found_ = i;
    }
  }
  if (found_ == count) return false;
  is_tried_[selection_.nearest_sample(found_)] = true;
  tried_.push_back(selection_.nearest_sample(found_));
  return true;
}

}  // namespace iksel
