// SPDX-License-Identifier: BSD-3-Clause
// The answers of a search that ends with the first.
#pragma once

#include <optional>

#include "base/work.hpp"
#include "goal/goal.hpp"
#include "search/search.hpp"

namespace iksel {

class FirstAnswer {
 public:
  /// `wraps`: answers are brought inside the limits by whole turns.
  FirstAnswer(const JointSpace& joints, bool wraps, const Goal& goal, double deadline,
              Result& result)
      : joints_(joints), wraps_(wraps), goal_(goal), deadline_(deadline), result_(result) {}

  Verdict offer(int /*lane*/, JointVector& q) {
    if (wraps_) joints_.wrap(q.data());
    if (!goal_.check(q, result_)) return Verdict::refine;
    if (goal_.is_free(q)) return Verdict::stop;
    result_ = {};
    result_.status = Status::in_collision;
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
  [[nodiscard]] bool wants_more() const { return false; }
  void look_for_partners(bool /*look*/) {}
  void set_all_branches_tried() {}
  void converge_from_near() {}
  /// Says that all answers collide.
  void refuse() { result_.status = Status::in_collision; }
  /// Whether the target was reached inside the limits, be it in a collision.
  [[nodiscard]] bool has_any() const {
    return result_.success() || result_.status == Status::in_collision;
  }
  [[nodiscard]] bool should_continue() {
    if (!deadline_.has_passed()) return true;
    result_.status = Status::out_of_time;
    return false;
  }

 private:
  const JointSpace& joints_;
  bool wraps_;
  const Goal& goal_;
  Deadline deadline_;
  Result& result_;
  std::optional<bool> never_free_;  ///< once it was asked
};

}  // namespace iksel
