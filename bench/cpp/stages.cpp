// SPDX-License-Identifier: BSD-3-Clause
// Time of each stage by itself, on the arms of the paper. Every benchmark goes round over the same
// 1024 targets, so that no cache holds one answer.
#include <benchmark/benchmark.h>

#include <iksel/iksel.hpp>
#include <memory>
#include <string>
#include <vector>

#include "database/reduction.hpp"
#include "kinematics/chain_model.hpp"
#include "seeds/selection.hpp"
#include "simd/kernels.hpp"

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
  iksel::Jacobian J;
  std::size_t i = 0;
  for (auto _ : state) {
    const double* q = p.configurations[i++ % kTargets].data();
    const iksel::Pose pose = iksel::to_pose(p.robot.model().fk_jacobian(q, J));
    benchmark::DoNotOptimize(pose);
    benchmark::DoNotOptimize(J);
  }
}
BENCHMARK(kernel_fk_jacobian)->Arg(0)->Arg(1);

void query(benchmark::State& state) {
  const Problem& p = problem(state.range(0));
  const iksel::Solver& s = solver(state.range(0), true);
  const auto& paper = std::get<iksel::Paper>(s.options().strategy);
  iksel::Selection selection(&p.robot.model(), &p.robot.model(), s.database().data(), paper);
  std::size_t i = 0;
  for (auto _ : state) selection.query(p.targets[i++ % kTargets]);
}
BENCHMARK(query)->Arg(0)->Arg(1);

void query_and_rank(benchmark::State& state) {
  const Problem& p = problem(state.range(0));
  const iksel::Solver& s = solver(state.range(0), true);
  const auto& paper = std::get<iksel::Paper>(s.options().strategy);
  iksel::Selection selection(&p.robot.model(), &p.robot.model(), s.database().data(), paper);
  std::size_t i = 0;
  for (auto _ : state) {
    selection.query(p.targets[i++ % kTargets]);
    selection.rank();
  }
}
BENCHMARK(query_and_rank)->Arg(0)->Arg(1);

/// The leaf of the descent-only tree that a target falls into.
void leaf_query(benchmark::State& state) {
  const Problem& p = problem(state.range(0));
  const iksel::DatabaseData& data = solver(state.range(0), false).database().data();
  double key[12];
  std::size_t i = 0;
  for (auto _ : state) {
    data.make_key(p.targets[i++ % kTargets], key);
    benchmark::DoNotOptimize(data.leaves.block(key));
  }
}
BENCHMARK(leaf_query)->Arg(0)->Arg(1);

/// The same number of samples, by nanoflann.
void exact_query(benchmark::State& state) {
  const Problem& p = problem(state.range(0));
  const iksel::DatabaseData& data = solver(state.range(0), false).database().data();
  double key[12];
  iksel::Neighbour nearest[iksel::lanes::kBlock];
  std::size_t i = 0;
  for (auto _ : state) {
    data.make_key(p.targets[i++ % kTargets], key);
    benchmark::DoNotOptimize(data.tree->nearest(key, iksel::lanes::kBlock, nearest));
  }
}
BENCHMARK(exact_query)->Arg(0)->Arg(1);

/// Seeds and ranking of one block.
void prepare_seeds(benchmark::State& state) {
  const Problem& p = problem(state.range(0));
  const iksel::DatabaseData& data = solver(state.range(0), false).database().data();
  const iksel::lanes::SeedChain chain = iksel::make_seed_chain(p.robot.model(), *data.reduction);
  std::vector<const float*> blocks;
  std::vector<iksel::lanes::SeedTarget> targets;
  for (const iksel::Pose& target : p.targets) {
    double key[12];
    data.make_key(target, key);
    blocks.push_back(data.leaves.block(key));
    targets.push_back(iksel::make_seed_target(data.reduction->reduce(target)));
  }
  const auto prepare = iksel::lanes::choose_kernels().prepare;
  iksel::lanes::SeedPack seeds;
  std::size_t i = 0;
  for (auto _ : state) {
    prepare(chain, targets[i % kTargets], blocks[i % kTargets], seeds);
    benchmark::DoNotOptimize(seeds.order[0]);
    ++i;
  }
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations() * iksel::lanes::kBlock));
}
BENCHMARK(prepare_seeds)->Arg(0)->Arg(1);

/// One iteration of a pack, narrow (0) or wide (1); items are seeds.
void lane_iteration(benchmark::State& state) {
  const Problem& p = problem(state.range(0));
  const auto chain = iksel::make_lane_chain(p.robot.model());
  const iksel::Reduction reduction = iksel::Reduction::of(p.robot.model(), 1);
  const auto& kernels = iksel::lanes::choose_kernels();
  const auto& packs = state.range(1) == 0 ? kernels.narrow : kernels.wide;
  iksel::lanes::LanePack pack{};
  for (int lane = 0; lane < iksel::lanes::kWidth; ++lane) {
    const iksel::Pose Y = reduction.reduce(p.targets[static_cast<std::size_t>(lane)]);
    for (int r = 0; r < 3; ++r) {
      pack.target[r][lane] = Y(r, 3);
      for (int c = 0; c < 3; ++c) pack.target[3 + 3 * c + r][lane] = Y(r, c);
    }
  }
  const iksel::lanes::LaneOptions options{1e-3, 1e-18, 0, 0, 0, 0, 0};  // never there
  constexpr int kIterations = 16;
  std::size_t i = 0;
  for (auto _ : state) {
    const iksel::JointVector& q = p.configurations[i++ % kTargets];
    for (int j = 0; j < p.robot.dof(); ++j) {
      for (double& value : pack.q[j]) value = q[j];
    }
    benchmark::DoNotOptimize(packs.advance(chain, options, nullptr, ~0U, kIterations, pack));
  }
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations()) * kIterations * packs.lanes);
  state.counters["per_iteration"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * kIterations,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(lane_iteration)->ArgsProduct({{0, 1}, {0, 1}});

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
  for (auto _ : state) benchmark::DoNotOptimize(s.solve_batch(p.targets, {}, {}, 1));
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations() * kTargets));
}
BENCHMARK(solve_batch)->ArgNames({"arm", "paper"})->ArgsProduct({{0, 1}, {0, 1}});

}  // namespace
