// SPDX-License-Identifier: BSD-3-Clause
#include "scene/target_shape.hpp"

#include <algorithm>
#include <utility>

#include "base/constants.hpp"

namespace iksel {
namespace {

/// Keeps of each ball what stays in its place while a body's joint turns, the ball on the axis that
/// it holds; nothing where the joint slides. Balls go from the body's frame to its parent's, or,
/// `to_body`, the other way.
void hold_still(const lanes::SceneBody& body, bool to_body, std::vector<Sphere>& spheres) {
  if (body.prismatic) spheres.clear();
  const Pose frame = to_body ? frame_of(body).inverse() : frame_of(body);
  for (Sphere& sphere : spheres) {
    if (to_body) sphere.centre = frame * sphere.centre;
    sphere.radius -= sphere.centre.head<2>().norm();
    sphere.centre.head<2>().setZero();
    if (!to_body) sphere.centre = frame * sphere.centre;
  }
  spheres.erase(std::remove_if(spheres.begin(), spheres.end(),
                               [](const Sphere& sphere) { return !(sphere.radius > 0); }),
                spheres.end());
}

}  // namespace

TargetShape::TargetShape(const ArmShape& arm)
    : T_tip_body_(arm.tip_to_body()), smallest_(kInfinity) {
  const auto& bodies = arm.bodies();
  for (int b = arm.tip_body(); b > 0; b = bodies[static_cast<std::size_t>(b)].parent) {
    to_tip_.push_back(b);
  }
  const std::size_t count = arm.links().size();
  std::vector<int> from_base(count, -1);
  std::vector<int> from_tip(count, -1);
  for (std::size_t i = 0; i < count; ++i) {
    from_base[i] = add(seen_from_base(arm, i));
    from_tip[i] = add(seen_from_tip(arm, i));
  }
  for (const lanes::ScenePair& pair : arm.pairs()) {
    const auto a = static_cast<std::size_t>(pair.a);
    const auto b = static_cast<std::size_t>(pair.b);
    if (from_base[a] >= 0 && from_tip[b] >= 0) table_.add_pair({from_base[a], from_tip[b]});
    if (from_base[b] >= 0 && from_tip[a] >= 0) table_.add_pair({from_base[b], from_tip[a]});
  }
}

TargetShape::Part TargetShape::seen_from_base(const ArmShape& arm, std::size_t link) const {
  Part part{0, arm.spheres(link)};
  const auto& bodies = arm.bodies();
  for (int b = arm.links()[link].body; b > 0; b = bodies[static_cast<std::size_t>(b)].parent) {
    hold_still(bodies[static_cast<std::size_t>(b)], /*to_body=*/false, part.spheres);
  }
  return part;
}

TargetShape::Part TargetShape::seen_from_tip(const ArmShape& arm, std::size_t link) const {
  const auto at = std::find(to_tip_.begin(), to_tip_.end(), arm.links()[link].body);
  if (at == to_tip_.end()) return {};
  Part part{1, arm.spheres(link)};
  for (auto next = at; next != to_tip_.begin();) {
    hold_still(arm.bodies()[static_cast<std::size_t>(*--next)], /*to_body=*/true, part.spheres);
  }
  return part;
}

int TargetShape::add(Part part) {
  if (part.spheres.empty()) return -1;
  for (const Sphere& sphere : part.spheres) {
    smallest_ = std::min(smallest_, sphere.radius);
    if (part.body == 1) reach_ = std::max(reach_, (T_tip_body_ * sphere.centre).norm());
  }
  return table_.add(part.body, std::move(part.spheres));
}

bool TargetShape::show(const Pose& T_base_tip, double position, double rotation, Bodies& bodies,
                       lanes::SceneView& view) const {
  table_.show(view);
  view.smaller = position + rotation * reach_;
  if (!(smallest_ > view.smaller)) return false;
  bodies = {body_at(), body_at(T_base_tip * Pose(T_tip_body_), 0)};
  view.bodies = static_cast<int>(bodies.size());
  view.body = bodies.data();
  return true;
}

}  // namespace iksel
