// SPDX-License-Identifier: BSD-3-Clause
// What a search has come to so far, whichever answers it is for.
#pragma once

#include <cmath>

#include "base/constants.hpp"
#include "base/work.hpp"
#include "goal/goal.hpp"
#include "iksel/request.hpp"

namespace iksel {

/// How much is done for an answer.
enum class Effort {
  quick,  ///< what finds most: closed forms, or else the nearest seeds; no answer says little
  full,
};

class SearchState {
 public:
  /// All must outlive this.
  SearchState(const Goal& goal, const SolveRequest& request, int max_attempts)
      : work(max_attempts), goal_(goal), request_(request), deadline_(request.deadline) {}

  [[nodiscard]] const Goal& goal() const { return goal_; }
  [[nodiscard]] const SolveRequest& request() const { return request_; }
  [[nodiscard]] Status status() const { return result_.status; }

  // What families of solutions tell, and seeds.

  /// All answers collide.
  void refuse() { result_.status = Status::in_collision; }
  /// The target was reached outside the limits.
  void leave_limits() {
    if (result_.status == Status::not_converged) result_.status = Status::outside_limits;
  }
  /// No answer can be found; of several tips: as that one cannot reach its target by itself.
  void put_unreachable(int tip, Status status) {
    result_.unreachable_tip = tip;
    if (!result_.success()) result_.status = status;
  }

  /// Notes where a seed came to rest that is no answer, if that matters: of the first so many.
  void note_rest(const JointVector& q) {
    if (rests_ == kMostRests || !goal_.is_overdetermined() || !goal_.joints().contains(q.data())) {
      return;
    }
    ++rests_;
    double position = 0;
    double rotation = 0;
    goal_.measure(q, position, rotation);
    const double off = std::hypot(position / goal_.task().position_tolerance(),
                                  rotation / goal_.task().rotation_tolerance());
    if (!(off < least_off_)) return;
    least_off_ = off;
    rest_ = q;
  }
  /// Of these the one that is least off, measured by the tolerances; null if there is none.
  [[nodiscard]] const JointVector* rest() const {
    return least_off_ < kInfinity ? &rest_ : nullptr;
  }

  Work work;

 protected:
  const Goal& goal_;
  const SolveRequest& request_;
  Deadline deadline_;
  Result result_;

 private:
  /// They come to few places, and each again and again.
  static constexpr int kMostRests = 256;

  int rests_ = 0;
  JointVector rest_;
  double least_off_ = kInfinity;
};

}  // namespace iksel
