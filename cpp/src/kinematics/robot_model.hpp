// SPDX-License-Identifier: BSD-3-Clause
// What the library knows of a robot, whatever the number of its tips: its joints and its links.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "iksel/robot_options.hpp"
#include "kinematics/joint_space.hpp"
#include "kinematics/link_poses.hpp"
#include "urdf/chain_spec.hpp"

namespace iksel {

/// Six rows for each tip; never on the heap.
using Jacobians = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic,
                                Eigen::ColMajor | Eigen::DontAlign, 6 * kMaxTips, kMaxDof>;

class RobotModel {
 public:
  RobotModel(std::string urdf_xml, RobotOptions options_in)
      : urdf(std::move(urdf_xml)), options(std::move(options_in)) {}
  virtual ~RobotModel() = default;

  [[nodiscard]] int tip_count() const { return static_cast<int>(tip_links.size()); }
  /// Geometric Jacobians at q, 6 rows [linear; angular] for each tip.
  [[nodiscard]] virtual Jacobians jacobians(const double* q) const = 0;

  int dof = 0;
  std::string urdf;
  RobotOptions options;
  std::string name;
  std::vector<std::string> link_names;  ///< of the whole URDF
  std::vector<std::string> tip_links;
  JointSpace joints;
  JointVector soft_lower, soft_upper;
  /// Where the joints of each tip's chain stand among all.
  std::vector<std::vector<int>> joints_of_tip;
  /// The joints that move more than one tip, ascending.
  std::vector<int> shared;
  /// What iterations count lengths in [m]: then an arm of any size is as one of about a metre. A
  /// power of two, so that nothing is rounded, and 1 for arms of the usual size.
  double unit = 1;
  std::uint64_t hash = 0;
  /// Shared by all copies, which have the same URDF and locked joints.
  std::shared_ptr<LinkPoseCache> link_poses = std::make_shared<LinkPoseCache>();

 protected:
  void add_joint(const ChainVariable& variable, bool repeats) {
    joints.names.push_back(variable.name);
    joints.types.push_back(variable.type);
    joints.repeats.push_back(repeats);
    const auto append = [this](JointVector& values, double value) {
      values.conservativeResize(dof + 1);
      values[dof] = value;
    };
    append(joints.lower, variable.lower);
    append(joints.upper, variable.upper);
    append(joints.velocity, variable.velocity);
    append(soft_lower, variable.soft_lower);
    append(soft_upper, variable.soft_upper);
    ++dof;
  }

  RobotModel(const RobotModel&) = default;
  RobotModel(RobotModel&&) = default;
  RobotModel& operator=(const RobotModel&) = default;
  RobotModel& operator=(RobotModel&&) = default;
};

}  // namespace iksel
