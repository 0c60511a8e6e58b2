// SPDX-License-Identifier: BSD-3-Clause
// What a URDF may hold, and what is said of one that cannot be used.
#include <gtest/gtest.h>

#include <iksel/iksel.hpp>
#include <map>
#include <string>
#include <vector>

#include "database/data.hpp"
#include "iksel/urdf_text.hpp"
#include "kinematics/chain_model.hpp"
#include "robots.hpp"
#include "search/context.hpp"

namespace {

using iksel::JointVector;
using iksel::Kinematics;
using iksel::Pose;
using iksel::Robot;
using iksel::RobotOptions;

std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& inside) {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/>" + inside + "</joint>";
}

std::string robot_xml(const std::string& joints) {
  std::string links;
  for (const char* link : {"a", "b", "c", "d", "e"}) {
    if (joints.find("link='" + std::string(link) + "'") != std::string::npos) {
      links += "<link name='" + std::string(link) + "'/>";
    }
  }
  return "<?xml version='1.0'?><robot name='test'>" + links + joints + "</robot>";
}

const std::string kTurn =
    "<origin xyz='0.1 0.2 0.3' rpy='0.1 0.2 0.3'/><axis xyz='0 1 0'/>"
    "<limit lower='-1' upper='2' effort='0' velocity='3'/>";

std::string tree() {
  // b is below a, c and d are both below b.
  return robot_xml(joint("ab", "revolute", "a", "b", kTurn) +
                   joint("bc", "revolute", "b", "c",
                         "<origin xyz='0 0 0.4' rpy='0.3 0 0'/><axis xyz='1 1 0'/>"
                         "<limit lower='-2' upper='2' effort='0' velocity='0'/>") +
                   joint("bd", "prismatic", "b", "d",
                         "<origin xyz='0.5 0 0' rpy='0 0.4 0'/><axis xyz='0 0 2'/>"
                         "<limit lower='-0.1' upper='0.2' effort='0' velocity='1'/>"));
}

Robot load(const std::string& xml, const std::string& base, const std::string& tip) {
  RobotOptions options;
  options.base_link = base;
  options.tip_link = tip;
  return Robot::from_urdf_string(xml, options);
}

/// Message of the Error that loading throws; fails the test if there is none or more than a line.
template <typename Error = iksel::UrdfError>
std::string refusal(const std::string& xml, const std::string& base, const std::string& tip) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  std::string message;
  try {
    load(xml, base, tip);
    ADD_FAILURE() << "was accepted";
  } catch (const Error& error) {
    message = error.what();
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(message.find('\n'), std::string::npos);
  return message;
}

void expect_mentions(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    EXPECT_NE(text.find(word), std::string::npos) << "'" << word << "' is not in: " << text;
  }
}

TEST(Urdf, ChainDownTheTree) {
  const Robot robot = load(tree(), "a", "c");
  EXPECT_EQ(robot.dof(), 2);
  EXPECT_EQ(robot.joint_names(), (std::vector<std::string>{"ab", "bc"}));
  EXPECT_EQ(robot.lower()[0], -1);
  EXPECT_EQ(robot.upper()[0], 2);
  EXPECT_EQ(robot.velocity_limit()[0], 3);
  EXPECT_TRUE(std::isinf(robot.velocity_limit()[1]));  // 0 means none
}

TEST(Urdf, ChainUpAndDownTheTreeIsTheInverseOfTheOther) {
  const Robot there = load(tree(), "c", "d");
  const Robot back = load(tree(), "d", "c");
  EXPECT_EQ(there.joint_names(), (std::vector<std::string>{"bc", "bd"}));
  EXPECT_EQ(there.joint_types()[1], iksel::JointType::prismatic);
  const Eigen::MatrixXd q = there.random_configurations(100, iksel_test::seed());
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const JointVector at = q.row(i);
    const JointVector reversed = at.reverse();
    for (const Kinematics kinematics : {Kinematics::kernel, Kinematics::kdl}) {
      const Pose product = there.fk(at, kinematics) * back.fk(reversed, kinematics);
      EXPECT_LT((product.matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-13);
    }
    // By the two ways down from b.
    const JointVector zero = JointVector::Zero(1);
    JointVector first(2);
    first << 0, at[0];
    JointVector second(2);
    second << 0, at[1];
    const Pose T_a_c = load(tree(), "a", "c").fk(first);
    const Pose T_a_d = load(tree(), "a", "d").fk(second);
    EXPECT_LT((there.fk(at).matrix() - (T_a_c.inverse() * T_a_d).matrix()).norm(), 1e-13);
  }
}

TEST(Urdf, MimicJointFollowsItsSource) {
  const std::string follower =
      "<origin xyz='0 0 0.4'/><axis xyz='1 0 0'/><limit lower='-9' upper='9' effort='0' "
      "velocity='1'/><mimic joint='ab' multiplier='-0.5' offset='0.25'/>";
  const Robot robot = load(robot_xml(joint("ab", "revolute", "a", "b", kTurn) +
                                     joint("bc", "revolute", "b", "c", follower)),
                           "a", "c");
  const Robot free = load(
      robot_xml(joint("ab", "revolute", "a", "b", kTurn) +
                joint("bc", "revolute", "b", "c", follower.substr(0, follower.find("<mimic")))),
      "a", "c");
  ASSERT_EQ(robot.dof(), 1);
  const Eigen::MatrixXd q = robot.random_configurations(100, iksel_test::seed());
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const JointVector at = q.row(i);
    JointVector both(2);
    both << at[0], -0.5 * at[0] + 0.25;
    EXPECT_LT((robot.fk(at).matrix() - free.fk(both).matrix()).norm(), 1e-13);
    EXPECT_LT((robot.fk(at, Kinematics::kdl).matrix() - free.fk(both).matrix()).norm(), 1e-13);
    const iksel::Jacobian J = free.jacobian(both);
    for (const Kinematics kinematics : {Kinematics::kernel, Kinematics::kdl}) {
      EXPECT_LT((robot.jacobian(at, kinematics).col(0) - (J.col(0) - 0.5 * J.col(1))).norm(),
                1e-13);
    }
  }
}

TEST(Urdf, LimitsOfAMimicJointNarrowItsSource) {
  const std::string follower =
      "<axis xyz='1 0 0'/><limit lower='-0.1' upper='0.3' effort='0' velocity='1'/>"
      "<mimic joint='ab' multiplier='-0.5'/>";
  const Robot robot = load(robot_xml(joint("ab", "revolute", "a", "b", kTurn) +
                                     joint("bc", "revolute", "b", "c", follower)),
                           "a", "c");
  EXPECT_NEAR(robot.lower()[0], -0.6, 1e-15);
  EXPECT_NEAR(robot.upper()[0], 0.2, 1e-15);
  EXPECT_NEAR(robot.velocity_limit()[0], 2.0, 1e-15);
}

TEST(Urdf, MimicOfAJointOffTheChainIsDrivenByIt) {
  const std::string follower =
      "<axis xyz='1 0 0'/><limit lower='-9' upper='9' effort='0' velocity='1'/>"
      "<mimic joint='ab'/>";
  const Robot robot = load(robot_xml(joint("ab", "revolute", "a", "b", kTurn) +
                                     joint("ac", "revolute", "a", "c", follower)),
                           "a", "c");
  EXPECT_EQ(robot.joint_names(), (std::vector<std::string>{"ab"}));
}

/// All links of `xml` at q, against KDL's chain to each.
void expect_links_by_kdl(const std::string& xml, const std::string& base, const std::string& tip,
                         const std::map<std::string, double>& others) {
  const Robot robot = load(xml, base, tip);
  const Eigen::MatrixXd rows = robot.random_configurations(20, iksel_test::seed());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const JointVector q = rows.row(i);
    std::map<std::string, double> values = others;
    for (int j = 0; j < robot.dof(); ++j) {
      values[robot.joint_names()[static_cast<std::size_t>(j)]] = q[j];
    }
    const std::vector<Pose> poses = robot.link_poses(q, others);
    ASSERT_EQ(poses.size(), robot.link_names().size());
    std::vector<double> flat(16 * poses.size());
    robot.link_poses(q.data(), 1, others, flat.data());
    for (std::size_t link = 0; link < poses.size(); ++link) {
      EXPECT_EQ(flat[16 * link + 3], poses[link].translation().x());
      const std::string& name = robot.link_names()[link];
      if (name == base) {
        EXPECT_TRUE(poses[link].matrix().isIdentity(0));
        continue;
      }
      const Robot to_link = load(xml, base, name);
      JointVector at(to_link.dof());
      for (int j = 0; j < to_link.dof(); ++j) {
        const auto value = values.find(to_link.joint_names()[static_cast<std::size_t>(j)]);
        at[j] = value == values.end() ? 0.0 : value->second;
      }
      const Pose expected = to_link.fk(at, Kinematics::kdl);
      EXPECT_LT((poses[link].matrix() - expected.matrix()).norm(), 1e-13) << name;
    }
  }
}

TEST(Urdf, PosesOfAllLinksAreThoseOfKdl) {
  for (const char* base : {"a", "b", "c", "d"}) {
    for (const char* tip : {"a", "b", "c", "d"}) {
      if (std::string(base) != tip) expect_links_by_kdl(tree(), base, tip, {});
    }
  }
  expect_links_by_kdl(tree(), "a", "c", {{"bd", 0.1}});
  const auto follower = [](const std::string& source) {
    return "<origin xyz='0 0 0.4' rpy='0.3 0 0'/><axis xyz='1 1 0'/><limit lower='-9' upper='9' "
           "effort='0' velocity='1'/><mimic joint='" +
           source + "' multiplier='-0.5' offset='0.25'/>";
  };
  const std::string of_each_other = robot_xml(joint("ab", "revolute", "a", "b", kTurn) +
                                              joint("ac", "prismatic", "a", "c", follower("ab")) +
                                              joint("cd", "revolute", "c", "d", follower("ac")) +
                                              joint("de", "revolute", "d", "e", follower("cd")));
  expect_links_by_kdl(of_each_other, "a", "b", {});
  expect_links_by_kdl(of_each_other, "e", "b", {});
}

TEST(Urdf, ValuesOfJointsThatTheArmMovesAreRefused) {
  const Robot robot = load(tree(), "a", "c");
  const JointVector q = JointVector::Zero(2);
  EXPECT_THROW((void)robot.link_poses(q, {{"ab", 0.1}}), iksel::InvalidArgumentError);
  EXPECT_THROW((void)robot.link_poses(q, {{"bd", 1e9}}), iksel::InvalidArgumentError);
  EXPECT_THROW((void)robot.link_poses(q, {{"be", 0.1}}), iksel::UnknownNameError);
  EXPECT_THROW((void)robot.link_poses(JointVector::Zero(3)), iksel::InvalidArgumentError);
}

TEST(Urdf, CircleOfMimicsIsRefused) {
  const auto mimic = [](const char* source) {
    return "<axis xyz='1 0 0'/><limit lower='-9' upper='9' effort='0' velocity='1'/><mimic "
           "joint='" +
           std::string(source) + "'/>";
  };
  expect_mentions(refusal(robot_xml(joint("ab", "revolute", "a", "b", mimic("bc")) +
                                    joint("bc", "revolute", "b", "c", mimic("ab"))),
                          "a", "c"),
                  {"ab", "circle"});
}

TEST(Urdf, LockedJointIsNoDegreeOfFreedom) {
  RobotOptions options;
  options.base_link = "a";
  options.tip_link = "c";
  options.locked_joints["bc"] = 0.7;
  const Robot locked = Robot::from_urdf_string(tree(), options);
  ASSERT_EQ(locked.joint_names(), (std::vector<std::string>{"ab"}));
  JointVector both(2);
  both << 0.4, 0.7;
  const JointVector one = JointVector::Constant(1, 0.4);
  const Pose expected = load(tree(), "a", "c").fk(both);
  EXPECT_LT((locked.fk(one).matrix() - expected.matrix()).norm(), 1e-14);
  EXPECT_LT((locked.fk(one, Kinematics::kdl).matrix() - expected.matrix()).norm(), 1e-14);

  options.locked_joints["nothing"] = 0;
  EXPECT_THROW(Robot::from_urdf_string(tree(), options), iksel::UnknownNameError);
}

TEST(Urdf, JointsLockedOnTheWayUpAndAlongASlide) {
  const std::string xml = robot_xml(joint("ab", "revolute", "a", "b", kTurn) +
                                    joint("bc", "prismatic", "b", "c", kTurn) +
                                    joint("bd", "revolute", "b", "d", kTurn));
  for (const char* name : {"bc", "bd"}) {
    RobotOptions options;
    options.base_link = "c";
    options.tip_link = "d";
    options.locked_joints[name] = -0.6;
    const Robot locked = Robot::from_urdf_string(xml, options);
    const Robot whole = load(xml, "c", "d");
    ASSERT_EQ(whole.joint_names(), (std::vector<std::string>{"bc", "bd"}));
    JointVector both = JointVector::Constant(2, 0.4);
    both[locked.joint_names()[0] == "bc" ? 1 : 0] = -0.6;
    const JointVector one = JointVector::Constant(1, 0.4);
    const Pose expected = whole.fk(both, Kinematics::kdl);
    EXPECT_LT((locked.fk(one).matrix() - expected.matrix()).norm(), 1e-14) << name;
    EXPECT_LT((locked.fk(one, Kinematics::kdl).matrix() - expected.matrix()).norm(), 1e-14) << name;
  }
}

/// With a joint locked in its middle the panda is an arm of six joints like any other.
TEST(Urdf, LockedPandaSolvesInLanesAndAnswersForTheWholeArm) {
  constexpr double kLocked = 0.4;
  RobotOptions options;
  options.base_link = "panda_link0";
  options.tip_link = "panda_link8";
  const std::string file = std::string(IKSEL_ROBOTS_DIR) + "/panda.urdf";
  const Robot whole = Robot::from_urdf_file(file, options);
  options.locked_joints["panda_joint3"] = kLocked;
  const Robot locked = Robot::from_urdf_file(file, options);
  ASSERT_EQ(locked.dof(), 6);

  const iksel::Solver solver(locked);
  EXPECT_EQ(solver.database().options().key_scheme, iksel::KeyScheme::reduced);
  const iksel::SharedBySearches shared(locked, locked, &solver.database(), solver.options());
  EXPECT_TRUE(shared.in_lanes);

  const Eigen::MatrixXd q = locked.random_configurations(500, iksel_test::seed());
  std::size_t solved = 0;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const Pose target = locked.fk(q.row(i), Kinematics::kdl);
    const iksel::Result result = solver.solve(target);
    if (!result.success()) continue;
    ++solved;
    JointVector all(7);
    all << result.q.head(2), kLocked, result.q.tail(4);
    const auto e = iksel::pose_error(target, whole.fk(all, Kinematics::kdl));
    EXPECT_LE(e.head<3>().norm(), solver.options().position_tolerance + 1e-13) << "target " << i;
    EXPECT_LE(e.tail<3>().norm(), solver.options().rotation_tolerance + 1e-13) << "target " << i;
  }
  EXPECT_GE(solved, 495U) << "seed " << iksel_test::seed();
}

TEST(Urdf, SoftLimitsAreReadAndUsedOnRequest) {
  const std::string soft =
      "<axis xyz='1 0 0'/><limit lower='-2' upper='2' effort='0' velocity='1'/>"
      "<safety_controller soft_lower_limit='-1.5' soft_upper_limit='3' k_velocity='1'/>";
  const std::string xml = robot_xml(joint("ab", "revolute", "a", "b", soft));
  RobotOptions options;
  const Robot hard = Robot::from_urdf_string(xml, options);
  EXPECT_EQ(hard.lower()[0], -2);
  EXPECT_EQ(hard.soft_lower()[0], -1.5);
  EXPECT_EQ(hard.soft_upper()[0], 2);  // never wider than the hard limit
  options.soft_limits = true;
  const Robot narrowed = Robot::from_urdf_string(xml, options);
  EXPECT_EQ(narrowed.lower()[0], -1.5);
  EXPECT_EQ(narrowed.upper()[0], 2);
  EXPECT_NE(hard.chain_hash(), narrowed.chain_hash());
}

TEST(Urdf, BaseAndTipHaveDefaults) {
  const Robot robot = Robot::from_urdf_string(robot_xml(joint("ab", "revolute", "a", "b", kTurn)));
  EXPECT_EQ(robot.base_link(), "a");
  EXPECT_EQ(robot.tip_link(), "b");
  EXPECT_EQ(robot.options().tip_link, "b");
  // Two leaves: which one is meant must be said.
  expect_mentions(refusal(tree(), "", ""), {"c", "d", "tip"});
}

TEST(Urdf, NamesTheUnknownLinkAndTheKnownOnes) {
  expect_mentions(refusal<iksel::UnknownNameError>(tree(), "a", "tool0"),
                  {"tip link 'tool0'", "a, b, c, d"});
  expect_mentions(refusal<iksel::UnknownNameError>(tree(), "world", "c"),
                  {"base link 'world'", "a, b, c, d"});
}

TEST(Urdf, RefusesWhatCannotBeSolved) {
  expect_mentions(refusal(robot_xml(joint("ab", "floating", "a", "b", "")), "a", "b"),
                  {"'ab'", "floating"});
  expect_mentions(
      refusal(robot_xml(joint("ab", "planar", "a", "b", "<axis xyz='0 0 1'/>")), "a", "b"),
      {"'ab'", "planar"});
  expect_mentions(refusal(robot_xml(joint("ab", "fixed", "a", "b", "")), "a", "b"),
                  {"no movable joint"});
  expect_mentions(refusal(tree(), "a", "a"), {"no movable joint"});
}

TEST(Urdf, RefusesUnusableLimits) {
  const auto limits = [](const std::string& lower, const std::string& upper) {
    return robot_xml(joint("ab", "revolute", "a", "b",
                           "<axis xyz='0 0 1'/><limit lower='" + lower + "' upper='" + upper +
                               "' effort='0' velocity='1'/>"));
  };
  expect_mentions(refusal(limits("1", "-1"), "a", "b"), {"ab", "limits", "1", "-1"});
  expect_mentions(refusal(limits("1", "1"), "a", "b"), {"ab", "limits"});
  expect_mentions(refusal(limits("nan", "1"), "a", "b"), {"ab"});
  expect_mentions(
      refusal(robot_xml(joint("ab", "revolute", "a", "b", "<axis xyz='0 0 1'/>")), "a", "b"),
      {"ab"});
}

TEST(Urdf, RefusesAZeroAxis) {
  expect_mentions(refusal(robot_xml(joint("ab", "revolute", "a", "b",
                                          "<axis xyz='0 0 0'/><limit lower='-1' upper='1' "
                                          "effort='0' velocity='1'/>")),
                          "a", "b"),
                  {"ab", "axis"});
}

TEST(Urdf, RefusesTextThatDoesNotParse) {
  for (const char* text :
       {"", "not xml", "<robot name='x'>", "<robot name='x'/>", "<robot><link name='a'/></robot>",
        "<mesh/>", "<robot name='x'><link name='a'/><link name='b'/></robot>"}) {
    EXPECT_FALSE(refusal(text, "a", "b").empty()) << text;
  }
}

/// The text in UTF-16.
std::string wide(const std::string& ascii, bool big_endian) {
  std::string bytes = big_endian ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : ascii) {
    const char unit[] = {big_endian ? '\0' : c, big_endian ? c : '\0'};
    bytes.append(unit, 2);
  }
  return bytes;
}

TEST(Urdf, MendedTextIsOfTheSameRobotAndStaysAsItIs) {
  std::string odd = tree();
  odd.replace(odd.find("<link"), 0,
              "<!-- a -- b --><joint:x joint:y='R&D'/><![CDATA[ <a> ]]>&lt;&#x41;&none; < ");
  odd.insert(0, "<!-- first -->");
  odd.replace(odd.find("<robot"), 0, "<!DOCTYPE robot [<!ENTITY pi '3.14'> <!-- ]> -->]>");
  for (const std::string& text : {odd, wide(odd, false), wide(odd, true), "\xEF\xBB\xBF" + odd}) {
    const std::string mended = iksel::mend_xml(text);
    EXPECT_EQ(mended, iksel::mend_xml(odd));
    EXPECT_EQ(iksel::mend_xml(mended), mended);
    EXPECT_EQ(load(text, "a", "c").urdf(), mended);
    EXPECT_EQ(load(text, "a", "c").chain_hash(), load(tree(), "a", "c").chain_hash());
  }
  expect_mentions(iksel::mend_xml(odd), {"xmlns:joint=\"joint\"", "joint:y=\"R&amp;D\"",
                                         " &lt;a&gt; ", "&lt;A&amp;none; &lt; <link"});
}

TEST(Urdf, TheTreeOfTheChainIsLeft) {
  std::string two = tree();
  two.insert(two.find("<link"),
             "<link name='x'/><link name='y'/>" + joint("xy", "revolute", "x", "y", kTurn));
  const Robot robot = load(two, "a", "c");
  EXPECT_EQ(robot.link_names(), load(tree(), "a", "c").link_names());
  EXPECT_EQ(load(two, "", "y").joint_names(), (std::vector<std::string>{"xy"}));
  EXPECT_EQ(iksel::LinkTree::from_urdf_string(two, "c").links, robot.link_names());
  expect_mentions(refusal(two, "", ""), {"several trees, whose roots are x, a"});
  expect_mentions(refusal(two, "a", "y"), {"'a' and 'y' are not connected"});
}

TEST(Urdf, FaultsOfXmlHaveALine) {
  const std::string text = "<robot name='a'>\n<link name='b'/>\n";
  expect_mentions(refusal(text, "", ""), {"line 3: ", "cut off"});
  expect_mentions(refusal(text + "<link name='c>\n</robot>", "", ""),
                  {"line 3: ", "closing quote"});
  expect_mentions(refusal(text + "</link>", "", ""), {"line 3: ", "</link>", "<robot> of line 1"});
}

TEST(Urdf, NamesAFileThatIsNotThere) {
  try {
    Robot::from_urdf_file("no/such/file.urdf");
    FAIL();
  } catch (const iksel::UrdfError& error) {
    expect_mentions(error.what(), {"no/such/file.urdf"});
  }
  EXPECT_THROW(Robot::from_urdf_file("/"), iksel::UrdfError);
}

TEST(Urdf, UpToThirtyTwoJoints) {
  const auto snake = [](int n) {
    std::string links = "<link name='l0'/>";
    std::string joints;
    for (int i = 0; i < n; ++i) {
      const std::string from = "l" + std::to_string(i);
      const std::string to = "l" + std::to_string(i + 1);
      links += "<link name='" + to + "'/>";
      joints += joint("j" + std::to_string(i), "revolute", from, to,
                      std::string("<origin xyz='0 0 0.1'/><axis xyz='") +
                          (i % 2 == 0 ? "0 0 1" : "0 1 0") +
                          "'/><limit lower='-2' upper='2' effort='0' velocity='1'/>");
    }
    return "<robot name='snake'>" + links + joints + "</robot>";
  };
  const Robot robot = Robot::from_urdf_string(snake(32));
  ASSERT_EQ(robot.dof(), 32);
  const Eigen::MatrixXd q = robot.random_configurations(20, iksel_test::seed());
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    EXPECT_LT((robot.fk(q.row(i)).matrix() - robot.fk(q.row(i), Kinematics::kdl).matrix()).norm(),
              1e-12);
  }
  expect_mentions(refusal(snake(33), "l0", "l33"), {"33", "32"});
  EXPECT_EQ(Robot::from_urdf_string(snake(1)).dof(), 1);
}

}  // namespace
