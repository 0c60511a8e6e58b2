// SPDX-License-Identifier: BSD-3-Clause
// The answers of a search that ends with the first.
#pragma once

#include <optional>

#include "search/search.hpp"
#include "search/search_state.hpp"

namespace iksel {

class FirstAnswer : public SearchState {
 public:
  /// `wraps`: answers are brought inside the limits by whole turns.
  FirstAnswer(bool wraps, const Goal& goal, const SolveRequest& request, int max_attempts,
              Effort effort = Effort::full)
      : SearchState(goal, request, max_attempts), wraps_(wraps), effort_(effort) {}

  [[nodiscard]] Effort effort() const { return effort_; }

  Verdict offer(int /*lane*/, JointVector& q) {
    if (wraps_) goal_.joints().wrap(q.data());
    if (!goal_.check(q, result_)) {
      note_rest(q);
      return Verdict::refine;
    }
    if (goal_.is_free(q)) return Verdict::stop;
    result_ = {};
    refuse();
    return is_never_free() ? Verdict::stop : Verdict::next;
  }
  /// Whether no answer is free, whatever is found (Goal).
  [[nodiscard]] bool is_never_free() {
    if (!never_free_) never_free_ = goal_.is_never_free();
    return *never_free_;
  }
  template <typename Q>
  [[nodiscard]] bool knows(const Q& /*q*/) const {
    return false;
  }
  [[nodiscard]] bool should_continue() {
    if (!deadline_.has_passed()) return true;
    result_.status = Status::out_of_time;
    return false;
  }
  /// Whether the target was reached inside the limits, be it in a collision.
  [[nodiscard]] bool has_any() const {
    return result_.success() || result_.status == Status::in_collision;
  }
  /// The answer, or why there is none. `proof`: that of the search.
  [[nodiscard]] Result result(Proof proof) {
    if (!result_.success()) result_.proof = proof;
    if (result_.status == Status::in_collision && is_never_free()) result_.proof = Proof::target;
    result_.attempts = work.attempts;
    result_.iterations = work.iterations;
    return result_;
  }

  // What a Collector has to be told, and does (collector.hpp).
  [[nodiscard]] bool wants_more() const { return false; }
  void look_for_partners(bool /*look*/) {}
  void set_all_branches_tried() {}
  void settle(bool /*is_settled*/) {}
  [[nodiscard]] const JointVector* only_nearest_to() const { return nullptr; }

 private:
  bool wraps_;
  Effort effort_;
  std::optional<bool> never_free_;  ///< once it was asked
};

}  // namespace iksel
