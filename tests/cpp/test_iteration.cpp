// SPDX-License-Identifier: BSD-3-Clause
// Each scheme: what its step is, and that it converges from near by.
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <Eigen/SVD>

#include "base/pseudo_inverse.hpp"
#include "goal/goal.hpp"
#include "iksel/iksel.hpp"
#include "refine/iterate.hpp"
#include "refine/limited_step.hpp"
#include "refine/schemes.hpp"
#include "robots.hpp"

namespace {

using iksel::Iteration;
using iksel::JacobianMatrix;
using iksel::JointVector;
using iksel::Pose;
using iksel::Robot;
using iksel::SolverOptions;
using iksel::Vector6;

Vector6 random_error(iksel::Random& random) {
  Vector6 e;
  for (int i = 0; i < 6; ++i) e[i] = random.uniform(-0.1, 0.1);
  return e;
}

TEST(Steps, AgreeWithEigensOtherDecomposition) {
  iksel::Random random(iksel_test::seed());
  for (const std::string& name : iksel_test::all_robots()) {
    const Robot& robot = iksel_test::robot(name);
    const Eigen::MatrixXd q = robot.random_configurations(20, iksel_test::seed());
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      const JacobianMatrix J = robot.jacobian(q.row(i));
      const Vector6 e = random_error(random);
      iksel::Paper scheme;
      scheme.damping = 0;
      scheme.pinv_cutoff = 0;
      const Eigen::VectorXd expected =
          Eigen::MatrixXd(J).completeOrthogonalDecomposition().solve(e);
      const double scale = 1e-6 * std::max(1.0, expected.norm());
      if (expected.norm() > 100) continue;  // nearly singular
      EXPECT_LT((iksel::dls_step(J, e, scheme) - expected).norm(), scale) << name;
      EXPECT_LT((iksel::pinv_step(J, e, scheme) - expected).norm(), scale);
      scheme.damping = 0.01;
      const Eigen::MatrixXd A =
          J.transpose() * J + 0.01 * Eigen::MatrixXd::Identity(robot.dof(), robot.dof());
      const Eigen::VectorXd damped = A.ldlt().solve(J.transpose() * e);
      EXPECT_LT((iksel::dls_step(J, e, scheme) - damped).norm(), 1e-9);
    }
  }
}

TEST(Steps, SingularValuesAreEigensForAnyNumberOfJoints) {
  iksel::Random random(iksel_test::seed());
  for (int dof = 1; dof <= 12; ++dof) {
    for (int i = 0; i < 50; ++i) {
      JacobianMatrix J(6, dof);
      for (Eigen::Index k = 0; k < J.size(); ++k) J(k) = random.uniform(-1, 1);
      // Of full rank; flat as a planar arm's; and with two rows that depend on each other.
      if (i % 3 == 1) J.bottomRows(2).setZero();
      if (i % 3 == 2) J.row(4) = 0.5 * J.row(1) - J.row(2);
      const Eigen::JacobiSVD<Eigen::MatrixXd> expected(J,
                                                       Eigen::ComputeThinU | Eigen::ComputeThinV);
      EXPECT_LT((iksel::singular_values(J) - expected.singularValues()).norm(), 1e-14 * 6)
          << dof << " joints";
      const Eigen::MatrixXd inverse = iksel::TruncatedSvd(J, 1e-9).inverse();
      Eigen::VectorXd sigma = expected.singularValues();
      for (double& s : sigma) s = s > 1e-9 * sigma.maxCoeff() ? 1 / s : 0;
      const Eigen::MatrixXd difference =
          inverse - expected.matrixV() * sigma.asDiagonal() * expected.matrixU().transpose();
      EXPECT_LT(difference.norm(), 1e-13 * sigma.squaredNorm()) << dof << " joints";
    }
  }
}

TEST(Steps, TruncationIgnoresTheSingularDirection) {
  // Two equal columns and five directions: one singular value is zero up to rounding.
  JacobianMatrix J = JacobianMatrix::Identity(6, 6);
  J.col(5) = J.col(4) * (1 + 1e-9);
  J(5, 5) = 1e-6;
  const Vector6 e = Vector6::Ones();
  iksel::Paper scheme;
  scheme.damping = 0;
  EXPECT_LT(iksel::dls_step(J, e, scheme).norm(), 10);
  scheme.pinv_cutoff = 0;
  EXPECT_GT(iksel::dls_step(J, e, scheme).norm(), 1e4);
}

TEST(Steps, ClampingWeightsFallToZeroAtTheLimits) {
  const Robot& robot = iksel_test::robot("cvr038");
  const auto& model = robot.model();
  const JointVector range = robot.upper() - robot.lower();
  const auto weight = [&](double part) {
    const JointVector q = robot.lower() + part * range;
    return iksel::joint_weights(model, q, 0.1)[2];
  };
  EXPECT_EQ(weight(0.5), 1);
  EXPECT_EQ(weight(0.11), 1);
  EXPECT_NEAR(weight(0.05), 0.5, 1e-12);
  EXPECT_NEAR(weight(0.95), 0.5, 1e-12);
  EXPECT_NEAR(weight(0.025), 3.0 / 16 - 2.0 / 64, 1e-12);
  EXPECT_EQ(weight(0.0), 0);
  EXPECT_EQ(weight(1.2), 0);
}

TEST(Steps, CwlnWithAllWeightsOneIsLeastNorm) {
  const Robot& robot = iksel_test::robot("irb14050");
  const JointVector middle = 0.5 * (robot.lower() + robot.upper());
  JointVector q = middle;
  for (int i = 0; i < robot.dof(); ++i) q[i] += 0.2 * (i % 2 == 0 ? 1 : -1);
  const JacobianMatrix J = robot.jacobian(q);
  iksel::Random random(iksel_test::seed());
  const Vector6 e = random_error(random);
  const JointVector expected = iksel::pinv_step(J, e, iksel::Paper{});
  EXPECT_LT((iksel::cwln_step(robot.model(), q, J, e, iksel::Paper{}) - expected).norm(), 1e-5);
  EXPECT_LT((iksel::cwpi_step(robot.model(), q, J, e, iksel::Paper{}) - expected).norm(), 1e-9);
}

TEST(Steps, CwlnPullsAJointBackFromItsLimit) {
  const Robot& robot = iksel_test::robot("irb14050");
  JointVector q = 0.5 * (robot.lower() + robot.upper());
  q[3] = robot.upper()[3];
  const JacobianMatrix J = robot.jacobian(q);
  const JointVector step = iksel::cwln_step(robot.model(), q, J, Vector6::Zero(), iksel::Paper{});
  EXPECT_LT(step[3], 0);
}

TEST(Steps, TheNullSpaceGainLeadsRedundantJointsToTheMiddle) {
  iksel::Random random(iksel_test::seed());
  for (const char* name : {"irb14050", "panda", "pr2_right_arm", "cvr038"}) {
    const Robot& robot = iksel_test::robot(name);
    const Eigen::MatrixXd q = robot.random_configurations(50, iksel_test::seed());
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      const JacobianMatrix J = robot.jacobian(q.row(i));
      const Vector6 e = random_error(random);
      const Eigen::MatrixXd inverse =
          Eigen::MatrixXd(J).completeOrthogonalDecomposition().pseudoInverse();
      if (inverse.norm() > 100) continue;  // nearly singular
      iksel::Paper scheme;
      scheme.null_space_gain = random.uniform(0.1, 1);
      Eigen::VectorXd way = 0.5 * (robot.lower() + robot.upper()) - q.row(i).transpose();
      for (double& each : way) each = std::isfinite(each) ? each : 0;  // turns without end
      const Eigen::MatrixXd N =
          Eigen::MatrixXd::Identity(robot.dof(), robot.dof()) - inverse * Eigen::MatrixXd(J);
      Eigen::VectorXd expected = inverse * e;
      if (robot.dof() > 6) expected += scheme.null_space_gain * (N * way);
      for (const Iteration iteration : {Iteration::dls, Iteration::pinv, Iteration::pinv_rr}) {
        scheme.iteration = iteration;
        const JointVector step = iksel::inverse_step(robot.model(), q.row(i), J, e, scheme);
        EXPECT_LT((step - expected).norm(), 1e-9 * (1 + way.norm()) * (1 + inverse.norm()))
            << name << " seed " << iksel_test::seed();
      }
    }
  }
}

TEST(Steps, LmNeverLeavesTheLimits) {
  iksel::Random random(iksel_test::seed());
  for (const std::string& name : iksel_test::paper_robots()) {
    const Robot& robot = iksel_test::robot(name);
    const Eigen::MatrixXd q = robot.random_configurations(200, iksel_test::seed());
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      JointVector at = q.row(i);
      at[1] = i % 2 == 0 ? robot.lower()[1] : robot.upper()[1];
      const Vector6 e = 5 * random_error(random);
      const JacobianMatrix J = robot.jacobian(at);
      const JointVector goal = at + iksel::lm_step(robot.model().joints, robot.model().unit, at, J,
                                                   e, 1e-3 * e.squaredNorm(), /*wraps=*/true);
      for (int j = 0; j < robot.dof(); ++j) {
        if (robot.model().joints.is_periodic(j)) continue;
        EXPECT_GE(goal[j], robot.lower()[j] - 1e-12);
        EXPECT_LE(goal[j], robot.upper()[j] + 1e-12);
      }
    }
  }
}

/// What a scheme does besides its step, as the paper's reference implementation has it.
struct Rules {
  Iteration iteration;
  bool growth_stop;
  iksel::GrowthStop option;
  bool limits_stop = false;
};

/// An attempt as its loop reads, on the same kinematics, to the bit.
bool reference_attempt(const Robot& robot, const Rules& rules, const iksel::Paper& paper,
                       iksel::KdlChain& kdl, const Pose& target, int max_steps,
                       iksel::Random& random, JointVector& q, int& steps) {
  const iksel::JointSpace& joints = robot.model().joints;
  const bool restarts = rules.iteration == Iteration::pinv_rr;
  double last_position = 1e9;
  double last_rotation = 1e9;
  for (int n = 0;; ++n) {
    const JacobianMatrix J = kdl.jacobian(q);
    Vector6 e = iksel::pose_error(target, kdl.fk(q));
    const double position = e.head<3>().norm();
    const double rotation = e.tail<3>().norm();
    if (position < 1e-4 && rotation < 1e-3) {
      if (joints.contains(q.data())) return true;
      if (rules.limits_stop) return false;
    }
    const bool grew = position > last_position && rotation > last_rotation;
    if ((rules.growth_stop && grew) || n == max_steps) return false;
    last_position = position;
    last_rotation = rotation;
    if (position > 0.1) e.head<3>() *= 0.1 / position;
    if (rotation > paper.rotation_clamp) e.tail<3>() *= paper.rotation_clamp / rotation;
    const JointVector step = rules.iteration == Iteration::cwpi
                                 ? iksel::cwpi_step(robot.model(), q, J, e, paper)
                                 : iksel::pinv_step(J, e, paper);
    ++steps;
    const bool stands_still = std::abs(step.sum()) < paper.min_step;
    if (stands_still && !restarts) return false;
    if (!stands_still) q += step;
    if (restarts && (stands_still || !joints.contains(q.data()))) q = joints.sample(random);
  }
}

class Attempts : public testing::TestWithParam<Rules> {};

TEST_P(Attempts, EndAsInTheReferenceImplementation) {
  const Rules rules = GetParam();
  const Robot& robot = iksel_test::robot("cvr038");
  SolverOptions options = SolverOptions::paper();
  iksel::Paper& paper = iksel_test::paper_of(options);
  paper.iteration = rules.iteration;
  paper.growth_stop = rules.option;
  paper.limits_stop = rules.limits_stop;
  // Large enough to be met.
  paper.min_step = 1e-3;
  const auto kdl = robot.model().make_kdl(Pose::Identity());
  const iksel::TaskSpace task({}, options.position_tolerance, options.rotation_tolerance);
  const Robot bare = robot.with_tcp(Pose::Identity());
  const Eigen::MatrixXd all = robot.random_configurations(400, iksel_test::seed());
  int solved = 0;
  int early = 0;
  for (Eigen::Index i = 0; i + 1 < all.rows(); i += 2) {
    const Pose target = bare.fk(all.row(i));
    const iksel::Goal goal(bare.model(), task, target);
    // Half-way there is near enough for some, far enough for most to fail.
    const JointVector start = 0.5 * (all.row(i) + all.row(i + 1));
    const std::uint64_t seed = iksel_test::seed() + static_cast<std::uint64_t>(i);
    iksel::Random ours(seed);
    iksel::Random theirs(seed);
    JointVector q = start;
    JointVector expected = start;
    int steps = 0;
    int expected_steps = 0;
    const iksel::IterationContext context{bare.model(),      paper,     8,   goal,
                                          goal.tip_target(), kdl.get(), ours};
    const bool is_solved = iksel::iterate(context, q, steps) == iksel::Outcome::solved;
    EXPECT_EQ(is_solved, reference_attempt(bare, rules, paper, *kdl, target, 8, theirs, expected,
                                           expected_steps))
        << "target " << i << " seed " << iksel_test::seed();
    EXPECT_EQ(steps, expected_steps);
    EXPECT_EQ(q, expected);
    solved += is_solved;
    early += !is_solved && steps < 8;
  }
  EXPECT_GT(solved, 20);
  EXPECT_EQ(early > 0,
            rules.growth_stop || rules.limits_stop || rules.iteration == Iteration::cwpi);
}

INSTANTIATE_TEST_SUITE_P(
    All, Attempts,
    testing::Values(Rules{Iteration::pinv, true, iksel::GrowthStop::by_scheme},
                    Rules{Iteration::pinv, false, iksel::GrowthStop::off, true},
                    Rules{Iteration::pinv_rr, true, iksel::GrowthStop::by_scheme},
                    Rules{Iteration::pinv_rr, false, iksel::GrowthStop::off},
                    Rules{Iteration::cwpi, false, iksel::GrowthStop::by_scheme},
                    Rules{Iteration::cwpi, true, iksel::GrowthStop::on}));

class Schemes : public testing::TestWithParam<std::tuple<Iteration, iksel::Kinematics>> {};

TEST_P(Schemes, ConvergeFromNearBy) {
  const auto [scheme, kinematics] = GetParam();
  const Robot& robot = iksel_test::robot("irb14050");
  SolverOptions options = SolverOptions::paper();
  iksel_test::paper_of(options).iteration = scheme;
  iksel::Random random(iksel_test::seed());
  const auto kdl = robot.model().make_kdl(Pose::Identity());
  int solved = 0;
  constexpr int kCases = 200;
  // Well inside the limits, where no scheme is hindered.
  for (int i = 0; i < kCases; ++i) {
    JointVector q(robot.dof());
    for (int j = 0; j < robot.dof(); ++j) {
      const double range = robot.upper()[j] - robot.lower()[j];
      q[j] = random.uniform(robot.lower()[j] + 0.2 * range, robot.upper()[j] - 0.2 * range);
    }
    const Pose target = robot.fk(q);
    const iksel::TaskSpace task({}, options.position_tolerance, options.rotation_tolerance);
    const iksel::Goal goal(robot.model(), task, target);
    for (int j = 0; j < robot.dof(); ++j) q[j] += random.uniform(-0.1, 0.1);
    const iksel::IterationContext context{
        robot.model(),
        std::get<iksel::Paper>(options.strategy),
        30,
        goal,
        goal.tip_target(),
        kinematics == iksel::Kinematics::kdl ? kdl.get() : nullptr,
        random};
    int steps = 0;
    if (iksel::iterate(context, q, steps) != iksel::Outcome::solved) continue;
    ++solved;
    EXPECT_LE(steps, 30);
    double position = 1;
    double rotation = 1;
    iksel::measure_error(target, iksel::forward(robot.model().kernel, q.data()), position,
                         rotation);
    EXPECT_LT(position, 1e-4);
    EXPECT_LT(rotation, 1e-3);
  }
  EXPECT_GE(solved, kCases * 9 / 10);
}

INSTANTIATE_TEST_SUITE_P(
    All, Schemes,
    testing::Combine(testing::Values(Iteration::dls, Iteration::pinv, Iteration::pinv_rr,
                                     Iteration::cwln, Iteration::cwpi, Iteration::lm),
                     testing::Values(iksel::Kinematics::kernel, iksel::Kinematics::kdl)));

}  // namespace
