// SPDX-License-Identifier: BSD-3-Clause
#include "robots.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <map>
#include <stdexcept>

#include "base/rotation.hpp"
#include "kinematics/chain_model.hpp"
#include "kinematics/kdl_chain.hpp"
#include "task_errors.hpp"

namespace iksel_test {

namespace {

/// What robots.toml says of one robot: the texts behind its keys.
using Facts = std::map<std::string, std::string>;

struct Manifest {
  std::map<std::string, Facts> robots;
  std::vector<std::string> names;  ///< in the order of the file
};

/// The little of TOML that the file uses: "[robots.NAME]", and "key = value" on one line.
Manifest read_manifest() {
  Manifest manifest;
  std::ifstream file(std::string(IKSEL_ROBOTS_DIR) + "/robots.toml");
  const std::string table = "[robots.";
  for (std::string line; std::getline(file, line);) {
    const auto equals = line.find(" = ");
    if (line.rfind(table, 0) == 0) {
      manifest.names.push_back(line.substr(table.size(), line.find(']') - table.size()));
    } else if (line.rfind('#', 0) != 0 && equals != std::string::npos) {
      std::string value = line.substr(equals + 3);
      if (value.front() == '"') value = value.substr(1, value.rfind('"') - 1);
      manifest.robots[manifest.names.back()][line.substr(0, equals)] = value;
    }
  }
  return manifest;
}

const Manifest& manifest() {
  static const Manifest read = read_manifest();
  return read;
}

/// T of "{ xyz = [x, y, z], rpy = [roll, pitch, yaw] }", whatever the locale.
iksel::Pose transform_of(const std::string& text) {
  std::array<double, 6> numbers{};
  auto at = text.find('[');
  for (double& number : numbers) {
    at = text.find_first_of("-0123456789", at);
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), number);
    if (error != std::errc()) throw std::runtime_error("robots.toml: no transform: " + text);
    at = static_cast<std::size_t>(end - text.data());
  }
  const auto& [x, y, z, roll, pitch, yaw] = numbers;
  iksel::Pose pose = iksel::Pose::Identity();
  pose.translation() << x, y, z;
  pose.rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()))
      .rotate(Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()))
      .rotate(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()));
  return pose;
}

iksel::Robot load(const std::string& name) {
  const Facts& facts = manifest().robots.at(name);
  iksel::RobotOptions options;
  options.base_link = facts.at("base_link");
  options.tip_link = facts.at("tip_link");
  if (facts.count("tcp") > 0) options.tcp = iksel::StoredPose(transform_of(facts.at("tcp")));
  return iksel::Robot::from_urdf_file(IKSEL_ROBOTS_DIR "/" + facts.at("urdf"), options);
}

/// The value at `key`, made the first time.
template <class Value, class Make>
const Value& kept(std::map<std::string, Value>& values, const std::string& key, const Make& make) {
  const auto found = values.find(key);
  return found != values.end() ? found->second : values.emplace(key, make()).first->second;
}

}  // namespace

const iksel::Robot& robot(const std::string& name) {
  static std::map<std::string, iksel::Robot> robots;
  return kept(robots, name, [&] { return load(name); });
}

const iksel::Solver& solver(const std::string& name) {
  static std::map<std::string, iksel::Solver> solvers;
  return kept(solvers, name, [&] { return iksel::Solver(robot(name)); });
}

const iksel::Solver& paper_solver(const std::string& name) {
  static std::map<std::string, iksel::Solver> solvers;
  return kept(solvers, name,
              [&] { return iksel::Solver(robot(name), iksel::SolverOptions::paper()); });
}

const std::vector<std::string>& paper_robots() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> found;
    for (const std::string& name : manifest().names) {
      if (manifest().robots.at(name).count("paper") > 0) found.push_back(name);
    }
    return found;
  }();
  return names;
}

const std::vector<std::string>& all_robots() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = paper_robots();
    for (const char* name :
         {"ur3", "ur3e", "ur10e", "yumi_right", "panda", "iiwa14", "gen3_6dof", "pr2_right_arm",
          "xarm5", "wx250", "valkyrie_waist_right_arm", "synthetic10"}) {
      all.emplace_back(name);
    }
    return all;
  }();
  return names;
}

int cases(int normal, int least) {
  const char* text = std::getenv("IKSEL_TEST_CASES");
  return std::max(least, text != nullptr ? std::atoi(text) : normal);
}

std::uint64_t seed() {
  const char* text = std::getenv("IKSEL_TEST_SEED");
  return text != nullptr ? std::strtoull(text, nullptr, 10) : 1;
}

std::vector<iksel::Pose> poses(const iksel::Robot& robot, const Eigen::MatrixXd& q) {
  std::vector<iksel::Pose> found;
  for (Eigen::Index i = 0; i < q.rows(); ++i) found.push_back(robot.fk(q.row(i)));
  return found;
}

std::vector<iksel::Pose> random_targets(const iksel::Robot& robot, int n) {
  return poses(robot, robot.random_configurations(static_cast<std::size_t>(n), seed()));
}

Judge::Judge(const iksel::Robot& robot) : robot_(robot), kdl_(robot.model().make_kdl()) {}

iksel::Pose Judge::fk(const iksel::JointVector& q) { return kdl_->fk(q); }

void Judge::expect_solution(const iksel::Pose& target, const iksel::JointVector& q,
                            const iksel::SolverOptions& options) {
  const Vector6 error = outside_of(options.task, task_deviation(options.task, target, kdl_->fk(q)));
  EXPECT_LE(error.head<3>().norm(), options.position_tolerance + 1e-12) << q.transpose();
  EXPECT_LE(error.tail<3>().norm(), options.rotation_tolerance + 1e-12) << q.transpose();
  EXPECT_TRUE(robot_.within_limits(q)) << q.transpose();
}

int count_solved(const iksel::Solver& solver, int n) {
  const std::vector<iksel::Pose> targets = random_targets(solver.robot(), n);
  std::vector<iksel::Pose> batch;
  for (std::size_t i = 1; i < targets.size(); i += 2) batch.push_back(targets[i]);
  const std::vector<iksel::Result> rows = solver.solve_batch(batch);
  Judge judge(solver.robot());
  int solved = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const iksel::Result result = i % 2 == 0 ? solver.solve(targets[i]) : rows[i / 2];
    if (!result.success()) continue;
    ++solved;
    judge.expect_solution(targets[i], result.q, solver.options());
  }
  return solved;
}

double least_singular_value(const Eigen::MatrixXd& J) {
  return J.jacobiSvd().singularValues().minCoeff();
}

Eigen::Matrix<double, 6, 1> pose_vector(const iksel::Pose& pose) {
  Eigen::Matrix<double, 6, 1> x;
  x << pose.translation(), iksel::to_rotation_vector(pose.linear());
  return x;
}

}  // namespace iksel_test
