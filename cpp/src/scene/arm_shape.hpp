// SPDX-License-Identifier: BSD-3-Clause
// An arm as spheres on the bodies that its joints move.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "iksel/scene.hpp"
#include "kinematics/link_poses.hpp"
#include "scene/link_table.hpp"
#include "simd/scene_types.hpp"

namespace iksel {

/// A body's frame in its parent's, where its joint does not move it.
inline Pose frame_of(const lanes::SceneBody& body) {
  Pose frame = Pose::Identity();
  frame.linear() << to_vector(body.x), to_vector(body.y), to_vector(body.z);
  frame.translation() = to_vector(body.p);
  return frame;
}

/// The body of a frame in that of another, and no joint; of the base, which has no parent, by
/// default.
inline lanes::SceneBody body_at(const Pose& frame = Pose::Identity(), int parent = -1) {
  lanes::SceneBody body{};
  copy_vector(frame.linear().col(0), body.x);
  copy_vector(frame.linear().col(1), body.y);
  copy_vector(frame.linear().col(2), body.z);
  copy_vector(frame.translation(), body.p);
  body.parent = parent;
  return body;
}

class ArmShape {
 public:
  /// Throws as Scene.
  ArmShape(const Robot& robot, const RobotSpheres& spheres,
           const std::map<std::string, double>& other_joints);

  /// Adds an object of a link that there is; it touches all links and objects but those named and
  /// those that move with it.
  void attach(const std::string& name, const AttachedObject& object);

  /// Sets what of a view belongs to the arm; it holds as long as this is not changed.
  void show(lanes::SceneView& view) const;

  /// Spheres of each link or object in the base frame, where the URDF's links are.
  [[nodiscard]] std::vector<std::vector<Sphere>> spheres_at(
      const std::vector<Pose>& T_base_link) const;

  /// The body that the tip link is on, and T_tip_body.
  [[nodiscard]] int tip_body() const { return tip_body_; }
  [[nodiscard]] Pose tip_to_body() const { return Pose(T_body_tip_).inverse(); }

  /// Of each of the table's links, the name of the link or object.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] const std::vector<lanes::SceneBody>& bodies() const { return bodies_; }
  /// Spheres of the table's links, in their bodies' frames.
  [[nodiscard]] const std::vector<Sphere>& spheres(std::size_t link) const {
    return spheres_[link];
  }
  [[nodiscard]] const std::vector<lanes::SceneLink>& links() const { return table_.links(); }
  [[nodiscard]] const std::vector<lanes::ScenePair>& pairs() const { return table_.pairs(); }

 private:
  /// Where a link of the URDF is on its body.
  struct Place {
    int body;
    Pose T_body_link;
  };
  void make_bodies(const Robot& robot, const LinkPoses& links);
  /// The body that a joint moves, whose part that does not move is `origin` on another.
  int add_body(const LinkPoses::Step& step, int parent, const Pose& origin);
  void add(const std::string& name, const Place& place, const std::vector<Sphere>& spheres);
  /// Of a link that there is.
  [[nodiscard]] const Place& place_of(const std::string& link) const;
  /// Index of a link or object with spheres; -1 if there is none.
  [[nodiscard]] int find(const std::string& name) const;

  std::vector<std::string> link_names_;  ///< of the URDF
  std::vector<Place> places_;
  int tip_body_ = 0;
  StoredPose T_body_tip_;
  std::vector<lanes::SceneBody> bodies_;
  std::vector<std::shared_ptr<const MotionCurve>> curves_;  ///< of the bodies
  std::vector<std::string> names_;
  std::vector<std::vector<Sphere>> spheres_;
  LinkTable table_;
};

}  // namespace iksel
