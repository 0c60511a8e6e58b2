// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <sstream>

#include "error_check.hpp"
#include "iksel/error.hpp"
#include "math/constants.hpp"
#include "urdf/chain_spec.hpp"
#include "urdf/parse.hpp"

namespace iksel {
namespace {

Eigen::Isometry3d to_eigen(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized().toRotationMatrix();
  T.translation() << pose.position.x, pose.position.y, pose.position.z;
  return T;
}

class ChainReader {
 public:
  ChainReader(const urdf::ModelInterface& model, RobotOptions& options)
      : model_(model), options_(options) {}

  ChainSpec read() {
    spec_.robot_name = model_.getName();
    if (options_.base_link.empty()) options_.base_link = model_.getRoot()->name;
    if (options_.tip_link.empty()) options_.tip_link = only_leaf();
    for (const auto& [name, value] : options_.locked_joints) {
      if (!model_.joints_.count(name)) {
        throw UnknownNameError("locked joint '" + name +
                               "' is not in the URDF; it has: " + list_names(model_.joints_));
      }
      if (!std::isfinite(value)) {
        throw InvalidArgumentError("locked joint '" + name + "': its value is not finite");
      }
    }

    // Up from the base to the first link that is also above the tip, then down to the tip.
    const auto base_up = path_to_root(find_link(options_.base_link, "base"));
    const auto tip_up = path_to_root(find_link(options_.tip_link, "tip"));
    std::size_t common_base = base_up.size();
    std::size_t common_tip = tip_up.size();
    while (common_base > 0 && common_tip > 0 &&
           base_up[common_base - 1] == tip_up[common_tip - 1]) {
      --common_base;
      --common_tip;
    }
    if (common_base == base_up.size()) {
      throw UrdfError("links '" + options_.base_link + "' and '" + options_.tip_link +
                      "' are not connected");
    }
    for (std::size_t i = 0; i < common_base; ++i) add_joint(*base_up[i]->parent_joint, true);
    for (std::size_t i = common_tip; i-- > 0;) add_joint(*tip_up[i]->parent_joint, false);

    for (const ChainVariable& variable : spec_.variables) check_variable(variable);
    if (spec_.variables.empty()) {
      throw UrdfError("the chain from '" + options_.base_link + "' to '" + options_.tip_link +
                      "' has no movable joint");
    }
    if (spec_.variables.size() > static_cast<std::size_t>(kMaxDof)) {
      throw UrdfError("the chain from '" + options_.base_link + "' to '" + options_.tip_link +
                      "' has " + std::to_string(spec_.variables.size()) +
                      " movable joints; at most " + std::to_string(kMaxDof) + " are possible");
    }
    return std::move(spec_);
  }

 private:
  /// Where a joint's motion comes from: multiplier * (value of `source`) + offset.
  struct Motion {
    const urdf::Joint* source;
    double multiplier;
    double offset;
  };

  std::string only_leaf() const {
    std::vector<std::string> leaves;
    for (const auto& [name, link] : model_.links_) {
      if (link->child_joints.empty()) leaves.push_back(name);
    }
    if (leaves.size() == 1) return leaves.front();
    throw UrdfError("no tip link is given and the URDF ends in several: " + list_names(leaves));
  }

  const urdf::Link* find_link(const std::string& name, const char* role) const {
    const auto it = model_.links_.find(name);
    if (it != model_.links_.end()) return it->second.get();
    throw UnknownNameError(std::string(role) + " link '" + name +
                           "' is not in the URDF; it has: " + list_names(model_.links_));
  }

  static std::vector<const urdf::Link*> path_to_root(const urdf::Link* link) {
    std::vector<const urdf::Link*> path;
    urdf::LinkSharedPtr parent;
    while (link != nullptr) {
      path.push_back(link);
      parent = link->getParent();
      link = parent.get();
    }
    return path;
  }

  void add_joint(const urdf::Joint& joint, bool upwards) {
    ChainJoint segment;
    segment.name = joint.name;
    const Eigen::Isometry3d origin = to_eigen(joint.parent_to_joint_origin_transform);
    if (!origin.matrix().allFinite()) {
      throw UrdfError("joint '" + joint.name + "': its origin is not finite");
    }
    // Parent -> child is origin * motion(q); the way up is its inverse, motion(-q) * origin^-1.
    (upwards ? segment.after : segment.before) = upwards ? origin.inverse() : origin;

    switch (joint.type) {
      case urdf::Joint::FIXED:
        segment.fixed = true;
        spec_.joints.push_back(segment);
        return;
      case urdf::Joint::REVOLUTE:
      case urdf::Joint::CONTINUOUS:
        break;
      case urdf::Joint::PRISMATIC:
        segment.prismatic = true;
        break;
      default:
        throw UrdfError("joint '" + joint.name + "' is " + type_name(joint.type) +
                        "; only revolute, continuous, prismatic and fixed joints can be solved");
    }

    const Eigen::Vector3d axis(joint.axis.x, joint.axis.y, joint.axis.z);
    if (!axis.allFinite() || axis.norm() < 1e-9) {
      throw UrdfError("joint '" + joint.name + "' has no axis: its axis vector is zero");
    }
    segment.axis = axis.normalized();

    if (upwards) segment.axis = -segment.axis;

    const Motion motion = resolve_mimic(joint);
    segment.multiplier = motion.multiplier;
    segment.offset = motion.offset;
    const auto locked = options_.locked_joints.find(motion.source->name);
    const auto own_lock = options_.locked_joints.find(joint.name);
    if (own_lock != options_.locked_joints.end()) {
      lock(segment, own_lock->second);
    } else if (locked != options_.locked_joints.end()) {
      lock(segment, motion.multiplier * locked->second + motion.offset);
    } else {
      segment.variable = variable_of(*motion.source);
      narrow_by_follower(joint, motion, spec_.variables[segment.variable]);
    }
    spec_.joints.push_back(segment);
  }

  /// The joint that really moves `joint`, through any number of mimic tags.
  Motion resolve_mimic(const urdf::Joint& joint) const {
    Motion motion{&joint, 1.0, 0.0};
    for (std::size_t steps = 0; motion.source->mimic; ++steps) {
      const urdf::JointMimic& mimic = *motion.source->mimic;
      const auto it = model_.joints_.find(mimic.joint_name);
      if (it == model_.joints_.end()) {
        throw UnknownNameError(
            "joint '" + motion.source->name + "' mimics '" + mimic.joint_name +
            "', which is not in the URDF; it has: " + list_names(model_.joints_));
      }
      if (steps > model_.joints_.size()) {
        throw UrdfError("joint '" + joint.name + "' mimics itself through a circle of joints");
      }
      motion = {it->second.get(), motion.multiplier * mimic.multiplier,
                motion.offset + motion.multiplier * mimic.offset};
    }
    if (!std::isfinite(motion.multiplier) || !std::isfinite(motion.offset)) {
      throw UrdfError("joint '" + joint.name + "': its mimic multiplier or offset is not finite");
    }
    const auto type = motion.source->type;
    if (type != urdf::Joint::REVOLUTE && type != urdf::Joint::CONTINUOUS &&
        type != urdf::Joint::PRISMATIC) {
      throw UrdfError("joint '" + joint.name + "' mimics '" + motion.source->name + "', which is " +
                      type_name(type));
    }
    return motion;
  }

  /// A locked joint is a fixed one: its motion by `value` becomes part of the constant transform.
  static void lock(ChainJoint& segment, double value) {
    if (segment.prismatic) {
      segment.before.translate(value * segment.axis);
    } else {
      segment.before.rotate(Eigen::AngleAxisd(value, segment.axis));
    }
    segment.fixed = true;
  }

  int variable_of(const urdf::Joint& source) {
    for (std::size_t i = 0; i < spec_.variables.size(); ++i) {
      if (spec_.variables[i].name == source.name) return static_cast<int>(i);
    }
    spec_.variables.push_back(make_variable(source));
    return static_cast<int>(spec_.variables.size()) - 1;
  }

  ChainVariable make_variable(const urdf::Joint& joint) const {
    ChainVariable variable;
    variable.name = joint.name;
    variable.velocity =
        joint.limits && joint.limits->velocity > 0 ? joint.limits->velocity : kInfinity;
    if (joint.type == urdf::Joint::CONTINUOUS) {
      // Safety limits of continuous joints are placeholders in practice (0, 0).
      variable.type = JointType::continuous;
      variable.lower = variable.soft_lower = -kInfinity;
      variable.upper = variable.soft_upper = kInfinity;
      return variable;
    }
    variable.type =
        joint.type == urdf::Joint::PRISMATIC ? JointType::prismatic : JointType::revolute;
    if (!joint.limits) {
      throw UrdfError("joint '" + joint.name + "' has no limits; only continuous joints need none");
    }
    variable.lower = joint.limits->lower;
    variable.upper = joint.limits->upper;
    variable.soft_lower = variable.lower;
    variable.soft_upper = variable.upper;
    if (joint.safety && joint.safety->soft_lower_limit < joint.safety->soft_upper_limit) {
      variable.soft_lower = std::max(variable.lower, joint.safety->soft_lower_limit);
      variable.soft_upper = std::min(variable.upper, joint.safety->soft_upper_limit);
    }
    if (options_.soft_limits) {
      variable.lower = variable.soft_lower;
      variable.upper = variable.soft_upper;
    }
    return variable;
  }

  /// A joint that follows another has limits of its own, which the other must respect.
  void narrow_by_follower(const urdf::Joint& follower, const Motion& motion,
                          ChainVariable& variable) const {
    if (motion.source == &follower || motion.multiplier == 0.0) return;
    const ChainVariable own = make_variable(follower);
    const auto narrow = [&](double low, double high, double& lower, double& upper) {
      low = (low - motion.offset) / motion.multiplier;
      high = (high - motion.offset) / motion.multiplier;
      lower = std::max(lower, std::min(low, high));
      upper = std::min(upper, std::max(low, high));
    };
    narrow(own.lower, own.upper, variable.lower, variable.upper);
    narrow(own.soft_lower, own.soft_upper, variable.soft_lower, variable.soft_upper);
    variable.velocity = std::min(variable.velocity, own.velocity / std::abs(motion.multiplier));
    if (variable.type == JointType::continuous && std::isfinite(variable.lower)) {
      variable.type = JointType::revolute;
    }
  }

  static void check_variable(const ChainVariable& variable) {
    if (variable.type == JointType::continuous) return;
    if (std::isfinite(variable.lower) && std::isfinite(variable.upper) &&
        variable.lower < variable.upper) {
      return;
    }
    std::ostringstream text;
    text << "joint '" << variable.name << "' has no usable limits: lower " << variable.lower
         << ", upper " << variable.upper << " (finite numbers with lower < upper are needed)";
    throw UrdfError(text.str());
  }

  static const char* type_name(int type) {
    switch (type) {
      case urdf::Joint::FIXED:
        return "fixed";
      case urdf::Joint::FLOATING:
        return "floating";
      case urdf::Joint::PLANAR:
        return "planar";
      default:
        return "of an unknown type";
    }
  }

  const urdf::ModelInterface& model_;
  RobotOptions& options_;
  ChainSpec spec_;
};

}  // namespace

ChainSpec read_chain(const std::string& urdf_xml, RobotOptions& options) {
  const auto model = parse_urdf(urdf_xml);
  return ChainReader(*model, options).read();
}

}  // namespace iksel
