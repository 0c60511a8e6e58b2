// SPDX-License-Identifier: BSD-3-Clause
// What a program outside the tree does with the library: every noun once, an exception across the
// library's border, and the Eigen types that the two hand each other.
#include <cstdio>
#include <iksel/iksel.hpp>
#include <vector>

namespace {

int failures = 0;

void expect(bool condition, const char* what) {
  if (condition) return;
  std::printf("failed: %s\n", what);
  ++failures;
}

bool unknown_link_is_reported(const char* urdf) {
  iksel::RobotOptions options;
  options.tip_link = "no_such_link";
  try {
    iksel::Robot::from_urdf_file(urdf, options);
  } catch (const iksel::UnknownNameError&) {
    return true;
  }
  return false;
}

}  // namespace

int main() {
  const char* const urdf = IKSEL_ROBOTS_DIR "/ur3.urdf";
  expect(unknown_link_is_reported(urdf), "an unknown link throws UnknownNameError");

  iksel::RobotOptions links;
  links.base_link = "base_link";
  links.tip_link = "tool0";
  const auto robot = iksel::Robot::from_urdf_file(urdf, links);
  const auto configurations = robot.random_configurations(20, 1);

  iksel::SolverOptions options;
  options.database.samples = 2000;
  const auto database = iksel::Database::build(robot, options.database);
  expect(database.pseudo_inverse(7).rows() == robot.dof(), "a pseudo-inverse is dof x 6");
  const iksel::Solver solver(robot, options, database);

  std::vector<iksel::Pose> targets;
  for (Eigen::Index i = 0; i < configurations.rows(); ++i) {
    targets.push_back(robot.fk(configurations.row(i).transpose()));
  }
  const auto results = solver.solve_batch(targets);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    expect(results[i].success(), "a reachable target is solved");
    expect(!results[i].success() ||
               iksel::pose_error(targets[i], robot.fk(results[i].q)).norm() < 1e-5,
           "a solution reaches its target");
    expect(solver.solve(targets[i]).success() == results[i].success(),
           "one by one as in the batch");
  }
  std::printf("iksel %s: %s\n", iksel::kVersion, failures == 0 ? "works" : "is broken");
  return failures == 0 ? 0 : 1;
}
