// SPDX-License-Identifier: BSD-3-Clause
// What becomes of the answers that a search for several tips finds (the interface is search.hpp's).
#pragma once

#include "base/constants.hpp"
#include "base/work.hpp"
#include "goal/joint_move.hpp"
#include "refine/self_motion.hpp"
#include "search/search.hpp"

namespace iksel {

/// The first that the filter lets through.
class FirstTreeAnswer {
 public:
  /// All must outlive this.
  FirstTreeAnswer(const StackedGoal& goal, const TreeRequest& request, TreeResult& result)
      : goal_(goal), request_(request), result_(result), deadline_(request.deadline) {}

  Verdict offer(int /*lane*/, JointVector& q) { return take(q) ? Verdict::stop : Verdict::next; }
  template <typename Q>
  [[nodiscard]] bool knows(const Q& /*q*/) const {
    return false;
  }
  [[nodiscard]] bool should_continue() {
    if (!deadline_.has_passed()) return true;
    if (!result_.success()) result_.status = Status::out_of_time;
    return false;
  }

 protected:
  /// Makes q the result if it is an answer.
  bool take(const JointVector& q) {
    TreeResult found;
    if (!goal_.check(q, found)) return false;
    bool keep = true;
    if (request_.filter) request_.filter(q.data(), 1, &keep);
    if (keep) {
      result_ = found;
    } else if (!result_.success()) {
      result_.status = Status::rejected;
    }
    return keep;
  }

  const StackedGoal& goal_;
  const TreeRequest& request_;
  TreeResult& result_;

 private:
  Deadline deadline_;
};

/// The nearest to `near` of all that are offered, and of what those come down to along their
/// self-motions.
class NearestTreeAnswer : public FirstTreeAnswer {
 public:
  /// All must outlive this; `best` is the length of the least move so far.
  NearestTreeAnswer(const StackedGoal& goal, const TreeRequest& request, const JointMove& move,
                    double& best, Work& work, TreeResult& result)
      : FirstTreeAnswer(goal, request, result), move_(move), best_(best), work_(work) {}

  Verdict offer(int /*lane*/, JointVector& q) {
    take_nearer(q);
    work_.iterations += descend_to_near(goal_, move_, *request_.near, q);
    take_nearer(q);
    // There is nothing nearer than here.
    return best_ < 1e-9 ? Verdict::stop : Verdict::next;
  }

 private:
  void take_nearer(JointVector q) {
    goal_.model().joints.wrap_nearest(*request_.near, 0, q);
    const double length = move_.length(q - *request_.near);
    if (!(length < best_) || !take(q)) return;
    best_ = length;
    result_.move = length;
  }

  const JointMove& move_;
  double& best_;
  Work& work_;
};

}  // namespace iksel
