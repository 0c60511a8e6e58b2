// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/tree_solver.hpp>

namespace iksel_headers {

void use_tree_solver(const iksel::TreeRobot& robot, const std::vector<iksel::Pose>& poses) {
  const iksel::TreeSolver solver(robot, iksel::SolverOptions());
  iksel::TreeRequest().validate(solver.robot().dof(), solver.robot().tips());
  static_cast<void>(solver.options().max_attempts + solver.chain_solver(0).robot().dof());
  static_cast<void>(solver.solve(poses).success() && solver.solve_batch(poses).empty());
  static_cast<void>(solver.diagnose(poses).tips.size());
}

}  // namespace iksel_headers
