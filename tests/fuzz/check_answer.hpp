// SPDX-License-Identifier: BSD-3-Clause
// What every fuzzer asks of an answer.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <iksel/iksel.hpp>

namespace iksel_fuzz {

/// Ends the process, so that the fuzzer keeps the input.
[[noreturn]] inline void finding(const char* what) {
  std::fprintf(stderr, "finding: %s\n", what);
  std::abort();
}

/// An answer that says success is one, by KDL's forward kinematics and the limits.
inline void check_answer(const iksel::Solver& solver, const iksel::Pose& target,
                         const iksel::Result& result) {
  const iksel::Robot& robot = solver.robot();
  if (!result.success()) {
    if (result.q.size() != 0) finding("joint values without success");
    return;
  }
  if (result.q.size() != robot.dof()) finding("an answer of the wrong length");
  if (!robot.within_limits(result.q)) finding("an answer outside of the limits");
  const iksel::Pose reached = robot.fk(result.q, iksel::Kinematics::kdl);
  const auto error = iksel::pose_error(target, reached);
  // Room for the rounding of two ways of computing: far more digits than any arm has.
  const double rounding = 1e-12 * (1 + target.translation().norm() + robot.reach());
  if (!(error.head<3>().norm() <= solver.options().position_tolerance + rounding) ||
      !(error.tail<3>().norm() <= solver.options().rotation_tolerance + 1e-9)) {
    finding("a false success");
  }
}

}  // namespace iksel_fuzz
