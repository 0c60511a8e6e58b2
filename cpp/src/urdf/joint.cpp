// SPDX-License-Identifier: BSD-3-Clause
#include "urdf/joint.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/constants.hpp"
#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "iksel/types.hpp"
#include "urdf/parse.hpp"

namespace iksel {
namespace {

bool is_limited(const urdf::Joint& joint) { return joint.type != urdf::Joint::CONTINUOUS; }

/// Exporters write 0, 0 where they know no limits; urdfdom reads a limit without numbers so.
bool lacks_limits(const urdf::Joint& joint) {
  return is_limited(joint) &&
         (!joint.limits || (joint.limits->lower == 0 && joint.limits->upper == 0));
}

bool are_usable(double lower, double upper) {
  return std::isfinite(lower) && std::isfinite(upper) && lower < upper;
}

void set_limits(ChainVariable& variable, double lower, double upper) {
  variable.lower = variable.soft_lower = lower;
  variable.upper = variable.soft_upper = upper;
}

void narrow_to_ends(const MotionCurve& curve, ChainVariable& variable) {
  for (double* lower : {&variable.lower, &variable.soft_lower}) {
    *lower = std::max(*lower, curve.lower());
  }
  for (double* upper : {&variable.upper, &variable.soft_upper}) {
    *upper = std::min(*upper, curve.upper());
  }
  if (variable.type == JointType::continuous) variable.type = JointType::revolute;
  // Else there is nothing to narrow.
  check_limits(variable);
}

}  // namespace

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

Eigen::Vector3d axis_of(const urdf::Joint& joint) {
  const Eigen::Vector3d axis(joint.axis.x, joint.axis.y, joint.axis.z);
  if (!(axis.norm() >= 1e-9 && axis.norm() <= kMaxCoordinate)) {
    throw UrdfError("joint '" + joint.name + "' has no axis: its axis vector has the length " +
                    number_text(axis.norm()));
  }
  return axis.normalized();
}

Motion resolve_mimic(const urdf::ModelInterface& model, const CheckedCurves& curves,
                     const urdf::Joint& joint) {
  Motion motion{&joint, 1.0, 0.0, nullptr};
  for (std::size_t steps = 0;; ++steps) {
    const auto curve = curves.find(motion.source->name);
    if (curve != curves.end()) {
      motion.source = curve->second.source;
      motion.curve = curve->second.curve;
      break;
    }
    if (!motion.source->mimic) break;
    const urdf::JointMimic& mimic = *motion.source->mimic;
    const auto it = model.joints_.find(mimic.joint_name);
    if (it == model.joints_.end()) {
      throw_unknown_name("joint '" + motion.source->name + "' mimics '" + mimic.joint_name +
                             "', which is not in the URDF",
                         mimic.joint_name, joint_names_of(model));
    }
    if (steps > model.joints_.size()) {
      throw UrdfError("joint '" + joint.name + "' mimics itself through a circle of joints");
    }
    motion = {it->second.get(), motion.multiplier * mimic.multiplier,
              motion.offset + motion.multiplier * mimic.offset, nullptr};
  }
  for (const double number : {motion.multiplier, motion.offset}) {
    if (std::abs(number) <= kMaxCoordinate) continue;
    throw UrdfError("joint '" + joint.name + "': its mimic multiplier or offset is " +
                    too_large_text(number));
  }
  const auto type = motion.source->type;
  if (type != urdf::Joint::REVOLUTE && type != urdf::Joint::CONTINUOUS &&
      type != urdf::Joint::PRISMATIC) {
    throw UrdfError("joint '" + joint.name + "' mimics '" + motion.source->name + "', which is " +
                    joint_type_name(type));
  }
  return motion;
}

ChainVariable make_variable(const urdf::Joint& joint, const RobotOptions& options) {
  ChainVariable variable;
  variable.name = joint.name;
  variable.velocity =
      joint.limits && joint.limits->velocity > 0 ? joint.limits->velocity : kInfinity;
  if (!is_limited(joint)) {
    // Safety limits of continuous joints are placeholders in practice (0, 0).
    variable.type = JointType::continuous;
    set_limits(variable, -kInfinity, kInfinity);
    return variable;
  }
  variable.type = joint.type == urdf::Joint::PRISMATIC ? JointType::prismatic : JointType::revolute;
  if (!lacks_limits(joint)) {
    set_limits(variable, joint.limits->lower, joint.limits->upper);
  } else if (options.default_limits) {
    set_limits(variable, options.default_limits->first, options.default_limits->second);
  } else {
    throw UrdfError("joint '" + joint.name +
                    "' has no limits (they are missing or 0, 0): give default_limits for such "
                    "joints, or hold it at a value by locked_joints");
  }
  if (joint.safety && joint.safety->soft_lower_limit < joint.safety->soft_upper_limit) {
    variable.soft_lower = std::max(variable.lower, joint.safety->soft_lower_limit);
    variable.soft_upper = std::min(variable.upper, joint.safety->soft_upper_limit);
  }
  if (options.soft_limits) {
    variable.lower = variable.soft_lower;
    variable.upper = variable.soft_upper;
  }
  return variable;
}

void narrow_by_follower(const urdf::Joint& follower, const Motion& motion,
                        const RobotOptions& options, ChainVariable& variable) {
  if (motion.source == &follower || motion.multiplier == 0.0) return;
  if (motion.curve) narrow_to_ends(*motion.curve, variable);
  // A curve has ends of its own.
  if ((options.default_limits || motion.curve) && lacks_limits(follower)) return;
  const ChainVariable own = make_variable(follower, options);
  const auto narrow = [&](double low, double high, double& lower, double& upper) {
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
  narrow(own.lower, own.upper, variable.lower, variable.upper);
  narrow(own.soft_lower, own.soft_upper, variable.soft_lower, variable.soft_upper);
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
