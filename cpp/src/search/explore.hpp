// SPDX-License-Identifier: BSD-3-Clause
// The search behind solve(pose, request) and solve_all: one stream of seeds, every solution of
// which is kept.
#pragma once

#include <chrono>
#include <cmath>

#include "base/function_ref.hpp"
#include "goal/task_space.hpp"
#include "iksel/result.hpp"
#include "search/lane_search.hpp"
#include "search/solution_set.hpp"

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

/// Seeds in a row without a new solution after which a search has most likely found all.
/// With 96, an arm whose limits cut into its branches lost one in a pose of 170, with 128
/// in one of 300, with 160 in one of 700 (bench/README.md).
inline constexpr int kStagnation = 160;
/// The same where the signs of det J cancel. In 10,000 poses of a UR10e, 15 solutions of 71,798
/// were lost with 14, 7 with 20, and 1 with 28 as with 40.
inline constexpr int kStagnationBalanced = 28;

/// The same where there are as many solutions as the chain was ever seen to have.
inline constexpr int kStagnationMost = 2;

/// Whether some answers to the request are better than others.
inline bool ranks_answers(const SolveRequest& request) {
  return request.near || request.objective.is_set();
}

/// One exploration: what it looks for, and what came of it.
struct Exploration {
  const Pose& T_base_tip;
  const TaskSpace& task;
  const SolveRequest& request;
  /// Solutions nearer than this in every joint are one.
  double min_distance;
  /// Asked between blocks of seeds; true ends the search.
  FunctionRef<bool(const Exploration& search)> enough;
  /// Whether the search ends when it has most likely found all.
  bool until_complete;

  Status status = Status::not_converged;  ///< solved if anything was found
  Work work = {};
  int found = 0;                       ///< solutions
  int last_new = 0;                    ///< seeds tried until the last of them
  int jacobian_sign = 0;               ///< sum of their signs of det J
  bool jacobian_signs_cancel = false;  ///< over all that there are
  int most = 0;  ///< solutions that a pose is known to have at most; 0: unknown
  bool out_of_time = false;

  /// Whether more than the first answer is wanted.
  [[nodiscard]] bool wants_more() const { return until_complete || ranks_answers(request); }
  [[nodiscard]] bool ends_complete() const { return until_complete && is_likely_complete(); }
  /// Whether all there is has most likely been found: many seeds in a row led to nothing new; or
  /// fewer, and the signs of det J, of which a single solution more would leave one over, cancel.
  [[nodiscard]] bool is_likely_complete() const {
    const bool balanced = jacobian_signs_cancel && jacobian_sign == 0;
    const int in_vain = !balanced       ? kStagnation
                        : found == most ? kStagnationMost
                                        : kStagnationBalanced;
    return found > 0 && work.attempts - last_new >= in_vain;
  }
};

}  // namespace iksel
