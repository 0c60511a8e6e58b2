// SPDX-License-Identifier: BSD-3-Clause
// Time of each stage by itself, on the arms of the paper. Every benchmark goes round over the same
// 1024 targets, so that no cache holds one answer.
#include <benchmark/benchmark.h>

#include <iksel/iksel.hpp>
#include <memory>
#include <string>
#include <vector>

#include "kinematics/chain_model.hpp"
#include "selection/selection.hpp"

namespace {

constexpr std::size_t kTargets = 1024;

struct Arm {
  const char* name;
  const char* base;
  const char* tip;
};
constexpr Arm kArms[] = {
    {"ur3_wrs", "ur3_base", "ur3_flange"},
    {"irb14050", "irb14050_base", "irb14050_flange"},
};

/// A robot with its targets.
struct Problem {
  explicit Problem(const Arm& arm)
      : robot([&] {
          iksel::RobotOptions options;
          options.base_link = arm.base;
          options.tip_link = arm.tip;
          return iksel::Robot::from_urdf_file(
              std::string(IKSEL_ROBOTS_DIR) + "/" + arm.name + ".urdf", options);
        }()) {
    const Eigen::MatrixXd q = robot.random_configurations(kTargets, 1);
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      configurations.emplace_back(q.row(i));
      targets.push_back(robot.fk(configurations.back()));
    }
  }

  iksel::Robot robot;
  std::vector<iksel::JointVector> configurations;
  std::vector<iksel::Pose> targets;
};

const Problem& problem(int64_t arm) {
  static const Problem problems[] = {Problem(kArms[0]), Problem(kArms[1])};
  return problems[arm];
}

const iksel::Solver& solver(int64_t arm, bool paper) {
  static std::unique_ptr<iksel::Solver> solvers[2][2];
  auto& found = solvers[arm][paper ? 1 : 0];
  if (!found) {
    found = std::make_unique<iksel::Solver>(
        problem(arm).robot, paper ? iksel::SolverOptions::paper() : iksel::SolverOptions{});
  }
  return *found;
}

void kdl_fk_jacobian(benchmark::State& state) {
  const Problem& p = problem(state.range(0));
  const auto kdl = p.robot.model().make_kdl();
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(kdl->fk_and_jacobian(p.configurations[i++ % kTargets]));
  }
}
BENCHMARK(kdl_fk_jacobian)->Arg(0)->Arg(1);

void kernel_fk(benchmark::State& state) {
  const Problem& p = problem(state.range(0));
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(p.robot.model().fk(p.configurations[i++ % kTargets].data()));
  }
}
BENCHMARK(kernel_fk)->Arg(0)->Arg(1);

void kernel_fk_jacobian(benchmark::State& state) {
  const Problem& p = problem(state.range(0));
  iksel::Pose pose;
  iksel::Jacobian J;
  std::size_t i = 0;
  for (auto _ : state) {
    p.robot.model().fk_jacobian(p.configurations[i++ % kTargets].data(), pose, J);
    benchmark::DoNotOptimize(J);
  }
}
BENCHMARK(kernel_fk_jacobian)->Arg(0)->Arg(1);

void query(benchmark::State& state) {
  const Problem& p = problem(state.range(0));
  const iksel::Solver& s = solver(state.range(0), true);
  iksel::Selection selection(p.robot.model(), s.database().data(), s.options());
  std::size_t i = 0;
  for (auto _ : state) selection.query(p.targets[i++ % kTargets]);
}
BENCHMARK(query)->Arg(0)->Arg(1);

void query_and_rank(benchmark::State& state) {
  const Problem& p = problem(state.range(0));
  const iksel::Solver& s = solver(state.range(0), true);
  iksel::Selection selection(p.robot.model(), s.database().data(), s.options());
  std::size_t i = 0;
  for (auto _ : state) {
    selection.query(p.targets[i++ % kTargets]);
    selection.rank();
  }
}
BENCHMARK(query_and_rank)->Arg(0)->Arg(1);

void solve(benchmark::State& state) {
  const Problem& p = problem(state.range(0));
  const iksel::Solver& s = solver(state.range(0), state.range(1) != 0);
  std::size_t i = 0;
  std::size_t solved = 0;
  for (auto _ : state) solved += s.solve(p.targets[i++ % kTargets]).success() ? 1 : 0;
  state.counters["success"] =
      benchmark::Counter(static_cast<double>(solved), benchmark::Counter::kAvgIterations);
}
BENCHMARK(solve)->ArgNames({"arm", "paper"})->ArgsProduct({{0, 1}, {0, 1}});

void solve_batch(benchmark::State& state) {
  const Problem& p = problem(state.range(0));
  const iksel::Solver& s = solver(state.range(0), state.range(1) != 0);
  for (auto _ : state) benchmark::DoNotOptimize(s.solve_batch(p.targets, 1));
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations() * kTargets));
}
BENCHMARK(solve_batch)->ArgNames({"arm", "paper"})->ArgsProduct({{0, 1}, {0, 1}});

}  // namespace
