// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"

namespace iksel::python {

template <>
struct FieldTable<SelfMotionEnd> : HeaderTable<SelfMotionEnd> {
  static std::vector<Field> fields() {
    return HeaderFields<SelfMotionEnd>()
        .check<&is_index<kMaxDof>>({"joint"})
        .check<&is_index<kMaxCoupledLimits>>({"coupled_limit"})
        .all();
  }
};

template <>
struct FieldTable<SelfMotionArc> : HeaderTable<SelfMotionArc> {
  using A = SelfMotionArc;
  static std::vector<Field> fields() {
    return HeaderFields<A>().check<&is_length>({"length"}).all();
  }
  static void check(const A& self) {
    if (self.elbow.empty() || self.elbow.size() == self.q.size()) return;
    refuse_state("pickled SelfMotionArc, elbow", "an angle for each q, or none", "another number");
  }
};

template <>
struct FieldTable<SelfMotion> : HeaderTable<SelfMotion> {
  using M = SelfMotion;
  static std::vector<Field> fields() { return HeaderFields<M>().hide({"arcs"}).all(); }
  static void check(const M& self) {
    if (self.success() == self.arcs.empty() || self.success() != (self.proof == Proof::answer)) {
      refuse_state("pickled SelfMotion, arcs", "arcs where solved, and only there", "others");
    }
  }
};

namespace {

SelfMotionArc arc_at(const SelfMotion& self, py::ssize_t i) {
  const auto n = static_cast<py::ssize_t>(self.arcs.size());
  return self.arcs[static_cast<std::size_t>(as_row(i, n, "arc"))];
}

SelfMotion self_motion(const Solver& self, const Pose& target, double spacing) {
  return without_gil([&] { return self.self_motion(target, spacing); });
}

void bind_arc(py::module_& m) {
  using A = SelfMotionArc;
  auto cls = bind_fields<A>(m, "Solver.self_motion");
  add_property(cls, "is_closed", &A::is_closed);
  def(cls, "__len__", "", [](const A& self) { return self.q.size(); });
  def(cls, "__iter__", "", [](const A& self) {
    return RowIterator<py::array_t<double>>(
        py::iter(FromPython<std::vector<JointVector>>::show(self.q)));
  });
}

}  // namespace

void bind_self_motion(py::module_& m, py::class_<Solver>& solver) {
  using M = SelfMotion;
  bind_enums<ArcEnd>(m);
  bind_fields<SelfMotionEnd>(m, "Solver.self_motion");
  bind_arc(m);
  auto cls = bind_fields<M>(m, "Solver.self_motion");
  def_success(cls);
  def_proven(cls);
  def(cls, "__len__", "", [](const M& self) { return self.arcs.size(); });
  def(cls, "__getitem__", "i", fn<&arc_at>);
  def_iter<SelfMotionArc>(cls);
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
