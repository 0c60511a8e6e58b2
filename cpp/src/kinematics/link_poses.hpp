// SPDX-License-Identifier: BSD-3-Clause
// Forward kinematics of all links of a URDF, on the chain or not.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "iksel/types.hpp"
#include "urdf/chain_spec.hpp"

namespace iksel {

class RobotModel;

/// The links of a URDF as a robot moves them, the other joints held.
class LinkPoses {
 public:
  /// Throws UnknownNameError or InvalidArgumentError naming a bad entry of `other_joints`.
  LinkPoses(const RobotModel& model, const std::vector<LinkJoint>& joints,
            const std::map<std::string, double>& other_joints);

  /// Poses of all links in the base link's frame.
  void at(const double* q, Pose* T_base_link) const;

  /// How a link is placed on the one that carries it.
  struct Step {
    LinkJoint joint;  ///< of one that is held, the value is part of its origin
    int variable;     ///< -1: held
  };
  /// Of all links, in the order of Robot::link_names: parents first.
  [[nodiscard]] const std::vector<Step>& steps() const { return steps_; }
  /// The base link.
  [[nodiscard]] std::size_t base() const { return base_; }

 private:
  std::vector<Step> steps_;
  std::size_t base_;
};

/// Reads the URDF when it is first asked for.
class LinkPoseCache {
 public:
  template <class Use>
  void with(const RobotModel& model, const std::map<std::string, double>& other_joints,
            const Use& use) {
    read(model);
    if (other_joints.empty()) return use(*plain_);
    use(LinkPoses(model, joints_, other_joints));
  }

 private:
  void read(const RobotModel& model);

  std::once_flag once_;
  std::vector<LinkJoint> joints_;
  std::unique_ptr<const LinkPoses> plain_;  ///< without values of other joints
};

}  // namespace iksel
