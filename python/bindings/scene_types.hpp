// SPDX-License-Identifier: BSD-3-Clause
// What scenes are made of, as Python has it.
#pragma once

#include <memory>

#include "bindings.hpp"

namespace iksel::python {

template <>
struct FromPython<PointCloud> {
  static std::string text() { return ArrayLike::kText; }
  static PointCloud convert(py::handle value, const char* name) {
    const DoubleArray array = as_shaped(value, name, {-1, 3}, "an (N, 3) array");
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
  static OptionalArray show(const SharedPoints& value) {
    return OptionalArray(value ? py::object(to_array(Matrix(*value))) : py::none());
  }
};
template <>
struct FromPython<StoredPose> : FromPython<Pose> {};

template <>
struct FieldTable<Obstacle> : HeaderTable<Obstacle> {};

template <>
struct FieldTable<Contact> : HeaderTable<Contact> {
  static std::vector<Field> fields() {
    return HeaderFields<Contact>().check<&is_length>({"depth"}).all();
  }
};

/// Spheres, (N, 4): centre and radius.
template <>
struct FromPython<std::vector<Sphere>> {
  static std::string text() { return ArrayLike::kText; }
  static std::vector<Sphere> convert(py::handle value, const char* name) {
    const DoubleArray array =
        as_shaped(value, name, {-1, 4}, "an (N, 4) array, rows of centre and radius");
    std::vector<Sphere> spheres;
    for (py::ssize_t i = 0; i < array.shape(0); ++i) {
      const double* row = array.data(i);
      spheres.push_back({{row[0], row[1], row[2]}, row[3]});
    }
    return spheres;
  }
  static py::array_t<double> show(const std::vector<Sphere>& spheres) {
    py::array_t<double> array({static_cast<py::ssize_t>(spheres.size()), py::ssize_t{4}});
    double* out = array.mutable_data();
    for (const Sphere& sphere : spheres) {
      out = std::copy_n(sphere.centre.data(), 3, out);
      *out++ = sphere.radius;
    }
    return array;
  }
};

template <>
inline constexpr const char* kItems<std::vector<Sphere>> = "(N, 4) arrays";

/// In pickles.
template <>
struct FieldTable<AttachedObject> : HeaderTable<AttachedObject> {};

/// Anything but a text that can be stepped through.
template <class Item>
struct Iterable : std::vector<Item> {};
template <class Item>
struct FromPython<Iterable<Item>> {
  static std::string text() { return "collections.abc.Iterable[" + FromPython<Item>::text() + "]"; }
  static Iterable<Item> convert(py::handle value, const char* name) {
    if (py::isinstance<py::str>(value) || !py::isinstance<py::iterable>(value)) {
      throw_wrong_type(name, "names", value);
    }
    Iterable<Item> items;
    for (const py::handle item : py::iter(value)) items.push_back(from_python<Item>(item, name));
    return items;
  }
};

template <>
struct FromPython<std::pair<std::string, std::string>> {
  static std::string text() { return "tuple[str, str]"; }
  static std::pair<std::string, std::string> convert(py::handle value, const char* name) {
    const auto pair = from_python<Iterable<std::string>>(value, name);
    if (pair.size() != 2) throw_wrong_type(name, "two names", value);
    return {pair[0], pair[1]};
  }
};

/// A pose, or a position of what is not turned.
struct Place : Pose {
  explicit Place(const Pose& pose) : Pose(pose) {}
};
template <>
struct FromPython<Place> {
  static std::string text() { return PoseLike::kText; }
  static Place convert(py::handle value, const char* name);
};

}  // namespace iksel::python
