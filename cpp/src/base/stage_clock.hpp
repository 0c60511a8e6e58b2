// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

#include "iksel/result.hpp"

namespace iksel {

/// Adds the time between laps to the stages of a solve; does nothing if there is nobody to tell.
class StageClock {
 public:
  explicit StageClock(StageTimes* times) : times_(times) {
    if (times_ != nullptr) last_ = Clock::now();
  }

  void lap(double StageTimes::*stage) {
    if (times_ == nullptr) return;
    const auto now = Clock::now();
    times_->*stage += std::chrono::duration<double, std::nano>(now - last_).count();
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  StageTimes* times_;
  Clock::time_point last_;
};

}  // namespace iksel
