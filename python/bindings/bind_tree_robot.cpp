// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "array_checks.hpp"
#include "bindings.hpp"
#include "enums.hpp"
#include "gil.hpp"
#include "iksel/pose.hpp"
#include "iksel/tree_robot.hpp"
#include "pose_arguments.hpp"
#include "progress.hpp"
#include "property.hpp"
#include "robot_arguments.hpp"
#include "sequence_of.hpp"
#include "urdf_source.hpp"

namespace iksel::python {

/// A sequence of link names.
struct LinkNames : RawArgument {
  using RawArgument::RawArgument;
  static constexpr const char* kText = "collections.abc.Sequence[str]";
};

namespace {

std::vector<std::string> as_links(py::handle value, const std::string& name) {
  return read_sequence(value, name, "a list of link names", from_python<std::string>);
}

std::vector<StoredPose> as_tools(py::handle value, const std::string& name) {
  const DoubleArray array = as_poses(value, name.c_str());
  std::vector<StoredPose> tools;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    const std::string at = name + "[" + std::to_string(i) + "]";
    Pose tool;
    tool.matrix() = Eigen::Map<const RowMajorPose>(array.data(i));
    tools.emplace_back(check_pose(tool, at.c_str()));
  }
  return tools;
}

TreeRobot tree_robot_from_urdf(const UrdfSource& path_or_xml, const LinkNames& tip_links,
                               const std::optional<std::string>& base_link,
                               const std::optional<PoseLike>& tcps,
                               const std::optional<JointValues>& locked_joints, bool soft_limits,
                               const std::optional<Limits>& default_limits,
                               const std::vector<CoupledLimit>& coupled_limits) {
  TreeOptions options;
  options.tip_links = as_links(tip_links, "tip_links");
  if (base_link) options.base_link = *base_link;
  if (tcps) options.tcps = as_tools(*tcps, "tcps");
  if (locked_joints) options.locked_joints = *locked_joints;
  options.soft_limits = soft_limits;
  options.default_limits = default_limits;
  options.coupled_limits = coupled_limits;
  return read_urdf(
      path_or_xml,
      [&](const std::string& xml) { return TreeRobot::from_urdf_string(xml, options); },
      [&](const std::filesystem::path& path) { return TreeRobot::from_urdf_file(path, options); });
}

constexpr const char* kTreeFromUrdf =
    "path_or_xml, tip_links, base_link=None, tcps=None, locked_joints=None, soft_limits=False, "
    "default_limits=None, coupled_limits=()";

/// (k, 4, 4) of their own.
template <class Poses>
py::array_t<double> to_stack(const Poses& poses) {
  py::array_t<double> array(
      {static_cast<py::ssize_t>(poses.size()), py::ssize_t{4}, py::ssize_t{4}});
  double* out = array.mutable_data();
  for (const auto& pose : poses) {
    Eigen::Map<RowMajorPose>{out} = pose.matrix();
    out += 16;
  }
  return array;
}

std::string tree_robot_repr(const TreeRobot& self) {
  return "TreeRobot(" + py::cast<std::string>(py::repr(py::str(self.name()))) +
         ", dof=" + std::to_string(self.dof()) + ", base_link='" + self.base_link() +
         "', tip_links=" + py::cast<std::string>(py::repr(py::cast(self.tip_links()))) + ")";
}

py::dict tree_robot_state(const TreeRobot& self) {
  const TreeOptions& o = self.options();
  return py::dict("path_or_xml"_a = self.urdf(), "tip_links"_a = o.tip_links,
                  "base_link"_a = o.base_link, "tcps"_a = to_stack(o.tcps),
                  "locked_joints"_a = o.locked_joints, "soft_limits"_a = o.soft_limits,
                  "default_limits"_a = o.default_limits, "coupled_limits"_a = o.coupled_limits);
}

void bind_from_urdf(py::class_<TreeRobot>& cls) {
  def_static(cls, "from_urdf", kTreeFromUrdf, fn<&tree_robot_from_urdf>,
             R"(Reads the chains from one link of a URDF to several.

Args:
    path_or_xml: a path, or the URDF itself: a str whose first character is '<', or bytes.
    tip_links: links whose poses are solved for, 1 to 8.
    base_link: link that all poses are relative to; None: the root link.
    tcps: T_tip_tcp of each tip, (k, 4, 4), or None: no tip has a tool.
    locked_joints: joints held at a value [rad or m]; they are no degrees of freedom.
    soft_limits: narrow the limits to the URDF's safety_controller where there is one.
    default_limits: (lower, upper) [rad or m] of revolute and prismatic joints whose limits the
        URDF leaves out or has as 0, 0; without, such a joint is an error.
    coupled_limits: limits of sums of joint values, beside those of each joint, of one chain or of
        several; at most 8.

Raises:
    UrdfError: as Robot.from_urdf, of each chain; more than 32 joints together; joints that follow
        a shared one leave it no value between its limits.
    UnknownNameError: no such link or joint.
    InvalidArgumentError: no tip link, one twice, more than 8, not a tool for each, or a number
        that is no good.)");
}

void bind_facts(py::class_<TreeRobot>& cls) {
  add_property(cls, "name", &TreeRobot::name, "Name in the URDF.");
  add_property(cls, "base_link", &TreeRobot::base_link, "Link that all poses are relative to.");
  add_property(cls, "tip_links", &TreeRobot::tip_links, "Links whose poses are solved for.");
  add_property(cls, "urdf", &TreeRobot::urdf,
               "The URDF text this robot was made of, as every XML reader takes it.");
  add_property(
      cls, "tcps", [](const TreeRobot& self) { return to_stack(self.options().tcps); },
      "T_tip_tcp of each tip, (k, 4, 4).");
  bind_common_options(cls);
  add_property(cls, "tips", &TreeRobot::tips, "Number of tips.");
  add_property(cls, "dof", &TreeRobot::dof, "Number of joints of all chains together.");
  add_property(cls, "joint_names", &TreeRobot::joint_names,
               "Names of the joints: those of the first chain from base to tip, then those that "
               "only the second has, and so on.");
  add_property(cls, "joint_types", &TreeRobot::joint_types, "How each joint moves.");
  add_property(cls, "shared_joints", &TreeRobot::shared_joints,
               "Indices of the joints that move more than one tip, ascending.");
  const auto vector = [&](const char* name, const JointVector& (TreeRobot::*get)() const,
                          const char* doc) {
    add_property(
        cls, name,
        [get](const TreeRobot& self) {
          return read_only_view((self.*get)(), py::cast(self, py::return_value_policy::reference));
        },
        doc);
  };
  vector("lower", &TreeRobot::lower, "Lower position limits [rad or m], (dof,); -inf: none.");
  vector("upper", &TreeRobot::upper, "Upper position limits [rad or m], (dof,); inf: none.");
  vector("velocity_limit", &TreeRobot::velocity_limit,
         "Velocity limits [rad/s or m/s], (dof,); inf where the URDF has none.");
}

void bind_tips(py::class_<TreeRobot>& cls) {
  def(
      cls, "chain", "tip", [](const TreeRobot& self, int tip) { return self.chain(tip); },
      "The chain to one tip by itself, a Robot; tips count from 0.\n\nRaises:\n"
      "    InvalidArgumentError: no such tip.");
  def(
      cls, "joints_of", "tip", [](const TreeRobot& self, int tip) { return self.joints_of(tip); },
      "Where the joints of that chain stand among all: its joint values are q[joints_of(tip)]."
      "\n\nRaises:\n    InvalidArgumentError: no such tip.");
}

void bind_configurations(py::class_<TreeRobot>& cls) {
  def(
      cls, "fk", "q",
      [](const TreeRobot& self, const ArrayLike& q) {
        return map_joints(q, self.dof(), "q", {self.tips(), 4, 4},
                          [&](const JointVector& joints, double* out) {
                            for (const Pose& pose : self.fk(joints)) {
                              Eigen::Map<RowMajorPose>{out} = pose.matrix();
                              out += 16;
                            }
                          });
      },
      R"(Forward kinematics: T_base_tip of each tip, of its TCP if there is a tool.

Args:
    q: joint values [rad or m], (dof,) or (N, dof).

Returns:
    (k, 4, 4), or (N, k, 4, 4) with the GIL released.

Raises:
    InvalidArgumentError: wrong shape or dtype, or a number that is not finite.)");
  def(
      cls, "jacobian", "q",
      [](const TreeRobot& self, const ArrayLike& q) {
        const int rows = 6 * self.tips();
        const int dof = self.dof();
        return map_joints(q, dof, "q", {rows, dof}, [&](const JointVector& joints, double* out) {
          Eigen::Map<RowMajorMatrix>(out, rows, dof) = self.jacobian(joints);
        });
      },
      R"(Geometric Jacobians of all tips, one below the other: rows [linear; angular] for each.

Args:
    q: joint values [rad or m], (dof,) or (N, dof).

Returns:
    (6 k, dof), or (N, 6 k, dof) with the GIL released.

Raises:
    InvalidArgumentError: wrong shape or dtype, or a number that is not finite.)");
  def(
      cls, "within_limits", "q",
      [](const TreeRobot& self, const ArrayLike& q) {
        return self.within_limits(as_joints(q, self.dof(), "q"));
      },
      "Whether q [rad or m], (dof,), lies inside the position limits.");
  def(
      cls, "random_configurations", "n, seed",
      [](const TreeRobot& self, std::size_t n, std::uint64_t seed) {
        return to_array(
            without_gil([&] { return self.random_configurations(n, seed, interruptible()); }));
      },
      "n configurations uniform inside the limits (continuous joints in [-pi, pi)), (n, dof). The "
      "same seed gives the same numbers everywhere.");
}

}  // namespace

void bind_tree_robot(py::module_& m) {
  auto cls = bind_class<TreeRobot>(
      m, "TreeRobot",
      "The chains from one link of a URDF to several tips, joined: a joint that lies on several of "
      "them is one degree of freedom. Immutable, safe to use from many threads at once.",
      "TreeRobot.from_urdf");
  bind_from_urdf(cls);
  bind_facts(cls);
  bind_tips(cls);
  bind_configurations(cls);
  def(cls, "__repr__", "", fn<&tree_robot_repr>);
  def_copies(cls);
  def_pickle(cls, fn<&tree_robot_state>, without_defaults(kTreeFromUrdf),
             fn<&tree_robot_from_urdf>);
}

}  // namespace iksel::python
