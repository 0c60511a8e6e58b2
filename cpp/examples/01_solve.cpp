// SPDX-License-Identifier: BSD-3-Clause
// Solves inverse kinematics for one pose of a UR3, or of the arm from base_link to tool0 in the
// URDF file given as argument. python/examples/01_solve.py prints the same.
#include <cstdio>
#include <exception>
#include <iksel/iksel.hpp>

namespace {

void print(const char* name, const Eigen::MatrixXd& matrix) {
  std::printf("%s\n", name);
  for (const auto& row : matrix.rowwise()) {
    for (const double value : row) std::printf(" %13.9f", value);
    std::printf("\n");
  }
}

int run(const char* urdf) {
  iksel::RobotOptions links;
  links.base_link = "base_link";
  links.tip_link = "tool0";
  const auto robot = iksel::Robot::from_urdf_file(urdf, links);

  // A target that can be reached: the pose T_base_tip at joint values of our choice.
  iksel::JointVector chosen(robot.dof());
  for (int i = 0; i < robot.dof(); ++i) chosen[i] = 0.3 + 0.2 * i;
  const iksel::Pose target = robot.fk(chosen);

  // Builds its database of seeds; then `solve` may be called from many threads at once.
  const iksel::Solver solver(robot);
  const iksel::Result result = solver.solve(target);
  if (!result.success()) {
    std::fprintf(stderr, "no solution: %s\n", iksel::to_string(result.status));
    return 1;
  }

  // Not always the joint values from above: a UR3 has up to eight answers per pose, and more by
  // whole turns.
  print("target", target.matrix());
  print("q [rad]", result.q.transpose());
  std::printf("position error [m]   %.9f\n", result.position_error);
  std::printf("rotation error [rad] %.9f\n", result.rotation_error);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc > 1 ? argv[1] : IKSEL_ROBOTS_DIR "/ur3.urdf");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
