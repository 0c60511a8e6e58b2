// SPDX-License-Identifier: BSD-3-Clause
// Which configurations are free, and at which targets none is.
#include <algorithm>

#include "base/constants.hpp"
#include "scene/scene_data.hpp"

namespace iksel {
namespace {

/// Room for the kernel, of each thread its own, taken once.
struct ThreadRoom {
  std::vector<double> frame, centre;
  std::vector<int> near;

  lanes::SceneRoom show(const lanes::SceneView& view) {
    const auto grow = [](auto& room, int count) {
      if (room.size() < static_cast<std::size_t>(count))
        room.resize(static_cast<std::size_t>(count));
    };
    const int stride = (view.links / lanes::kWidth + 2) * lanes::kWidth;
    grow(frame, lanes::kFrameNumbers * view.bodies);
    grow(centre, 4 * stride);
    grow(near, view.pairs);
    return {frame.data(), centre.data(), stride, near.data(), {}};
  }
};

ThreadRoom& thread_room() {
  thread_local ThreadRoom room;
  return room;
}

/// Frame of a body in the base frame.
Pose frame_at(const lanes::SceneRoom& room, int body) {
  return Pose(Eigen::Map<const Eigen::Matrix4d>(room.frame + lanes::kFrameNumbers * body));
}

/// Whether a ball below a node touches; `found` is then it. `touches` is asked of balls around
/// others, too.
template <class Touches>
bool find_touching(const lanes::SceneView& view, int at, const Touches& touches,
                   lanes::SceneBall& found) {
  const lanes::SceneNode& node = view.node[at];
  for (int k = 0; k < node.count; ++k) {
    const lanes::SceneBall ball{{node.x[k], node.y[k], node.z[k]}, node.radius[k]};
    if (!touches(ball, node.is_leaf)) continue;
    found = ball;
    if (node.is_leaf || find_touching(view, node.first + k, touches, found)) return true;
  }
  return false;
}

}  // namespace

double Scene::Data::find_clearance(const double* q, SceneLook& look) const {
  lanes::SceneView view{};
  arm_.show(view);
  show_obstacles(view);
  view.cleared = look.is_target_clear ? arm_.tip_body() : 0;
  lanes::SceneRoom room = thread_room().show(view);
  room.culprit = look.culprit;
  const double clearance = kernels_.find_clearance(view, q, room);
  look.culprit = room.culprit;
  if (!(clearance > 0) || clouds_.empty()) return clearance;
  return std::min(clearance, clearance_of_points(view, room, look));
}

void Scene::Data::find_free(const double* q, std::size_t count, bool* free) const {
  const auto dof = static_cast<std::size_t>(robot.dof());
  SceneLook look;
  for (std::size_t i = 0; i < count; ++i) free[i] = find_clearance(q + i * dof, look) > 0;
}

double Scene::Data::clearance_of_points(const lanes::SceneView& view, const lanes::SceneRoom& room,
                                        SceneLook& look) const {
  double clearance = kInfinity;
  // Whether a ball of a link touches a cloud's points, or one around its balls may.
  const auto test_of = [&](const Cloud& cloud, int link) {
    const Pose T_cloud_body = Pose(cloud.T_cloud_base) * frame_at(room, view.link[link].body);
    return [&, T_cloud_body](const lanes::SceneBall& ball, bool is_own) {
      const Eigen::Vector3d centre = T_cloud_body * to_vector(ball.centre);
      const double reach = ball.radius - view.smaller + cloud.radius;
      return is_own ? cloud.grid->touches(centre, reach, clearance)
                    : cloud.grid->may_touch(centre, reach);
    };
  };
  if (look.ball && look.cloud < clouds_.size() &&
      test_of(clouds_[look.cloud], look.link)(*look.ball, /*is_own=*/true)) {
    return clearance;
  }
  for (std::size_t c = 0; c < clouds_.size(); ++c) {
    for (int i = 0; i < view.links; ++i) {
      const lanes::SceneLink& link = view.link[i];
      if (link.body == 0 || link.body == view.cleared) continue;
      const auto touches = test_of(clouds_[c], i);
      lanes::SceneBall found{};
      if (!touches(link.around, /*is_own=*/false) ||
          !find_touching(view, link.root, touches, found)) {
        continue;
      }
      look.cloud = c;
      look.link = i;
      look.ball = found;
      return clearance;
    }
  }
  return clearance;
}

bool Scene::Data::touches_at(const Pose& T_base_tip, double position, double rotation) const {
  TargetShape::Bodies bodies;
  lanes::SceneView view{};
  if (!target_shape_.show(T_base_tip, position, rotation, bodies, view)) return false;
  show_obstacles(view);
  lanes::SceneRoom room = thread_room().show(view);
  // The bodies stand still.
  const double q = 0;
  SceneLook look;
  return !(kernels_.find_clearance(view, &q, room) > 0) ||
         !(clearance_of_points(view, room, look) > 0);
}

}  // namespace iksel
