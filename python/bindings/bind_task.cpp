// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"
#include "task_fields.hpp"

namespace iksel::python {

void bind_task(py::module_& m) {
  bind_enum<TaskFrame>(m);
  bind_enum<Axis>(m);
  auto cls = bind_keyword_class<Task>(m, /*writable=*/false);
  def_static(cls, "pose", "", fn<&Task::pose>, "The whole pose, exactly.");
  def_static(cls, "position_only", "", fn<&Task::position_only>, "The position; any rotation.");
  def_static(cls, "free_spin", "axis='z'", fn<&Task::free_spin>,
             "The position and the direction of one of the tool's axes; any spin about it.");
  def_static(cls, "upright", "axis='z'", fn<&Task::upright>,
             "The position, and the rotation up to a turn about one of the base's axes: a glass "
             "stays upright.");
  def_static(cls, "planar", "normal='z'", fn<&Task::planar>,
             "The position in the plane that `normal` of the base is normal to, and the angle "
             "about it; three axes are left free. For arms that move in a plane.");
  def_static(cls, "box", "position, rotation, frame='tool'", fn<&Task::box>,
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
  def(cls, "__hash__", "", [](const Task& self) { return py::hash(py::str(to_repr(self))); });
}

}  // namespace iksel::python
