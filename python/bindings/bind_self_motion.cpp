// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/self_motion.hpp"

#include <string>
#include <vector>

#include "array_fields.hpp"
#include "bindings.hpp"
#include "gil.hpp"
#include "html.hpp"
#include "iksel/solver.hpp"
#include "pose_arguments.hpp"
#include "py_result.hpp"

namespace iksel::python {

template <>
struct FieldTable<SelfMotionEnd> {
  using E = SelfMotionEnd;
  static constexpr const char* kName = "SelfMotionEnd";
  static constexpr const char* kDoc = "One end of an arc of a self-motion.";
  static std::vector<Field> fields() {
    return {field("kind", &E::kind, "What ends the arc there."),
            field<&is_index<kMaxDof>>(
                "joint", &E::joint, "Index of the joint that is at its limit; -1 unless `limit`."),
            field<&is_index<kMaxCoupledLimits>>(
                "coupled_limit", &E::coupled_limit,
                "Index of the coupled limit that is reached, if it is not a joint's own; else -1."),
            field("at_upper", &E::at_upper, "Whether it is at the upper one of its limits.")};
  }
};

template <>
struct FieldTable<SelfMotionArc> {
  using A = SelfMotionArc;
  static constexpr const char* kName = "SelfMotionArc";
  static constexpr const char* kDoc = "A connected piece of a self-motion inside the limits.";
  static std::vector<Field> fields() {
    return {
        field("q", &A::q,
              "Configurations along it, (n, dof) [rad], its ends included; each reaches the pose. "
              "A closed arc does not repeat the first."),
        field("elbow", &A::elbow,
              "The elbow's angle at each about the line from shoulder to wrist, (n,) [rad]: 0 on "
              "the side where the first axis points to, NaN where shoulder and wrist lie on that "
              "axis. Empty unless three axes meet in a shoulder and three in a wrist."),
        field<&is_length>("length", &A::length, "Sum of the joint moves along it [rad]."),
        field("begin", &A::begin, "What ends it before its first configuration."),
        field("end", &A::end, "What ends it behind its last configuration.")};
  }
  static void check(const A& self) {
    if (self.elbow.empty() || self.elbow.size() == self.q.size()) return;
    refuse_state("pickled SelfMotionArc, elbow", "an angle for each q, or none", "another number");
  }
};

template <>
struct FieldTable<SelfMotion> {
  using M = SelfMotion;
  static constexpr const char* kName = "SelfMotion";
  static constexpr const char* kDoc =
      "The arcs of a pose's self-motion, the longest first; true if there are any. Indexing gives "
      "a SelfMotionArc.";
  static std::vector<Field> fields() {
    return {field("status", &M::status, "`solved`, or why there is none."),
            field("proof", &M::proof,
                  "`answer` if there is an arc; else how certain it is that there is none."),
            field("arcs", &M::arcs, nullptr)};
  }
  static void check(const M& self) {
    if (self.success() == self.arcs.empty() || self.success() != (self.proof == Proof::answer)) {
      refuse_state("pickled SelfMotion, arcs", "arcs where solved, and only there", "others");
    }
  }
};

namespace {

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

SelfMotionArc arc_at(const SelfMotion& self, py::ssize_t i) {
  const auto n = static_cast<py::ssize_t>(self.arcs.size());
  if (i < -n || i >= n) throw py::index_error("arc index out of range");
  return self.arcs[static_cast<std::size_t>(i < 0 ? i + n : i)];
}

std::string motion_repr(const SelfMotion& self) {
  return "SelfMotion(" + status_text(self.status, self.proof) + ", " +
         std::to_string(self.arcs.size()) + " arcs)";
}

SelfMotion self_motion(const Solver& self, const Pose& target, double spacing) {
  return without_gil([&] { return self.self_motion(target, spacing); });
}

void bind_arc(py::module_& m) {
  using A = SelfMotionArc;
  auto cls = bind_fields<A>(m, "Solver.self_motion");
  add_property(
      cls, "is_closed", [](const A& self) { return self.is_closed(); },
      "Whether the last configuration leads on to the first.");
  def(cls, "__len__", "", [](const A& self) { return self.q.size(); });
  def(cls, "__iter__", "", [](const A& self) {
    return RowIterator<py::array_t<double>>(
        py::iter(ValueOf<std::vector<JointVector>>::to_plain(self.q)));
  });
  def(cls, "__repr__", "", fn<&arc_repr>);
}

}  // namespace

void bind_self_motion(py::module_& m, py::class_<Solver>& solver) {
  using M = SelfMotion;
  bind_enum<ArcEnd>(m);
  auto end = bind_fields<SelfMotionEnd>(m, "Solver.self_motion");
  def(end, "__repr__", "",
      [](const SelfMotionEnd& self) { return "SelfMotionEnd(" + end_text(self) + ")"; });
  bind_arc(m);
  auto cls = bind_fields<M>(m, "Solver.self_motion");
  add_property(cls, "success", &M::success, "Whether there is at least one arc.");
  def(cls, "__len__", "", [](const M& self) { return self.arcs.size(); });
  def(cls, "__getitem__", "i", fn<&arc_at>);
  def_iter<SelfMotionArc>(cls);
  def(cls, "__bool__", "", fn<&M::success>);
  def(cls, "__repr__", "", fn<&motion_repr>);
  def(solver, "self_motion", "pose, spacing=0.1", fn<&self_motion>,
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
