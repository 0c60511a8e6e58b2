// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <filesystem>
#include <map>
#include <optional>
#include <random>
#include <string>

#include "array_checks.hpp"
#include "bindings.hpp"
#include "enums.hpp"
#include "gil.hpp"
#include "html.hpp"
#include "iksel/pose.hpp"
#include "iksel/robot.hpp"
#include "iksel/structure.hpp"
#include "pickle.hpp"
#include "pose_arguments.hpp"
#include "progress.hpp"
#include "property.hpp"
#include "robot_arguments.hpp"
#include "sequence_of.hpp"
#include "urdf_source.hpp"

namespace iksel::python {

/// A sequence of MimicCurve.
class MimicCurves : public py::object {
  PYBIND11_OBJECT_DEFAULT(MimicCurves, object, is_any_object)
};

/// A truth value for one configuration, an array of them for many.
class BoolOrArray : public py::object {
  PYBIND11_OBJECT_DEFAULT(BoolOrArray, object, is_any_object)
};

}  // namespace iksel::python

// NOLINTBEGIN(readability-identifier-naming): pybind11 looks for `name`.
namespace pybind11::detail {
template <>
struct handle_type_name<iksel::python::MimicCurves> {
  static constexpr auto name = const_name("collections.abc.Sequence[iksel_cpp.MimicCurve]");
};
template <>
struct handle_type_name<iksel::python::BoolOrArray> {
  // Which of the two, the types of arrays do not tell.
  static constexpr auto name = const_name("bool | typing.Any");
};
}  // namespace pybind11::detail
// NOLINTEND(readability-identifier-naming)

namespace iksel::python {

namespace {

/// From the system's source of randomness.
std::uint64_t fresh_seed() {
  std::random_device device;
  return (std::uint64_t{device()} << 32) | device();
}

Robot from_urdf(const UrdfSource& path_or_xml, const std::optional<Loose<std::string>>& base_link,
                const std::optional<Loose<std::string>>& tip_link,
                const std::optional<PoseLike>& tcp, const std::optional<JointValues>& locked_joints,
                const Loose<bool>& soft_limits, const std::optional<ArrayLike>& default_limits,
                const CoupledLimits& coupled_limits, const MimicCurves& mimic_curves) {
  RobotOptions options;
  set_common_options(base_link, locked_joints, soft_limits, default_limits, coupled_limits,
                     options);
  if (tip_link) options.tip_link = from_python<std::string>(*tip_link, "tip_link");
  if (tcp) options.tcp = check_pose(as_pose(*tcp, "tcp"), "tcp");
  options.mimic_curves = as_sequence_of<MimicCurve>(mimic_curves, "mimic_curves", "MimicCurve");
  return read_urdf(
      path_or_xml, [&](const std::string& xml) { return Robot::from_urdf_string(xml, options); },
      [&](const std::filesystem::path& path) { return Robot::from_urdf_file(path, options); });
}

std::string robot_repr(const Robot& self) {
  return "Robot(" + py::cast<std::string>(py::repr(py::str(self.name()))) +
         ", dof=" + std::to_string(self.dof()) + ", base_link='" + self.base_link() +
         "', tip_link='" + self.tip_link() + "')";
}

py::object robot_state(const Robot& self) {
  const RobotOptions& options = self.options();
  return py::make_tuple(self.urdf(), options.tip_link, to_array(self.tcp())) +
         common_state(options) + py::make_tuple(options.mimic_curves);
}

Robot robot_from_state(const py::object& state) {
  PickleState in(state, "Robot", 9);
  const std::string urdf = in.value<std::string>("urdf");
  RobotOptions options;
  options.tip_link = in.value<std::string>("tip_link");
  options.tcp = check_pose(as_pose(in.object(), in.name("tcp").c_str()), in.name("tcp").c_str());
  set_common_options(in, options);
  options.mimic_curves =
      as_sequence_of<MimicCurve>(in.object(), in.name("mimic_curves"), "MimicCurve");
  return Robot::from_urdf_string(urdf, options);
}

/// A table of the joints.
std::string robot_html(const Robot& self) {
  HtmlTable table(self.name() + ": " + self.base_link() + " to " + self.tip_link(),
                  {"joint", "type", "lower", "upper", "velocity limit"});
  for (int i = 0; i < self.dof(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const JointType type = self.joint_types()[k];
    const std::string unit = type == JointType::prismatic ? " [m]" : " [rad]";
    table.add_row({self.joint_names()[k], enum_name(type) + unit, short_number(self.lower()[i]),
                   short_number(self.upper()[i]), short_number(self.velocity_limit()[i])});
  }
  return table.text();
}

/// A read-only property over one of the robot's joint vectors, without a copy.
void def_joint_vector(py::class_<Robot>& cls, const char* name,
                      const JointVector& (Robot::*get)() const, const char* doc) {
  add_property(
      cls, name,
      [get](const Robot& self) {
        return read_only_view((self.*get)(), py::cast(self, py::return_value_policy::reference));
      },
      doc);
}

void bind_chain(py::class_<Robot>& cls) {
  add_property(cls, "name", &Robot::name, "Name in the URDF.");
  add_property(cls, "base_link", &Robot::base_link, "Link the poses are relative to.");
  add_property(cls, "tip_link", &Robot::tip_link, "Link whose pose is solved for.");
  add_property(cls, "link_names", &Robot::link_names,
               "Names of all links of the URDF, the chain's and others, depth first "
               "from the root.");
  add_property(cls, "urdf", &Robot::urdf,
               "The URDF text this robot was made of, as every XML reader takes it.");
  bind_common_options(cls);
  add_property(
      cls, "mimic_curves", [](const Robot& self) { return self.options().mimic_curves; },
      "How joints follow others where that is no straight line.");
  add_property(
      cls, "tcp", [](const Robot& self) { return to_array(self.tcp()); },
      "T_tip_tcp, the tool centre point in the tip link's frame, (4, 4).");
  add_property(cls, "dof", &Robot::dof, "Degrees of freedom.");
  add_property(cls, "joint_names", &Robot::joint_names,
               "Names of the degrees of freedom, base to tip.");
  add_property(cls, "joint_types", &Robot::joint_types,
               "How each degree of freedom moves, base to tip.");
  def_joint_vector(cls, "lower", &Robot::lower,
                   "Lower position limits [rad or m], (dof,); -inf for continuous joints.");
  def_joint_vector(cls, "upper", &Robot::upper,
                   "Upper position limits [rad or m], (dof,); inf for continuous joints.");
  def_joint_vector(cls, "velocity_limit", &Robot::velocity_limit,
                   "Velocity limits [rad/s or m/s], (dof,); inf where the URDF has none.");
  def_joint_vector(cls, "soft_lower", &Robot::soft_lower,
                   "Lower limits of the safety controller [rad or m], (dof,); `lower` where the "
                   "URDF has none.");
  def_joint_vector(cls, "soft_upper", &Robot::soft_upper,
                   "Upper limits of the safety controller [rad or m], (dof,); `upper` where the "
                   "URDF has none.");
  add_property(cls, "reach", &Robot::reach,
               "No pose farther than this from `reach_centre` can be reached [m].");
  add_property(
      cls, "reach_centre",
      [](const Robot& self) { return to_array(JointVector(self.reach_centre())); },
      "A point on the first joint's axis, in the base frame [m], (3,).");
  add_property(
      cls, "structure", [](const Robot& self) { return find_structure(self); },
      "How the axes lie, and whether that gives all solutions of a pose in closed form.");
  add_property(cls, "chain_hash", &Robot::chain_hash,
               "Hash of the chain up to the tip link: equal for chains that may share a database.");
}

void bind_from_urdf(py::class_<Robot>& cls) {
  const RobotOptions defaults;
  cls.def_static("from_urdf", &from_urdf, py::arg("path_or_xml"), py::arg("base_link") = py::none(),
                 py::arg("tip_link") = py::none(), py::arg("tcp") = py::none(),
                 py::arg("locked_joints") = py::none(),
                 py::arg("soft_limits") = defaults.soft_limits,
                 py::arg("default_limits") = py::none(), py::arg("coupled_limits") = py::tuple(),
                 py::arg("mimic_curves") = py::tuple(),
                 R"(Reads the chain between two links of a URDF.

Args:
    path_or_xml: a path, or the URDF itself: a str whose first character is '<', or bytes.
    base_link: link the poses are relative to; None: the root link.
    tip_link: link whose pose is solved for; None: the one link without children.
    tcp: T_tip_tcp, (4, 4): tool centre point. Poses, FK and IK are then of the TCP.
    locked_joints: joints held at a value [rad or m]; they are no degrees of freedom.
    soft_limits: narrow the limits to the URDF's safety_controller where there is one.
    default_limits: (lower, upper) [rad or m] of revolute and prismatic joints whose limits the
        URDF leaves out or has as 0, 0; without, such a joint is an error.
    coupled_limits: limits of sums of joint values, beside those of each joint; at most 8.
    mimic_curves: how joints follow others where that is no straight line, one MimicCurve for each
        that does; in the place of their mimic tags.

Raises:
    UrdfError: the file, the XML, a joint type or a limit is no good, or a length or joint value
        is beyond 1e8, where double precision ends. Where there was a choice of names, `available`
        has them all.
    UnknownNameError: no such link or joint.
    InvalidArgumentError: tcp is no rigid transform, or a number in the options is no good, or the
        coupled limits leave no configuration, or a curve is no good.)");
}

void bind_configurations(py::class_<Robot>& cls) {
  cls.def(
      "within_limits",
      [](const Robot& self, const ArrayLike& q) {
        const auto inside = map_joints<bool>(
            q, self.dof(), "q", {},
            [&](const JointVector& joints, bool* out) { *out = self.within_limits(joints); });
        return BoolOrArray(inside.ndim() == 0 ? py::object(py::bool_(*inside.data()))
                                              : py::object(inside));
      },
      py::arg("q"),
      "Whether q [rad or m], (dof,), lies inside the position limits; of (N, dof) values each, "
      "(N,).");
  cls.def(
      "random_configurations",
      [](const Robot& self, const Loose<std::size_t>& n,
         const std::optional<Loose<std::uint64_t>>& seed) {
        const auto count = from_python<std::size_t>(n, "n");
        const auto number = seed ? from_python<std::uint64_t>(*seed, "seed") : fresh_seed();
        const std::optional<ProgressCallable> no_callable;
        const Progress interruptible = make_progress(no_callable);
        return to_array(
            without_gil([&] { return self.random_configurations(count, number, interruptible); }));
      },
      py::arg("n"), py::arg("seed") = py::none(),
      "n configurations uniform inside the limits (continuous joints in [-pi, pi)), (n, dof). The "
      "same seed gives the same numbers everywhere; None: other numbers in each call.");
}

}  // namespace

void bind_robot(py::module_& m) {
  bind_enum<JointType>(m);
  bind_enum<Kinematics>(m);

  py::class_<Robot> cls(m, "Robot",
                        "An immutable serial chain between two links of a URDF, with its limits. "
                        "Safe to use from many threads at once.");
  bind_from_urdf(cls);
  bind_dh(m, cls);
  bind_chain(cls);
  cls.def(
      "with_tcp",
      [](const Robot& self, const PoseLike& tcp) { return self.with_tcp(as_pose(tcp, "tcp")); },
      py::arg("tcp"),
      "The same chain with another tool T_tip_tcp, (4, 4). Databases built for one serve the "
      "other.");
  bind_kinematics(cls);
  bind_configurations(cls);
  cls.def("__repr__", &robot_repr);
  cls.def("_repr_html_", &robot_html);
  cls.def("__copy__", [](const Robot& self) { return self; });
  cls.def(
      "__deepcopy__", [](const Robot& self, const py::dict&) { return self; }, py::arg("memo"));
  cls.def(py::pickle(&robot_state, &robot_from_state));
}

}  // namespace iksel::python
