// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/solver.hpp>

namespace iksel_headers {

void use_solver(const iksel::Robot& robot, const iksel::Pose& pose) {
  const iksel::Solver own(robot, iksel::SolverOptions::paper());
  const iksel::Solver given(robot, own.options(), own.database());
  const iksel::Solver solver(robot, own.options(), given.database(), own.nominal());
  static_cast<void>(iksel::measure_calibration_deviation(robot, own.robot()).position);
  static_cast<void>(solver.calibration_deviation().rotation);
  static_cast<void>(solver.work_bound());
  iksel::StageTimes times;
  static_cast<void>(solver.solve(pose).success() || solver.solve(pose, {}, &times).success());
  static_cast<void>(solver.solve_all(pose).all.size());
  static_cast<void>(solver.self_motion(pose).arcs.size());
  static_cast<void>(solver.diagnose(pose).message.size());
  static_cast<void>(solver.solve_path({pose}, iksel::PathOptions()).q.size());
  static_cast<void>(solver.solve_batch({pose}).size());
  solver.solve_batch(pose.data(), 0, {}, nullptr, iksel::BatchView());
}

}  // namespace iksel_headers
