// SPDX-License-Identifier: BSD-3-Clause
// The search behind solve(pose, request) and solve_all: one stream of seeds, every solution of
// which is kept.
#pragma once

#include <chrono>
#include <cmath>

#include "iksel/result.hpp"
#include "iteration/task_space.hpp"
#include "solver/found.hpp"
#include "solver/lane_search.hpp"
#include "util/function_ref.hpp"

namespace iksel {

/// A wall-clock deadline; asks the clock only if there is one.
class Deadline {
 public:
  explicit Deadline(double seconds) : set_(std::isfinite(seconds)) {
    // Longer than a year is none: the clock's numbers end somewhere.
    set_ = set_ && seconds < 3e7;
    if (set_) {
      end_ = Clock::now() +
             std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    }
  }
  [[nodiscard]] bool passed() const { return set_ && Clock::now() >= end_; }

 private:
  using Clock = std::chrono::steady_clock;
  bool set_;
  Clock::time_point end_;
};

/// One exploration: what it looks for, and what came of it.
struct Exploration {
  const Pose& T_base_tip;
  const TaskSpace& task;
  const SolveRequest& request;
  /// Solutions nearer than this in every joint are one.
  double min_distance;
  /// Asked between the groups of seeds; true ends the search.
  FunctionRef<bool(int attempts)> enough;

  Status status = Status::not_converged;  ///< solved if anything was found
  Work work = {};
  bool out_of_time = false;
};

/// Tells when a search has most likely found all there is: so many seeds in a row led to nothing
/// new.
class Saturation {
 public:
  bool reached(const Found& found, int attempts) {
    if (found.size() > found_) {
      found_ = found.size();
      last_ = attempts;
    }
    return found_ > 0 && attempts - last_ >= kSeeds;
  }

 private:
  /// With 32 a UR lost a branch in one pose of a hundred, with 48 in one of a thousand.
  static constexpr int kSeeds = 64;
  std::size_t found_ = 0;
  int last_ = 0;
};

}  // namespace iksel
