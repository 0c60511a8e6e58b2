// SPDX-License-Identifier: BSD-3-Clause
// The paper's loop by hand: select a seed, iterate it, and after a failure re-select. Solves 200
// poses of a UR3 so and by the paper preset, which gives the same joint values.
// python/examples/08_selection.py prints the same.
#include <cstdio>
#include <exception>
#include <iksel/iksel.hpp>
#include <vector>

namespace {

/// The answer for a pose; `tried` are the samples that were tried.
iksel::Result solve_by_hand(const iksel::Solver& solver, iksel::Selector& selector,
                            const iksel::Pose& pose, std::vector<std::size_t>& tried) {
  selector.candidates(pose, 200, iksel::Ranking::joint_adjustment);
  iksel::SolveRequest one_seed;
  one_seed.database_seeds = false;
  iksel::Result result;
  tried.clear();
  while (!result.success() && tried.size() < std::size_t(solver.options().max_attempts)) {
    tried.push_back(selector.next(tried).value());
    // One attempt of the iteration from this seed alone.
    one_seed.seeds = {solver.database().q(tried.back())};
    result = solver.solve(pose, one_seed);
  }
  return result;
}

int run() {
  iksel::RobotOptions links;
  links.base_link = "base_link";
  links.tip_link = "tool0";
  const auto robot = iksel::Robot::from_urdf_file(IKSEL_ROBOTS_DIR "/ur3.urdf", links);
  const auto options = iksel::SolverOptions::paper();
  const iksel::Solver solver(robot, options);
  iksel::Selector selector(solver.database(), std::get<iksel::Paper>(options.strategy));

  const iksel::Matrix joints = robot.random_configurations(200, 1);
  std::vector<std::size_t> tried;
  int solved = 0;
  int reselected = 0;
  int same = 0;
  for (Eigen::Index i = 0; i < joints.rows(); ++i) {
    const iksel::Pose pose = robot.fk(joints.row(i));
    const iksel::Result result = solve_by_hand(solver, selector, pose, tried);
    solved += result.success();
    reselected += tried.size() > 1;
    same += result.q == solver.solve(pose).q;
  }
  std::printf("solved %d of %td\nre-selected %d\nas the paper preset %d\n", solved, joints.rows(),
              reselected, same);

  const auto best =
      selector.candidates(robot.fk(joints.row(0)), 5, iksel::Ranking::joint_adjustment);
  std::printf("sample    distance  adjustment\n");
  for (std::size_t i = 0; i < best.indices.size(); ++i) {
    std::printf("%6zu %11.6f %11.6f\n", best.indices[i], best.distances[i], best.adjustments[i]);
  }
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
