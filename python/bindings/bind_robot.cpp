// SPDX-License-Identifier: BSD-3-Clause
#include <random>

#include "bindings.hpp"
#include "urdf_source.hpp"

namespace iksel::python {

/// Lower and upper.
using Limits = std::pair<double, double>;

template <>
struct FromPython<Limits> {
  static std::string text() { return ArrayLike::kText; }
  static Limits convert(py::handle value, const char* name) {
    const DoubleArray array = as_shaped(value, name, {2}, "two numbers, (lower, upper)");
    return {array.at(0), array.at(1)};
  }
};

template <>
struct FieldTable<CoupledLimit> : HeaderTable<CoupledLimit> {};

template <>
struct FieldTable<Structure> : HeaderTable<Structure> {};

template <>
struct FromPython<std::vector<CoupledLimit>> : FromSequence<CoupledLimit> {};
template <>
struct FromPython<std::vector<MimicCurve>> : FromSequence<MimicCurve> {};

namespace {

std::string limit_text(const CoupledLimit& self) {
  const auto short_number = [](double x) {
    return py::cast<std::string>(py::str("{:.5g}").format(x));
  };
  const CoupledLimit defaults;
  std::string text = to_string(self);
  if (self.lower != defaults.lower) text = short_number(self.lower) + " <= " + text;
  if (self.upper != defaults.upper) text += " <= " + short_number(self.upper);
  return text;
}

void bind_coupled_limit(py::module_& m) {
  auto cls = bind_fields<CoupledLimit>(m, nullptr);
  def_init(
      cls, "coefficients, lower=-inf, upper=inf",
      [](const JointValues& coefficients, double lower, double upper) {
        return CoupledLimit{coefficients, lower, upper};
      },
      R"(Args:
    coefficients: by joint name; not 0. Joints between base and tip, mimic and locked ones too,
        but none that turns without limits.
    lower: least value of the sum [rad or m].
    upper: largest value of the sum [rad or m].

Raises:
    InvalidArgumentError: not names and numbers. What is wrong with the limit of a robot, it says
        when that is loaded.)");
  def(cls, "__str__", "", fn<&limit_text>);
  def_equal(cls);
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
                const std::vector<MimicCurve>& mimic_curves, const std::optional<Names>& tip_links,
                const std::optional<PoseLike>& tcps) {
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
    options.tip_links = *tip_links;
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

/// A read-only property over one of the robot's joint vectors, without a copy.
void add_vector(py::class_<Robot>& cls, const char* name,
                const JointVector& (Robot::*get)() const) {
  add_property(cls, name, [get](const Robot& self) {
    return read_only_view((self.*get)(), py::cast(self, py::return_value_policy::reference));
  });
}

/// What the robot was made with.
template <class T>
void add_option(py::class_<Robot>& cls, const char* name, T RobotOptions::*option) {
  add_property(
      cls, name, [option](const Robot& self) -> T { return self.options().*option; },
      header_text(std::string("RobotOptions.") + name));
}

py::array_t<double> tools_of(const Robot& self) {
  std::vector<Pose> tools;
  for (int i = 0; i < self.tips(); ++i) tools.push_back(self.chain(i).tcp());
  return to_stack(tools);
}

void bind_properties(py::class_<Robot>& cls) {
  add_properties(cls, "name", &Robot::name, "base_link", &Robot::base_link, "tip_link",
                 &Robot::tip_link, "link_names", &Robot::link_names, "urdf", &Robot::urdf);
  add_option(cls, "locked_joints", &RobotOptions::locked_joints);
  add_option(cls, "soft_limits", &RobotOptions::soft_limits);
  add_option(cls, "default_limits", &RobotOptions::default_limits);
  add_option(cls, "coupled_limits", &RobotOptions::coupled_limits);
  add_option(cls, "mimic_curves", &RobotOptions::mimic_curves);
  add_properties(cls, "tcp", &Robot::tcp, "dof", &Robot::dof, "joint_names", &Robot::joint_names,
                 "joint_types", &Robot::joint_types);
  add_vector(cls, "lower", &Robot::lower);
  add_vector(cls, "upper", &Robot::upper);
  add_vector(cls, "velocity_limit", &Robot::velocity_limit);
  add_vector(cls, "soft_lower", &Robot::soft_lower);
  add_vector(cls, "soft_upper", &Robot::soft_upper);
  add_properties(cls, "reach", &Robot::reach, "reach_centre", &Robot::reach_centre);
  add_property(
      cls, "structure", [](const Robot& self) { return find_structure(self); },
      "How the axes lie, and whether that gives all solutions of a pose in closed form.");
  add_properties(cls, "chain_hash", &Robot::chain_hash, "tips", &Robot::tips, "tip_links",
                 &Robot::tip_links);
  add_property(cls, "tcps", &tools_of, "T_tip_tcp of each tip, (k, 4, 4).");
  add_property(cls, "shared_joints", &Robot::shared_joints);
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
  std::random_device device;
  const std::uint64_t number = seed ? *seed : (std::uint64_t{device()} << 32) | device();
  return to_array(
      without_gil([&] { return self.random_configurations(n, number, interruptible()); }));
}

}  // namespace

void bind_robot(py::module_& m) {
  bind_enums<JointType, Kinematics, StructureKind>(m);
  bind_fields<Structure>(m, "Robot.structure");
  bind_coupled_limit(m);
  auto cls =
      bind_class<Robot>(m, "Robot", "iksel.load_robot(name) or Robot.from_urdf(path_or_xml)");
  bind_from_urdf(cls);
  bind_dh(m, cls);
  bind_properties(cls);
  def(cls, "chain", "tip", [](const Robot& self, int tip) { return self.chain(tip); });
  def(cls, "joints_of", "tip", fn<&Robot::joints_of>);
  def(cls, "with_tcp", "tcp", fn<&Robot::with_tcp>);
  bind_kinematics(cls);
  def(cls, "within_limits", "q", fn<&within_limits>,
      "Whether q [rad or m], (dof,), lies inside the position limits; of (N, dof) values each, "
      "(N,).");
  def(cls, "random_configurations", "n, seed=None", fn<&random_configurations>,
      "n configurations uniform inside the limits (continuous joints in [-pi, pi)), (n, dof). The "
      "same seed gives the same numbers everywhere; None: other numbers in each call.");
  def_repr(cls);
  def_page(cls);
  def_copies(cls);
  def_pickle(cls, fn<&robot_state>, without_defaults(kFromUrdf), fn<&from_urdf>);
}

}  // namespace iksel::python
