// SPDX-License-Identifier: BSD-3-Clause
// Progress that is told now and then.
#pragma once

#include <chrono>
#include <cstddef>

#include "iksel/types.hpp"

namespace iksel {

/// Passes on to a Progress, but not more often than people look.
class Pace {
 public:
  using Clock = std::chrono::steady_clock;

  /// `progress` must outlive this; it may be empty.
  Pace(const Progress& progress, std::size_t total) : progress_(progress), total_(total) {}

  void operator()(std::size_t done, Clock::time_point now = Clock::now()) {
    if (!progress_ || now < next_) return;
    next_ = now + std::chrono::milliseconds(30);
    progress_(done, total_);
  }

 private:
  const Progress& progress_;
  std::size_t total_;
  Clock::time_point next_{};
};

}  // namespace iksel
