// SPDX-License-Identifier: BSD-3-Clause
// Which configurations are free, in lanes, and at which targets none is.
#include <algorithm>
#include <array>

#include "scene/scene_data.hpp"

namespace iksel {
namespace {

constexpr int kLanes = lanes::kWidth;

/// Room for the kernel, of each thread its own, taken once.
struct ThreadRoom {
  std::vector<double> frame, centre;
  std::vector<unsigned char> placed;

  lanes::SceneRoom show(const lanes::SceneView& view) {
    const auto grow = [](auto& room, int count) {
      if (room.size() < static_cast<std::size_t>(count))
        room.resize(static_cast<std::size_t>(count));
    };
    grow(frame, 12 * kLanes * view.bodies);
    grow(centre, 3 * kLanes * view.balls);
    grow(placed, view.nodes);
    return {frame.data(), centre.data(), placed.data(), {}};
  }
};

ThreadRoom& thread_room() {
  thread_local ThreadRoom room;
  return room;
}

/// Frame of a body in the base frame.
Pose frame_in_lane(const double* frame, int body, int lane) {
  const double* in = frame + 12 * body * kLanes + lane;
  Pose pose = Pose::Identity();
  for (int i = 0; i < 12; ++i) pose(i % 3, i / 3) = in[i * kLanes];
  return pose;
}

/// A ball below a node that touches; -1 if there is none. `may` tells it of balls around others.
template <class May, class Touches>
int find_touching(const lanes::SceneView& view, int node, const May& may, const Touches& touches) {
  const lanes::SceneNode& at = view.node[node];
  if (!may(at.ball)) return -1;
  for (int i = at.first; i < at.first + at.count; ++i) {
    const int found = at.is_leaf ? (touches(i) ? i : -1) : find_touching(view, i, may, touches);
    if (found >= 0) return found;
  }
  return -1;
}

}  // namespace

void Scene::Data::find_clearance_pack(const double* q, int count, double* clearance,
                                      SceneLook& look) const {
  const int dof = robot.dof();
  alignas(64) std::array<double, static_cast<std::size_t>(kMaxDof) * kLanes> packed;
  for (int lane = 0; lane < kLanes; ++lane) {
    // Lanes that nobody asks for do as the first does.
    const double* from = q + (lane < count ? lane : 0) * dof;
    for (int j = 0; j < dof; ++j) packed[static_cast<std::size_t>(j * kLanes + lane)] = from[j];
  }
  lanes::SceneView view{};
  arm_.show(view);
  show_obstacles(view);
  view.cleared = look.is_target_clear ? arm_.tip_body() : 0;
  lanes::SceneRoom room = thread_room().show(view);
  room.culprit = look.culprit;
  alignas(64) std::array<double, kLanes> found;
  kernels_.find_clearance(view, packed.data(), count, room, found.data());
  look.culprit = room.culprit;
  for (int lane = 0; lane < count; ++lane) {
    const double above = found[static_cast<std::size_t>(lane)];
    const bool touches = above > 0 && touches_points(view, room.frame, lane, look);
    clearance[lane] = touches ? 0.0 : above;
  }
}

void Scene::Data::find_clearance(const double* q, std::size_t count, double* clearance,
                                 SceneLook& look) const {
  const auto dof = static_cast<std::size_t>(robot.dof());
  constexpr std::size_t kWidth = lanes::kWidth;
  for (std::size_t i = 0; i < count; i += kWidth) {
    const auto in_pack = static_cast<int>(std::min(kWidth, count - i));
    find_clearance_pack(q + i * dof, in_pack, clearance + i, look);
  }
}

void Scene::Data::find_free(const double* q, std::size_t count, bool* free) const {
  const auto dof = static_cast<std::size_t>(robot.dof());
  constexpr std::size_t kWidth = lanes::kWidth;
  std::array<double, kWidth> clearance{};
  SceneLook look;
  for (std::size_t i = 0; i < count; i += kWidth) {
    const std::size_t in_pack = std::min(kWidth, count - i);
    find_clearance(q + i * dof, in_pack, clearance.data(), look);
    for (std::size_t k = 0; k < in_pack; ++k) free[i + k] = clearance[k] > 0;
  }
}

bool Scene::Data::touches_points(const lanes::SceneView& view, const double* frame, int lane,
                                 SceneLook& look) const {
  const auto touches = [&](const Cloud& cloud, const Pose& T_cloud_body, int ball) {
    const lanes::SceneBall& of = view.ball[ball];
    return cloud.grid->touches(T_cloud_body * Eigen::Map<const Eigen::Vector3d>(of.centre),
                               of.radius - view.smaller + cloud.radius);
  };
  const auto may_touch = [&](const Cloud& cloud, const Pose& T_cloud_body, int ball) {
    const lanes::SceneBall& of = view.ball[ball];
    return cloud.grid->may_touch(T_cloud_body * Eigen::Map<const Eigen::Vector3d>(of.centre),
                                 of.radius - view.smaller + cloud.radius);
  };
  const auto place = [&](const Cloud& cloud, int link) {
    return Pose(cloud.T_cloud_base) * frame_in_lane(frame, view.link[link].body, lane);
  };
  if (look.ball > 0 && look.cloud < clouds_.size()) {
    const Cloud& cloud = clouds_[look.cloud];
    if (touches(cloud, place(cloud, look.link), look.ball)) return true;
  }
  for (std::size_t c = 0; c < clouds_.size(); ++c) {
    const Cloud& cloud = clouds_[c];
    for (int i = 0; i < view.links; ++i) {
      const lanes::SceneLink& link = view.link[i];
      if (link.body == 0 || link.body == view.cleared) continue;
      const Pose T_cloud_body = place(cloud, i);
      const int ball = find_touching(
          view, link.root, [&](int b) { return may_touch(cloud, T_cloud_body, b); },
          [&](int b) { return touches(cloud, T_cloud_body, b); });
      if (ball < 0) continue;
      look.cloud = c;
      look.link = i;
      look.ball = ball;
      return true;
    }
  }
  return false;
}

bool Scene::Data::touches_at(const Pose& T_base_tip, double position, double rotation) const {
  TargetShape::Bodies bodies;
  lanes::SceneView view{};
  if (!target_shape_.show(T_base_tip, position, rotation, bodies, view)) return false;
  show_obstacles(view);
  lanes::SceneRoom room = thread_room().show(view);
  // The bodies stand still.
  alignas(64) const std::array<double, kLanes> q{};
  alignas(64) std::array<double, kLanes> found;
  kernels_.find_clearance(view, q.data(), 1, room, found.data());
  SceneLook look;
  return !(found[0] > 0) || touches_points(view, room.frame, 0, look);
}

}  // namespace iksel
