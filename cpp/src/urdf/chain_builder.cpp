// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "base/constants.hpp"
#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "urdf/chain_spec.hpp"
#include "urdf/joint.hpp"
#include "urdf/parse.hpp"

namespace iksel {
namespace {

/// Written so that NaN fails.
void check_size(const std::string& joint, const std::string& what, double value, const char* unit) {
  if (std::abs(value) <= kMaxCoordinate) return;
  throw UrdfError("joint '" + joint + "': " + what + " is " + too_large_text(value, unit) +
                  " (lengths are metres, angles radians)");
}

/// Largest value that the motion of a joint takes. A slide goes on where a turn begins again.
double largest_motion(const ChainJoint& joint, const ChainVariable& variable) {
  const bool free = variable.type == JointType::continuous && !joint.prismatic;
  const auto of = motion_between(joint, free ? -kPi : variable.lower, free ? kPi : variable.upper);
  return std::max(std::abs(of.lower), std::abs(of.upper));
}

/// Throws UrdfError, naming the joint, where a length or joint value of the chain, or the chain as
/// a whole, is beyond kMaxCoordinate or not finite.
void check_sizes(const ChainSpec& spec) {
  for (const ChainVariable& variable : spec.variables) {
    if (variable.type == JointType::continuous) continue;
    const char* unit = variable.type == JointType::prismatic ? "m" : "rad";
    for (const double limit : {variable.lower, variable.upper}) {
      check_size(variable.name, "a limit (a joint that turns freely is 'continuous')", limit, unit);
    }
  }
  double length = 0;
  for (const ChainJoint& joint : spec.joints) {
    for (const auto* T : {&joint.before, &joint.after}) {
      const double offset = T->translation().stableNorm();
      check_size(joint.name, "the length of its origin", offset, "m");
      length += offset;
    }
    if (joint.fixed) continue;
    const ChainVariable& variable = spec.variables[static_cast<std::size_t>(joint.variable)];
    const double motion = largest_motion(joint, variable);
    if (motion == kInfinity) {
      throw UrdfError("joint '" + joint.name + "' has no limits, and '" + variable.name +
                      "', which it follows, turns without end: give one of them limits, or hold "
                      "it at a value by locked_joints");
    }
    check_size(joint.name, "its largest value", motion, joint.prismatic ? "m" : "rad");
    if (joint.prismatic) length += motion;
    check_size(joint.name, "the chain's length up to it", length, "m");
  }
  check_size(spec.joints.back().name, "the chain's length up to it", length, "m");
}

class ChainReader {
 public:
  ChainReader(const urdf::ModelInterface& model, RobotOptions& options)
      : model_(model),
        options_(options),
        motions_(check_mimic_curves(model, options.mimic_curves)) {}

  ChainSpec read() {
    check_default_limits(options_);
    const LinkTree tree = make_link_tree(model_);
    spec_.robot_name = tree.robot_name;
    spec_.link_names = tree.links;
    if (options_.base_link.empty()) options_.base_link = model_.getRoot()->name;
    if (options_.tip_link.empty()) options_.tip_link = only_tip(tree);
    for (const auto& [name, value] : options_.locked_joints) {
      find_joint(model_, name, "locked joint '" + name + "' is not in the URDF");
      if (!(std::abs(value) <= kMaxCoordinate)) {
        throw InvalidArgumentError("locked joint '" + name + "': its value is " +
                                   too_large_text(value));
      }
    }

    // Up from the base to the first link that is also above the tip, then down to the tip.
    const auto base_up = path_to_root(find_link(options_.base_link, "base"));
    const auto tip_up = path_to_root(find_link(options_.tip_link, "tip"));
    const auto parted =
        std::mismatch(base_up.rbegin(), base_up.rend(), tip_up.rbegin(), tip_up.rend());
    std::for_each(base_up.begin(), parted.first.base(),
                  [&](const urdf::Link* link) { add_joint(*link->parent_joint, true); });
    std::for_each(parted.second, tip_up.rend(),
                  [&](const urdf::Link* link) { add_joint(*link->parent_joint, false); });

    for (const ChainVariable& variable : spec_.variables) check_limits(variable);
    const std::string chain =
        "the chain from '" + options_.base_link + "' to '" + options_.tip_link + "' has ";
    if (spec_.variables.empty()) {
      throw UrdfError(chain + "no movable joint; choose links with one between them");
    }
    if (spec_.variables.size() > static_cast<std::size_t>(kMaxDof)) {
      throw UrdfError(chain + std::to_string(spec_.variables.size()) + " movable joints; at most " +
                      std::to_string(kMaxDof) + " are possible");
    }
    check_sizes(spec_);
    return std::move(spec_);
  }

 private:
  static std::string only_tip(const LinkTree& tree) {
    if (tree.tips.size() == 1) return tree.tips.front().link;
    std::vector<std::string> links;
    for (const LinkTree::Tip& tip : tree.tips) links.push_back(tip.link);
    throw UrdfError(
        "no tip link is given and the URDF ends in several (LinkTree shows how they "
        "hang together): " +
            list_names(links),
        links);
  }

  const urdf::Link* find_link(const std::string& name, const char* role) const {
    const auto it = model_.links_.find(name);
    if (it != model_.links_.end()) return it->second.get();
    throw_unknown_name(std::string(role) + " link '" + name + "' is not in the URDF", name,
                       spec_.link_names);
  }

  static std::vector<const urdf::Link*> path_to_root(const urdf::Link* link) {
    std::vector<const urdf::Link*> path;
    for (; link != nullptr; link = link->getParent().get()) path.push_back(link);
    return path;
  }

  void add_joint(const urdf::Joint& joint, bool upwards) {
    const LinkJoint read = read_joint(model_, joint, motions_);
    if (!read.moves && joint.type != urdf::Joint::FIXED) {
      throw UrdfError("joint '" + joint.name + "' is " + joint_type_name(joint.type) +
                      "; only revolute, continuous, prismatic and fixed joints can be solved: "
                      "choose a base link behind it");
    }
    ChainJoint& segment = spec_.joints.emplace_back();
    static_cast<Following&>(segment) = read;
    segment.name = read.name;
    segment.link = upwards ? joint.parent_link_name : joint.child_link_name;
    // Parent -> child is origin * motion(q); the way up is its inverse, motion(-q) * origin^-1.
    (upwards ? segment.after : segment.before) = upwards ? read.origin.inverse() : read.origin;
    segment.fixed = !read.moves;
    if (segment.fixed) return;
    segment.axis = (upwards ? -1.0 : 1.0) * read.axis;
    segment.prismatic = read.prismatic;

    const auto locked = options_.locked_joints.find(read.source);
    const auto own_lock = options_.locked_joints.find(joint.name);
    if (own_lock != options_.locked_joints.end()) {
      lock(segment, own_lock->second);
    } else if (locked != options_.locked_joints.end()) {
      check_lock(read, locked->second);
      lock(segment, motion_of(read, locked->second));
    } else {
      segment.variable = variable_of(*model_.joints_.at(read.source));
      narrow_by_follower(joint, read, options_, spec_.variables[segment.variable]);
    }
  }

  /// A curve is known between its ends only.
  static void check_lock(const LinkJoint& joint, double value) {
    if (!joint.curve) return;
    const double lower = joint.curve->lower();
    const double upper = joint.curve->upper();
    if (value >= lower && value <= upper) return;
    throw InvalidArgumentError("locked joint '" + joint.source + "': " + number_text(value) +
                               " is beyond the curve by which '" + joint.name +
                               "' follows it, from " + number_text(lower) + " to " +
                               number_text(upper));
  }

  /// A locked joint is a fixed one: its motion by `value` becomes part of the constant transform.
  static void lock(ChainJoint& segment, double value) {
    segment.before = moved(segment.before, segment.axis, segment.prismatic, value);
    segment.fixed = true;
    segment.is_locked = true;
    segment.locked_at = value;
  }

  int variable_of(const urdf::Joint& source) {
    const auto [place, is_new] =
        places_.try_emplace(&source, static_cast<int>(spec_.variables.size()));
    if (is_new) spec_.variables.push_back(make_variable(source, options_));
    return place->second;
  }

  const urdf::ModelInterface& model_;
  RobotOptions& options_;
  Motions motions_;
  ChainSpec spec_;
  std::map<const urdf::Joint*, int> places_;  ///< of joints among the variables
};

}  // namespace

ChainSpec read_chain(const std::string& urdf_xml, RobotOptions& options) {
  return explain_xacro(urdf_xml, [&] {
    const auto model = parse_urdf(urdf_xml, {options.base_link, options.tip_link});
    return ChainReader(*model, options).read();
  });
}

}  // namespace iksel
