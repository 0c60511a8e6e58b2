// SPDX-License-Identifier: BSD-3-Clause
#include "tree/tree_model.hpp"

#include <algorithm>
#include <utility>

#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "iksel/link_tree.hpp"
#include "kinematics/coupled_limits.hpp"

namespace iksel {
namespace {

/// The link that a joint leads to on the way to the tip: its child, or where the way goes up from
/// the base its parent.
std::string link_behind(const LinkTree& tree, const std::string& joint,
                        const std::vector<ChainJoint>& chain, std::size_t index) {
  const auto find = [&](const std::string& name) {
    return std::find_if(tree.joints.begin(), tree.joints.end(),
                        [&](const LinkTreeJoint& each) { return each.name == name; });
  };
  const auto at = find(joint);
  // The next joint hangs on the link behind this one.
  const auto next = find(chain[index + 1].name);
  const bool downwards = at->child_link == next->parent_link || at->child_link == next->child_link;
  return downwards ? at->child_link : at->parent_link;
}

/// Appends joint j of `from`.
void append_joint(const JointSpace& from, int j, JointSpace& to) {
  const Eigen::Index n = to.dof();
  to.names.push_back(from.name(j));
  to.types.push_back(from.type(j));
  for (auto [values, source] :
       {std::make_pair(&to.lower, &from.lower), std::make_pair(&to.upper, &from.upper),
        std::make_pair(&to.velocity, &from.velocity)}) {
    values->conservativeResize(n + 1);
    (*values)[n] = (*source)[j];
  }
}

}  // namespace

TreeModel::TreeModel(const std::string& urdf, const TreeOptions& options_in) : options(options_in) {
  check_options();
  options.tcps.resize(options.tip_links.size(), StoredPose::Identity());
  for (std::size_t i = 0; i < options.tip_links.size(); ++i) {
    RobotOptions of_chain = options_between(options.base_link, options.tip_links[i]);
    of_chain.tcp = options.tcps[i];
    const Robot chain = Robot::from_urdf_string(urdf, of_chain);
    options.base_link = chain.base_link();
    tips.push_back({{chain, add_joints(chain.model().joints)}, std::nullopt, std::nullopt});
  }
  if (!options.coupled_limits.empty()) couple_joints(urdf);
  find_shared();
  for (TreeTip& tip : tips) split(tip, urdf);
}

void TreeModel::couple_joints(const std::string& urdf) {
  ChainSpec all;
  for (const TreeTip& tip : tips) {
    for (ChainJoint joint : tip.chain.model().spec.joints) {
      const bool known = std::any_of(all.joints.begin(), all.joints.end(),
                                     [&](const auto& other) { return other.name == joint.name; });
      if (known) continue;
      if (!joint.fixed) {
        joint.variable = tip.chain.joints[static_cast<std::size_t>(joint.variable)];
      }
      all.joints.push_back(std::move(joint));
    }
  }
  add_coupled_limits(options.coupled_limits, all, joints);
  for (TreeTip& tip : tips) tip.chain.robot = coupled(tip.chain.robot, urdf);
}

Robot TreeModel::coupled(const Robot& part, const std::string& urdf) const {
  const ChainModel& model = part.model();
  const auto has = [&](const std::string& name) {
    const auto& names = model.joints.names;
    return std::find(names.begin(), names.end(), name) != names.end() ||
           std::any_of(model.spec.joints.begin(), model.spec.joints.end(),
                       [&](const auto& joint) { return joint.name == name && joint.has_value(); });
  };
  RobotOptions of_part = model.options;
  for (const CoupledLimit& limit : options.coupled_limits) {
    const auto& all = limit.coefficients;
    const bool has_all =
        std::all_of(all.begin(), all.end(), [&](const auto& each) { return has(each.first); });
    if (has_all) of_part.coupled_limits.push_back(limit);
  }
  return of_part.coupled_limits.empty() ? part : Robot::from_urdf_string(urdf, of_part);
}

void TreeModel::check_options() const {
  const std::size_t count = options.tip_links.size();
  if (count == 0) throw InvalidArgumentError("tip_links: expected one link or more, got none");
  if (count > static_cast<std::size_t>(kMaxTips)) {
    throw InvalidArgumentError("tip_links: " + std::to_string(count) + " links; at most " +
                               std::to_string(kMaxTips) + " are possible");
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::string& link = options.tip_links[i];
    const auto at = static_cast<std::ptrdiff_t>(i);
    if (link.empty()) throw_invalid("tip_links", at, "expected the name of a link, got ''");
    const auto end = options.tip_links.begin() + at;
    if (std::find(options.tip_links.begin(), end, link) != end) {
      throw_invalid("tip_links", at, "'" + link + "' is there already; a link can be a tip once");
    }
  }
  if (!options.tcps.empty() && options.tcps.size() != count) {
    throw InvalidArgumentError("tcps: expected one for each of " + std::to_string(count) +
                               " tips, or none, got " + std::to_string(options.tcps.size()));
  }
}

std::vector<int> TreeModel::add_joints(const JointSpace& chain) {
  std::vector<int> places;
  for (int j = 0; j < chain.dof(); ++j) {
    const auto known = std::find(joints.names.begin(), joints.names.end(), chain.name(j));
    const int place = static_cast<int>(known - joints.names.begin());
    places.push_back(place);
    if (known == joints.names.end()) {
      if (joints.dof() == kMaxDof) {
        throw UrdfError("the chains from '" + options.base_link + "' to " +
                        list_names(options.tip_links) + " have more than " +
                        std::to_string(kMaxDof) + " movable joints together");
      }
      append_joint(chain, j, joints);
      continue;
    }
    // A joint that follows this one on another chain may narrow its limits there.
    joints.lower[place] = std::max(joints.lower[place], chain.lower[j]);
    joints.upper[place] = std::min(joints.upper[place], chain.upper[j]);
    if (joints.lower[place] > joints.upper[place]) {
      throw UrdfError("joint '" + chain.name(j) +
                      "': the joints that follow it on the chains to several tips leave it no "
                      "value between its limits");
    }
  }
  return places;
}

void TreeModel::find_shared() {
  for (int j = 0; j < dof(); ++j) {
    const auto moves = [j](const TreeTip& tip) {
      return std::count(tip.chain.joints.begin(), tip.chain.joints.end(), j) > 0;
    };
    if (std::count_if(tips.begin(), tips.end(), moves) > 1) shared.push_back(j);
  }
}

bool TreeModel::is_shared(int joint) const {
  return std::binary_search(shared.begin(), shared.end(), joint);
}

std::vector<int> TreeModel::places_of(const Robot& part) const {
  std::vector<int> places;
  for (const std::string& name : part.joint_names()) {
    places.push_back(static_cast<int>(std::find(joints.names.begin(), joints.names.end(), name) -
                                      joints.names.begin()));
  }
  return places;
}

RobotOptions TreeModel::options_between(const std::string& base, const std::string& tip) const {
  RobotOptions between;
  between.base_link = base;
  between.tip_link = tip;
  between.locked_joints = options.locked_joints;
  between.soft_limits = options.soft_limits;
  between.default_limits = options.default_limits;
  return between;
}

void TreeModel::split(TreeTip& tip, const std::string& urdf) const {
  const std::vector<ChainJoint>& chain = tip.chain.model().spec.joints;
  const auto is_of_stem = [&](const ChainJoint& joint) {
    return !joint.fixed && is_shared(tip.chain.joints[static_cast<std::size_t>(joint.variable)]);
  };
  const auto is_of_arm = [&](const ChainJoint& joint) {
    return !joint.fixed && !is_of_stem(joint);
  };
  const auto first_own = std::find_if(chain.begin(), chain.end(), is_of_arm);
  if (std::none_of(chain.begin(), chain.end(), is_of_stem)) {
    tip.arm = tip.chain;
    return;
  }
  if (first_own == chain.end() || std::any_of(first_own, chain.end(), is_of_stem)) return;
  auto last = first_own;
  while (!is_of_stem(*last)) --last;
  const std::string link = link_behind(LinkTree::from_urdf_string(urdf), last->name, chain,
                                       static_cast<std::size_t>(last - chain.begin()));
  const Robot stem = Robot::from_urdf_string(urdf, options_between(options.base_link, link));
  RobotOptions of_arm = options_between(link, tip.chain.robot.tip_link());
  of_arm.tcp = tip.chain.robot.tcp();
  const Robot arm = Robot::from_urdf_string(urdf, of_arm);
  tip.stem = TreePart{coupled(stem, urdf), places_of(stem)};
  tip.arm = TreePart{coupled(arm, urdf), places_of(arm)};
}

}  // namespace iksel
