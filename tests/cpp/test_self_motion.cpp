// SPDX-License-Identifier: BSD-3-Clause
// The arcs of a self-motion: that they are solutions, what ends them, and that none is missing; and
// what is made of them: the nearest, a spread, paths.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iksel/iksel.hpp>
#include <vector>

#include "branches.hpp"
#include "closed_chains.hpp"
#include "robots.hpp"

namespace {

using iksel::ArcEnd;
using iksel::JointVector;
using iksel::Pose;
using iksel::Result;
using iksel::Robot;
using iksel::SelfMotion;
using iksel::SelfMotionArc;
using iksel::SelfMotionEnd;
using iksel::Solver;
using iksel_test::distance;

constexpr double kSpacing = 0.05;

/// Distance of q from the nearest configuration of an arc.
double distance_from(const Robot& robot, const SelfMotion& motion, const JointVector& q) {
  double nearest = 10;
  for (const SelfMotionArc& arc : motion.arcs) {
    for (const JointVector& point : arc.q) nearest = std::min(nearest, distance(robot, point, q));
  }
  return nearest;
}

class SelfMotions : public testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] const Solver& solver() const { return iksel_test::solver(GetParam()); }
  [[nodiscard]] const Robot& robot() const { return solver().robot(); }
};

TEST_P(SelfMotions, EveryConfigurationIsASolution) {
  iksel_test::Judge judge(robot());
  for (const Pose& target : iksel_test::random_targets(robot(), iksel_test::cases(40) / 4)) {
    const SelfMotion motion = solver().self_motion(target, kSpacing);
    ASSERT_TRUE(motion.success());
    double before = motion.arcs.front().length;
    for (const SelfMotionArc& arc : motion.arcs) {
      EXPECT_LE(arc.length, before);
      before = arc.length;
      EXPECT_TRUE(arc.elbow.empty() || arc.elbow.size() == arc.q.size());
      double length = 0;
      for (std::size_t i = 0; i < arc.q.size(); ++i) {
        judge.expect_solution(target, arc.q[i]);
        if (i == 0) continue;
        const double step = distance(robot(), arc.q[i - 1], arc.q[i]);
        // What is refined may come to lie a little farther away.
        EXPECT_LE(step, kSpacing + 1e-4);
        length += step;
      }
      EXPECT_GE(arc.length, length - 1e-9);
      if (arc.is_closed() && arc.q.size() > 2) {
        EXPECT_LE(distance(robot(), arc.q.front(), arc.q.back()), kSpacing + 1e-4);
      }
    }
  }
}

TEST_P(SelfMotions, EndsAreWhatTheySayTheyAre) {
  int folds = 0;
  int ends = 0;
  for (const Pose& target : iksel_test::random_targets(robot(), iksel_test::cases(40))) {
    for (const SelfMotionArc& arc : solver().self_motion(target, kSpacing).arcs) {
      EXPECT_EQ(arc.begin.kind == ArcEnd::closed, arc.end.kind == ArcEnd::closed);
      for (const auto& [end, q] :
           {std::pair(arc.begin, arc.q.front()), std::pair(arc.end, arc.q.back())}) {
        ++ends;
        folds += end.kind == ArcEnd::fold;
        EXPECT_EQ(end.kind == ArcEnd::limit, end.joint >= 0);
        if (end.kind != ArcEnd::limit) continue;
        const double limit = end.at_upper ? robot().upper()[end.joint] : robot().lower()[end.joint];
        EXPECT_NEAR(q[end.joint], limit, 1e-5) << "joint " << end.joint;
      }
    }
  }
  EXPECT_LE(folds, ends / 50) << "of " << ends << " ends, seed " << iksel_test::seed();
}

/// Configurations in pieces that hang together, each as far across as its two farthest.
std::vector<double> extents(const Robot& robot, std::vector<JointVector> points) {
  std::vector<double> found;
  while (!points.empty()) {
    std::vector<JointVector> piece = {points.back()};
    points.pop_back();
    for (std::size_t next = 0; next < piece.size(); ++next) {
      const auto joins = [&](const JointVector& q) {
        return distance(robot, piece[next], q) <= kSpacing;
      };
      const auto rest = std::stable_partition(points.begin(), points.end(), std::not_fn(joins));
      piece.insert(piece.end(), rest, points.end());
      points.erase(rest, points.end());
    }
    double extent = 0;
    for (const JointVector& q : piece) {
      for (const JointVector& other : piece) extent = std::max(extent, distance(robot, q, other));
    }
    found.push_back(extent);
  }
  return found;
}

/// Nothing of the curve that restarts find is missing but pieces shorter than the spacing, where
/// limits all but touch it. With IKSEL_TEST_CASES=500: 100 targets, 100,000 restarts each.
TEST_P(SelfMotions, NoArcIsMissing) {
  const int n = iksel_test::cases(20, 5) / 5;
  const int restarts = 200 * iksel_test::cases(20);
  std::size_t found = 0;
  std::size_t pieces = 0;
  for (const Pose& target : iksel_test::random_targets(robot(), n)) {
    const SelfMotion motion = solver().self_motion(target, kSpacing);
    std::vector<JointVector> missed;
    for (const JointVector& q : iksel_test::brute_force(solver(), target, restarts)) {
      ++found;
      if (distance_from(robot(), motion, q) > kSpacing) missed.push_back(q);
    }
    for (const double extent : extents(robot(), missed)) {
      ++pieces;
      EXPECT_LE(extent, kSpacing) << "seed " << iksel_test::seed();
    }
  }
  EXPECT_LE(pieces, found / 200) << "of " << found << ", seed " << iksel_test::seed();
  EXPECT_GE(found, static_cast<std::size_t>(n));
}

TEST_P(SelfMotions, NearIsTheNearestOfADenseSampling) {
  iksel_test::Judge judge(robot());
  const int n = iksel_test::cases(60);
  const Eigen::MatrixXd q = robot().random_configurations(n, iksel_test::seed());
  const iksel::Matrix noise = robot().random_configurations(n, iksel_test::seed() + 1);
  int farther = 0;
  for (int i = 0; i < n; ++i) {
    iksel::SolveRequest request;
    request.near = iksel_test::noisy(q.row(i).transpose(), noise, i, i % 3 == 0 ? 1 : 0.2);
    request.norm = i % 2 == 0 ? iksel::MoveNorm::two : iksel::MoveNorm::max;
    const Pose target = robot().fk(q.row(i));
    const Result result = solver().solve(target, request);
    ASSERT_TRUE(result.success());
    judge.expect_solution(target, result.q);
    double best = 100;
    for (const SelfMotionArc& arc : solver().self_motion(target, 0.02).arcs) {
      for (const JointVector& point : arc.q) {
        const double move = iksel_test::shortest_move(robot(), point, *request.near, request.norm);
        best = std::min(best, move);
      }
    }
    farther += result.move > best + 1e-3;
  }
  EXPECT_LE(farther, 1 + n / 50) << "of " << n << ", seed " << iksel_test::seed();
}

TEST_P(SelfMotions, SolveAllSpreadsOverTheArcs) {
  iksel_test::Judge judge(robot());
  const int n = iksel_test::cases(40);
  int uneven = 0;
  for (const Pose& target : iksel_test::random_targets(robot(), n)) {
    const auto all = solver().solve_all(target);
    ASSERT_TRUE(all.success());
    const SelfMotion motion = solver().self_motion(target, kSpacing);
    double length = 0;
    for (const SelfMotionArc& arc : motion.arcs) length += arc.length;
    for (const Result& one : all.all) {
      judge.expect_solution(target, one.q);
      EXPECT_LE(distance_from(robot(), motion, one.q), kSpacing);
    }
    // On shorter ones not so many lie min_distance apart, each joint counted; of some that pass by
    // the stretched arm two and two hardly differ.
    if (length > 3.5) {
      EXPECT_EQ(all.all.size(), 64U) << length;
    }
    double farthest = 0;
    for (const SelfMotionArc& arc : motion.arcs) {
      for (const JointVector& point : arc.q) {
        double nearest = 10;
        for (const Result& one : all.all) {
          nearest = std::min(nearest, distance(robot(), one.q, point));
        }
        farthest = std::max(farthest, nearest);
      }
    }
    uneven += farthest > 0.3 + 2 * length / 64 ? 1 : 0;
  }
  // None of the curve is far from a solution, but for small arcs and where joints swing between two
  // samples: of 1,200 targets of six arms, 28.
  EXPECT_LE(uneven, 2 + n / 20) << "of " << n << ", seed " << iksel_test::seed();
}

TEST_P(SelfMotions, ThereIsNoneWhereThereIsNoSolution) {
  Pose far = Pose::Identity();
  far.translation().x() = 5;
  const SelfMotion none = solver().self_motion(far);
  EXPECT_FALSE(none.success());
  EXPECT_EQ(none.status, iksel::Status::out_of_reach);
  EXPECT_EQ(none.proof, iksel::Proof::reach);
  int concluded = 0;
  iksel_test::Dice dice(iksel_test::seed());
  for (Pose target : iksel_test::random_targets(robot(), iksel_test::cases(100, 60))) {
    target.linear() = iksel_test::rotation_of_rpy<double>(dice.vector(3.1));
    const SelfMotion motion = solver().self_motion(target);
    const Result result = solver().solve(target);
    EXPECT_TRUE(!motion.success() || result.success());
    if (motion.success()) continue;
    EXPECT_TRUE(motion.arcs.empty());
    concluded += motion.proof != iksel::Proof::none;
    if (motion.proof == iksel::Proof::closed_form) EXPECT_EQ(result.proof, motion.proof);
  }
  EXPECT_GE(concluded, 1);
}

INSTANTIATE_TEST_SUITE_P(Robots, SelfMotions,
                         testing::Values("panda", "fr3", "iiwa7", "iiwa14", "xarm7",
                                         "pr2_right_arm", "valkyrie_right_arm"),
                         [](const auto& info) { return std::string(info.param); });

TEST(SelfMotion, TheElbowTurnsWithTheArc) {
  const Solver& solver = iksel_test::solver("iiwa14");
  for (const Pose& target : iksel_test::random_targets(solver.robot(), 10)) {
    for (const SelfMotionArc& arc : solver.self_motion(target, 0.02).arcs) {
      ASSERT_EQ(arc.elbow.size(), arc.q.size());
      for (std::size_t i = 1; i < arc.elbow.size(); ++i) {
        // Joint 4 holds the triangle of shoulder, elbow and wrist.
        EXPECT_NEAR(arc.q[i][3], arc.q[0][3], 1e-5);
        EXPECT_LE(std::abs(std::remainder(arc.elbow[i] - arc.elbow[i - 1], iksel_test::kTwoPi)),
                  0.2);
      }
    }
  }
  const Pose target = iksel_test::random_targets(iksel_test::robot("panda"), 1)[0];
  EXPECT_TRUE(iksel_test::solver("panda").self_motion(target).arcs[0].elbow.empty());
}

TEST(SelfMotion, OfACalibratedArmIsItsOwn) {
  const Solver& nominal = iksel_test::solver("iiwa14");
  std::string urdf = nominal.robot().urdf();
  const std::string axis = "<axis xyz=\"0 0 1\"/>";
  urdf.replace(urdf.rfind(axis), axis.size(), "<axis xyz=\"0.002 0.003 1\"/>");
  const Robot robot = Robot::from_urdf_string(urdf, nominal.robot().options());
  const Solver solver(robot, {}, nominal.database(), nominal.robot());
  iksel_test::Judge judge(robot);
  int found = 0;
  for (const Pose& target : iksel_test::random_targets(robot, 20)) {
    const SelfMotion motion = solver.self_motion(target);
    found += motion.success();
    EXPECT_NE(motion.proof, iksel::Proof::sweep);
    for (const SelfMotionArc& arc : motion.arcs) {
      for (const JointVector& q : arc.q) judge.expect_solution(target, q);
    }
  }
  EXPECT_GE(found, 18);
}

TEST(SelfMotion, ErrorsNameTheCulprit) {
  const auto expect_error = [](const Solver& solver, double spacing, const std::string& what) {
    try {
      (void)solver.self_motion(solver.robot().fk(JointVector::Zero(solver.robot().dof())), spacing);
      FAIL() << what;
    } catch (const iksel::InvalidArgumentError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  expect_error(iksel_test::solver("ur3"), 0.1,
               "robot 'ur3' has no self-motion that could be swept");
  expect_error(iksel_test::solver("ur3"), 0.1, "closed_form: axes 2, 3 and 4 are parallel");
  expect_error(iksel_test::solver("irb14050"), 0.1, "searched: ");
  expect_error(iksel_test::paper_solver("panda"), 0.1, "strategy Paper");
  for (const double spacing : {0.0, -1.0, 4.0, double(NAN)}) {
    expect_error(iksel_test::solver("panda"), spacing, "spacing: ");
  }
  iksel::SolverOptions options;
  options.task = iksel::Task::free_spin();
  const Solver spins(iksel_test::robot("panda"), options);
  expect_error(spins, 0.1, "task with free axes, 5 of 6 fixed");
}

}  // namespace
