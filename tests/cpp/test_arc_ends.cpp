// SPDX-License-Identifier: BSD-3-Clause
// Where the arcs of self-motions end, and what that proves.
#include "seeds/arc_ends.hpp"

#include <gtest/gtest.h>

#include <iksel/iksel.hpp>
#include <regex>

#include "branches.hpp"
#include "closed_chains.hpp"
#include "kinematics/chain_model.hpp"
#include "robots.hpp"
#include "simd/kernels.hpp"

namespace {

using iksel::Pose;
using iksel::Proof;
using iksel::Robot;
using iksel::Solver;

constexpr double kTolerance = 1e-6;

/// iiwa14 with joints 1, 3, 5 and 7 without limits, as gen3 has them.
Robot endless_robot() {
  const Robot& limited = iksel_test::robot("iiwa14");
  const std::regex odd(R"((<joint name="[^"]*[1357]") type="revolute")");
  const std::string urdf = std::regex_replace(limited.urdf(), odd, "$1 type=\"continuous\"");
  return Robot::from_urdf_string(urdf, limited.options());
}

class Ends {
 public:
  explicit Ends(const Robot& robot)
      : arms_(iksel::LockedArms::of(robot.model())),
        ends_(robot.model(), arms_, kTolerance, kTolerance, iksel::lanes::choose_kernels()) {}

  [[nodiscard]] const iksel::LockedArms& arms() const { return arms_; }
  iksel::ArcEnds& operator*() { return ends_; }
  iksel::ArcEnds* operator->() { return &ends_; }
  /// How many there are, and whether these are certainly all.
  int count(const Pose& target, bool& is_certain) {
    ends_.begin();
    is_certain = true;
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      is_certain = ends_.find(i, target) && is_certain;
    }
    return ends_.count();
  }
  /// Whether no curve of solutions goes through any of the places, of arms that are closed.
  bool rule_out(const Pose& target) {
    ends_.begin();
    bool is_none = ends_.are_closed();
    for (std::size_t i = 0; i < ends_.places() && is_none; ++i) {
      is_none = ends_.find(i, target) && ends_.count() == 0;
    }
    return is_none;
  }

 private:
  iksel::LockedArms arms_;
  iksel::ArcEnds ends_;
};

TEST(ArcEnds, AreClosedWhereTheElbowGoesRound) {
  for (const char* name : {"iiwa7", "iiwa14", "valkyrie_right_arm"}) {
    const Ends ends(iksel_test::robot(name));
    EXPECT_TRUE(ends.arms().are_closed) << name;
    EXPECT_FALSE(ends.arms().crossing) << name;
  }
  EXPECT_TRUE(Ends(endless_robot()).arms().crossing);
  for (const char* name : {"panda", "xarm7", "pr2_right_arm"}) {
    EXPECT_FALSE(Ends(iksel_test::robot(name)).arms().are_closed) << name;
  }
}

TEST(ArcEnds, ClosedCurvesCrossThePlaneOfTheElbow) {
  const Robot robot = endless_robot();
  Ends ends(robot);
  iksel_test::Judge judge(robot);
  int endless = 0;
  for (const Pose& target : iksel_test::random_targets(robot, iksel_test::cases(200, 50))) {
    EXPECT_FALSE(ends.rule_out(target)) << "seed " << iksel_test::seed();
    bool is_certain = false;
    if (ends.count(target, is_certain) > 0 || !is_certain) continue;
    ++endless;
    int crossings = 0;
    for (const std::size_t side : {0, 1}) {
      // Where it cannot be told, some are counted that are none.
      ends->begin();
      const bool is_known = ends->find(ends->size() + side, target);
      crossings += ends->count();
      for (int k = 0; is_known && k < ends->count(); ++k) {
        judge.expect_solution(target, Eigen::Map<const Eigen::VectorXd>(ends->q(k), 7));
      }
    }
    EXPECT_GT(crossings, 0) << "seed " << iksel_test::seed();
  }
  EXPECT_GT(endless, 10);
}

TEST(ArcEnds, RuleOutNothingThatIsThere) {
  const Robot endless = endless_robot();
  for (const Robot& robot : {iksel_test::robot("iiwa14"), endless}) {
    Ends ends(robot);
    const Solver solver(robot);
    iksel_test::Dice dice(iksel_test::seed());
    int noes = 0;
    int proven = 0;
    for (Pose target : iksel_test::random_targets(robot, iksel_test::cases(200, 100))) {
      EXPECT_FALSE(ends.rule_out(target)) << "seed " << iksel_test::seed();
      target.linear() = iksel_test::rotation_of_rpy<double>(dice.vector(3.1));
      const bool is_none = ends.rule_out(target);
      const iksel::Result result = solver.solve(target);
      EXPECT_EQ(result.proof == Proof::closed_form, is_none);
      if (result.success()) continue;
      ++noes;
      proven += is_none;
      if (noes > 10) continue;
      EXPECT_TRUE(iksel_test::brute_force(solver, target, 200).empty())
          << "seed " << iksel_test::seed();
    }
    EXPECT_GT(noes, 5);
    EXPECT_GE(proven, noes * 97 / 100);
  }
}

/// Where the elbow is all but straight, the angles behind it are hardly determined; but nearly all
/// of what there is lies far outside of the limits.
TEST(ArcEnds, AlmostStraightElbowsLeaveFewDoubts) {
  const Robot& robot = iksel_test::robot("valkyrie_right_arm");
  const Solver& solver = iksel_test::solver("valkyrie_right_arm");
  iksel_test::Dice dice(iksel_test::seed());
  int noes = 0;
  int proven = 0;
  for (Pose target : iksel_test::random_targets(robot, iksel_test::cases(3000, 3000))) {
    target.linear() = iksel_test::rotation_of_rpy<double>(dice.vector(3.1));
    const iksel::Result result = solver.solve(target);
    noes += !result.success();
    proven += result.proof == Proof::closed_form;
  }
  EXPECT_GT(noes, 1000);
  EXPECT_GE(proven, noes * 97 / 100) << "seed " << iksel_test::seed();
}

}  // namespace
