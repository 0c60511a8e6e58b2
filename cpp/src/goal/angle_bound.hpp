// SPDX-License-Identifier: BSD-3-Clause
// Angles so large that a double cannot tell their poses apart.
#pragma once

#include "iksel/options.hpp"
#include "iksel/request.hpp"
#include "kinematics/chain_model.hpp"

namespace iksel {

class AngleBound {
 public:
  /// `robot` must outlive this. Throws InvalidArgumentError if the limits go beyond.
  AngleBound(const Robot& robot, const SolverOptions& options);

  /// Throws InvalidArgumentError naming the first joint beyond.
  void check(const JointVector& q, const char* name) const;
  /// The same for all that a request holds.
  void check(const SolveRequest& request) const;
  [[nodiscard]] bool holds(const JointVector& q) const { return first_beyond(q) < 0; }

 private:
  /// The first joint beyond, or -1.
  [[nodiscard]] int first_beyond(const JointVector& q) const;

  const JointSpace& joints_;
  double position_tolerance_, rotation_tolerance_;
  /// Angles up to these lose a tenth of the tolerances at most when FK rounds them [rad]; infinite
  /// for joints that turn nothing.
  JointVector largest_;
};

}  // namespace iksel
