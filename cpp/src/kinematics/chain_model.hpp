// SPDX-License-Identifier: BSD-3-Clause
// Everything the library knows of one chain: what the URDF says, flattened once for the kernels. A
// robot with one tip is a chain.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "iksel/robot.hpp"
#include "kinematics/kdl_chain.hpp"
#include "kinematics/kernel.hpp"
#include "kinematics/robot_model.hpp"
#include "kinematics/unmoved.hpp"
#include "urdf/chain_spec.hpp"

namespace iksel {

/// Frame of the kernel as a pose.
Pose to_pose(const Frame& frame);

class ChainModel final : public RobotModel {
 public:
  ChainModel(std::string urdf, const RobotOptions& options);
  /// The same chain with another tool.
  [[nodiscard]] std::shared_ptr<const ChainModel> with_tcp(const Pose& T_tip_tcp) const;

  /// The same chain with joints that turn freely and slides that reach farther, but for what curves
  /// are of, and for joints by which others slide that turn, or turn that slide.
  [[nodiscard]] std::shared_ptr<const ChainModel> without_limits() const;

  /// KDL's chain to the TCP, or to another frame behind the tip link.
  [[nodiscard]] std::unique_ptr<KdlChain> make_kdl() const { return make_kdl(Pose(tcp)); }
  [[nodiscard]] std::unique_ptr<KdlChain> make_kdl(const Pose& T_tip_end) const;

  [[nodiscard]] Pose fk(const double* q) const;
  /// The same as a frame, with fused multiply-adds where the processor has them.
  [[nodiscard]] Frame fk_frame(const double* q) const;
  /// Jacobian of the TCP, or of the tip link if not `with_tool`, whose frame is returned.
  Frame fk_jacobian(const double* q, Jacobian& jacobian, bool with_tool = true) const;
  /// Brings a Jacobian's lengths, and what slides move, to the unit.
  void to_unit(Jacobian& jacobian) const;
  /// Whether the variable moves a joint, its own or one that follows it, that is such.
  template <typename IsSuch>
  [[nodiscard]] bool moves_any(int variable, const IsSuch& is_such) const {
    return std::any_of(kernel.joints.begin(), kernel.joints.end(), [&](const KernelJoint& joint) {
      return joint.variable == variable && is_such(joint);
    });
  }
  /// Whether the arm is singular at q, or almost (base/pseudo_inverse.hpp).
  [[nodiscard]] bool is_almost_singular(const double* q) const;

  [[nodiscard]] Jacobians jacobians(const double* q) const override;

  /// So many random configurations inside the limits, always the same ones, tell what is so
  /// everywhere.
  static constexpr int kConfigurations = 24;
  /// Visits each, with the TCP's pose and its Jacobian in the unit.
  template <typename Visit>
  void visit_configurations(const Visit& visit) const {
    Random random(/*seed=*/8);
    Jacobian J;
    for (int i = 0; i < kConfigurations; ++i) {
      const JointVector q = joints.sample(random);
      const Pose pose = to_pose(fk_jacobian(q.data(), J));
      to_unit(J);
      visit(q, pose, J);
    }
  }

  ChainSpec spec;
  KernelChain kernel;
  /// T_tip_tcp and its inverse.
  StoredPose tcp, tcp_inverse;
  Eigen::Matrix<double, 3, 1, Eigen::DontAlign> reach_centre;
  double reach;
  /// In how many directions of position and rotation the joints move the TCP, wherever they are.
  int rank = 0;
  /// What of its pose they do not move; nothing where that is not known.
  Unmoved unmoved;
  /// Farthest that the TCP may be from reach_centre [m].
  [[nodiscard]] double reach_of_tcp() const { return reach + tcp.translation().norm(); }

 private:
  void flatten();
  void set_tool(const Pose& T_tip_tcp);
  void measure_reach();
  void measure_rank();
  [[nodiscard]] std::uint64_t compute_hash() const;
};

/// Adds the limits to `joints`, whose own are set. Mimic joints become their sources, locked ones
/// constants. Throws InvalidArgumentError, naming the limit and what is wrong with it: no number, a
/// joint that turns without limits, nothing between its ends, or no configuration inside of all;
/// UnknownNameError for a name that is no joint of the chain.
void add_coupled_limits(const std::vector<CoupledLimit>& limits, const ChainSpec& spec,
                        JointSpace& joints);

}  // namespace iksel
