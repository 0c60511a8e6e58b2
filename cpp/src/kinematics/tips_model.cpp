// SPDX-License-Identifier: BSD-3-Clause
#include "kinematics/tips_model.hpp"

#include <algorithm>
#include <utility>

#include "base/hash.hpp"
#include "base/message_text.hpp"
#include "iksel/error.hpp"

namespace iksel {

TipsModel::TipsModel(const std::string& urdf_in, const RobotOptions& options_in)
    : RobotModel(urdf_in, options_in) {
  check_options();
  tip_links = options.tip_links;
  options.tcps.resize(tip_links.size(), StoredPose::Identity());
  Hash64 hasher;
  unit = 0;
  for (std::size_t i = 0; i < tip_links.size(); ++i) {
    RobotOptions of_chain = options_between(options.base_link, tip_links[i]);
    of_chain.tcp = options.tcps[i];
    const Robot chain = Robot::from_urdf_string(urdf_in, of_chain);
    options.base_link = chain.base_link();
    joints_of_tip.push_back(add_joints(chain.model()));
    tips.push_back({{chain, joints_of_tip.back()}, std::nullopt, std::nullopt});
    hasher.add(chain.chain_hash());
    unit = std::max(unit, chain.model().unit);
  }
  const ChainModel& first = tips.front().chain.model();
  urdf = first.urdf;
  name = first.name;
  link_names = first.link_names;
  if (!options.coupled_limits.empty()) couple_joints();
  hash = hasher.value();
  find_shared();
  for (Tip& tip : tips) split(tip);
}

Jacobians TipsModel::jacobians(const double* q) const {
  const JointVector all = Eigen::Map<const Eigen::VectorXd>(q, dof);
  Jacobians out = Jacobians::Zero(6 * tip_count(), dof);
  Jacobian J;
  for (int i = 0; i < tip_count(); ++i) {
    const ChainPart& chain = tip(i).chain;
    chain.model().fk_jacobian(picked(all, chain.joints).data(), J);
    put_columns(J, chain.joints, out.middleRows<6>(6 * i));
  }
  return out;
}

void TipsModel::couple_joints() {
  ChainSpec all;
  for (const Tip& tip : tips) {
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
  for (Tip& tip : tips) tip.chain.robot = coupled(tip.chain.robot);
}

Robot TipsModel::coupled(const Robot& part) const {
  const ChainModel& model = part.model();
  const auto has = [&](const std::string& wanted) {
    return model.joints.find(wanted) >= 0 ||
           std::any_of(model.spec.joints.begin(), model.spec.joints.end(), [&](const auto& joint) {
             return joint.name == wanted && joint.has_value();
           });
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

void TipsModel::check_options() const {
  if (!options.tip_link.empty()) {
    throw InvalidArgumentError("tip_link: '" + options.tip_link +
                               "' is given, and tip_links too; give one of them");
  }
  if (options.tcp.matrix() != StoredPose::Identity().matrix()) {
    throw InvalidArgumentError("tcp: with several tips each has its own; give tcps");
  }
  const std::size_t count = options.tip_links.size();
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

std::vector<int> TipsModel::add_joints(const ChainModel& model) {
  const JointSpace& chain = model.joints;
  std::vector<int> places;
  for (int j = 0; j < model.dof; ++j) {
    const int place = joints.find(chain.name(j));
    places.push_back(place < 0 ? dof : place);
    if (place < 0) {
      if (dof == kMaxDof) {
        throw UrdfError("the chains from '" + options.base_link + "' to " +
                        list_names(options.tip_links) + " have more than " +
                        std::to_string(kMaxDof) + " movable joints together");
      }
      const auto i = static_cast<std::size_t>(j);
      add_joint(model.spec.variables[i], chain.repeats[i]);
      continue;
    }
    // A joint that follows this one on another chain may narrow its limits there.
    joints.lower[place] = std::max(joints.lower[place], chain.lower[j]);
    joints.upper[place] = std::min(joints.upper[place], chain.upper[j]);
    if (joints.type(place) == JointType::continuous) {
      joints.types[static_cast<std::size_t>(place)] = chain.type(j);
    }
    if (!chain.repeats[static_cast<std::size_t>(j)]) {
      joints.repeats[static_cast<std::size_t>(place)] = false;
    }
    if (joints.lower[place] >= joints.upper[place]) {
      throw UrdfError("joint '" + chain.name(j) +
                      "': the joints that follow it on the chains to several tips leave nothing "
                      "between its limits");
    }
  }
  return places;
}

void TipsModel::find_shared() {
  for (int j = 0; j < dof; ++j) {
    const auto moves = [j](const Tip& tip) {
      return std::count(tip.chain.joints.begin(), tip.chain.joints.end(), j) > 0;
    };
    if (std::count_if(tips.begin(), tips.end(), moves) > 1) shared.push_back(j);
  }
}

RobotOptions TipsModel::options_between(const std::string& base, const std::string& tip) const {
  RobotOptions between;
  between.base_link = base;
  between.tip_link = tip;
  between.locked_joints = options.locked_joints;
  between.soft_limits = options.soft_limits;
  between.default_limits = options.default_limits;
  between.mimic_curves = options.mimic_curves;
  return between;
}

void TipsModel::split(Tip& tip) const {
  const std::vector<ChainJoint>& chain = tip.chain.model().spec.joints;
  const auto is_of_stem = [&](const ChainJoint& joint) {
    return !joint.fixed &&
           std::binary_search(shared.begin(), shared.end(),
                              tip.chain.joints[static_cast<std::size_t>(joint.variable)]);
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
  const auto make_part = [&](const RobotOptions& of_part) {
    const Robot part = Robot::from_urdf_string(urdf, of_part);
    std::vector<int> places;
    for (const std::string& each : part.joint_names()) places.push_back(joints.find(each));
    return ChainPart{coupled(part), places};
  };
  tip.stem = make_part(options_between(options.base_link, last->link));
  RobotOptions of_arm = options_between(last->link, tip.chain.robot.tip_link());
  of_arm.tcp = tip.chain.robot.tcp();
  tip.arm = make_part(of_arm);
}

}  // namespace iksel
