// SPDX-License-Identifier: BSD-3-Clause
// The chains of several tips, and how they hang together.
//
// A joint that moves more than one tip is shared. Where all joints from the base to a tip's last
// shared one are shared, the chain splits into a stem, which has the shared joints, and an arm,
// which has those of its own: with the shared joints at a value, the arm is a chain by itself,
// whose base stands where the stem ends. (It does not where a joint mimics one across that border,
// or where a tip lies on another's chain and has no joint of its own.)
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "iksel/robot.hpp"
#include "kinematics/chain_model.hpp"
#include "kinematics/robot_model.hpp"

namespace iksel {

/// Joint values of a chain, picked from those of the robot.
inline JointVector picked(const JointVector& q, const std::vector<int>& joints) {
  JointVector out(static_cast<Eigen::Index>(joints.size()));
  for (std::size_t j = 0; j < joints.size(); ++j) {
    out[static_cast<Eigen::Index>(j)] = q[joints[j]];
  }
  return out;
}

/// The way back.
inline void put(const JointVector& values, const std::vector<int>& joints, JointVector& q) {
  for (std::size_t j = 0; j < joints.size(); ++j) {
    q[joints[j]] = values[static_cast<Eigen::Index>(j)];
  }
}

/// The columns of a chain's Jacobian, put where its joints stand.
template <typename Rows>
void put_columns(const Jacobian& of_chain, const std::vector<int>& joints, Rows&& rows) {
  for (std::size_t j = 0; j < joints.size(); ++j) {
    rows.col(joints[j]) = of_chain.col(static_cast<Eigen::Index>(j));
  }
}

/// A part of a chain, and where its joints stand among those of the robot.
struct ChainPart {
  Robot robot;
  std::vector<int> joints;

  [[nodiscard]] const ChainModel& model() const { return robot.model(); }
  [[nodiscard]] Pose fk(const JointVector& q) const { return model().fk(picked(q, joints).data()); }
};

struct Tip {
  ChainPart chain;
  /// Behind the shared joints; without any, the chain itself. None where the chain does not split.
  std::optional<ChainPart> arm;
  /// From the base to where the arm begins; none if no joint is shared.
  std::optional<ChainPart> stem;
};

class TipsModel final : public RobotModel {
 public:
  /// Throws as Robot.
  TipsModel(const std::string& urdf, const RobotOptions& options_in);

  [[nodiscard]] const Tip& tip(int i) const { return tips[static_cast<std::size_t>(i)]; }
  [[nodiscard]] Jacobians jacobians(const double* q) const override;

  std::vector<Tip> tips;

 private:
  void check_options() const;
  /// Adds a chain's joints to those of the robot; returns where they stand.
  std::vector<int> add_joints(const ChainModel& model);
  void find_shared();
  void split(Tip& tip) const;
  [[nodiscard]] RobotOptions options_between(const std::string& base, const std::string& tip) const;
  /// Adds the options' coupled limits to those of all joints, and to the chains that have them.
  void couple_joints();
  /// A robot under those coupled limits of which it has all joints.
  [[nodiscard]] Robot coupled(const Robot& part) const;
};

}  // namespace iksel
