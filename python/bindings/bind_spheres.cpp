// SPDX-License-Identifier: BSD-3-Clause
#include "scene_types.hpp"

namespace iksel::python {

namespace {

RobotSpheres make_spheres(
    const std::map<std::string, std::vector<Sphere>>& links,
    const std::optional<Iterable<std::pair<std::string, std::string>>>& pairs) {
  RobotSpheres spheres{links, {}};
  if (pairs) spheres.pairs = *pairs;
  spheres.validate();
  return spheres;
}

std::map<std::string, py::array_t<double>> links_of(const RobotSpheres& self) {
  std::map<std::string, py::array_t<double>> links;
  for (const auto& [name, spheres] : self.links) {
    links[name] = FromPython<std::vector<Sphere>>::show(spheres);
  }
  return links;
}

py::dict spheres_state(const RobotSpheres& self) {
  return py::dict("links"_a = links_of(self), "pairs"_a = self.pairs);
}

}  // namespace

void bind_robot_spheres(py::module_& m) {
  auto cls = bind_class<RobotSpheres>(m, "RobotSpheres");
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
  add_property(cls, "pairs", &RobotSpheres::pairs);
  def_repr(cls);
  def_pickle(cls, fn<&spheres_state>, "links, pairs", fn<&make_spheres>);
}

}  // namespace iksel::python
