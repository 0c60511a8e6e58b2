// SPDX-License-Identifier: BSD-3-Clause
// Parts of a pose, objectives, and why there is no answer. python/examples/06_task.py prints the
// same.
#include <cmath>
#include <cstdio>
#include <exception>
#include <iksel/iksel.hpp>

namespace {

void print(const char* name, const iksel::JointVector& q) {
  std::printf("%-16s q", name);
  for (const double value : q) std::printf(" %7.3f", value);
  std::printf("\n");
}

int run() {
  iksel::RobotOptions links;
  links.base_link = "panda_link0";
  links.tip_link = "panda_link8";
  const auto robot = iksel::Robot::from_urdf_file(IKSEL_ROBOTS_DIR "/panda.urdf", links);
  const iksel::Solver solver(robot);
  const auto here = (iksel::JointVector(7) << 0.2, -0.4, 0.1, -2.0, 0.3, 1.7, 0.5).finished();
  iksel::Pose target = robot.fk(here);
  target.translation() += Eigen::Vector3d(-0.05, 0.1, 0.05);

  iksel::SolveRequest request;
  request.near = here;
  print("the pose", solver.solve(target, request).q);

  // The hand may turn about its own z axis, say to drill: one joint more is free.
  request.task = iksel::Task::free_spin();
  print("any spin", solver.solve(target, request).q);
  // Within 2 cm to either side along the tool's x, and exact along the rest.
  request.task = iksel::Task::box({0.02, 0, 0}, {0, 0, 0});
  print("2 cm of room", solver.solve(target, request).q);

  // Seven joints for six directions: the one left makes the answer a better one.
  request = {};
  request.objective = iksel::Objective::far_from_limits();
  print("far from limits", solver.solve(target, request).q);
  // Any function will do.
  request.objective =
      iksel::Objective::custom([](const iksel::JointVector& q) { return 1 - std::cos(q[2]); });
  std::printf("elbow in         cost %.3f\n", solver.solve(target, request).cost);

  // Beyond what the arm reaches.
  target.translation() *= 1.5 / target.translation().norm();
  const iksel::Diagnosis diagnosis = solver.diagnose(target);
  std::printf("no answer        %s by %.2f m\n", iksel::to_string(diagnosis.cause),
              diagnosis.beyond_reach);
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
