// SPDX-License-Identifier: BSD-3-Clause
// A robot with several tips, whose chains may share joints: a torso and its two arms.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "iksel/coupled_limit.hpp"
#include "iksel/export.hpp"
#include "iksel/robot.hpp"
#include "iksel/types.hpp"

namespace iksel {

/// Most tips that a robot may have.
inline constexpr int kMaxTips = 8;

/// A number for each tip; never on the heap.
using TipVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::DontAlign, kMaxTips, 1>;

/// What to take out of a URDF.
struct TreeOptions {
  /// Link that all poses are relative to; empty: the root link.
  std::string base_link;
  /// Links whose poses are solved for, 1 to kMaxTips.
  std::vector<std::string> tip_links;
  /// T_tip_tcp of each tip, or empty: none has a tool.
  std::vector<StoredPose> tcps;
  /// As in RobotOptions.
  std::map<std::string, double> locked_joints;
  bool soft_limits = false;
  std::optional<std::pair<double, double>> default_limits;
  /// As in RobotOptions; of joints of one chain or of several.
  std::vector<CoupledLimit> coupled_limits;
};

class TreeModel;

/// The chains from one base link to several tip links, joined: a joint that lies on several of them
/// is one degree of freedom. Immutable; copies share the data.
class IKSEL_EXPORT TreeRobot {
 public:
  /// Reads a URDF file. Throws as Robot::from_urdf_file, of each chain; UrdfError if the chains
  /// together have more than kMaxDof joints, or leave a joint that they share no value between its
  /// limits; InvalidArgumentError if there is no tip link, one twice, more than kMaxTips, or not a
  /// tool for each.
  static TreeRobot from_urdf_file(const std::filesystem::path& path, const TreeOptions& options);
  /// Parses URDF text. Throws as from_urdf_file.
  static TreeRobot from_urdf_string(const std::string& xml, const TreeOptions& options);

  [[nodiscard]] const std::string& name() const;
  [[nodiscard]] const std::string& base_link() const;
  [[nodiscard]] const std::vector<std::string>& tip_links() const;
  [[nodiscard]] const std::string& urdf() const;
  /// Those it was made with, base link and tools filled in.
  [[nodiscard]] const TreeOptions& options() const;

  /// Number of tips.
  [[nodiscard]] int tips() const;
  /// Number of joints of all chains together, 1 to kMaxDof. The vectors below have that length: the
  /// joints of the first chain from base to tip, then those that only the second has, and so on.
  [[nodiscard]] int dof() const;
  [[nodiscard]] const std::vector<std::string>& joint_names() const;
  [[nodiscard]] const std::vector<JointType>& joint_types() const;
  /// Position limits [rad or m], those that all chains allow; infinite for continuous joints. Those
  /// of the options' coupled_limits come on top.
  [[nodiscard]] const JointVector& lower() const;
  [[nodiscard]] const JointVector& upper() const;
  /// Velocity limits [rad/s or m/s]; infinite where the URDF has none.
  [[nodiscard]] const JointVector& velocity_limit() const;
  [[nodiscard]] bool within_limits(const JointVector& q) const;

  /// The chain to one tip by itself; `tip` counts from 0. Throws InvalidArgumentError, as the next.
  [[nodiscard]] const Robot& chain(int tip) const;
  /// Where that chain's joints stand among all: chain joint j has the value q[joints_of(tip)[j]].
  [[nodiscard]] const std::vector<int>& joints_of(int tip) const;
  /// The joints that move more than one tip, ascending.
  [[nodiscard]] const std::vector<int>& shared_joints() const;

  /// T_base_tip of each tip (of its TCP, if it has one). Throws InvalidArgumentError if q has not
  /// dof elements or one is not finite.
  [[nodiscard]] std::vector<Pose> fk(const JointVector& q) const;
  /// Geometric Jacobians of all tips, one below the other: 6 rows [linear; angular] for each, dof
  /// columns. Throws as fk.
  [[nodiscard]] Matrix jacobian(const JointVector& q) const;
  /// n configurations uniform inside the limits, as Robot::random_configurations.
  [[nodiscard]] Matrix random_configurations(std::size_t n, std::uint64_t seed,
                                             const Progress& progress = {}) const;

  /// For the library itself.
  [[nodiscard]] const TreeModel& model() const { return *model_; }

 private:
  explicit TreeRobot(std::shared_ptr<const TreeModel> model);
  std::shared_ptr<const TreeModel> model_;
};

}  // namespace iksel
