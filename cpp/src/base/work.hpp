// SPDX-License-Identifier: BSD-3-Clause
// What one search has done and may do, and where its time went.
#pragma once

#include <algorithm>
#include <chrono>

#include "iksel/result.hpp"

namespace iksel {

/// Seeds and iterations so far. Of seeds from the database and at random there are `max_attempts`
/// at most; others come on top. Time is only taken if there is somebody to tell.
class Work {
 public:
  explicit Work(int max_attempts) : left_(max_attempts) {}

  [[nodiscard]] bool has_left() const { return left_ > 0; }
  // Each counts a seed; false if there may be no more.
  bool take() {
    if (left_ <= 0) return false;
    --left_;
    ++attempts;
    return true;
  }
  /// From now on, so many seeds at most.
  void leave(int most) { left_ = std::min(left_, most); }
  bool take_on_top() {
    ++attempts;
    return true;
  }
  /// One that was counted before.
  bool take_counted() { return true; }
  /// Counts a guess at a solution by another one, which is no seed.
  bool take_guess() {
    ++guesses_;
    return true;
  }
  [[nodiscard]] int all_attempts() const { return attempts + guesses_; }

  /// From now on, the time between laps is added to the stages of a solve; `times` may be null.
  void begin_laps(StageTimes* times) {
    times_ = times;
    if (times_ != nullptr) last_ = Clock::now();
  }
  void lap(double StageTimes::*stage) {
    if (times_ == nullptr) return;
    const auto now = Clock::now();
    times_->*stage += std::chrono::duration<double, std::nano>(now - last_).count();
    last_ = now;
  }

  int attempts = 0;  ///< without guesses
  int iterations = 0;
  int arrivals = 0;  ///< seeds that led to the goal, whatever became of it there

 private:
  using Clock = std::chrono::steady_clock;
  int left_;
  int guesses_ = 0;
  StageTimes* times_ = nullptr;
  Clock::time_point last_;
};

/// A wall-clock deadline; asks the clock only if there is one.
class Deadline {
 public:
  /// A year or longer is none: the clock's numbers end somewhere.
  explicit Deadline(double seconds) : set_(seconds < 3.15e7) {
    if (set_) {
      end_ = Clock::now() +
             std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    }
  }
  [[nodiscard]] bool has_passed() const { return set_ && Clock::now() >= end_; }

 private:
  using Clock = std::chrono::steady_clock;
  bool set_;
  Clock::time_point end_;
};

}  // namespace iksel
