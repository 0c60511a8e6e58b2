// SPDX-License-Identifier: BSD-3-Clause
// An arm as spheres on the bodies that its joints move.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "iksel/scene.hpp"
#include "kinematics/link_poses.hpp"
#include "simd/scene_types.hpp"

namespace iksel {

inline void copy_vector(const Eigen::Vector3d& from, double (&to)[3]) {
  std::copy_n(from.data(), 3, to);
}

class ArmShape {
 public:
  /// Throws as Scene.
  ArmShape(const Robot& robot, const RobotSpheres& spheres,
           const std::map<std::string, double>& other_joints);

  /// Adds an object, which touches all links and objects but those named and those that move with
  /// it. Throws UnknownNameError.
  void attach(const std::string& name, const AttachedObject& object);
  /// Throws UnknownNameError about a link that the URDF lacks.
  void check_link(const std::string& link, const char* argument) const;

  /// Sets what of a view belongs to the arm; it holds as long as this is not changed.
  void show(lanes::SceneView& view) const;

  /// Of each entry of `links`, the name of the link or object.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] const std::vector<lanes::SceneLink>& links() const { return links_; }
  [[nodiscard]] const std::vector<lanes::SceneBall>& balls() const { return balls_; }
  [[nodiscard]] const std::vector<lanes::ScenePair>& pairs() const { return pairs_; }

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
  /// Index of a link or object with spheres; -1 if there is none.
  [[nodiscard]] int find(const std::string& name) const;

  std::vector<std::string> link_names_;  ///< of the URDF
  std::vector<Place> places_;
  std::vector<lanes::SceneBody> bodies_;
  std::vector<std::string> names_;
  std::vector<lanes::SceneLink> links_;
  std::vector<lanes::SceneBall> balls_;
  std::vector<lanes::ScenePair> pairs_;
};

}  // namespace iksel
