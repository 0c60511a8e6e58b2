// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/self_motion.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "array_checks.hpp"
#include "bindings.hpp"
#include "gil.hpp"
#include "html.hpp"
#include "iksel/solver.hpp"
#include "pickle.hpp"
#include "pose_arguments.hpp"
#include "property.hpp"
#include "py_result.hpp"
#include "python_types.hpp"

namespace iksel::python {

namespace {

py::object end_state(const SelfMotionEnd& self) {
  return py::make_tuple(enum_name(self.kind), self.joint, self.at_upper, self.coupled_limit);
}

SelfMotionEnd end_from_state(const py::object& state) {
  PickleState in(state, "SelfMotionEnd", 4);
  SelfMotionEnd end;
  end.kind = in.value<ArcEnd>("kind");
  end.joint = in.index<int>("joint", kMaxDof);
  end.at_upper = in.value<bool>("at_upper");
  end.coupled_limit = in.index<int>("coupled_limit", kMaxCoupledLimits);
  return end;
}

py::array_t<double> arc_q(const SelfMotionArc& self) {
  const auto dof = static_cast<py::ssize_t>(self.q.empty() ? 0 : self.q.front().size());
  py::array_t<double> array({static_cast<py::ssize_t>(self.q.size()), dof});
  double* out = array.mutable_data();
  for (const JointVector& q : self.q) out = std::copy_n(q.data(), dof, out);
  return array;
}

py::array_t<double> arc_elbow(const SelfMotionArc& self) {
  return py::array_t<double>(static_cast<py::ssize_t>(self.elbow.size()), self.elbow.data());
}

py::object arc_state(const SelfMotionArc& self) {
  return py::make_tuple(arc_q(self), arc_elbow(self), self.length, end_state(self.begin),
                        end_state(self.end));
}

SelfMotionArc arc_from_state(const py::object& state) {
  PickleState in(state, "SelfMotionArc", 5);
  SelfMotionArc arc;
  const auto q = in.rows("q");
  const auto dof = static_cast<int>(q.shape(1));
  for (py::ssize_t i = 0; i < q.shape(0); ++i) {
    check_finite(q.data(i), dof, "pickled SelfMotionArc, q[" + std::to_string(i) + "]");
    arc.q.emplace_back(Eigen::Map<const Eigen::VectorXd>(q.data(i), dof));
  }
  const py::object elbow = in.object();
  const DoubleArray angles = as_doubles(elbow, "pickled SelfMotionArc, elbow");
  if (angles.ndim() != 1 || (angles.shape(0) != 0 && angles.shape(0) != q.shape(0))) {
    in.refuse("elbow", "an angle for each q, or none", "another number");
  }
  arc.elbow.assign(angles.data(), angles.data() + angles.shape(0));
  arc.length = in.length("length", /*may_be_nan=*/false);
  arc.begin = end_from_state(in.object());
  arc.end = end_from_state(in.object());
  return arc;
}

py::object motion_state(const SelfMotion& self) {
  py::list arcs;
  for (const SelfMotionArc& arc : self.arcs) arcs.append(arc_state(arc));
  return py::make_tuple(enum_name(self.status), enum_name(self.proof), arcs);
}

SelfMotion motion_from_state(const py::object& state) {
  PickleState in(state, "SelfMotion", 3);
  SelfMotion motion;
  motion.status = in.value<Status>("status");
  motion.proof = in.value<Proof>("proof");
  for (const py::handle arc : in.list("arcs")) {
    motion.arcs.push_back(arc_from_state(py::reinterpret_borrow<py::object>(arc)));
  }
  if (motion.success() == motion.arcs.empty() ||
      motion.success() != (motion.proof == Proof::answer)) {
    in.refuse("arcs", "arcs where solved, and only there", "others");
  }
  return motion;
}

std::string end_text(const SelfMotionEnd& end) {
  if (end.kind != ArcEnd::limit) return enum_name(end.kind);
  const bool is_coupled = end.coupled_limit >= 0;
  return (is_coupled ? "sum " : "joint ") +
         std::to_string((is_coupled ? end.coupled_limit : end.joint) + 1) +
         (end.at_upper ? " at its upper" : " at its lower") + " limit";
}

std::string arc_repr(const SelfMotionArc& self) {
  std::string text = "SelfMotionArc(" + std::to_string(self.q.size()) + " configurations, length " +
                     short_number(self.length, 3);
  text += self.is_closed() ? ", closed"
                           : ", from " + end_text(self.begin) + " to " + end_text(self.end);
  return text + ")";
}

void bind_end(py::module_& m) {
  bind_enum<ArcEnd>(m);
  py::class_<SelfMotionEnd> cls(m, "SelfMotionEnd", "One end of an arc of a self-motion.");
  add_property(cls, "kind", &SelfMotionEnd::kind, "What ends the arc there.");
  add_property(cls, "joint", &SelfMotionEnd::joint,
               "Index of the joint that is at its limit; -1 unless `limit`.");
  add_property(cls, "coupled_limit", &SelfMotionEnd::coupled_limit,
               "Index of the coupled limit that is reached, if it is not a joint's own; else -1.");
  add_property(cls, "at_upper", &SelfMotionEnd::at_upper,
               "Whether it is at the upper one of its limits.");
  cls.def("__repr__",
          [](const SelfMotionEnd& self) { return "SelfMotionEnd(" + end_text(self) + ")"; });
  cls.def(py::pickle(&end_state, &end_from_state));
}

void bind_arc(py::module_& m) {
  using A = SelfMotionArc;
  py::class_<A> cls(m, "SelfMotionArc", "A connected piece of a self-motion inside the limits.");
  add_property(
      cls, "q", &arc_q,
      "Configurations along it, (n, dof) [rad], its ends included; each reaches the pose. A closed "
      "arc does not repeat the first.");
  add_property(
      cls, "elbow", &arc_elbow,
      "The elbow's angle at each about the line from shoulder to wrist, (n,) [rad]: 0 on the side "
      "where the first axis points to, NaN where shoulder and wrist lie on that axis. Empty unless "
      "three axes meet in a shoulder and three in a wrist.");
  add_property(cls, "length", &A::length, "Sum of the joint moves along it [rad].");
  add_property(
      cls, "is_closed", [](const A& self) { return self.is_closed(); },
      "Whether the last configuration leads on to the first.");
  add_property(cls, "begin", &A::begin, "What ends it before its first configuration.");
  add_property(cls, "end", &A::end, "What ends it behind its last configuration.");
  cls.def("__len__", [](const A& self) { return self.q.size(); });
  cls.def("__iter__", [](const A& self) {
    using Rows = py::typing::Iterator<py::array_t<double>>;
    return py::reinterpret_steal<Rows>(py::iter(arc_q(self)).release());
  });
  cls.def("__repr__", &arc_repr);
  cls.def(py::pickle(&arc_state, &arc_from_state));
}

}  // namespace

void bind_self_motion(py::module_& m, py::class_<Solver>& solver) {
  using M = SelfMotion;
  bind_end(m);
  bind_arc(m);
  py::class_<M> cls(m, "SelfMotion",
                    "The arcs of a pose's self-motion, the longest first; true if there are any. "
                    "Indexing gives a SelfMotionArc.");
  add_property(
      cls, "success", [](const M& self) { return self.success(); },
      "Whether there is at least one arc.");
  add_property(cls, "status", &M::status, "`solved`, or why there is none.");
  add_property(cls, "proof", &M::proof,
               "`answer` if there is an arc; else how certain it is that there is none.");
  cls.def("__len__", [](const M& self) { return self.arcs.size(); });
  cls.def(
      "__getitem__",
      [](const M& self, py::ssize_t i) {
        const auto n = static_cast<py::ssize_t>(self.arcs.size());
        if (i < -n || i >= n) throw py::index_error("arc index out of range");
        return self.arcs[static_cast<std::size_t>(i < 0 ? i + n : i)];
      },
      py::arg("i"));
  cls.def(
      "__iter__",
      [](const M& self) { return py::make_iterator(self.arcs.begin(), self.arcs.end()); },
      py::keep_alive<0, 1>());
  cls.def("__bool__", &M::success);
  cls.def("__repr__", [](const M& self) {
    return "SelfMotion(" + status_text(self.status, self.proof) + ", " +
           std::to_string(self.arcs.size()) + " arcs)";
  });
  cls.def(py::pickle(&motion_state, &motion_from_state));
  solver.def(
      "self_motion",
      [](const Solver& self, const PoseLike& pose, const Loose<double>& spacing) {
        const Pose target = as_pose(pose, "pose");
        const auto step = from_python<double>(spacing, "spacing");
        return without_gil([&] { return self.self_motion(target, step); });
      },
      py::arg("pose"), py::arg("spacing") = 0.1,
      R"(All solutions of a redundant arm at once: the arcs of its self-motion inside the limits.

Seven joints that turn, of which one can be swept (`Robot.structure`). Joints with a range of a
whole turn or more end no arc. Each arc that a joint's limit ends is followed from there; a closed one,
or one that coupled limits end, may be missed if it lies between two of 128 samples of the swept joint.

Args:
    pose: T_base_tip [m], as in solve.
    spacing: farthest that a joint moves from one configuration of an arc to the next, 0.0001 to pi
        [rad].

Returns:
    A SelfMotion; empty, with a status that says why, if there is no solution.

Raises:
    InvalidArgumentError: a robot of another structure, a task with free axes, another strategy than
        Lanes, a spacing out of range; else as solve.)");
}

}  // namespace iksel::python
