// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "array_checks.hpp"
#include "bindings.hpp"
#include "enums.hpp"
#include "gil.hpp"
#include "html.hpp"
#include "iksel/pose.hpp"
#include "iksel/robot.hpp"
#include "iksel/structure.hpp"
#include "pose_arguments.hpp"
#include "progress.hpp"
#include "property.hpp"
#include "robot_arguments.hpp"
#include "sequence_of.hpp"
#include "urdf_source.hpp"

namespace iksel::python {

namespace {

/// From the system's source of randomness.
std::uint64_t fresh_seed() {
  std::random_device device;
  return (std::uint64_t{device()} << 32) | device();
}

Robot from_urdf(const UrdfSource& path_or_xml, const std::optional<std::string>& base_link,
                const std::optional<std::string>& tip_link, const std::optional<Pose>& tcp,
                const std::optional<JointValues>& locked_joints, bool soft_limits,
                const std::optional<Limits>& default_limits,
                const std::vector<CoupledLimit>& coupled_limits,
                const std::vector<MimicCurve>& mimic_curves) {
  RobotOptions options;
  if (base_link) options.base_link = *base_link;
  if (tip_link) options.tip_link = *tip_link;
  if (tcp) options.tcp = check_pose(*tcp, "tcp");
  if (locked_joints) options.locked_joints = *locked_joints;
  options.soft_limits = soft_limits;
  options.default_limits = default_limits;
  options.coupled_limits = coupled_limits;
  options.mimic_curves = mimic_curves;
  return read_urdf(
      path_or_xml, [&](const std::string& xml) { return Robot::from_urdf_string(xml, options); },
      [&](const std::filesystem::path& path) { return Robot::from_urdf_file(path, options); });
}

constexpr const char* kFromUrdf =
    "path_or_xml, base_link=None, tip_link=None, tcp=None, locked_joints=None, soft_limits=False, "
    "default_limits=None, coupled_limits=(), mimic_curves=()";

std::string robot_repr(const Robot& self) {
  return "Robot(" + repr_text(py::str(self.name())) + ", dof=" + std::to_string(self.dof()) +
         ", base_link='" + self.base_link() + "', tip_link='" + self.tip_link() + "')";
}

/// The arguments of from_urdf that make the same robot.
py::dict robot_state(const Robot& self) {
  const RobotOptions& options = self.options();
  return py::dict("path_or_xml"_a = self.urdf(), "base_link"_a = options.base_link,
                  "tip_link"_a = options.tip_link, "tcp"_a = to_array(self.tcp()),
                  "locked_joints"_a = options.locked_joints, "soft_limits"_a = options.soft_limits,
                  "default_limits"_a = options.default_limits,
                  "coupled_limits"_a = options.coupled_limits,
                  "mimic_curves"_a = options.mimic_curves);
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
  def_static(cls, "from_urdf", kFromUrdf, fn<&from_urdf>,
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

BoolOrArray within_limits(const Robot& self, const ArrayLike& q) {
  const auto inside = map_joints<bool>(
      q, self.dof(), "q", {},
      [&](const JointVector& joints, bool* out) { *out = self.within_limits(joints); });
  return to_bool_or_array(inside);
}

py::array_t<double> random_configurations(const Robot& self, std::size_t n,
                                          const std::optional<std::uint64_t>& seed) {
  const std::uint64_t number = seed ? *seed : fresh_seed();
  return to_array(
      without_gil([&] { return self.random_configurations(n, number, interruptible()); }));
}

}  // namespace

void bind_robot(py::module_& m) {
  bind_enum<JointType>(m);
  bind_enum<Kinematics>(m);

  auto cls = bind_class<Robot>(m, "Robot",
                               "An immutable serial chain between two links of a URDF, with its "
                               "limits. Safe to use from many threads at once.",
                               "iksel.load_robot(name) or Robot.from_urdf(path_or_xml)");
  bind_from_urdf(cls);
  bind_dh(m, cls);
  bind_chain(cls);
  def(
      cls, "with_tcp", "tcp", [](const Robot& self, const Pose& tcp) { return self.with_tcp(tcp); },
      "The same chain with another tool T_tip_tcp, (4, 4). Databases built for one serve the "
      "other.");
  bind_kinematics(cls);
  def(cls, "within_limits", "q", fn<&within_limits>,
      "Whether q [rad or m], (dof,), lies inside the position limits; of (N, dof) values each, "
      "(N,).");
  def(cls, "random_configurations", "n, seed=None", fn<&random_configurations>,
      "n configurations uniform inside the limits (continuous joints in [-pi, pi)), (n, dof). The "
      "same seed gives the same numbers everywhere; None: other numbers in each call.");
  def(cls, "__repr__", "", fn<&robot_repr>);
  def(cls, "_repr_html_", "", fn<&robot_html>);
  def_copies(cls);
  def_pickle(cls, fn<&robot_state>, without_defaults(kFromUrdf), fn<&from_urdf>);
}

}  // namespace iksel::python
