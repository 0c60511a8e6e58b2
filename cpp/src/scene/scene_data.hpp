// SPDX-License-Identifier: BSD-3-Clause
// What a Scene holds, and the check of configurations.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "iksel/scene.hpp"
#include "scene/arm_shape.hpp"
#include "scene/point_grid.hpp"
#include "scene/target_shape.hpp"
#include "simd/kernels.hpp"
#include "simd/scene_types.hpp"

namespace iksel {

/// What is known while configurations are looked at one after the other, which mostly fail by the
/// same.
struct SceneLook {
  /// Whether nothing touches that is where it is in all solutions (TargetShape).
  bool is_target_clear = false;
  lanes::SceneCulprit culprit;
  /// Of the points: the ball that touched some, if one did, and of which link.
  std::size_t cloud = 0;
  int link = 0;
  std::optional<lanes::SceneBall> ball;
};

struct Scene::Data {
  /// Throws as Scene.
  Data(const Robot& robot_in, const RobotSpheres& spheres_in,
       const std::map<std::string, double>& other_joints_in)
      : robot(robot_in),
        spheres(spheres_in),
        other_joints(other_joints_in),
        bare_(robot, spheres, other_joints),
        arm_(bare_),
        target_shape_(arm_),
        kernels_(lanes::choose_kernels()) {}

  /// Lays out the obstacles for the kernel; of a cloud the grid, if there is none yet.
  void lay_out();
  /// Puts what is attached on the arm.
  void attach_all();
  /// Throws unless nothing of another kind has that name.
  void check_name(const std::string& name, bool is_obstacle) const;

  /// The clearance (scene_types.hpp) of a configuration.
  double find_clearance(const double* q, SceneLook& look) const;
  /// Whether something certainly touches in all solutions that bring the tip link to a pose, within
  /// those tolerances [m, rad].
  [[nodiscard]] bool touches_at(const Pose& T_base_tip, double position, double rotation) const;
  /// Which of `count` configurations, one after the other, are free.
  void find_free(const double* q, std::size_t count, bool* free) const;
  [[nodiscard]] std::vector<Contact> contacts(const JointVector& q) const;

  Robot robot;
  RobotSpheres spheres;
  std::map<std::string, double> other_joints;
  std::map<std::string, Obstacle> obstacles;
  std::map<std::string, AttachedObject> attached;

  /// Points, seen from a cloud's frame.
  struct Cloud {
    std::shared_ptr<const PointGrid> grid;
    StoredPose T_cloud_base;
    double radius;  ///< with its margin [m]
  };

 private:
  void add(const Obstacle& obstacle);
  void show_obstacles(lanes::SceneView& view) const;
  /// The clearance of what a view shows from the points, with the bodies where they are in `room`;
  /// infinite where nothing touches one.
  double clearance_of_points(const lanes::SceneView& view, const lanes::SceneRoom& room,
                             SceneLook& look) const;
  /// Of spheres in the base frame.
  void add_contacts(std::size_t link, const std::vector<Sphere>& placed,
                    std::vector<Contact>& found) const;
  void add_pair_contacts(const std::vector<std::vector<Sphere>>& placed,
                         std::vector<Contact>& found) const;

  ArmShape bare_;  ///< without what is attached
  ArmShape arm_;
  TargetShape target_shape_;
  const lanes::LaneKernels& kernels_;
  std::vector<lanes::SceneBlock> blocks_;
  std::vector<lanes::SceneCylinder> cylinders_;
  std::vector<lanes::ScenePlane> planes_;
  std::vector<Cloud> clouds_;
  /// By the points that they are made of, which they keep alive.
  std::map<std::shared_ptr<const PointCloud>, std::shared_ptr<const PointGrid>> grids_;
};

}  // namespace iksel
