// SPDX-License-Identifier: BSD-3-Clause
// Solves for 1000 random reachable poses of a UR3 at once. python/examples/03_batch.py prints the
// same.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iksel/iksel.hpp>
#include <vector>

namespace {

void run() {
  iksel::RobotOptions links;
  links.base_link = "base_link";
  links.tip_link = "tool0";
  const auto robot = iksel::Robot::from_urdf_file(IKSEL_ROBOTS_DIR "/ur3.urdf", links);

  std::vector<iksel::Pose> targets;
  const auto configurations = robot.random_configurations(1000, /*seed=*/1);
  for (const auto& q : configurations.rowwise()) {
    targets.push_back(robot.fk(q.transpose()));
  }

  // On one thread per core; the answers have the same bits for any number of threads.
  const iksel::Solver solver(robot);
  const std::vector<iksel::Result> results = solver.solve_batch(targets);

  int solved = 0;
  double worst_position = 0;
  double worst_rotation = 0;
  double sum = 0;
  for (const iksel::Result& result : results) {
    if (!result.success()) continue;
    ++solved;
    worst_position = std::max(worst_position, result.position_error);
    worst_rotation = std::max(worst_rotation, result.rotation_error);
    sum += result.q.sum();
  }
  const auto yes_or_no = [](bool value) { return value ? "yes" : "no"; };
  std::printf("targets %zu\n", targets.size());
  std::printf("solved %d\n", solved);
  std::printf("all positions within %g m: %s\n", solver.options().position_tolerance,
              yes_or_no(worst_position < solver.options().position_tolerance));
  std::printf("all rotations within %g rad: %s\n", solver.options().rotation_tolerance,
              yes_or_no(worst_rotation < solver.options().rotation_tolerance));
  std::printf("sum of all joint values %.6f\n", sum);
}

}  // namespace

int main() {
  try {
    run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
