// SPDX-License-Identifier: BSD-3-Clause
#include "scene/arm_shape.hpp"

#include <algorithm>
#include <utility>

#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "kinematics/chain_model.hpp"

namespace iksel {
namespace {

/// T_base_root, which must not depend on the arm's joints.
Pose root_in_base(const Robot& robot, const LinkPoses& links) {
  Pose T_root_base = Pose::Identity();
  for (int i = static_cast<int>(links.base()); i > 0;) {
    const LinkPoses::Step& step = links.steps()[static_cast<std::size_t>(i)];
    if (step.variable >= 0) {
      throw InvalidArgumentError("scene: joint '" + step.joint.name +
                                 "' of the arm moves its base link '" + robot.base_link() +
                                 "' against the root of the URDF");
    }
    T_root_base = step.joint.origin * T_root_base;
    i = step.joint.parent;
  }
  return T_root_base.inverse();
}

}  // namespace

ArmShape::ArmShape(const Robot& robot, const RobotSpheres& spheres,
                   const std::map<std::string, double>& other_joints)
    : link_names_(robot.link_names()) {
  if (spheres.links.empty()) {
    throw InvalidArgumentError(
        "spheres: there are none; make them from a URDF's collision geometry, or read them from a "
        "sphere file (in Python iksel.spheres)");
  }
  spheres.validate();
  const RobotModel& model = robot.all();
  model.link_poses->with(model, other_joints,
                         [&](const LinkPoses& links) { make_bodies(robot, links); });
  tip_body_ = place_of(robot.tip_links().front()).body;
  T_body_tip_ = place_of(robot.tip_links().front()).T_body_link;
  for (const auto& [name, of_link] : spheres.links) {
    if (std::find(link_names_.begin(), link_names_.end(), name) != link_names_.end()) continue;
    throw_unknown_name("spheres: the URDF has no link '" + name + "'", name, link_names_);
  }
  // What is on one body stands together: the kernel places it in lanes.
  for (int body = 0; body < static_cast<int>(bodies_.size()); ++body) {
    for (const auto& [name, of_link] : spheres.links) {
      const Place& place = place_of(name);
      if (place.body == body) add(name, place, of_link);
    }
  }
  for (const auto& [a, b] : spheres.pairs) {
    const lanes::ScenePair pair{find(a), find(b)};
    const auto body = [&](int i) { return links()[static_cast<std::size_t>(i)].body; };
    // What does not move against each other touches always or never.
    if (body(pair.a) != body(pair.b)) table_.add_pair(pair);
  }
}

void ArmShape::make_bodies(const Robot& robot, const LinkPoses& links) {
  bodies_.push_back(body_at());
  places_.push_back({0, root_in_base(robot, links)});
  const auto& steps = links.steps();
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const Place& parent = places_[static_cast<std::size_t>(steps[i].joint.parent)];
    const Pose origin = parent.T_body_link * steps[i].joint.origin;
    if (steps[i].variable < 0) {
      places_.push_back({parent.body, origin});
      continue;
    }
    // The body's z axis is the joint's.
    Pose turn = Pose::Identity();
    turn.linear() =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), steps[i].joint.axis)
            .toRotationMatrix();
    const int body = add_body(steps[i], parent.body, origin * turn);
    places_.push_back({body, turn.inverse()});
  }
}

int ArmShape::add_body(const LinkPoses::Step& step, int parent, const Pose& origin) {
  if (bodies_.size() == lanes::kMaxBodies) {
    throw InvalidArgumentError("scene: more than " + std::to_string(lanes::kMaxBodies) +
                               " links of the robot move with the arm");
  }
  lanes::SceneBody body = body_at(origin, parent);
  body.multiplier = step.joint.multiplier;
  body.offset = step.joint.offset;
  body.variable = step.variable;
  body.prismatic = step.joint.prismatic;
  body.curve = step.joint.curve.get();
  if (step.joint.curve) curves_.push_back(step.joint.curve);
  bodies_.push_back(body);
  return static_cast<int>(bodies_.size()) - 1;
}

void ArmShape::add(const std::string& name, const Place& place,
                   const std::vector<Sphere>& spheres) {
  std::vector<Sphere> placed = spheres;
  for (Sphere& sphere : placed) sphere.centre = place.T_body_link * sphere.centre;
  names_.push_back(name);
  table_.add(place.body, placed);
  spheres_.push_back(std::move(placed));
}

void ArmShape::attach(const std::string& name, const AttachedObject& object) {
  add(name, place_of(object.link), object.spheres);
  const int added = static_cast<int>(links().size()) - 1;
  for (int i = 0; i < added; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const bool may = std::find(object.may_touch.begin(), object.may_touch.end(), names_[k]) !=
                     object.may_touch.end();
    if (!may && links()[k].body != links().back().body) table_.add_pair({i, added});
  }
}

const ArmShape::Place& ArmShape::place_of(const std::string& link) const {
  const auto at = std::find(link_names_.begin(), link_names_.end(), link);
  return places_[static_cast<std::size_t>(at - link_names_.begin())];
}

int ArmShape::find(const std::string& name) const {
  const auto at = std::find(names_.begin(), names_.end(), name);
  return at == names_.end() ? -1 : static_cast<int>(at - names_.begin());
}

std::vector<std::vector<Sphere>> ArmShape::spheres_at(const std::vector<Pose>& T_base_link) const {
  std::vector<Pose> frame(bodies_.size());
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Place& place = places_[i];
    frame[static_cast<std::size_t>(place.body)] = T_base_link[i] * place.T_body_link.inverse();
  }
  std::vector<std::vector<Sphere>> placed = spheres_;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const Pose& body = frame[static_cast<std::size_t>(links()[i].body)];
    for (Sphere& sphere : placed[i]) sphere.centre = body * sphere.centre;
  }
  return placed;
}

void ArmShape::show(lanes::SceneView& view) const {
  table_.show(view);
  view.bodies = static_cast<int>(bodies_.size());
  view.body = bodies_.data();
}

}  // namespace iksel
