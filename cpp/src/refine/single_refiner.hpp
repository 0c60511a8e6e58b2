// SPDX-License-Identifier: BSD-3-Clause
// One seed at a time brought to its goal, by whatever iterates it.
#pragma once

#include <algorithm>

#include "base/function_ref.hpp"
#include "iksel/types.hpp"

namespace iksel {

/// The interface is that of search.hpp.
class SingleRefiner {
 public:
  /// An attempt from the seed in q to its end: whether it arrived. `steps` counts those taken.
  using Attempt = FunctionRef<bool(JointVector& q, int& steps)>;

  /// What is called must outlive this.
  SingleRefiner(int dof, const Attempt& attempt) : attempt_(attempt), q_(dof) {}

  [[nodiscard]] static int width() { return 1; }
  void load_seed(int /*lane*/, const double* q) { std::copy_n(q, q_.size(), q_.data()); }
  void load_answer(int lane, const double* q) { load_seed(lane, q); }
  int advance(unsigned /*busy*/) {
    int steps = 0;
    has_arrived_ = attempt_(q_, steps);
    return steps;
  }
  [[nodiscard]] bool has_arrived(int /*lane*/) const { return has_arrived_; }
  [[nodiscard]] static bool is_spent(int /*lane*/) { return true; }
  [[nodiscard]] static bool stays(int /*lane*/) { return false; }
  [[nodiscard]] static bool is_to_be_looked_at(int /*lane*/) { return false; }
  [[nodiscard]] const JointVector& at(int /*lane*/) const { return q_; }
  [[nodiscard]] const JointVector& q(int /*lane*/) const { return q_; }

 private:
  Attempt attempt_;
  JointVector q_;
  bool has_arrived_ = false;
};

}  // namespace iksel
