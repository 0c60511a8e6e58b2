// SPDX-License-Identifier: BSD-3-Clause
// The lane kernels of every instruction set that this machine has.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iksel/iksel.hpp>

#include "database/reduction.hpp"
#include "kinematics/chain_model.hpp"
#include "lanes/kernels.hpp"
#include "lanes/lane_math.hpp"
#include "math/random.hpp"
#include "robots.hpp"

namespace {

namespace lanes = iksel::lanes;
using iksel::JointVector;
using iksel::Pose;
using iksel::Robot;

/// Forces a level for as long as it lives.
class ForcedLevel {
 public:
  explicit ForcedLevel(const std::string& level) { ::setenv("IKSEL_SIMD", level.c_str(), 1); }
  ForcedLevel(const ForcedLevel&) = delete;
  ForcedLevel& operator=(const ForcedLevel&) = delete;
  ~ForcedLevel() { ::unsetenv("IKSEL_SIMD"); }
};

/// Levels that this machine has.
std::vector<std::string> levels() {
  std::vector<std::string> found;
  for (const char* level : {"avx512", "avx2", "sse2", "neon", "scalar"}) {
    const ForcedLevel forced(level);
    try {
      iksel::simd_level();
      found.emplace_back(level);
    } catch (const iksel::InvalidArgumentError&) {
      continue;
    }
  }
  return found;
}

TEST(LaneMath, SincosIsPreciseOverManyTurns) {
  iksel::Random random(iksel_test::seed());
  for (int i = 0; i < 100'000; ++i) {
    const double x = random.uniform(-1, 1) * std::pow(10.0, random.uniform(-6, 3));
    double sine = 0;
    double cosine = 0;
    lanes::sincos(x, sine, cosine);
    EXPECT_NEAR(sine, std::sin(x), 1e-13) << x;
    EXPECT_NEAR(cosine, std::cos(x), 1e-13) << x;
  }
}

TEST(LaneMath, RoughAtan2IsGoodEnoughForSeeds) {
  iksel::Random random(iksel_test::seed());
  for (int i = 0; i < 10'000; ++i) {
    const double y = random.uniform(-1, 1);
    const double x = random.uniform(-1, 1);
    EXPECT_NEAR(lanes::rough_atan2(y, x), std::atan2(y, x), 2e-5);
  }
  for (const auto& [y, x] :
       {std::pair(0.0, 1.0), {0.0, -1.0}, {1.0, 0.0}, {-1.0, 0.0}, {0.0, 0.0}}) {
    EXPECT_NEAR(lanes::rough_atan2(y, x), std::atan2(y, x), 2e-5) << y << " " << x;
  }
}

TEST(Levels, ThereIsAlwaysScalar) {
  EXPECT_EQ(levels().back(), "scalar");
  EXPECT_STREQ(iksel::simd_level(), levels().front().c_str());
}

TEST(Levels, AnUnknownOneIsRefusedByName) {
  const ForcedLevel forced("mmx");
  try {
    const iksel::Solver solver(iksel_test::load(iksel_test::paper_robots()[0]));
    FAIL();
  } catch (const iksel::InvalidArgumentError& error) {
    EXPECT_NE(std::string(error.what()).find("'mmx'"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("scalar"), std::string::npos);
  }
}

TEST(Levels, EachSolvesEverythingItCanReach) {
  const auto n = static_cast<std::size_t>(iksel_test::cases(2000));
  for (const std::string& level : levels()) {
    const ForcedLevel forced(level);
    ASSERT_EQ(iksel::simd_level(), level);
    for (const auto& c : iksel_test::all_robots()) {
      const Robot robot = iksel_test::load(c);
      if (robot.dof() < 6) continue;
      const iksel::Evaluation e = iksel::evaluate(iksel::Solver(robot), n, iksel_test::seed());
      EXPECT_EQ(e.solved, n) << level << " " << c.name << " seed " << iksel_test::seed();
      EXPECT_EQ(e.false_success, 0U) << level << " " << c.name;
    }
  }
}

TEST(Levels, EachGivesTheSameBitsForAnyNumberOfThreads) {
  for (const std::string& level : levels()) {
    const ForcedLevel forced(level);
    const Robot robot = iksel_test::load(iksel_test::paper_robots()[3]);
    const iksel::Solver solver(robot);
    const Eigen::MatrixXd q =
        robot.random_configurations(iksel_test::cases(2000), iksel_test::seed());
    std::vector<Pose> targets;
    for (Eigen::Index i = 0; i < q.rows(); ++i) targets.push_back(robot.fk(q.row(i)));
    const auto one = solver.solve_batch(targets, 1);
    for (const int threads : {2, 8}) {
      const auto many = solver.solve_batch(targets, threads);
      for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].q, many[i].q) << level;
    }
  }
}

/// A pack of seeds near a solution converges to it, whichever kernel iterates.
TEST(Kernels, FixedAndAnyNumberOfJointsAgree) {
  const auto& kernels = lanes::choose_kernels();
  const Robot robot = iksel_test::load(iksel_test::paper_robots()[3]).with_tcp(Pose::Identity());
  const iksel::Reduction reduction = iksel::Reduction::of(robot.model(), 1);
  const auto chain = iksel::make_lane_chain(robot.model());
  const lanes::LaneOptions options{1e-9, 1e-9, 1e-3, 30};
  const Eigen::MatrixXd q = robot.random_configurations(300, iksel_test::seed());
  iksel::Random random(iksel_test::seed());
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const auto target = iksel::make_lane_target(reduction.reduce(robot.fk(q.row(i))));
    std::vector<double> seeds(static_cast<std::size_t>(robot.dof() * lanes::kGroup));
    for (int j = 0; j < robot.dof(); ++j) {
      for (int s = 0; s < lanes::kGroup; ++s) {
        seeds[static_cast<std::size_t>(j * lanes::kGroup + s)] =
            q(i, j) + random.uniform(-0.05, 0.05);
      }
    }
    JointVector fixed(robot.dof());
    JointVector any(robot.dof());
    const auto a = kernels.solve[robot.dof()](chain, target, options, seeds.data(), fixed.data());
    const auto b = kernels.solve[0](chain, target, options, seeds.data(), any.data());
    EXPECT_EQ(a.lane, b.lane);
    EXPECT_EQ(a.iterations, b.iterations);
    if (a.lane < 0) continue;
    EXPECT_LT((fixed - any).norm(), 1e-9);
    const auto e = iksel::pose_error(robot.fk(q.row(i)), robot.fk(fixed));
    EXPECT_LT(e.norm(), 3e-9);
  }
}

TEST(Kernels, ANonFiniteLaneFailsAndEnds) {
  const auto& kernels = lanes::choose_kernels();
  const Robot robot = iksel_test::load(iksel_test::paper_robots()[0]);
  const auto chain = iksel::make_lane_chain(robot.model());
  const std::vector<double> seeds(static_cast<std::size_t>(robot.dof() * lanes::kGroup), NAN);
  JointVector q(robot.dof());
  lanes::LaneTarget target = iksel::make_lane_target(Pose::Identity());
  const lanes::LaneOptions options{1e-6, 1e-6, 1e-3, 20};
  EXPECT_EQ(kernels.solve[6](chain, target, options, seeds.data(), q.data()).lane, -1);
}

}  // namespace
