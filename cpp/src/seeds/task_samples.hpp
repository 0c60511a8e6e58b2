// SPDX-License-Identifier: BSD-3-Clause
// For a pose that a task allows the one sample near to it, of those not tried yet, that comes
// nearest to the task.
#pragma once

#include <cstdint>
#include <vector>

#include "goal/goal.hpp"
#include "seeds/selection.hpp"

namespace iksel {

class TaskSamples {
 public:
  static constexpr int kPerPose = 1;
  /// Samples looked at. With one, positions of random arms take half more iterations, with two a
  /// quarter more.
  static constexpr std::size_t kNeighbours = 4;

  /// All must outlive this.
  TaskSamples(const ChainModel& model, const DatabaseData& data, Selection& selection);

  bool find(const Goal& goal, const Pose& allowed, bool is_first);
  template <typename Refiner>
  void load(int /*rank*/, Refiner& refiner, int lane) const {
    refiner.load_seed(lane, selection_.nearest_seed(found_));
  }

 private:
  const ChainModel& model_;
  const DatabaseData& data_;
  Selection& selection_;
  std::size_t found_ = 0;
  /// Whether a sample of the database was a seed already, and which were.
  std::vector<bool> is_tried_;
  std::vector<std::uint32_t> tried_;
};

}  // namespace iksel
