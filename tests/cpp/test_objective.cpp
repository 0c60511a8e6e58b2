// SPDX-License-Identifier: BSD-3-Clause
// Objectives: answers are no worse than without, and no small self-motion makes them better; and
// calibrated chains that use the database of the nominal one.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <regex>
#include <vector>

#include "base/random.hpp"
#include "goal/objective_cost.hpp"
#include "iksel/iksel.hpp"
#include "kinematics/chain_model.hpp"
#include "robots.hpp"

namespace {

using iksel::JointVector;
using iksel::Objective;
using iksel::Pose;
using iksel::Random;
using iksel::Result;
using iksel::Robot;
using iksel::Solver;
using iksel::SolveRequest;

struct NamedObjective {
  const char* name;
  Objective objective;
};

/// A cost that nobody else has: heavy joints hang low.
double hanging(const JointVector& q) {
  double sum = 0;
  for (Eigen::Index i = 0; i < q.size(); ++i) sum += std::cos(q[i] + 0.3) / (1.0 + double(i));
  return sum;
}

std::vector<NamedObjective> objectives(const Robot& robot) {
  const JointVector posture = robot.random_configurations(1, 77).row(0);
  return {{"posture", Objective::near_posture(posture)},
          {"limits", Objective::far_from_limits()},
          {"manipulability", Objective::most_manipulable()},
          {"custom", Objective::custom(hanging)},
          {"custom with gradient", Objective::custom(hanging, [](const JointVector& q) {
             JointVector g(q.size());
             for (Eigen::Index i = 0; i < q.size(); ++i) {
               g[i] = -std::sin(q[i] + 0.3) / (1.0 + double(i));
             }
             return g;
           })}};
}

TEST(ObjectiveCosts, HaveTheGradientsOfTheirValues) {
  const Robot& robot = iksel_test::robot("panda");
  Random random(iksel_test::seed());
  for (const auto& [name, objective] : objectives(robot)) {
    const iksel::ObjectiveCost cost(robot.model(), objective);
    for (int i = 0; i < iksel_test::cases(100); ++i) {
      // Off the limits, where the differences would be one-sided.
      const JointVector q = 0.05 * (robot.lower() + robot.upper()) +
                            0.9 * JointVector(robot.random_configurations(1, random.next()).row(0));
      JointVector gradient(7);
      JointVector curvature(7);
      const double value = cost(q, &gradient, &curvature);
      EXPECT_EQ(value, cost.value(q));
      EXPECT_TRUE((curvature.array() > 0).all()) << name;
      for (int j = 0; j < 7; ++j) {
        JointVector above = q;
        JointVector below = q;
        above[j] += 1e-6;
        below[j] -= 1e-6;
        const double slope = (cost.value(above) - cost.value(below)) / 2e-6;
        EXPECT_NEAR(gradient[j], slope, 1e-5 * (1 + std::abs(slope))) << name << ", joint " << j;
      }
    }
  }
}

TEST(Objectives, MakeNoAnswerWorse) {
  for (const char* robot_name : {"ur3", "panda", "irb14050", "cvr038"}) {
    const Robot& robot = iksel_test::robot(robot_name);
    iksel_test::Judge judge(robot);
    const Solver& solver = iksel_test::solver(robot_name);
    const int cases = iksel_test::cases(200, 40) / 4;
    const Eigen::MatrixXd q = robot.random_configurations(cases, iksel_test::seed());
    for (const auto& [name, objective] : objectives(robot)) {
      const iksel::ObjectiveCost cost(robot.model(), objective);
      SolveRequest request;
      request.objective = objective;
      double sum = 0;
      double plain_sum = 0;
      for (int i = 0; i < cases; ++i) {
        const Pose target = robot.fk(q.row(i));
        const Result result = solver.solve(target, request);
        const Result plain = solver.solve(target);
        ASSERT_TRUE(result.success()) << robot_name << ", " << name << ", case " << i;
        judge.expect_solution(target, result.q);
        EXPECT_DOUBLE_EQ(result.cost, cost.value(result.q));
        EXPECT_TRUE(std::isnan(plain.cost));
        const double without = cost.value(plain.q);
        EXPECT_LE(result.cost, without + 1e-4 * (1 + std::abs(without)))
            << robot_name << ", " << name << ", case " << i << ", seed " << iksel_test::seed();
        sum += result.cost;
        plain_sum += without;
      }
      EXPECT_LT(sum, plain_sum) << robot_name << ", " << name;
    }
  }
}

TEST(Objectives, LeaveARedundantArmAtALocalMinimum) {
  const Robot& robot = iksel_test::robot("panda");
  const Solver& solver = iksel_test::solver("panda");
  const int cases = iksel_test::cases(200, 40) / 4;
  const Eigen::MatrixXd q = robot.random_configurations(cases, iksel_test::seed());
  for (const auto& [name, objective] : objectives(robot)) {
    const iksel::ObjectiveCost cost(robot.model(), objective);
    SolveRequest request;
    request.objective = objective;
    int minima = 0;
    for (int i = 0; i < cases; ++i) {
      const Pose target = robot.fk(q.row(i));
      const Result result = solver.solve(target, request);
      ASSERT_TRUE(result.success());
      // Along the null vector of J to either side, back to the pose by solving from there.
      const Eigen::MatrixXd J = robot.jacobian(result.q);
      const Eigen::VectorXd along =
          Eigen::FullPivLU<Eigen::MatrixXd>(J).kernel().col(0).normalized();
      bool least = true;
      for (const double step : {-0.02, 0.02}) {
        JointVector seed = result.q + step * along;
        seed = seed.cwiseMax(robot.lower()).cwiseMin(robot.upper());
        const Result beside = iksel_test::solve_from(solver, target, seed);
        if (!beside.success() || (beside.q - seed).norm() > 0.05) continue;
        const double margin = 1e-5 * (1 + std::abs(result.cost));
        if (cost.value(beside.q) < result.cost - margin) least = false;
      }
      minima += least;
    }
    EXPECT_GE(minima, cases * 95 / 100) << name << ", seed " << iksel_test::seed();
  }
}

TEST(Objectives, GoWithFiltersAndTasks) {
  const Robot& robot = iksel_test::robot("ur3");
  const Solver& solver = iksel_test::solver("ur3");
  SolveRequest request;
  request.task = iksel::Task::free_spin();
  request.objective = Objective::far_from_limits();
  request.filter = iksel::filter_each(6, [](const JointVector& q) { return q[1] < 0; });
  const Eigen::MatrixXd q = robot.random_configurations(20, 4);
  int solved = 0;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const Pose target = robot.fk(q.row(i));
    const Result result = solver.solve(target, request);
    if (!result.success()) continue;
    ++solved;
    EXPECT_LT(result.q[1], 0);
    EXPECT_LT((robot.fk(result.q).linear().col(2) - target.linear().col(2)).norm(), 2e-6);
  }
  EXPECT_GE(solved, 15);
}

TEST(Objectives, OfTheWrongSizeAreRefused) {
  const Robot& robot = iksel_test::robot("ur3");
  const Solver& solver = iksel_test::solver("ur3");
  SolveRequest request;
  request.objective = Objective::near_posture(JointVector::Zero(5));
  const Pose target = robot.fk(JointVector::Zero(6));
  EXPECT_THROW(static_cast<void>(solver.solve(target, request)), iksel::InvalidArgumentError);
  request.objective = Objective::near_posture(JointVector::Zero(6), -JointVector::Ones(6));
  EXPECT_THROW(static_cast<void>(solver.solve(target, request)), iksel::InvalidArgumentError);
  request.objective = Objective::custom(nullptr);
  EXPECT_THROW(static_cast<void>(solver.solve(target, request)), iksel::InvalidArgumentError);
}

/// The robot with every origin moved by up to `position` [m] and turned by up to `rotation` [rad].
Robot perturbed(const Robot& robot, double position, double rotation, std::uint64_t seed) {
  Random random(seed);
  std::string out;
  const std::string urdf = robot.urdf();
  const std::regex numbers("(xyz|rpy)=\"([^\"]*)\"");
  std::size_t at = 0;
  for (std::sregex_iterator it(urdf.begin(), urdf.end(), numbers), end; it != end; ++it) {
    const auto start = static_cast<std::size_t>(it->position());
    out += urdf.substr(at, start - at);
    at = start + static_cast<std::size_t>(it->length());
    const std::string before = urdf.substr(start < 8 ? 0 : start - 8, 8);
    const bool axis = before.find("axis") != std::string::npos;
    std::istringstream in((*it)[2]);
    std::ostringstream text;
    text.precision(17);
    const double size = (*it)[1] == "xyz" ? position : rotation;
    for (double value = 0; in >> value;) {
      text << (axis ? value : value + random.uniform(-size, size)) << ' ';
    }
    out += (*it)[1].str() + "=\"" + text.str() + "\"";
  }
  out += urdf.substr(at);
  return Robot::from_urdf_string(out, robot.options());
}

TEST(Calibration, ADatabaseOfTheNominalChainServesACalibratedOne) {
  for (const char* name : {"ur3", "panda", "iiwa14"}) {
    const Robot& nominal = iksel_test::robot(name);
    const Robot robot = perturbed(nominal, 1e-3, 1e-3, iksel_test::seed());
    iksel_test::Judge judge(robot);
    ASSERT_NE(robot.chain_hash(), nominal.chain_hash());
    const iksel::Database database = iksel::Database::build(nominal);
    EXPECT_THROW(Solver(robot, {}, database), iksel::DatabaseMismatchError);
    for (const auto iteration : {iksel::Iteration::lm, iksel::Iteration::dls}) {
      iksel::SolverOptions options;
      if (iteration != iksel::Iteration::lm) {
        iksel::Paper& paper = iksel_test::paper_of(options);
        paper.iteration = iteration;
        paper.limit_aware = true;
        paper.candidates = 100;
        paper.whole_turns = true;
      }
      const Solver solver(robot, options, database, nominal);
      const Solver own(robot, options);
      EXPECT_GT(solver.calibration_deviation().position, 1e-4);
      EXPECT_LT(solver.calibration_deviation().position, 0.03);
      EXPECT_LT(solver.calibration_deviation().rotation, 0.03);
      EXPECT_EQ(own.calibration_deviation().position, 0);
      const int cases = iksel_test::cases(2000);
      const Eigen::MatrixXd q = robot.random_configurations(cases, iksel_test::seed());
      int solved = 0;
      int solved_by_own = 0;
      for (int i = 0; i < cases; ++i) {
        const Pose target = robot.fk(q.row(i));
        const Result result = solver.solve(target);
        solved_by_own += own.solve(target).success();
        if (!result.success()) continue;
        ++solved;
        judge.expect_solution(target, result.q);
      }
      EXPECT_GE(solved, solved_by_own - 1 - cases / 1000)
          << name << ", seed " << iksel_test::seed();
    }
  }
}

TEST(Objective, ACostThatIsNoNumberIsAnError) {
  for (const char* name : {"ur3", "panda"}) {
    const Solver& solver = iksel_test::solver(name);
    const Robot& robot = solver.robot();
    const Eigen::MatrixXd q = robot.random_configurations(20, iksel_test::seed());
    std::vector<Pose> targets;
    for (int i = 0; i < 20; ++i) targets.push_back(robot.fk(q.row(i)));
    for (const double value : {std::nan(""), -std::numeric_limits<double>::infinity()}) {
      SolveRequest request;
      request.objective = Objective::custom([value](const JointVector&) { return value; });
      EXPECT_THROW((void)solver.solve(targets[0], request), iksel::InvalidArgumentError) << name;
      for (const int threads : {1, 2, 5}) {
        try {
          (void)solver.solve_batch(targets, request, {}, threads);
          FAIL() << name << ", " << threads << " threads";
        } catch (const iksel::InvalidArgumentError& error) {
          EXPECT_NE(std::string(error.what()).find("objective: the cost is"), std::string::npos);
        }
      }
    }
  }
}

TEST(Objective, AnInfiniteCostRefuses) {
  for (const char* name : {"ur3", "panda"}) {
    const Solver& solver = iksel_test::solver(name);
    const Robot& robot = solver.robot();
    const Eigen::MatrixXd q = robot.random_configurations(100, iksel_test::seed());
    SolveRequest request;
    // Never with the first joint on the left.
    request.objective = Objective::custom([](const JointVector& at) {
      return at[0] < 0 ? std::numeric_limits<double>::infinity() : at.squaredNorm();
    });
    int solved = 0;
    int rejected = 0;
    for (int i = 0; i < 100; ++i) {
      const Result result = solver.solve(robot.fk(q.row(i)), request);
      solved += result.success();
      rejected += result.status == iksel::Status::rejected;
      if (!result.success()) continue;
      EXPECT_GE(result.q[0], 0) << name << ", seed " << iksel_test::seed();
      EXPECT_TRUE(std::isfinite(result.cost));
    }
    EXPECT_EQ(solved + rejected, 100) << name;
    EXPECT_GT(solved, 50) << name;
    request.objective = Objective::custom(
        [](const JointVector&) { return std::numeric_limits<double>::infinity(); });
    EXPECT_EQ(solver.solve(robot.fk(q.row(0)), request).status, iksel::Status::rejected);
  }
}

TEST(Calibration, TooMuchDeviationIsRefusedWithItsSize) {
  const Robot& nominal = iksel_test::robot("ur3");
  const Robot robot = perturbed(nominal, 1e-3, 1e-3, 1);
  const iksel::Database database = iksel::Database::build(nominal);
  const iksel::CalibrationDeviation deviation =
      iksel::measure_calibration_deviation(robot, nominal);
  try {
    const Solver solver(robot, {}, database, nominal, {deviation.position / 2, 1});
    FAIL() << "accepted";
  } catch (const iksel::DatabaseMismatchError& error) {
    std::ostringstream number;
    number << deviation.position;
    EXPECT_NE(std::string(error.what()).find(number.str()), std::string::npos) << error.what();
  }
  // The database has to be the nominal chain's.
  EXPECT_THROW(Solver(robot, {}, database, robot), iksel::DatabaseMismatchError);
  EXPECT_THROW(Solver(robot, {}, database, iksel_test::robot("panda")),
               iksel::DatabaseMismatchError);
}

}  // namespace
