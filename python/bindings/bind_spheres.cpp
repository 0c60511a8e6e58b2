// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "array_checks.hpp"
#include "property.hpp"
#include "scene_arguments.hpp"

namespace iksel::python {

/// Names of links, and spheres (N, 4).
struct SphereTable : RawArgument {
  using RawArgument::RawArgument;
  static constexpr const char* kText = "collections.abc.Mapping[str, numpy.typing.ArrayLike]";
};
/// Pairs of names.
struct NamePairs : RawArgument {
  using RawArgument::RawArgument;
  static constexpr const char* kText = "collections.abc.Iterable[tuple[str, str]]";
};

std::vector<Sphere> as_spheres(py::handle value, const char* name) {
  const DoubleArray array = as_doubles(value, name);
  if (array.ndim() != 2 || array.shape(1) != 4) {
    throw_wrong_shape(name, "an (N, 4) array, rows of centre and radius", array);
  }
  std::vector<Sphere> spheres;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    const double* row = array.data(i);
    spheres.push_back({{row[0], row[1], row[2]}, row[3]});
  }
  return spheres;
}

py::array_t<double> sphere_rows(const std::vector<Sphere>& spheres) {
  py::array_t<double> array({static_cast<py::ssize_t>(spheres.size()), py::ssize_t{4}});
  double* out = array.mutable_data();
  for (const Sphere& sphere : spheres) {
    out = std::copy_n(sphere.centre.data(), 3, out);
    *out++ = sphere.radius;
  }
  return array;
}

py::iterator iterate(py::handle value, const char* name, const char* expected) {
  if (py::isinstance<py::str>(value) || !py::isinstance<py::iterable>(value)) {
    throw_wrong_type(name, expected, value);
  }
  return py::iter(value);
}

std::vector<std::string> as_names(py::handle value, const char* name) {
  std::vector<std::string> names;
  for (py::iterator it = iterate(value, name, "names"); it != py::iterator::sentinel(); ++it) {
    names.push_back(from_python<std::string>(*it, name));
  }
  return names;
}

namespace {

RobotSpheres make_spheres(const SphereTable& links, const std::optional<NamePairs>& pairs) {
  RobotSpheres spheres;
  if (!py::hasattr(links, "keys")) {
    throw_wrong_type("links", "a mapping of names to (N, 4) arrays", links);
  }
  for (const auto& [key, rows] : py::dict(py::reinterpret_borrow<py::object>(links))) {
    const auto link = from_python<std::string>(key, "links");
    spheres.links[link] = as_spheres(rows, ("links['" + link + "']").c_str());
  }
  if (pairs) {
    for (py::iterator it = iterate(*pairs, "pairs", "pairs of names");
         it != py::iterator::sentinel(); ++it) {
      std::vector<std::string> pair = as_names(*it, "pairs");
      if (pair.size() != 2) throw_wrong_type("pairs", "two names", *it);
      spheres.pairs.emplace_back(std::move(pair[0]), std::move(pair[1]));
    }
  }
  spheres.validate();
  return spheres;
}

std::map<std::string, py::array_t<double>> links_of(const RobotSpheres& self) {
  std::map<std::string, py::array_t<double>> links;
  for (const auto& [name, spheres] : self.links) links[name] = sphere_rows(spheres);
  return links;
}

std::size_t count_spheres(const RobotSpheres& self) {
  std::size_t count = 0;
  for (const auto& [name, spheres] : self.links) count += spheres.size();
  return count;
}

std::string spheres_repr(const RobotSpheres& self) {
  return "RobotSpheres(" + std::to_string(count_spheres(self)) + " on " +
         std::to_string(self.links.size()) + " links, " + std::to_string(self.pairs.size()) +
         " pairs)";
}

py::dict spheres_state(const RobotSpheres& self) {
  return py::dict("links"_a = links_of(self), "pairs"_a = self.pairs);
}

}  // namespace

void bind_robot_spheres(py::module_& m) {
  auto cls = bind_class<RobotSpheres>(
      m, "RobotSpheres",
      "Spheres that cover the links of a robot, and which links may not touch each other; made by "
      "iksel.spheres.");
  def_init(cls, "links, pairs=None", fn<&make_spheres>,
           R"(Takes spheres as they are.

Args:
    links: for each link that has a body its spheres, (N, 4), rows of centre in the link's frame and
        radius [m].
    pairs: pairs of links that are looked at for collisions with each other; None: no pair.

Raises:
    InvalidArgumentError: a sphere that is not finite or whose radius is not above 0, a link
        without any, a pair of one link or of a link that is not in `links`.)");
  add_property(cls, "links", &links_of,
               "For each link its spheres, (N, 4), rows of centre in the link's frame and radius "
               "[m].");
  add_property(cls, "pairs", &RobotSpheres::pairs,
               "Pairs of links that are looked at for collisions with each other.");
  def(cls, "__repr__", "", fn<&spheres_repr>);
  def_pickle(cls, fn<&spheres_state>, "links, pairs", fn<&make_spheres>);
}

}  // namespace iksel::python
