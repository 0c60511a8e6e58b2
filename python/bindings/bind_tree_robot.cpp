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
#include "pickle.hpp"
#include "pose_arguments.hpp"
#include "progress.hpp"
#include "property.hpp"
#include "robot_arguments.hpp"
#include "sequence_of.hpp"
#include "urdf_source.hpp"

namespace iksel::python {

namespace {

std::vector<std::string> as_links(const py::object& value, const std::string& name) {
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
                               const std::optional<Loose<std::string>>& base_link,
                               const std::optional<PoseLike>& tcps,
                               const std::optional<JointValues>& locked_joints,
                               const Loose<bool>& soft_limits,
                               const std::optional<ArrayLike>& default_limits,
                               const CoupledLimits& coupled_limits) {
  TreeOptions options;
  options.tip_links = as_links(tip_links, "tip_links");
  set_common_options(base_link, locked_joints, soft_limits, default_limits, coupled_limits,
                     options);
  if (tcps) options.tcps = as_tools(*tcps, "tcps");
  return read_urdf(
      path_or_xml,
      [&](const std::string& xml) { return TreeRobot::from_urdf_string(xml, options); },
      [&](const std::filesystem::path& path) { return TreeRobot::from_urdf_file(path, options); });
}

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

py::object tree_robot_state(const TreeRobot& self) {
  const TreeOptions& o = self.options();
  return py::make_tuple(self.urdf(), o.tip_links, to_stack(o.tcps)) + common_state(o);
}

TreeRobot tree_robot_from_state(const py::object& state) {
  PickleState in(state, "TreeRobot", 8);
  const std::string urdf = in.value<std::string>("urdf");
  TreeOptions options;
  options.tip_links = as_links(in.object(), in.name("tip_links"));
  options.tcps = as_tools(in.object(), in.name("tcps"));
  set_common_options(in, options);
  return TreeRobot::from_urdf_string(urdf, options);
}

void bind_from_urdf(py::class_<TreeRobot>& cls) {
  const TreeOptions defaults;
  cls.def_static("from_urdf", &tree_robot_from_urdf, py::arg("path_or_xml"), py::arg("tip_links"),
                 py::arg("base_link") = py::none(), py::arg("tcps") = py::none(),
                 py::arg("locked_joints") = py::none(),
                 py::arg("soft_limits") = defaults.soft_limits,
                 py::arg("default_limits") = py::none(), py::arg("coupled_limits") = py::tuple(),
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
  cls.def(
      "chain",
      [](const TreeRobot& self, const Loose<int>& tip) {
        return self.chain(from_python<int>(tip, "tip"));
      },
      py::arg("tip"),
      "The chain to one tip by itself, a Robot; tips count from 0.\n\nRaises:\n"
      "    InvalidArgumentError: no such tip.");
  cls.def(
      "joints_of",
      [](const TreeRobot& self, const Loose<int>& tip) {
        return self.joints_of(from_python<int>(tip, "tip"));
      },
      py::arg("tip"),
      "Where the joints of that chain stand among all: its joint values are q[joints_of(tip)]."
      "\n\nRaises:\n    InvalidArgumentError: no such tip.");
}

void bind_configurations(py::class_<TreeRobot>& cls) {
  cls.def(
      "fk",
      [](const TreeRobot& self, const ArrayLike& q) {
        return map_joints(q, self.dof(), "q", {self.tips(), 4, 4},
                          [&](const JointVector& joints, double* out) {
                            for (const Pose& pose : self.fk(joints)) {
                              Eigen::Map<RowMajorPose>{out} = pose.matrix();
                              out += 16;
                            }
                          });
      },
      py::arg("q"),
      R"(Forward kinematics: T_base_tip of each tip, of its TCP if there is a tool.

Args:
    q: joint values [rad or m], (dof,) or (N, dof).

Returns:
    (k, 4, 4), or (N, k, 4, 4) with the GIL released.

Raises:
    InvalidArgumentError: wrong shape or dtype, or a number that is not finite.)");
  cls.def(
      "jacobian",
      [](const TreeRobot& self, const ArrayLike& q) {
        const int rows = 6 * self.tips();
        const int dof = self.dof();
        return map_joints(q, dof, "q", {rows, dof}, [&](const JointVector& joints, double* out) {
          Eigen::Map<RowMajorMatrix>(out, rows, dof) = self.jacobian(joints);
        });
      },
      py::arg("q"),
      R"(Geometric Jacobians of all tips, one below the other: rows [linear; angular] for each.

Args:
    q: joint values [rad or m], (dof,) or (N, dof).

Returns:
    (6 k, dof), or (N, 6 k, dof) with the GIL released.

Raises:
    InvalidArgumentError: wrong shape or dtype, or a number that is not finite.)");
  cls.def(
      "within_limits",
      [](const TreeRobot& self, const ArrayLike& q) {
        return self.within_limits(as_joints(q, self.dof(), "q"));
      },
      py::arg("q"), "Whether q [rad or m], (dof,), lies inside the position limits.");
  cls.def(
      "random_configurations",
      [](const TreeRobot& self, const Loose<std::size_t>& n, const Loose<std::uint64_t>& seed) {
        const auto count = from_python<std::size_t>(n, "n");
        const auto number = from_python<std::uint64_t>(seed, "seed");
        const std::optional<ProgressCallable> no_callable;
        const Progress interruptible = make_progress(no_callable);
        return to_array(
            without_gil([&] { return self.random_configurations(count, number, interruptible); }));
      },
      py::arg("n"), py::arg("seed"),
      "n configurations uniform inside the limits (continuous joints in [-pi, pi)), (n, dof). The "
      "same seed gives the same numbers everywhere.");
}

}  // namespace

void bind_tree_robot(py::module_& m) {
  py::class_<TreeRobot> cls(
      m, "TreeRobot",
      "The chains from one link of a URDF to several tips, joined: a joint that lies on several of "
      "them is one degree of freedom. Immutable, safe to use from many threads at once.");
  bind_from_urdf(cls);
  bind_facts(cls);
  bind_tips(cls);
  bind_configurations(cls);
  cls.def("__repr__", &tree_robot_repr);
  cls.def("__copy__", [](const TreeRobot& self) { return self; });
  cls.def(
      "__deepcopy__", [](const TreeRobot& self, const py::dict&) { return self; }, py::arg("memo"));
  cls.def(py::pickle(&tree_robot_state, &tree_robot_from_state));
}

}  // namespace iksel::python
