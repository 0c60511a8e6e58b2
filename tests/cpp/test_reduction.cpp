// SPDX-License-Identifier: BSD-3-Clause
// The reduced key does not feel the first and last joint, and seeds made from it lead back to them.
#include <gtest/gtest.h>

#include <iksel/iksel.hpp>

#include "base/rotation.hpp"
#include "database/data.hpp"
#include "database/reduction.hpp"
#include "robots.hpp"
#include "simd/kernels.hpp"

namespace {

using iksel::Database;
using iksel::JointVector;
using iksel::Pose;
using iksel::Reduction;
using iksel::Robot;
using iksel::lanes::Side;

/// A chain of `kinds`: one letter per joint, r(evolute), c(ontinuous), p(rismatic).
Robot make_robot(const std::string& kinds) {
  std::string links = "<link name='l0'/>";
  std::string joints;
  const char* axes[] = {"0 0 1", "0 1 0", "1 0 0", "0.6 0 0.8", "0 1 0.2", "1 0 0.1", "0 0 1"};
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const std::string from = "l" + std::to_string(i);
    const std::string to = "l" + std::to_string(i + 1);
    links += "<link name='" + to + "'/>";
    const char* type = kinds[i] == 'r' ? "revolute" : kinds[i] == 'c' ? "continuous" : "prismatic";
    const char* limits = kinds[i] == 'p' ? "lower='-0.2' upper='0.5'" : "lower='-2.5' upper='2.8'";
    joints += "<joint name='j" + std::to_string(i) + "' type='" + type + "'><parent link='" + from +
              "'/><child link='" + to + "'/><origin xyz='0.05 0.02 0.3' rpy='0.1 0.2 " +
              std::to_string(0.1 * static_cast<double>(i)) + "'/><axis xyz='" + axes[i % 7] +
              "'/><limit " + (kinds[i] == 'c' ? "" : limits) + " effort='0' velocity='1'/></joint>";
  }
  return Robot::from_urdf_string("<robot name='" + kinds + "'>" + links + joints + "</robot>");
}

class Kinds : public testing::TestWithParam<const char*> {};

TEST_P(Kinds, KeyDoesNotFeelTheJointsLeftOut) {
  const Robot robot = make_robot(GetParam());
  const Reduction reduction = Reduction::of(robot.model(), 0.3);
  const Eigen::MatrixXd q = robot.random_configurations(200, iksel_test::seed());
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    JointVector moved = q.row(i);
    for (int j = 0; j < robot.dof(); ++j) {
      if (reduction.leaves_out(j)) moved[j] += 0.37 + 0.1 * j;
    }
    double key[12];
    double moved_key[12];
    reduction.make_key(reduction.reduce(robot.fk(q.row(i))), key);
    reduction.make_key(reduction.reduce(robot.fk(moved)), moved_key);
    for (int d = 0; d < reduction.key_dimension(); ++d) EXPECT_NEAR(key[d], moved_key[d], 1e-9);
  }
}

TEST_P(Kinds, SeedOfAPosesOwnSampleIsItsSolution) {
  const Robot robot = make_robot(GetParam());
  iksel::DatabaseOptions options;
  options.samples = 300;
  const Database database = Database::build(robot, options);
  const auto& data = database.data();
  const auto chain = iksel::make_lane_chain(robot.model());
  const auto seed_chain = iksel::make_seed_chain(robot.model(), *data.reduction);
  for (std::size_t i = 0; i < database.size(); ++i) {
    // Move the joints left out to somewhere inside their limits: the sample must lead back there.
    JointVector q = database.q(i);
    for (int j = 0; j < robot.dof(); ++j) {
      if (data.reduction->leaves_out(j)) q[j] = 0.3 - 0.05 * j;
    }
    const Pose Y = data.reduction->reduce(robot.fk(q));
    std::vector<float> block(
        static_cast<std::size_t>(iksel::lanes::block_rows(robot.dof()) * iksel::lanes::kBlock));
    for (int entry = 0; entry < iksel::lanes::kBlock; ++entry) {
      iksel::write_to_block(data, i, entry, block.data());
    }
    iksel::lanes::SeedPack seeds;
    iksel::lanes::kKernelsScalar.prepare(seed_chain, iksel::make_seed_target(Y), block.data(),
                                         seeds);
    for (int entry = 0; entry < iksel::lanes::kBlock; ++entry) {
      // Equals keep their order; the first step is about none, even along singular directions.
      EXPECT_EQ(seeds.order[entry], entry);
      for (int j = 0; j < robot.dof(); ++j) EXPECT_NEAR(seeds.q[j][entry], q[j], 2e-3) << j;
      if (data.reduction->leaves_out(0)) EXPECT_NEAR(seeds.first[entry], q[0], 1e-4);
      if (data.reduction->leaves_out(robot.dof() - 1)) {
        EXPECT_NEAR(seeds.last[entry], q[robot.dof() - 1], 1e-4);
      }
    }
    // Without the outer joints, the pose is the sample's.
    JointVector seed(robot.dof());
    for (int j = 0; j < robot.dof(); ++j) seed[j] = q[j];
    const Pose inner = data.reduction->without_outer_joints(Y, chain, seed.data());
    EXPECT_LT((inner.translation() - Eigen::Map<const Eigen::Vector3d>(data.x(i))).norm(), 1e-9);
    EXPECT_LT((inner.linear() -
               iksel::from_rotation_vector(Eigen::Map<const Eigen::Vector3d>(data.x(i) + 3)))
                  .norm(),
              1e-9);
  }
}

TEST_P(Kinds, SamplesCarryPoseAndDerivative) {
  const Robot robot = make_robot(GetParam());
  iksel::DatabaseOptions options;
  options.samples = 100;
  const Database database = Database::build(robot, options);
  const auto& data = database.data();
  for (std::size_t i = 0; i < database.size(); ++i) {
    const JointVector q = database.q(i);
    EXPECT_LT((database.pose(i).matrix() - robot.fk(q).matrix()).norm(), 1e-9);
    // J^+ J dq = dq for the joints' own small motions, seen as the reduced pose sees them (6 joints
    // and no singularity: J^+ is the inverse).
    if (robot.dof() != 6) continue;
    const Eigen::MatrixXd P = database.pseudo_inverse(i);
    Eigen::MatrixXd J(6, 6);
    constexpr double kStep = 1e-6;
    for (int j = 0; j < 6; ++j) {
      JointVector forward = q;
      JointVector backward = q;
      forward[j] += kStep;
      backward[j] -= kStep;
      J.col(j) = iksel::pose_error(data.reduction->reduce(robot.fk(forward)),
                                   data.reduction->reduce(robot.fk(backward))) /
                 (2 * kStep);
    }
    if (P.norm() > 100) continue;
    EXPECT_LT((P * J - Eigen::MatrixXd::Identity(6, 6)).norm(), 1e-5 * P.norm());
  }
}

TEST_P(Kinds, SolvesWhatItCanReach) {
  const Robot robot = make_robot(GetParam());
  const int n = iksel_test::cases(2000);
  EXPECT_GE(iksel_test::count_solved(iksel::Solver(robot), n), n * 199 / 200);
  // The same database by the paper's pipeline, one seed at a time.
  iksel::SolverOptions options = iksel::SolverOptions::paper();
  options.database = {};
  iksel::Paper& paper = iksel_test::paper_of(options);
  paper.rotation_difference = iksel::RotationDifference::geodesic;
  paper.limit_aware = true;
  options.max_attempts = 20;
  EXPECT_GE(iksel_test::count_solved(iksel::Solver(robot, options), n / 2), n / 2 * 85 / 100 - 5);
}

TEST_P(Kinds, SavesAndLoads) {
  const Robot robot = make_robot(GetParam());
  const Database database = Database::build(robot, {});
  const Database loaded = Database::from_bytes(database.to_bytes());
  const iksel::Solver a(robot, {}, database);
  const iksel::Solver b(robot, {}, loaded);
  const Eigen::MatrixXd q = robot.random_configurations(50, iksel_test::seed());
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    EXPECT_EQ(a.solve(robot.fk(q.row(i))).q, b.solve(robot.fk(q.row(i))).q);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Kinds,
                         testing::Values("rrrrrr", "crrrrc", "prrrrr", "rrrrrp", "prrrrrp",
                                         "rrrprrr", "rrrrrrr"));

TEST(Reduction, FallsBackSideBySide) {
  const auto sides = [](const char* kinds) {
    const Reduction r = Reduction::of(make_robot(kinds).model(), 1);
    return std::pair(r.left, r.right);
  };
  EXPECT_EQ(sides("rrrrrr"), std::pair(Side::rotation, Side::rotation));
  EXPECT_EQ(sides("prrrrp"), std::pair(Side::translation, Side::none));
  EXPECT_EQ(sides("rrrrrp"), std::pair(Side::rotation, Side::translation));
  EXPECT_EQ(sides("rr"), std::pair(Side::none, Side::none));
}

TEST(Reduction, DefaultDatabaseIsSmall) {
  const Robot& robot = iksel_test::robot("irb14050");
  EXPECT_LE(Database::build(robot, {}).bytes(), 4'000'000U);
}

}  // namespace
