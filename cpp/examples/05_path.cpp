// SPDX-License-Identifier: BSD-3-Clause
// A straight line of a Panda as a joint path, planned at once and streamed.
// python/examples/05_path.py prints the same.
#include <cstdio>
#include <exception>
#include <iksel/iksel.hpp>

namespace {

int run() {
  iksel::RobotOptions links;
  links.base_link = "panda_link0";
  links.tip_link = "panda_link8";
  const auto robot = iksel::Robot::from_urdf_file(IKSEL_ROBOTS_DIR "/panda.urdf", links);
  const iksel::Solver solver(robot);

  iksel::PathOptions options;
  options.start = (iksel::JointVector(7) << 0.0, -0.4, 0.0, -2.2, 0.0, 1.8, 0.8).finished();
  options.dt = 0.01;
  // 0.3 m sideways, a millimetre per time step.
  std::vector<iksel::Pose> line;
  for (int i = 1; i <= 300; ++i) {
    line.push_back(robot.fk(*options.start));
    line.back().translation().y() += 0.001 * i;
  }

  const iksel::PathResult path = solver.solve_path(line, options);
  std::printf("path: %s, %zu waypoints\n", iksel::to_string(path.status), path.q.size());
  std::printf("largest step %.4f rad, joint %d\n", path.largest_step, path.largest_step_joint);

  iksel::Tracker tracker(solver, *options.start);
  int late = 0;
  for (const iksel::Pose& pose : line) late += tracker.track(pose, options.dt).success() ? 0 : 1;
  std::printf("streamed: %d late, ends at q", late);
  for (const double value : tracker.q()) std::printf(" %.4f", value);
  std::printf("\n");
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
