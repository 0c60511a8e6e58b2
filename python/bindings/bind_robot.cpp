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

std::vector<StoredPose> as_tools(py::handle value) {
  std::vector<StoredPose> tools;
  for (const Pose& tool : to_poses(as_poses(value, "tcps"))) {
    const std::string name = "tcps[" + std::to_string(tools.size()) + "]";
    tools.emplace_back(check_pose(tool, name.c_str()));
  }
  return tools;
}

Robot from_urdf(const UrdfSource& path_or_xml, const std::optional<std::string>& base_link,
                const std::optional<std::string>& tip_link, const std::optional<Pose>& tcp,
                const std::optional<JointValues>& locked_joints, bool soft_limits,
                const std::optional<Limits>& default_limits,
                const std::vector<CoupledLimit>& coupled_limits,
                const std::vector<MimicCurve>& mimic_curves,
                const std::optional<LinkNames>& tip_links, const std::optional<PoseLike>& tcps) {
  RobotOptions options;
  if (base_link) options.base_link = *base_link;
  if (tip_link) options.tip_link = *tip_link;
  if (tcp) options.tcp = check_pose(*tcp, "tcp");
  if (locked_joints) options.locked_joints = *locked_joints;
  options.soft_limits = soft_limits;
  options.default_limits = default_limits;
  options.coupled_limits = coupled_limits;
  options.mimic_curves = mimic_curves;
  if (tip_links) {
    options.tip_links =
        read_sequence(*tip_links, "tip_links", "a list of link names", from_python<std::string>);
    if (options.tip_links.empty()) {
      throw InvalidArgumentError("tip_links: expected one link or more, got none");
    }
  }
  if (tcps) options.tcps = as_tools(*tcps);
  return read_urdf(
      path_or_xml, [&](const std::string& xml) { return Robot::from_urdf_string(xml, options); },
      [&](const std::filesystem::path& path) { return Robot::from_urdf_file(path, options); });
}

constexpr const char* kFromUrdf =
    "path_or_xml, base_link=None, tip_link=None, tcp=None, locked_joints=None, soft_limits=False, "
    "default_limits=None, coupled_limits=(), mimic_curves=(), tip_links=None, tcps=None";

/// "tip_link='tool0'", or the links of several.
std::string tip_text(const Robot& self) {
  if (self.tips() == 1) return "tip_link='" + self.tip_link() + "'";
  return "tip_links=" + repr_text(py::cast(self.tip_links()));
}

std::string robot_repr(const Robot& self) {
  return "Robot(" + repr_text(py::str(self.name())) + ", dof=" + std::to_string(self.dof()) +
         ", base_link='" + self.base_link() + "', " + tip_text(self) + ")";
}

/// The arguments of from_urdf that make the same robot.
py::dict robot_state(const Robot& self) {
  const RobotOptions& options = self.options();
  const bool has_one_tip = self.tips() == 1;
  const py::object none = py::none();
  return py::dict("path_or_xml"_a = self.urdf(), "base_link"_a = options.base_link,
                  "tip_link"_a = has_one_tip ? py::cast(options.tip_link) : none,
                  "tcp"_a = has_one_tip ? py::object(to_array(self.tcp())) : none,
                  "locked_joints"_a = options.locked_joints, "soft_limits"_a = options.soft_limits,
                  "default_limits"_a = options.default_limits,
                  "coupled_limits"_a = options.coupled_limits,
                  "mimic_curves"_a = options.mimic_curves,
                  "tip_links"_a = has_one_tip ? none : py::cast(options.tip_links),
                  "tcps"_a = has_one_tip ? none : py::object(to_stack(options.tcps)));
}

/// A table of the joints.
std::string robot_html(const Robot& self) {
  std::string tips;
  for (const std::string& link : self.tip_links()) tips += (tips.empty() ? "" : ", ") + link;
  HtmlTable table(self.name() + ": " + self.base_link() + " to " + tips,
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
  add_property(cls, "tip_link", &Robot::tip_link,
               "Link whose pose is solved for, of a robot with one tip.");
  add_property(cls, "link_names", &Robot::link_names,
               "Names of all links of the URDF, the chain's and others, depth first "
               "from the root.");
  add_property(cls, "urdf", &Robot::urdf,
               "The URDF text this robot was made of, as every XML reader takes it.");
  add_property(
      cls, "locked_joints", [](const Robot& self) { return self.options().locked_joints; },
      "Joints held at a value [rad or m], by name.");
  add_property(
      cls, "soft_limits", [](const Robot& self) { return self.options().soft_limits; },
      "Whether the limits are narrowed to the safety controller's.");
  add_property(
      cls, "default_limits", [](const Robot& self) { return self.options().default_limits; },
      "Lower and upper limit of joints that the URDF gives none [rad or m], or None.");
  add_property(
      cls, "coupled_limits", [](const Robot& self) { return self.options().coupled_limits; },
      "Limits of sums of joint values, beside those of each joint.");
  add_property(
      cls, "mimic_curves", [](const Robot& self) { return self.options().mimic_curves; },
      "How joints follow others where that is no straight line.");
  add_property(
      cls, "tcp", [](const Robot& self) { return to_array(self.tcp()); },
      "T_tip_tcp, the tool centre point in the tip link's frame, (4, 4).");
  add_property(cls, "dof", &Robot::dof, "Degrees of freedom.");
  add_property(cls, "joint_names", &Robot::joint_names,
               "Names of the degrees of freedom, base to tip; of several tips those of the first "
               "chain, then those that only the second has, and so on.");
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

void bind_tips(py::class_<Robot>& cls) {
  add_property(cls, "tips", &Robot::tips, "Number of tips.");
  add_property(cls, "tip_links", &Robot::tip_links, "Links whose poses are solved for.");
  add_property(
      cls, "tcps",
      [](const Robot& self) {
        std::vector<Pose> tools;
        for (int i = 0; i < self.tips(); ++i) tools.push_back(self.chain(i).tcp());
        return to_stack(tools);
      },
      "T_tip_tcp of each tip, (k, 4, 4).");
  add_property(cls, "shared_joints", &Robot::shared_joints,
               "Indices of the joints that move more than one tip, ascending.");
  def(
      cls, "chain", "tip", [](const Robot& self, int tip) { return self.chain(tip); },
      "The chain to one tip by itself; tips count from 0.\n\nRaises:\n"
      "    InvalidArgumentError: no such tip.");
  def(
      cls, "joints_of", "tip", [](const Robot& self, int tip) { return self.joints_of(tip); },
      "Where the joints of that chain stand among all: its joint values are q[joints_of(tip)]."
      "\n\nRaises:\n    InvalidArgumentError: no such tip.");
}

void bind_from_urdf(py::class_<Robot>& cls) {
  def_static(cls, "from_urdf", kFromUrdf, fn<&from_urdf>,
             R"(Reads the chain between two links of a URDF, or the chains to several tips.

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
    tip_links: in the place of tip_link, the links of a robot with several tips, 1 to 8: a torso and
        its two arms. A joint that lies on several of the chains is one degree of freedom.
    tcps: in the place of tcp, T_tip_tcp of each tip, (k, 4, 4); None: no tip has a tool.

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
                               "An immutable serial chain between two links of a URDF, or the "
                               "chains from one link to several tips, with their limits. Safe to "
                               "use from many threads at once. What is about one tip raises "
                               "InvalidArgumentError where there are several.",
                               "iksel.load_robot(name) or Robot.from_urdf(path_or_xml)");
  bind_from_urdf(cls);
  bind_dh(m, cls);
  bind_chain(cls);
  bind_tips(cls);
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
