// SPDX-License-Identifier: BSD-3-Clause
// The least moves to a self-motion as a source of seeds.
#pragma once

#include <algorithm>
#include <cstddef>

#include "base/work.hpp"
#include "seeds/nearest_on_curve.hpp"

namespace iksel {

/// The nearest alone first, the others if it leads to no such answer; once the curve's samples were
/// looked at (NearestOnCurve::find_at_samples).
/// `Known` tells how long the shortest move found is: least_move(), infinite if there is none.
template <typename Known>
class NearestOnCurveSeeds {
 public:
  NearestOnCurveSeeds(NearestOnCurve& curve, const Known& known, Work& work)
      : curve_(curve), known_(known), known_before_(known.least_move()), work_(work) {}

  bool next_stage() {
    if (has_led_to_answer() || !work_.has_left()) return false;
    if (!done_) {
      done_ = true;
      curve_.find_between(known_before_);
      work_.lap(&StageTimes::query);
      end_ = std::min<std::size_t>(curve_.size(), 1);
    } else {
      end_ = curve_.size();
    }
    return next_ < end_;
  }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (next_ == end_ || !work_.take()) return false;
    refiner.load_answer(lane, curve_.q(next_++));
    return true;
  }

  /// Whether one of them is nearer than what was known before, and as near as it promised to be:
  /// one beside a limit may be beyond it once it is refined, and a whole turn away.
  [[nodiscard]] bool has_led_to_answer() const {
    constexpr double kLost = 0.01;
    const double move = known_.least_move();
    return move < known_before_ && (curve_.size() == 0 || move < curve_.move(0) + kLost);
  }

 private:
  NearestOnCurve& curve_;
  const Known& known_;
  double known_before_;
  Work& work_;
  bool done_ = false;
  std::size_t next_ = 0;
  std::size_t end_ = 0;
};

}  // namespace iksel
