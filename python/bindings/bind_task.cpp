// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"
#include "property.hpp"
#include "task_fields.hpp"

namespace iksel::python {

void bind_task(py::module_& m) {
  bind_enum<TaskFrame>(m);
  bind_enum<Axis>(m);
  auto cls = bind_fields<Task>(m, FieldClass::immutable);
  cls.def_static("pose", &Task::pose, "The whole pose, exactly.");
  cls.def_static("position_only", &Task::position_only, "The position; any rotation.");
  const Loose<Axis> z = py::str(enum_name(Axis::z));
  cls.def_static(
      "free_spin",
      [](const Loose<Axis>& axis) { return Task::free_spin(from_python<Axis>(axis, "axis")); },
      py::arg("axis") = z,
      "The position and the direction of one of the tool's axes; any spin about it.");
  cls.def_static(
      "upright",
      [](const Loose<Axis>& axis) { return Task::upright(from_python<Axis>(axis, "axis")); },
      py::arg("axis") = z,
      "The position, and the rotation up to a turn about one of the base's axes: a glass stays "
      "upright.");
  cls.def_static(
      "planar",
      [](const Loose<Axis>& normal) { return Task::planar(from_python<Axis>(normal, "normal")); },
      py::arg("normal") = z,
      "The position in the plane that `normal` of the base is normal to, and the angle about it; "
      "three axes are left free. For arms that move in a plane.");
  const Loose<TaskFrame> tool = py::str(enum_name(TaskFrame::tool));
  cls.def_static(
      "box",
      [](const Loose<std::array<double, 3>>& position, const Loose<std::array<double, 3>>& rotation,
         const Loose<TaskFrame>& frame) {
        return Task::box(from_python<std::array<double, 3>>(position, "position"),
                         from_python<std::array<double, 3>>(rotation, "rotation"),
                         from_python<TaskFrame>(frame, "frame"));
      },
      py::arg("position"), py::arg("rotation"), py::arg("frame") = tool,
      R"(Symmetric tolerances about the target.

Args:
    position: half widths along x, y, z [m]; inf leaves an axis free.
    rotation: half widths about x, y, z [rad]; pi or more leaves an axis free.
    frame: whose axes these are.

Raises:
    InvalidArgumentError: a half width that is negative or not a number.)");
  add_property(cls, "is_full_pose", &Task::is_full_pose, "Whether every tolerance is zero.");
  add_property(cls, "constrained_axes", &Task::constrained_axes,
               "Number of axes that are not free, 0 to 6.");
  cls.def("__hash__", [](const Task& self) { return py::hash(py::repr(py::cast(self))); });
}

}  // namespace iksel::python
