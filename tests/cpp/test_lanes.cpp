// SPDX-License-Identifier: BSD-3-Clause
// The lane kernels of every instruction set that this machine has.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iksel/iksel.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/random.hpp"
#include "database/reduction.hpp"
#include "kinematics/chain_model.hpp"
#include "levels.hpp"
#include "robots.hpp"
#include "simd/kernels.hpp"
#include "simd/lane_math.hpp"

namespace {

namespace lanes = iksel::lanes;
using iksel::JointVector;
using iksel::Pose;
using iksel::Robot;
using iksel_test::ForcedLevel;
using iksel_test::levels;

TEST(LaneMath, SincosIsPreciseOverManyTurns) {
  iksel::Random random(iksel_test::seed());
  for (int i = 0; i < 100'000; ++i) {
    const double x = random.uniform(-1, 1) * std::pow(10.0, random.uniform(-6, 6));
    double sine = 0;
    double cosine = 0;
    iksel::sincos(x, sine, cosine);
    EXPECT_NEAR(sine, std::sin(x), 5e-16) << x;
    EXPECT_NEAR(cosine, std::cos(x), 5e-16) << x;
  }
}

TEST(LaneMath, RoughAtan2IsGoodEnoughForSeeds) {
  iksel::Random random(iksel_test::seed());
  for (int i = 0; i < 10'000; ++i) {
    const auto y = static_cast<float>(random.uniform(-1, 1));
    const auto x = static_cast<float>(random.uniform(-1, 1));
    EXPECT_NEAR(lanes::rough_atan2(y, x), std::atan2(y, x), 2e-5);
  }
  for (const auto& [y, x] :
       {std::pair(0.0F, 1.0F), {0.0F, -1.0F}, {1.0F, 0.0F}, {-1.0F, 0.0F}, {0.0F, 0.0F}}) {
    EXPECT_NEAR(lanes::rough_atan2(y, x), std::atan2(y, x), 2e-5) << y << " " << x;
  }
}

TEST(Levels, ThereIsAlwaysScalar) {
  EXPECT_EQ(levels().back(), "scalar");
  // The tests may be run with one asked for.
  const char* asked = std::getenv("IKSEL_SIMD");
  EXPECT_EQ(iksel::simd_level(), asked != nullptr ? std::string(asked) : levels().front());
}

TEST(Levels, AnUnknownOneIsRefusedByName) {
  const ForcedLevel forced("mmx");
  try {
    const iksel::Solver solver(iksel_test::robot("cvr038"));
    FAIL();
  } catch (const iksel::InvalidArgumentError& error) {
    EXPECT_NE(std::string(error.what()).find("'mmx'"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("scalar"), std::string::npos);
  }
}

TEST(Levels, EachGivesTheSameBitsForAnyNumberOfThreads) {
  for (const std::string& level : levels()) {
    const ForcedLevel forced(level);
    const Robot& robot = iksel_test::robot("irb14050");
    const iksel::Solver solver(robot);
    const Eigen::MatrixXd q =
        robot.random_configurations(iksel_test::cases(2000), iksel_test::seed());
    std::vector<Pose> targets;
    for (Eigen::Index i = 0; i < q.rows(); ++i) targets.push_back(robot.fk(q.row(i)));
    const auto one = solver.solve_batch(targets, {}, {}, 1);
    for (const int threads : {2, 8}) {
      const auto many = solver.solve_batch(targets, {}, {}, threads);
      for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].q, many[i].q) << level;
    }
  }
}

/// Numbers of the iteration for one tolerance on both errors, without a tool.
lanes::LaneOptions lane_options(double tolerance) {
  lanes::LaneOptions options{};
  options.damping = 1e-3;
  options.least_damping = 1e-18;
  options.position2 = options.rotation2 = tolerance * tolerance;
  options.last_step2 = tolerance;
  options.last_error2 = 16 * tolerance;
  return options;
}

void set_target(lanes::LanePack& pack, int lane, const Pose& Y) {
  for (int i = 0; i < 3; ++i) {
    pack.target[i][lane] = Y(i, 3);
    for (int c = 0; c < 3; ++c) pack.target[3 + 3 * c + i][lane] = Y(i, c);
  }
}

/// Packs of every level and width.
std::vector<std::pair<std::string, lanes::PackKernels>> all_packs() {
  std::vector<std::pair<std::string, lanes::PackKernels>> packs;
  for (const std::string& level : levels()) {
    const ForcedLevel forced(level);
    const auto& kernels = lanes::choose_kernels();
    packs.emplace_back(level + " narrow", kernels.narrow);
    packs.emplace_back(level + " wide", kernels.wide);
  }
  return packs;
}

/// Every lane of a pack with a target and a seed near its solution gets there.
TEST(Kernels, EveryLaneReachesItsOwnTarget) {
  const double tolerance = 1e-9;
  const lanes::LaneOptions options = lane_options(tolerance);
  for (const auto& [level, packs] : all_packs()) {
    const Robot robot = iksel_test::robot("irb14050").with_tcp(Pose::Identity());
    const int n = robot.dof();
    const iksel::Reduction reduction = iksel::Reduction::of(robot.model(), 1);
    const auto chain = iksel::make_lane_chain(robot.model());
    iksel::Random random(iksel_test::seed());
    int arrived = 0;
    for (int round = 0; round < 100; ++round) {
      const Eigen::MatrixXd q =
          robot.random_configurations(static_cast<std::size_t>(packs.lanes), 1000U + round);
      lanes::LanePack pack{};
      for (int lane = 0; lane < packs.lanes; ++lane) {
        set_target(pack, lane, reduction.reduce(robot.fk(q.row(lane))));
        for (int j = 0; j < n; ++j) pack.q[j][lane] = q(lane, j) + random.uniform(-0.03, 0.03);
      }
      auto watched = (1U << static_cast<unsigned>(packs.lanes)) - 1;
      for (int used = 0; watched != 0 && used < 60;) {
        const auto result = packs.advance(chain, options, nullptr, watched, 60 - used, pack);
        EXPECT_EQ(result.done & ~watched, 0U);
        used += result.iterations;
        for (int lane = 0; lane < packs.lanes; ++lane) {
          if ((result.done >> static_cast<unsigned>(lane) & 1U) == 0) continue;
          JointVector found(n);
          for (int j = 0; j < n; ++j) found[j] = pack.q[j][lane];
          const auto e = iksel::pose_error(robot.fk(q.row(lane)), robot.fk(found));
          EXPECT_LT(e.norm(), 10 * tolerance) << level << " round " << round;
          ++arrived;
        }
        watched &= ~result.done;
      }
    }
    EXPECT_GT(arrived, 100 * packs.lanes * 95 / 100) << level;
  }
}

/// What a lane does depends on nothing in the other lanes: packs may be mixed at will.
TEST(Kernels, ALaneIsBlindToTheOthers) {
  const lanes::LaneOptions options = lane_options(1e-9);
  for (const auto& [level, packs] : all_packs()) {
    const Robot& robot = iksel_test::robot("cvr038");
    const int n = robot.dof();
    const auto chain = iksel::make_lane_chain(robot.model());
    const iksel::Reduction reduction = iksel::Reduction::of(robot.model(), 1);
    for (unsigned round = 0; round < 50; ++round) {
      const Eigen::MatrixXd q = robot.random_configurations(2 * lanes::kWidth, 77 + round);
      lanes::LanePack pack{};
      for (int lane = 0; lane < packs.lanes; ++lane) {
        set_target(pack, lane, reduction.reduce(robot.fk(q.row(lane))));
        for (int j = 0; j < n; ++j) pack.q[j][lane] = q(lanes::kWidth + lane, j);
      }
      lanes::LanePack alone = pack;
      for (int lane = 1; lane < packs.lanes; ++lane) {
        for (auto& row : alone.target) row[lane] = row[0];
        for (int j = 0; j < n; ++j) alone.q[j][lane] = alone.q[j][0];
      }
      packs.advance(chain, options, nullptr, 0, 12, pack);
      packs.advance(chain, options, nullptr, 0, 12, alone);
      for (int j = 0; j < n; ++j) EXPECT_EQ(pack.q[j][0], alone.q[j][0]) << level;
      EXPECT_EQ(pack.error2[0], alone.error2[0]) << level;
    }
  }
}

TEST(Kernels, ANonFiniteLaneFailsAndEnds) {
  const Robot& robot = iksel_test::robot("cvr038");
  const auto chain = iksel::make_lane_chain(robot.model());
  lanes::LanePack nowhere{};
  for (int lane = 0; lane < lanes::kWidth; ++lane) {
    set_target(nowhere, lane, Pose::Identity());
    for (int j = 0; j < robot.dof(); ++j) nowhere.q[j][lane] = NAN;
  }
  for (const auto& [level, packs] : all_packs()) {
    lanes::LanePack pack = nowhere;
    const auto result = packs.advance(chain, lane_options(1e-6), nullptr, ~0U, 20, pack);
    EXPECT_EQ(result.done, 0U) << level;
    EXPECT_EQ(result.iterations, 20) << level;
  }
}

/// Against one number after the other.
TEST(Kernels, SeedsAreKeptFromWhatIsKnown) {
  constexpr int kJoints = 6;
  iksel::Random random(iksel_test::seed());
  const auto number = [&random] { return static_cast<float>(random.uniform(-6, 6)); };
  for (const std::string& level : levels()) {
    const ForcedLevel forced(level);
    const auto& kernels = lanes::choose_kernels();
    for (int round = 0; round < 100; ++round) {
      lanes::SeedPack seeds{};
      float from[kJoints];
      float per_turn[kJoints];
      for (int j = 0; j < kJoints; ++j) {
        from[j] = number();
        per_turn[j] = random.uniform(0, 1) < 0.5 ? static_cast<float>(0.5 / M_PI) : 0;
        for (float& q : seeds.q[j]) q = number();
      }
      float nearest[lanes::kBlock];
      for (float& d : nearest) d = static_cast<float>(random.uniform(-1, 4));
      float expected[lanes::kBlock];
      for (int entry = 0; entry < lanes::kBlock; ++entry) {
        float away = 0;
        for (int j = 0; j < kJoints; ++j) {
          const float d = seeds.q[j][entry] - from[j];
          away = std::max(away, std::abs(per_turn[j] > 0 ? std::remainder(d, 6.2831853F) : d));
        }
        expected[entry] = std::min(nearest[entry], away);
      }
      kernels.add_known(kJoints, per_turn, from, seeds.q[0], 1, 0, nearest);
      for (int entry = 0; entry < lanes::kBlock; ++entry) {
        EXPECT_NEAR(nearest[entry], expected[entry], 1e-5) << level << " round " << round;
      }
    }
  }
}

TEST(Kernels, TheFirstOfTheLargestIsFound) {
  constexpr int kMost = 4 * lanes::kBlock;
  iksel::Random random(iksel_test::seed());
  for (const std::string& level : levels()) {
    const ForcedLevel forced(level);
    const auto& kernels = lanes::choose_kernels();
    for (int round = 0; round < 400; ++round) {
      const int count = (1 + round % 4) * lanes::kBlock;
      float numbers[kMost];
      // Few values: the largest comes more than once.
      for (float& x : numbers) x = std::floor(static_cast<float>(random.uniform(-3, 30)));
      EXPECT_EQ(kernels.find_largest(count, numbers),
                std::max_element(numbers, numbers + count) - numbers)
          << level << " round " << round;
    }
    // Nothing is found of what is no number, but nothing read beyond the end either.
    const std::vector<float> none(lanes::kBlock, NAN);
    EXPECT_LT(kernels.find_largest(lanes::kBlock, none.data()), lanes::kBlock) << level;
  }
}

/// The answer from a workspace that no less than `depth` others, which solve meanwhile, leave.
iksel::Result solve_inside(const iksel::Solver& solver, const Pose& target, unsigned depth) {
  if (depth == 0) return solver.solve(target);
  iksel::Result inner;
  iksel::SolveRequest request;
  request.filter = [&](const double* /*q*/, std::size_t count, bool* keep) {
    inner = solve_inside(solver, target, depth - 1);
    std::fill_n(keep, count, true);
  };
  static_cast<void>(solver.solve(target, request));
  return inner;
}

/// A solver makes workspaces when more solve at once than the machine has cores: those have the
/// instruction set of the first, so that answers have the same bits from all of them.
TEST(Levels, ASolverKeepsItsOwn) {
  const Robot& robot = iksel_test::robot("panda");
  const auto levels = iksel_test::levels();
  const ForcedLevel first(levels.front());
  const iksel::Solver solver(robot);
  const iksel::Matrix q = robot.random_configurations(40, iksel_test::seed());
  const ForcedLevel second(levels.back());
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  for (int i = 0; i < q.rows(); ++i) {
    const Pose target = robot.fk(q.row(i));
    EXPECT_EQ(solve_inside(solver, target, cores).q, solver.solve(target).q)
        << "seed " << iksel_test::seed();
  }
  // Nothing reads the variable again.
  const ForcedLevel none("none");
  EXPECT_FALSE(solver.solve_all(robot.fk(q.row(0)), {}).all.empty());
}

}  // namespace
