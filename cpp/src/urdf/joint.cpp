// SPDX-License-Identifier: BSD-3-Clause
#include "urdf/joint.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.hpp"
#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "iksel/types.hpp"
#include "urdf/parse.hpp"

namespace iksel {
namespace {

bool is_limited(const urdf::Joint& joint) { return joint.type != urdf::Joint::CONTINUOUS; }

/// A number that exporters write where there is no limit, or that urdf_text.cpp has for infinity.
double infinite_if_huge(double limit) {
  return std::abs(limit) > kMaxCoordinate ? std::copysign(kInfinity, limit) : limit;
}

/// The limits that the URDF gives a joint; infinite where it gives none. Exporters write 0, 0 where
/// they know none; urdfdom reads a limit without numbers so.
std::pair<double, double> limits_of(const urdf::Joint& joint) {
  const urdf::JointLimits* limits = joint.limits.get();
  if (!is_limited(joint) || limits == nullptr || (limits->lower == 0 && limits->upper == 0)) {
    return {-kInfinity, kInfinity};
  }
  return {infinite_if_huge(limits->lower), infinite_if_huge(limits->upper)};
}

/// A joint that turns without end says so, or has numbers that stand for infinity.
bool turns_freely(const urdf::Joint& joint) {
  if (!is_limited(joint)) return true;
  const auto [lower, upper] = limits_of(joint);
  return joint.type == urdf::Joint::REVOLUTE && joint.limits && joint.limits->upper != 0 &&
         lower == -kInfinity && upper == kInfinity;
}

/// The degree of freedom that a joint is by its URDF, with infinite limits where it has none.
ChainVariable read_variable(const urdf::Joint& joint, const RobotOptions& options) {
  ChainVariable variable;
  variable.name = joint.name;
  const double velocity = joint.limits ? joint.limits->velocity : 0;
  variable.velocity = velocity > 0 ? infinite_if_huge(velocity) : kInfinity;
  const auto [lower, upper] = limits_of(joint);
  variable.lower = variable.soft_lower = lower;
  variable.upper = variable.soft_upper = upper;
  if (turns_freely(joint)) {
    // Safety limits of continuous joints are placeholders in practice (0, 0).
    variable.type = JointType::continuous;
    return variable;
  }
  variable.type = joint.type == urdf::Joint::PRISMATIC ? JointType::prismatic : JointType::revolute;
  if (joint.safety && joint.safety->soft_lower_limit < joint.safety->soft_upper_limit) {
    variable.soft_lower = std::max(lower, joint.safety->soft_lower_limit);
    variable.soft_upper = std::min(upper, joint.safety->soft_upper_limit);
  }
  if (options.soft_limits) {
    variable.lower = variable.soft_lower;
    variable.upper = variable.soft_upper;
  }
  return variable;
}

bool are_usable(double lower, double upper) {
  return std::isfinite(lower) && std::isfinite(upper) && lower < upper;
}

void narrow(double lower, double upper, ChainVariable& variable) {
  variable.lower = std::max(variable.lower, lower);
  variable.soft_lower = std::max(variable.soft_lower, lower);
  variable.upper = std::min(variable.upper, upper);
  variable.soft_upper = std::min(variable.soft_upper, upper);
}

/// Pose of the joint in its parent link.
Eigen::Isometry3d origin_of(const urdf::Joint& joint) {
  const urdf::Pose& pose = joint.parent_to_joint_origin_transform;
  const urdf::Rotation& r = pose.rotation;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized().toRotationMatrix();
  T.translation() << pose.position.x, pose.position.y, pose.position.z;
  if (!T.matrix().allFinite()) {
    throw UrdfError("joint '" + joint.name + "': its origin is not finite");
  }
  return T;
}

/// Unit vector about or along which the joint moves.
Eigen::Vector3d axis_of(const urdf::Joint& joint) {
  const Eigen::Vector3d axis(joint.axis.x, joint.axis.y, joint.axis.z);
  if (!(axis.norm() >= 1e-9 && axis.norm() <= kMaxCoordinate)) {
    throw UrdfError("joint '" + joint.name + "' has no axis: its axis vector has the length " +
                    number_text(axis.norm()));
  }
  return axis.normalized();
}

}  // namespace

const urdf::Joint& find_joint(const urdf::ModelInterface& model, const std::string& name,
                              const std::string& problem) {
  const auto it = model.joints_.find(name);
  if (it != model.joints_.end()) return *it->second;
  throw_unknown_name(problem, name, joint_names_of(model));
}

bool has_value(const urdf::Joint& joint) {
  return joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS ||
         joint.type == urdf::Joint::PRISMATIC;
}

Motion resolve_mimic(const urdf::ModelInterface& model, const urdf::Joint& joint, Motions& known) {
  std::vector<const urdf::Joint*> path{&joint};
  while (known.count(path.back()) == 0) {
    const urdf::Joint& last = *path.back();
    if (!last.mimic) {
      known[&last] = Motion{{}, &last};
    } else if (path.size() > model.joints_.size()) {
      throw UrdfError("joint '" + joint.name + "' mimics itself through a circle of joints");
    } else {
      const std::string& followed = last.mimic->joint_name;
      path.push_back(&find_joint(
          model, followed,
          "joint '" + last.name + "' mimics '" + followed + "', which is not in the URDF"));
    }
  }
  Motion motion = known[path.back()];
  // Also of those between, so that a long chain is walked once.
  for (auto it = path.rbegin() + 1; it != path.rend(); ++it) {
    const urdf::JointMimic& mimic = *(*it)->mimic;
    motion.offset = mimic.multiplier * motion.offset + mimic.offset;
    motion.multiplier *= mimic.multiplier;
    known[*it] = motion;
  }
  for (const double number : {motion.multiplier, motion.offset}) {
    if (std::abs(number) <= kMaxCoordinate) continue;
    throw UrdfError("joint '" + joint.name + "': its mimic multiplier or offset is " +
                    too_large_text(number));
  }
  if (!has_value(*motion.source)) {
    throw UrdfError("joint '" + joint.name + "' mimics '" + motion.source->name + "', which is " +
                    joint_type_name(motion.source->type));
  }
  return motion;
}

LinkJoint read_joint(const urdf::ModelInterface& model, const urdf::Joint& joint, Motions& known) {
  LinkJoint out;
  out.name = out.source = joint.name;
  out.origin = origin_of(joint);
  out.prismatic = joint.type == urdf::Joint::PRISMATIC;
  out.moves = has_value(joint);
  if (!out.moves) return out;
  out.axis = axis_of(joint);
  const Motion motion = resolve_mimic(model, joint, known);
  out.source = motion.source->name;
  static_cast<Following&>(out) = motion;
  return out;
}

ChainVariable make_variable(const urdf::Joint& joint, const RobotOptions& options) {
  ChainVariable variable = read_variable(joint, options);
  if (variable.type == JointType::continuous) return variable;
  const bool has_lower = variable.lower != -kInfinity;
  const bool has_upper = variable.upper != kInfinity;
  if (has_lower && has_upper) return variable;
  if (!options.default_limits) {
    const char* what = has_lower ? "upper limit" : has_upper ? "lower limit" : "limits";
    throw UrdfError("joint '" + joint.name + "' has no " + what +
                    " (missing, 0, 0 or infinite): give default_limits for such joints, or hold it "
                    "at a value by locked_joints");
  }
  const auto [least, most] = *options.default_limits;
  narrow(has_lower ? -kInfinity : least, has_upper ? kInfinity : most, variable);
  return variable;
}

void narrow_by_follower(const urdf::Joint& follower, const Following& motion,
                        const RobotOptions& options, ChainVariable& variable) {
  if (follower.name == variable.name || motion.multiplier == 0.0) return;
  if (motion.curve) {
    narrow(motion.curve->lower(), motion.curve->upper(), variable);
    if (variable.type == JointType::continuous) variable.type = JointType::revolute;
    check_limits(variable);  // else there is nothing to narrow
  }
  const ChainVariable own = read_variable(follower, options);
  const auto narrow_both = [&](double low, double high, double& lower, double& upper) {
    low = (low - motion.offset) / motion.multiplier;
    high = (high - motion.offset) / motion.multiplier;
    if (low > high) std::swap(low, high);
    if (!motion.curve) {
      lower = std::max(lower, low);
      upper = std::min(upper, high);
    } else if (!narrow_to_values(*motion.curve, low, high, lower, upper)) {
      throw UrdfError("joint '" + follower.name + "': its limits, lower " + number_text(own.lower) +
                      ", upper " + number_text(own.upper) +
                      ", leave no part of its curve, or several; '" + variable.name +
                      "', which it follows, goes from " + number_text(lower) + " to " +
                      number_text(upper));
    }
  };
  const auto [least, most] = std::pair(variable.lower, variable.upper);
  narrow_both(own.lower, own.upper, variable.lower, variable.upper);
  if (least < most && !(variable.lower < variable.upper)) {
    throw UrdfError("joint '" + follower.name + "': its limits, lower " + number_text(own.lower) +
                    ", upper " + number_text(own.upper) + ", leave it nowhere to go with '" +
                    variable.name + "', which it follows and which goes from " +
                    number_text(least) + " to " + number_text(most));
  }
  narrow_both(own.soft_lower, own.soft_upper, variable.soft_lower, variable.soft_upper);
  const double slope = std::abs(motion.multiplier) * (motion.curve ? motion.curve->steepest() : 1);
  variable.velocity = std::min(variable.velocity, own.velocity / slope);
  if (variable.type == JointType::continuous && std::isfinite(variable.lower)) {
    variable.type = JointType::revolute;
  }
}

void check_limits(const ChainVariable& variable) {
  if (variable.type == JointType::continuous || are_usable(variable.lower, variable.upper)) return;
  throw UrdfError("joint '" + variable.name + "' has no usable limits: lower " +
                  number_text(variable.lower) + ", upper " + number_text(variable.upper) +
                  " (finite numbers with lower < upper are needed; a joint that does not move is "
                  "held by locked_joints)");
}

void check_default_limits(const RobotOptions& options) {
  if (!options.default_limits) return;
  const auto [lower, upper] = *options.default_limits;
  if (are_usable(lower, upper)) return;
  throw InvalidArgumentError("default_limits: lower " + number_text(lower) + ", upper " +
                             number_text(upper) +
                             " are not finite numbers with lower < upper [rad or m]");
}

}  // namespace iksel
