// SPDX-License-Identifier: BSD-3-Clause
// Where the decimal point is a comma, files mean the same and messages are the same.
#include <gtest/gtest.h>

#include <clocale>
#include <functional>
#include <iksel/iksel.hpp>
#include <locale>
#include <string>
#include <vector>

#include "robots.hpp"

namespace {

using iksel::JointVector;
using iksel::Pose;
using iksel::Robot;
using iksel::RobotOptions;

/// "1.234,5", as from Germany, without its locale being installed.
class CommaPoint : public std::numpunct<char> {
 protected:
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

/// While it lives, C++ streams, and C's functions where a locale is installed, use a comma.
class CommaLocale {
 public:
  CommaLocale()
      : previous_(std::locale::global(std::locale(std::locale::classic(), new CommaPoint))),
        previous_c_(std::setlocale(LC_NUMERIC, nullptr)) {
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "nl_NL.UTF-8"}) {
      if (std::setlocale(LC_NUMERIC, name) != nullptr) break;
    }
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;
  ~CommaLocale() {
    std::locale::global(previous_);
    std::setlocale(LC_NUMERIC, previous_c_.c_str());
  }

 private:
  std::locale previous_;
  std::string previous_c_;
};

std::string arm(const std::string& limit) {
  return "<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='revolute'><parent "
         "link='a'/><child link='b'/><origin xyz='0.125 1234.5 -1.5e-1' rpy='0.25 0.5 0.75'/><axis "
         "xyz='0 0.6 0.8'/>" +
         limit + "</joint></robot>";
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const iksel::Error& error) {
    return error.what();
  }
  return "";
}

TEST(Locale, UrdfMeansTheSame) {
  const std::string text =
      arm("<limit lower='-1.25' upper='2.5' effort='0.5' velocity='1.75'/><safety_controller "
          "soft_lower_limit='-0.5' soft_upper_limit='1.125' k_velocity='1.5'/>");
  const Robot expected = Robot::from_urdf_string(text);
  ASSERT_EQ(expected.upper()[0], 2.5);
  const CommaLocale comma;
  const Robot robot = Robot::from_urdf_string(text);
  EXPECT_EQ(robot.chain_hash(), expected.chain_hash());
  EXPECT_EQ(robot.lower()[0], -1.25);
  EXPECT_EQ(robot.upper()[0], 2.5);
  EXPECT_EQ(robot.soft_upper()[0], 1.125);
  EXPECT_EQ(robot.velocity_limit()[0], 1.75);
  const JointVector q = JointVector::Constant(1, 0.3);
  EXPECT_EQ(robot.fk(q).matrix(), expected.fk(q).matrix());
}

/// Everything that a message writes a number in.
std::vector<std::function<void()>> mistakes(const iksel::Solver& solver) {
  const auto urdf = [](const std::string& limit) {
    return [text = arm(limit)] { Robot::from_urdf_string(text); };
  };
  const auto with = [](auto change) {
    return [change] {
      iksel::SolverOptions options;
      change(options);
      options.validate();
    };
  };
  Pose sheared = Pose::Identity();
  sheared.matrix()(0, 1) = 1234.5;
  RobotOptions limits;
  limits.default_limits = {1234.5, 0.5};
  const auto path = [&solver](double dt) {
    return [&solver, dt] {
      iksel::PathOptions options;
      options.dt = dt;
      (void)solver.solve_path({Pose::Identity()}, options);
    };
  };
  return {
      urdf("<limit lower='1234.5' upper='0.5' effort='0' velocity='1'/>"),
      urdf("<limit lower='-1234567.5e3' upper='0.5' effort='0' velocity='1'/>"),
      [limits] { Robot::from_urdf_string(arm(""), limits); },
      [sheared] { iksel::check_pose(sheared); },
      with([](auto& options) { options.position_tolerance = -1234.5; }),
      with([](auto& options) { options.max_iterations = -12345; }),
      with([](auto& options) { options.task.position_lower[0] = 1234.5; }),
      path(-1234.5),
      [&solver] { (void)solver.robot().inverse_jacobian(solver.robot().lower(), -0.5); },
  };
}

TEST(Locale, MessagesAreTheSame) {
  const Robot& robot = iksel_test::robot("cvr038");
  const iksel::Solver& solver = iksel_test::solver("cvr038");
  std::vector<std::string> expected;
  for (const auto& mistake : mistakes(solver)) expected.push_back(message_of(mistake));
  Pose far = robot.fk(0.5 * (robot.lower() + robot.upper()));
  far.translation().x() += 1234.5;
  const std::string reason = solver.diagnose(far).message;
  ASSERT_NE(reason.find("m beyond"), std::string::npos) << reason;

  const CommaLocale comma;
  std::size_t i = 0;
  for (const auto& mistake : mistakes(solver)) {
    EXPECT_NE(expected[i], "") << "mistake " << i;
    EXPECT_EQ(message_of(mistake), expected[i]);
    ++i;
  }
  EXPECT_EQ(solver.diagnose(far).message, reason);
}

}  // namespace
