// SPDX-License-Identifier: BSD-3-Clause
// Builds the paper's small database for a UR3, saves it, loads it again and solves with it, as a
// program that starts often would. python/examples/02_database.py prints the same.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iksel/iksel.hpp>
#include <random>
#include <string>

namespace {

void show_progress(std::size_t done, std::size_t total) {
  std::fprintf(stderr, "\r%zu of %zu samples%s", done, total, done < total ? "" : "\n");
}

int run() {
  iksel::RobotOptions links;
  links.base_link = "base_link";
  links.tip_link = "tool0";
  const auto robot = iksel::Robot::from_urdf_file(IKSEL_ROBOTS_DIR "/ur3.urdf", links);

  auto options = iksel::SolverOptions::paper();
  options.database.scale = iksel::Scale::small;
  const auto file = std::filesystem::temp_directory_path() /
                    ("ur3-" + std::to_string(std::random_device{}()) + ".iksel");
  iksel::Database::build(robot, options.database, show_progress).save(file);

  // Loading maps the file into memory: it takes no time, and processes share it. A file that is
  // damaged or belongs to another robot is refused.
  const auto database = iksel::Database::load(file);
  const iksel::Solver solver(robot, options, database);
  std::printf("samples %zu\n", database.size());

  iksel::JointVector chosen(robot.dof());
  for (int i = 0; i < robot.dof(); ++i) chosen[i] = 0.3 + 0.2 * i;
  const iksel::Result result = solver.solve(robot.fk(chosen));
  std::filesystem::remove(file);
  if (!result.success()) {
    std::fprintf(stderr, "no solution: %s\n", iksel::to_string(result.status));
    return 1;
  }
  std::printf("attempts %d\niterations %d\nq [rad]\n", result.attempts, result.iterations);
  for (const double value : result.q) std::printf(" %13.9f", value);
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
