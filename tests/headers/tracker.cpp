// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/tracker.hpp>

namespace iksel_headers {

void use_tracker(const iksel::Solver& solver, const iksel::Scene& scene) {
  const iksel::JointVector start = solver.robot().lower();
  iksel::TrackerState state;
  state.reached = start;
  iksel::Tracker tracker(solver, start, iksel::PoseWeights(), iksel::TargetCriteria(),
                         iksel::Objective(), state);
  static_cast<void>(tracker.track(solver.robot().fk(start), 0.01, &scene).success());
  static_cast<void>(tracker.q() == tracker.reached() && tracker.closest().has_value());
  static_cast<void>(tracker.solver().work_bound() > 0 && tracker.state().speed > 0);
}

}  // namespace iksel_headers
