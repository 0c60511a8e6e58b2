// SPDX-License-Identifier: BSD-3-Clause
#include "kinematics/chain_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.hpp"
#include "base/message_text.hpp"
#include "base/pseudo_inverse.hpp"
#include "iksel/error.hpp"
#include "iksel/pose.hpp"
#include "iksel/urdf_text.hpp"

namespace iksel {
namespace {

Frame to_frame(const Eigen::Isometry3d& T) {
  Frame f;
  for (int i = 0; i < 3; ++i) {
    f.x[i] = T.linear()(i, 0);
    f.y[i] = T.linear()(i, 1);
    f.z[i] = T.linear()(i, 2);
    f.p[i] = T.translation()[i];
  }
  return f;
}

/// Rotation that takes z to the unit vector `axis`, by the least angle; the identity where it is z
/// already. (Eigen's FromTwoVectors loses digits where the axis is nearly -z.)
Eigen::Isometry3d turn_z_to(const Eigen::Vector3d& axis) {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  if ((axis - z).norm() == 0) return T;
  const Eigen::Vector3d to = axis.normalized();
  if (to.z() < -0.5) {
    // By way of -z, from where the rest of the angle is small.
    const Eigen::Vector3d half_turn_about_x(1, -1, -1);
    T = turn_z_to(half_turn_about_x.cwiseProduct(to));
    T.linear() = half_turn_about_x.asDiagonal() * T.linear();
    return T;
  }
  // The unit quaternion (1 + z . to, z x to), up to its length.
  const double length = std::sqrt((1 + to.z()) * 2);
  const Eigen::Vector3d vector = z.cross(to) * (1 / length);
  T.linear() =
      Eigen::Quaterniond(length * 0.5, vector.x(), vector.y(), vector.z()).toRotationMatrix();
  return T;
}

Eigen::Isometry3d rotation_z(double angle) {
  return Eigen::Isometry3d(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
}

/// R = Rz(first) Rx(alpha) Rz(last), with sin(alpha) >= 0.
struct EulerZxz {
  double first, cos_alpha, sin_alpha, last;

  explicit EulerZxz(const Eigen::Matrix3d& R) {
    // For alpha near 0 or pi `first` is ill defined; any value serves, as the rest is taken from
    // what it leaves of R.
    const bool aligned = std::hypot(R(0, 2), R(1, 2)) < 1e-12;
    first = aligned ? 0.0 : std::atan2(R(0, 2), -R(1, 2));
    const Eigen::Matrix3d rest = rotation_z(-first).linear() * R;  // Rx(alpha) Rz(last)
    const double alpha = std::atan2(-rest(1, 2), rest(2, 2));
    cos_alpha = std::cos(alpha);
    sin_alpha = std::sin(alpha);
    last = std::atan2(-rest(0, 1), rest(0, 0));
  }
};

/// Adds a constant turn about the joint's axis.
void add_turn(KernelJoint& joint, double angle) {
  if (joint.prismatic) {
    const double turn = std::atan2(joint.sin_turn, joint.cos_turn) + angle;
    joint.cos_turn = std::cos(turn);
    joint.sin_turn = std::sin(turn);
  } else {
    joint.offset += angle;
  }
}

/// The tool as a rigid transform.
Pose check_tool(const Pose& T_tip_tcp) {
  Pose tool = check_pose(T_tip_tcp, "tcp");
  const double distance = tool.translation().stableNorm();
  if (distance <= kMaxCoordinate) return tool;
  throw InvalidArgumentError("tcp: its origin is " +
                             too_large_text(distance, "m from the tip link's"));
}

#if defined(__x86_64__)
/// Chains of products and sums are what forward kinematics waits for, and a fused one takes half
/// the time. All is inlined here, for what is called from here would be compiled without.
__attribute__((target("avx2,fma"), flatten)) Frame forward_fused(const KernelChain& chain,
                                                                 const double* q) {
  return forward(chain, q);
}

bool can_fuse() {
  static const bool kCan = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return kCan;
}
#endif

}  // namespace

Pose to_pose(const Frame& f) {
  Pose pose;
  pose.matrix() << f.x[0], f.y[0], f.z[0], f.p[0], f.x[1], f.y[1], f.z[1], f.p[1], f.x[2], f.y[2],
      f.z[2], f.p[2], 0, 0, 0, 1;
  return pose;
}

ChainModel::ChainModel(std::string urdf_xml, const RobotOptions& options_in)
    : RobotModel(std::move(urdf_xml), options_in) {
  options.tcp = check_tool(Pose(options.tcp));
  spec = read_chain(urdf, options);
  urdf = mend_xml(urdf, options.base_link);
  name = spec.robot_name;
  link_names = spec.link_names;
  tip_links = {options.tip_link};
  joints_of_tip.emplace_back();
  for (const ChainVariable& variable : spec.variables) {
    joints_of_tip.front().push_back(dof);
    add_joint(variable, /*repeats=*/true);
  }
  for (const ChainJoint& joint : spec.joints) {
    const bool turns = !joint.prismatic && !joint.curve;
    const bool repeats = turns && std::rint(joint.multiplier) == joint.multiplier;
    if (!joint.fixed && !repeats) joints.repeats[joint.variable] = false;
  }
  add_coupled_limits(options.coupled_limits, spec, joints);
  flatten();
  measure_reach();
  hash = compute_hash();
  set_tool(Pose(options.tcp));
}

std::shared_ptr<const ChainModel> ChainModel::with_tcp(const Pose& T_tip_tcp) const {
  const Pose tool = check_tool(T_tip_tcp);
  auto copy = std::make_shared<ChainModel>(*this);
  copy->options.tcp = tool;
  copy->set_tool(tool);
  return copy;
}

std::shared_ptr<const ChainModel> ChainModel::without_limits() const {
  auto copy = std::make_shared<ChainModel>(*this);
  JointSpace& wide = copy->joints;
  copy->options.coupled_limits.clear();
  wide.sums.clear();
  wide.turning.clear();
  wide.images.clear();
  for (int i = 0; i < dof; ++i) {
    // A curve is known between its ends only; and where turns move a slide, or a slide turns a
    // joint, lengths and angles may be bounded by what the limits are.
    const bool is_bounded = moves_any(i, [&](const KernelJoint& joint) {
      return joint.curve != nullptr || joint.prismatic != joints.is_slide(i);
    });
    if (is_bounded) continue;
    if (joints.is_slide(i)) {
      const double range = joints.upper[i] - joints.lower[i];
      wide.lower[i] = joints.lower[i] - range;
      wide.upper[i] = joints.upper[i] + range;
    } else {
      wide.types[static_cast<std::size_t>(i)] = JointType::continuous;
      wide.lower[i] = -kInfinity;
      wide.upper[i] = kInfinity;
    }
  }
  copy->measure_reach();
  copy->measure_rank();
  return copy;
}

std::unique_ptr<KdlChain> ChainModel::make_kdl(const Pose& T_tip_end) const {
  return std::make_unique<KdlChain>(spec.joints, dof, T_tip_end);
}

void ChainModel::flatten() {
  // `constant` gathers all that lies between two motions; `turn` is the constant rotation about z
  // that the previous motion can take over.
  Eigen::Isometry3d constant = Eigen::Isometry3d::Identity();
  for (const ChainJoint& joint : spec.joints) {
    if (joint.fixed) {
      constant = constant * joint.before * joint.after;
      continue;
    }
    if (kernel.joints.size() == kMaxMovingJoints) {
      throw UrdfError("the chain has more than " + std::to_string(kMaxMovingJoints) +
                      " moving joints, mimic joints included");
    }
    const Eigen::Isometry3d align = turn_z_to(joint.axis);
    constant = constant * joint.before * align;

    KernelJoint k{};
    static_cast<Following&>(k) = joint;
    k.variable = joint.variable;
    k.prismatic = joint.prismatic;
    k.cos_turn = 1;
    if (kernel.joints.empty()) {
      kernel.base = to_frame(constant);
      k.cos_alpha = 1;
    } else {
      // Behind the previous motion stands Trans(p) Rz(first) Rx(alpha) Rz(last). Rz(first) goes to
      // the previous joint, so p is seen from a frame turned by it; Rz(last) stays with this joint.
      const EulerZxz euler(constant.linear());
      const Eigen::Vector3d p = rotation_z(-euler.first).linear() * constant.translation();
      for (int i = 0; i < 3; ++i) k.p[i] = p[i];
      k.cos_alpha = euler.cos_alpha;
      k.sin_alpha = euler.sin_alpha;
      add_turn(kernel.joints.back(), euler.first);
      add_turn(k, euler.last);
    }
    kernel.joints.push_back(k);
    constant = align.inverse() * joint.after;
  }
  kernel.flange = to_frame(constant);
}

void ChainModel::set_tool(const Pose& T_tip_tcp) {
  tcp = T_tip_tcp;
  tcp_inverse = T_tip_tcp.inverse();
  kernel.tip = to_frame(to_pose(kernel.flange) * T_tip_tcp);
  measure_rank();
}

void ChainModel::measure_reach() {
  // The triangle inequality over the constant offsets and the slides; the tool is added by callers.
  reach_centre = Eigen::Vector3d::Map(kernel.base.p);
  reach = 0;
  for (const KernelJoint& k : kernel.joints) {
    reach += Eigen::Vector3d::Map(k.p).norm();
    if (k.prismatic) {
      const auto of = motion_between(k, joints.lower[k.variable], joints.upper[k.variable]);
      reach += std::max(std::abs(of.lower), std::abs(of.upper));
    }
  }
  reach += Eigen::Vector3d::Map(kernel.flange.p).norm();
  // Of 32, so that the reach is between 0.35 and 11.3 units.
  unit = reach > 0 ? std::exp2(5 * std::round(std::log2(reach / 2) / 5)) : 1;
}

void ChainModel::measure_rank() {
  std::vector<Pose> poses;
  rank = 0;
  visit_configurations([&](const JointVector&, const Pose& pose, const Jacobian& J) {
    if (rank == kPoseJoints) return;
    poses.push_back(pose);
    rank = std::max(rank, rank_of(J));
  });
  // A curve may stand still over what no configuration is in.
  const bool has_curve = std::any_of(kernel.joints.begin(), kernel.joints.end(),
                                     [](const KernelJoint& joint) { return joint.curve; });
  unmoved = rank < kPoseJoints && !has_curve ? Unmoved(poses, unit) : Unmoved();
}

Pose ChainModel::fk(const double* q) const { return to_pose(forward(kernel, q)); }

Frame ChainModel::fk_frame(const double* q) const {
#if defined(__x86_64__)
  if (can_fuse()) return forward_fused(kernel, q);
#endif
  return forward(kernel, q);
}

Frame ChainModel::fk_jacobian(const double* q, Jacobian& jacobian, bool with_tool) const {
  jacobian.resize(6, dof);
  const Frame& end = with_tool ? kernel.tip : kernel.flange;
  return forward_jacobian(kernel, end, dof, q, jacobian.data());
}

Jacobians ChainModel::jacobians(const double* q) const {
  Jacobian J;
  fk_jacobian(q, J);
  return J;
}

void ChainModel::to_unit(Jacobian& jacobian) const {
  if (unit == 1) return;
  jacobian.topRows<3>() /= unit;
  for (int j = 0; j < dof; ++j) {
    if (joints.is_slide(j)) jacobian.col(j) *= unit;
  }
}

bool ChainModel::is_almost_singular(const double* q) const {
  Jacobian J;
  fk_jacobian(q, J);
  to_unit(J);
  return iksel::is_almost_singular(J);
}

}  // namespace iksel
