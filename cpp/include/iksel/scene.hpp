// SPDX-License-Identifier: BSD-3-Clause
// What an arm may collide with: obstacles around it, objects that it carries, and itself.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "iksel/export.hpp"
#include "iksel/robot.hpp"
#include "iksel/robot_spheres.hpp"
#include "iksel/types.hpp"

namespace iksel {

/// Points in rows, (N, 3) [m].
using PointCloud = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor | Eigen::DontAlign>;

/// A shape at a pose, as a Scene holds it.
struct IKSEL_EXPORT Obstacle {
  enum class Shape {
    sphere,      ///< around the origin of its frame
    box,         ///< centred at the origin, edges along the axes
    capsule,     ///< all that is within `radius` of a segment on the z axis, centred at the origin
    cylinder,    ///< around the z axis, centred at the origin
    half_space,  ///< all below the plane z = 0
    points,      ///< a ball around each point
  };
  /// What it is: sphere, box, capsule, cylinder, half_space or points.
  Shape shape = Shape::sphere;
  double radius = 0;                               ///< sphere, capsule, cylinder, points [m]
  double length = 0;                               ///< capsule: of the segment; cylinder [m]
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< box: edges [m]
  std::shared_ptr<const PointCloud> points;        ///< in the obstacle's frame [m]
  /// T_base_obstacle.
  StoredPose pose = StoredPose::Identity();
  /// The arm keeps this far away [m].
  double margin = 0;

  static Obstacle sphere(double radius, const Pose& T_base_obstacle, double margin = 0);
  static Obstacle box(const Eigen::Vector3d& size, const Pose& T_base_obstacle, double margin = 0);
  static Obstacle capsule(double radius, double length, const Pose& T_base_obstacle,
                          double margin = 0);
  static Obstacle cylinder(double radius, double length, const Pose& T_base_obstacle,
                           double margin = 0);
  static Obstacle half_space(const Pose& T_base_obstacle, double margin = 0);
  static Obstacle point_cloud(PointCloud points, double radius, const Pose& T_base_obstacle,
                              double margin = 0);

  /// Throws InvalidArgumentError naming the first number that is no good: not finite, beyond
  /// kMaxCoordinate, or a length below what it may be.
  void validate() const;
};

/// Lower-case name of a shape.
IKSEL_EXPORT const char* to_string(Obstacle::Shape shape);

/// An object that a link carries.
struct IKSEL_EXPORT AttachedObject {
  /// The link that it moves with.
  std::string link;
  /// In that link's frame.
  std::vector<Sphere> spheres;
  /// Links and other objects that it may touch besides; what moves with the link always may.
  std::vector<std::string> may_touch;
};

/// Two things that touch.
struct Contact {
  std::string link;   ///< a link of the robot or an attached object
  std::string other;  ///< what it touches: an obstacle, a link or an attached object
  bool is_obstacle;   ///< whether `other` is an obstacle
  double depth;       ///< how far they would have to part, margins included [m]; 0 or more
};

/// A robot's body and what it may not touch. A value: copies share what neither of them changes,
/// and one does not see what is done to another. Safe to use from many threads at once as long as
/// none changes it.
///
/// The arm is where its spheres are, so that what is free has no contact as long as they cover it.
/// Links that no joint of the arm moves are not held against obstacles, which stand as still.
class IKSEL_EXPORT Scene {
 public:
  /// `other_joints` as in Robot::link_poses. Throws InvalidArgumentError if there are no spheres,
  /// one of them is no good, or the base link moves against the root of the URDF; UnknownNameError
  /// about a link that the URDF lacks, and as Robot::link_poses.
  Scene(const Robot& robot, const RobotSpheres& spheres,
        const std::map<std::string, double>& other_joints = {});

  /// The robot.
  [[nodiscard]] const Robot& robot() const;
  /// Its body.
  [[nodiscard]] const RobotSpheres& spheres() const;
  /// Values of joints that are not the arm's [rad or m], by name.
  [[nodiscard]] const std::map<std::string, double>& other_joints() const;
  /// The obstacles by name.
  [[nodiscard]] const std::map<std::string, Obstacle>& obstacles() const;
  [[nodiscard]] const std::map<std::string, AttachedObject>& attached() const;

  /// Adds an obstacle, or replaces the one of that name. Throws InvalidArgumentError about a number
  /// that is no good or a name that a link or an attached object has.
  void set(const std::string& name, const Obstacle& obstacle);
  /// Throws UnknownNameError, and InvalidArgumentError if the pose is not rigid or beyond
  /// kMaxCoordinate.
  void move(const std::string& name, const Pose& T_base_obstacle);
  /// Adds an object that a link carries, or replaces the one of that name. Throws
  /// InvalidArgumentError as `set`, UnknownNameError about a link or what it may touch.
  void attach(const std::string& name, const AttachedObject& object);
  /// Removes an obstacle or an attached object. Throws UnknownNameError.
  void remove(const std::string& name);

  /// Whether nothing touches at q. Throws InvalidArgumentError as Robot::fk.
  [[nodiscard]] bool is_free(const JointVector& q) const;
  /// The same of `count` configurations, one after the other, in `free`; what is not finite is not
  /// free.
  void find_free(const double* q, std::size_t count, bool* free) const;
  /// What touches at q, the deepest first: of each link and each thing that it touches, where they
  /// overlap most. Throws as is_free.
  [[nodiscard]] std::vector<Contact> contacts(const JointVector& q) const;

  /// Throws InvalidArgumentError unless it is of that robot, whatever its tool.
  void check_fits(const Robot& robot) const;

  /// What it holds; for the library's own files.
  struct Data;
  [[nodiscard]] const Data& data() const { return *data_; }

 private:
  /// The data, after it has been copied if others share it.
  Data& own();

  std::shared_ptr<Data> data_;
};

}  // namespace iksel
