// SPDX-License-Identifier: BSD-3-Clause
// The fields of an obstacle and of a contact, as iksel/scene.hpp declares them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "array_fields.hpp"
#include "iksel/scene.hpp"
#include "pose_arguments.hpp"

namespace iksel::python {

template <>
struct FromPython<Eigen::Vector3d> {
  static std::string text() { return ArrayLike::kText; }
  static Eigen::Vector3d convert(py::handle value, const char* name) {
    const DoubleArray array = as_doubles(value, name);
    if (array.ndim() != 1 || array.shape(0) != 3) throw_wrong_shape(name, "a (3,) array", array);
    return {array.at(0), array.at(1), array.at(2)};
  }
};
template <>
struct ResultType<Eigen::Vector3d> : ResultType<py::array_t<double>> {};
template <>
struct ValueOf<Eigen::Vector3d> : PlainValue<Eigen::Vector3d, ValueOf<Eigen::Vector3d>> {
  static py::object to_plain(const Eigen::Vector3d& value) { return to_array(JointVector(value)); }
};

template <>
struct FromPython<PointCloud> {
  static std::string text() { return ArrayLike::kText; }
  static PointCloud convert(py::handle value, const char* name) {
    const DoubleArray array = as_doubles(value, name);
    if (array.ndim() != 2 || array.shape(1) != 3) {
      throw_wrong_shape(name, "an (N, 3) array", array);
    }
    return Eigen::Map<const PointCloud>(array.data(), array.shape(0), 3);
  }
};

using SharedPoints = std::shared_ptr<const PointCloud>;

template <>
struct FromPython<SharedPoints> {
  static std::string text() { return std::string(ArrayLike::kText) + " | None"; }
  static SharedPoints convert(py::handle value, const char* name) {
    if (value.is_none()) return nullptr;
    return std::make_shared<const PointCloud>(from_python<PointCloud>(value, name));
  }
};
template <>
struct ResultType<SharedPoints> : ResultType<OptionalArray> {};
template <>
struct ValueOf<SharedPoints> : PlainValue<SharedPoints, ValueOf<SharedPoints>> {
  static py::object to_plain(const SharedPoints& value) {
    return value ? py::object(to_array(Matrix(*value))) : py::none();
  }
};

template <>
struct FromPython<StoredPose> {
  static std::string text() { return PoseLike::kText; }
  static StoredPose convert(py::handle value, const char* name) {
    return StoredPose(as_pose(value, name));
  }
};
template <>
struct ResultType<StoredPose> : ResultType<py::array_t<double>> {};
template <>
struct ValueOf<StoredPose> : PlainValue<StoredPose, ValueOf<StoredPose>> {
  static py::object to_plain(const StoredPose& value) { return to_array(Pose(value)); }
};

/// By name; no Python enum.
template <>
struct FromPython<Obstacle::Shape> {
  static std::string text() { return "str"; }
  static Obstacle::Shape convert(py::handle value, const char* name) {
    using Shape = Obstacle::Shape;
    const auto given = from_python<std::string>(value, name);
    for (const Shape shape : {Shape::sphere, Shape::box, Shape::capsule, Shape::cylinder,
                              Shape::half_space, Shape::points}) {
      if (given == to_string(shape)) return shape;
    }
    refuse_state(name, "a shape", given);
  }
};
template <>
struct ResultType<Obstacle::Shape> : ResultType<std::string> {};
template <>
struct ValueOf<Obstacle::Shape> : PlainValue<Obstacle::Shape, ValueOf<Obstacle::Shape>> {
  static py::object to_plain(Obstacle::Shape value) { return py::str(to_string(value)); }
};

template <>
struct FieldTable<Obstacle> {
  using O = Obstacle;
  static constexpr const char* kName = "Obstacle";
  static constexpr const char* kDoc = "A shape at a pose, as a Scene holds it.";
  static std::vector<Field> fields() {
    return {field("shape", &O::shape,
                  "'sphere', 'box', 'capsule', 'cylinder', 'half_space' or 'points'."),
            field("radius", &O::radius, "sphere, capsule, cylinder, points [m]."),
            field("length", &O::length, "capsule: of its segment; cylinder [m]."),
            field("size", &O::size, "box: edges, (3,) [m]."),
            field("points", &O::points, "In the obstacle's frame, (N, 3) [m]; None of others."),
            field("pose", &O::pose, "T_base_obstacle, (4, 4)."),
            field("margin", &O::margin, "The arm keeps this far away [m].")};
  }
};

template <>
struct FieldTable<Contact> {
  using C = Contact;
  static constexpr const char* kName = "Contact";
  static constexpr const char* kDoc = "Two things that touch.";
  static std::vector<Field> fields() {
    return {
        field("link", &C::link, "A link of the robot or an attached object."),
        field("other", &C::other, "What it touches: an obstacle, a link or an attached object."),
        field("is_obstacle", &C::is_obstacle, "Whether `other` is an obstacle."),
        field<&is_length>("depth", &C::depth,
                          "How far they would have to part, margins included [m]; 0 or more.")};
  }
};

}  // namespace iksel::python
