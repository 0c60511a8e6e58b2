// SPDX-License-Identifier: BSD-3-Clause
// A robot: the serial chain between two links of a URDF, or several that share joints.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "iksel/dh.hpp"
#include "iksel/export.hpp"
#include "iksel/robot_options.hpp"
#include "iksel/types.hpp"

namespace iksel {

class ChainModel;
class RobotModel;
class TipsModel;

/// An immutable serial chain with its limits, or the chains from one base link to several tip links
/// (RobotOptions::tip_links), joined: a joint that lies on several of them is one degree of
/// freedom. Copies are cheap and share the data. Safe to use from many threads at once. What is
/// about one tip throws InvalidArgumentError where there are several.
class IKSEL_EXPORT Robot {
 public:
  /// Reads a URDF file. Throws UrdfError (file, XML, joint type, limits, a length or joint value
  /// beyond kMaxCoordinate), UnknownNameError (links, locked joints), InvalidArgumentError (numbers
  /// in the options). Of several chains also UrdfError if they have more than kMaxDof joints
  /// together, or leave a joint that they share no value between its limits.
  static Robot from_urdf_file(const std::filesystem::path& path, const RobotOptions& options = {});
  /// Parses URDF text. Throws as from_urdf_file.
  static Robot from_urdf_string(const std::string& xml, const RobotOptions& options = {});
  /// Makes an arm of Denavit and Hartenberg's parameters. Throws InvalidArgumentError (a number, a
  /// name or limits of the table), and as from_urdf_file.
  static Robot from_dh(const DhTable& table, const RobotOptions& options = {});

  /// The same chain with another tool T_tip_tcp; databases built for one serve the other.
  [[nodiscard]] Robot with_tcp(const Pose& T_tip_tcp) const;

  /// The same chain with joints that turn freely, and slides that reach as far again at each end as
  /// between their limits, but for those that other joints turn by; databases built for one serve
  /// the other.
  [[nodiscard]] Robot without_limits() const;

  /// Name in the URDF.
  [[nodiscard]] const std::string& name() const;
  /// Link the poses are relative to.
  [[nodiscard]] const std::string& base_link() const;
  /// Link whose pose is solved for, of a robot with one tip.
  [[nodiscard]] const std::string& tip_link() const;
  /// The URDF text this robot was made of, as mend_xml gives it, without trees of links that the
  /// chain is not in.
  [[nodiscard]] const std::string& urdf() const;
  /// What it was made with, base and tip link filled in.
  [[nodiscard]] const RobotOptions& options() const;
  /// Names of all links of the URDF, the chain's and others, depth first from the root.
  [[nodiscard]] const std::vector<std::string>& link_names() const;
  /// T_tip_tcp, the tool centre point in the tip link's frame.
  [[nodiscard]] Pose tcp() const;

  /// Number of tips.
  [[nodiscard]] int tips() const;
  /// Links whose poses are solved for, 1 to kMaxTips.
  [[nodiscard]] const std::vector<std::string>& tip_links() const;
  /// The chain to one tip by itself; tips count from 0. Throws InvalidArgumentError if there is no
  /// such tip.
  [[nodiscard]] const Robot& chain(int tip) const;
  /// Where that chain's joints stand among all: its joint values are q[joints_of(tip)]. Throws as
  /// chain.
  [[nodiscard]] const std::vector<int>& joints_of(int tip) const;
  /// Indices of the joints that move more than one tip, ascending.
  [[nodiscard]] const std::vector<int>& shared_joints() const;

  /// Degrees of freedom, 1 to kMaxDof.
  [[nodiscard]] int dof() const;
  /// Names of the degrees of freedom, base to tip; of several tips those of the first chain, then
  /// those that only the second has, and so on.
  [[nodiscard]] const std::vector<std::string>& joint_names() const;
  /// How each degree of freedom moves, base to tip.
  [[nodiscard]] const std::vector<JointType>& joint_types() const;
  /// Position limits [rad or m], both inside; -inf and inf for continuous joints.
  [[nodiscard]] const JointVector& lower() const;
  [[nodiscard]] const JointVector& upper() const;
  /// Velocity limits [rad/s or m/s]; inf where the URDF has none.
  [[nodiscard]] const JointVector& velocity_limit() const;
  /// Limits of the safety controller [rad or m]; the position limits where the URDF has none.
  [[nodiscard]] const JointVector& soft_lower() const;
  [[nodiscard]] const JointVector& soft_upper() const;
  [[nodiscard]] bool within_limits(const JointVector& q) const;

  /// T_base_tip (of the TCP, if there is one) at q. Throws InvalidArgumentError if q has not dof
  /// elements or one is not finite.
  [[nodiscard]] Pose fk(const JointVector& q, Kinematics kinematics = Kinematics::kernel) const;
  /// Geometric Jacobian at q, 6 x dof. Throws as fk.
  [[nodiscard]] Jacobian jacobian(const JointVector& q,
                                  Kinematics kinematics = Kinematics::kernel) const;

  /// T_base_tip of each tip (of its TCP, if it has one). Throws as fk.
  [[nodiscard]] std::vector<Pose> tip_poses(const JointVector& q,
                                            Kinematics kinematics = Kinematics::kernel) const;
  /// Geometric Jacobians of all tips, one below the other: 6 rows [linear; angular] for each, dof
  /// columns. Throws as fk.
  [[nodiscard]] Matrix tip_jacobians(const JointVector& q,
                                     Kinematics kinematics = Kinematics::kernel) const;

  /// Poses of all links of the URDF in the base link's frame at q, in the order of link_names:
  /// side branches move with the arm's joints, too, and with what mimics them. Joints that q does
  /// not move are at their value in `other_joints` [rad or m], or else where they are locked, or
  /// else at 0; floating and planar ones at their origin. Throws as fk, UnknownNameError and
  /// InvalidArgumentError naming a bad entry of `other_joints`, and UrdfError if a joint off the
  /// chain is no good. The first call reads the URDF again.
  [[nodiscard]] std::vector<Pose> link_poses(
      const JointVector& q, const std::map<std::string, double>& other_joints = {}) const;
  /// The same at `count` configurations, one after the other, into 4x4 matrices row by row: those
  /// of all links at the first, at the second, ... Does not check that q is finite.
  void link_poses(const double* q, std::size_t count,
                  const std::map<std::string, double>& other_joints, double* T_base_link) const;

  /// The derivative of an answer q by its target: dq = inverse_jacobian * [linear; angular] for a
  /// small twist of the target in base axes at the TCP, of all dq the least. dof x 6: J^T (J J^T +
  /// damping^2 I)^-1, the damped pseudo-inverse (Nakamura and Hanafusa 1986); with damping 0 the
  /// pseudo-inverse, singular values under 1e-9 of the largest cut off. Throws as fk, and if the
  /// damping is negative or not finite.
  [[nodiscard]] Matrix inverse_jacobian(const JointVector& q, double damping = 0) const;

  /// n configurations uniform inside the limits (continuous joints in [-pi, pi)), one per row. The
  /// same seed gives the same numbers everywhere.
  [[nodiscard]] Matrix random_configurations(std::size_t n, std::uint64_t seed,
                                             const Progress& progress = {}) const;

  /// No pose whose origin lies farther than this from `reach_centre` can be reached [m].
  [[nodiscard]] double reach() const;
  /// A point on the first joint's axis, in the base frame [m].
  [[nodiscard]] Eigen::Vector3d reach_centre() const;

  /// Hash over the structure and numbers of the chain up to the tip link: equal for chains that may
  /// share a database. The TCP and names are not part of it.
  [[nodiscard]] std::uint64_t chain_hash() const;

  /// For the library itself: the flattened chain; what does not depend on the number of tips; and
  /// several chains, null if there is one.
  [[nodiscard]] const ChainModel& model() const {
    if (chain_ == nullptr) refuse_several_tips();
    return *chain_;
  }
  [[nodiscard]] const RobotModel& all() const { return *model_; }
  [[nodiscard]] const TipsModel* several() const { return several_; }

 private:
  explicit Robot(std::shared_ptr<const ChainModel> chain);
  explicit Robot(std::shared_ptr<const TipsModel> several);
  [[noreturn]] void refuse_several_tips() const;

  std::shared_ptr<const RobotModel> model_;
  /// The same, as the one of these that it is; the other is null.
  const ChainModel* chain_ = nullptr;
  const TipsModel* several_ = nullptr;
};

}  // namespace iksel
