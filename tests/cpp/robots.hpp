// SPDX-License-Identifier: BSD-3-Clause
// What C++ tests share: the built-in robots and their solvers, each made once; KDL's kinematics;
// the number of random cases and their seed.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <iksel/iksel.hpp>
#include <memory>
#include <string>
#include <vector>

#include "base/constants.hpp"

namespace iksel {
class KdlChain;
}

namespace iksel_test {

using iksel::kInfinity;
using iksel::kPi;
using iksel::kTwoPi;

/// The built-in robot of that name, tool included, as robots.toml describes it.
const iksel::Robot& robot(const std::string& name);

/// Its solvers of the two presets.
const iksel::Solver& solver(const std::string& name);
const iksel::Solver& paper_solver(const std::string& name);

/// Those of the paper's experiments, as robots.toml says.
const std::vector<std::string>& paper_robots();

/// Those, and others that differ in what matters to a solver: number of joints, limits, offsets.
const std::vector<std::string>& all_robots();

/// KDL's word on a robot's answers. To be made in each test: KDL remembers what it computed last,
/// and no two threads may share that.
class Judge {
 public:
  explicit Judge(const iksel::Robot& robot);

  iksel::Pose fk(const iksel::JointVector& q);

  /// Expects q to reach the options' task within the tolerances, and to lie inside the limits; by
  /// KDL and task_errors.hpp.
  void expect_solution(const iksel::Pose& target, const iksel::JointVector& q,
                       const iksel::SolverOptions& options = {});

 private:
  iksel::Robot robot_;
  std::shared_ptr<iksel::KdlChain> kdl_;
};

/// How many of n random targets the solver says it has solved, each of which is judged; every other
/// one in a batch.
int count_solved(const iksel::Solver& solver, int n);

/// Random cases per test: IKSEL_TEST_CASES, or `normal`; no fewer than a test needs to say
/// anything.
int cases(int normal, int least = 1);

/// The seed of all random cases: IKSEL_TEST_SEED, or 1. Print it with every failure.
std::uint64_t seed();

/// FK of every row of q.
std::vector<iksel::Pose> poses(const iksel::Robot& robot, const Eigen::MatrixXd& q);

/// FK at n random configurations.
std::vector<iksel::Pose> random_targets(const iksel::Robot& robot, int n);

/// How far a matrix is from losing rank.
double least_singular_value(const Eigen::MatrixXd& J);

/// A pose as the paper counts distances: translation [m] and rotation vector [rad].
Eigen::Matrix<double, 6, 1> pose_vector(const iksel::Pose& pose);

/// Names the cases of a suite by their parameter.
inline std::string name_of(const testing::TestParamInfo<std::string>& info) { return info.param; }

/// Solves from a seed first.
inline iksel::Result solve_from(const iksel::Solver& solver, const iksel::Pose& target,
                                const iksel::JointVector& seed) {
  iksel::SolveRequest request;
  request.seeds = {seed};
  return solver.solve(target, request);
}

/// The strategy of options that take one seed at a time; makes it the paper's if it is not.
inline iksel::Paper& paper_of(iksel::SolverOptions& options) {
  if (!std::holds_alternative<iksel::Paper>(options.strategy)) options.strategy = iksel::Paper{};
  return std::get<iksel::Paper>(options.strategy);
}

}  // namespace iksel_test
