// SPDX-License-Identifier: BSD-3-Clause
// The robots that C++ tests use: a row per file of cpp/robots.
#pragma once

#include <cstdlib>
#include <iksel/iksel.hpp>
#include <ostream>
#include <string>
#include <vector>

namespace iksel_test {

struct RobotCase {
  const char* name;
  const char* base;
  const char* tip;
  double tcp_z;  ///< experiment TCP along the tip's z [m]

  friend std::ostream& operator<<(std::ostream& out, const RobotCase& c) { return out << c.name; }
};

inline iksel::Robot load(const RobotCase& c) {
  iksel::RobotOptions options;
  options.base_link = c.base;
  options.tip_link = c.tip;
  options.tcp.translation().z() = c.tcp_z;
  return iksel::Robot::from_urdf_file(std::string(IKSEL_ROBOTS_DIR) + "/" + c.name + ".urdf",
                                      options);
}

inline const std::vector<RobotCase>& paper_robots() {
  static const std::vector<RobotCase> cases = {
      {"cvr038", "cvr038_base", "cvr038_flange", 0.05},
      {"cvrb1213", "cvrb1213_base", "cvrb1213_flange", 0.2},
      {"ur3_wrs", "ur3_base", "ur3_flange", 0.0},
      {"irb14050", "irb14050_base", "irb14050_flange", 0.13},
  };
  return cases;
}

inline const std::vector<RobotCase>& all_robots() {
  static const std::vector<RobotCase> cases = [] {
    std::vector<RobotCase> all = paper_robots();
    const std::vector<RobotCase> more = {
        {"ur3", "base_link", "tool0", 0},
        {"ur3e", "base_link", "tool0", 0},
        {"ur10e", "base_link", "tool0", 0},
        {"yumi_right", "yumi_body", "yumi_link_7_r", 0},
        {"panda", "panda_link0", "panda_link8", 0.1},
        {"iiwa14", "base_link", "tool0", 0},
        {"gen3_6dof", "base_link", "tool_frame", 0},
        {"pr2_right_arm", "torso_lift_link", "r_wrist_roll_link", 0},
        {"xarm5", "link_base", "link_eef", 0},
        {"wx250", "wx250/base_link", "wx250/ee_gripper_link", 0},
        {"valkyrie_waist_right_arm", "pelvis", "rightPalm", 0},
        {"synthetic10", "base", "tip", 0},
    };
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return cases;
}

/// Random cases per test: IKSEL_TEST_CASES, or `normal`.
inline int cases(int normal) {
  const char* text = std::getenv("IKSEL_TEST_CASES");
  return text != nullptr ? std::atoi(text) : normal;
}

/// The seed of all random cases: IKSEL_TEST_SEED, or 1. Print it with every failure.
inline std::uint64_t seed() {
  const char* text = std::getenv("IKSEL_TEST_SEED");
  return text != nullptr ? std::strtoull(text, nullptr, 10) : 1;
}

/// FK by KDL of row i.
inline iksel::Pose kdl_pose(const iksel::Robot& robot, const Eigen::MatrixXd& q, Eigen::Index i) {
  return robot.fk(q.row(i), iksel::Kinematics::kdl);
}

}  // namespace iksel_test
