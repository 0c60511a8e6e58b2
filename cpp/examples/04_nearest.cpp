// SPDX-License-Identifier: BSD-3-Clause
// The solution nearest to where a UR3 is, all of its branches, and the nearest that a filter lets
// through. python/examples/04_nearest.py prints the same.
#include <cstdio>
#include <exception>
#include <iksel/iksel.hpp>

namespace {

void print(const char* name, const iksel::Result& result) {
  std::printf("%-20s move %.3f  q", name, result.move);
  for (const double value : result.q) std::printf(" %7.3f", value);
  std::printf("\n");
}

int run() {
  iksel::RobotOptions links;
  links.base_link = "base_link";
  links.tip_link = "tool0";
  const auto robot = iksel::Robot::from_urdf_file(IKSEL_ROBOTS_DIR "/ur3.urdf", links);
  const iksel::Solver solver(robot);

  iksel::SolveRequest request;
  request.near = (iksel::JointVector(6) << 0.3, -1.2, 1.4, -0.6, 1.2, 0.2).finished();
  iksel::Pose target = robot.fk(*request.near);
  target.translation() += Eigen::Vector3d(0.02, -0.03, 0.01);

  print("nearest", solver.solve(target, request));
  for (const auto& one : solver.solve_all(target, {}, request).all) print("branch", one);

  // A real filter would look for collisions.
  request.filter = iksel::filter_each(
      robot.dof(), [](const iksel::JointVector& q) { return q[2] < 0 && q[4] > 0; });
  print("nearest, elbow up", solver.solve(target, request));
  return 0;
}

}  // namespace

int main() {
  try {
    return run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
