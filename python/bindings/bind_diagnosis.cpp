// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/diagnosis.hpp"

#include <pybind11/stl.h>

#include <string>

#include "array_checks.hpp"
#include "bindings.hpp"
#include "pickle.hpp"
#include "property.hpp"
#include "py_result.hpp"

namespace iksel::python {

namespace {

py::object diagnosis_state(const Diagnosis& self) {
  return py::make_tuple(enum_name(self.cause), self.message, self.beyond_reach, self.rotation_gap,
                        self.joint, self.limit_violation, self.refused, self.least_singular_value,
                        to_array(self.q), self.position_error, self.rotation_error,
                        self.q_is_solution, enum_name(self.proof), self.attempts,
                        to_array(self.branch), self.contacts, self.coupled_limit);
}

Diagnosis diagnosis_from_state(const py::object& state) {
  PickleState in(state, "Diagnosis", 17);
  constexpr bool kMayBeNan = true;
  Diagnosis out;
  out.cause = in.value<Cause>("cause");
  out.message = in.value<std::string>("message");
  out.beyond_reach = in.length("beyond_reach", kMayBeNan);
  out.rotation_gap = in.length("rotation_gap", kMayBeNan);
  out.joint = in.index<int>("joint", kMaxDof);
  out.limit_violation = in.length("limit_violation", kMayBeNan);
  out.refused = in.count("refused");
  out.least_singular_value = in.length("least_singular_value", kMayBeNan);
  out.q = in.joints("q");
  out.position_error = in.length("position_error", kMayBeNan);
  out.rotation_error = in.length("rotation_error", kMayBeNan);
  out.q_is_solution = in.value<bool>("q_is_solution");
  out.proof = in.value<Proof>("proof");
  out.attempts = in.count("attempts");
  out.branch = in.joints("branch");
  if (out.branch.size() != 0 && out.branch.size() != out.q.size()) {
    in.refuse("branch", "as many joints as q, or none", std::to_string(out.branch.size()));
  }
  for (const py::handle contact : in.list("contacts")) {
    if (!py::isinstance<Contact>(contact)) {
      in.refuse("contacts", "Contacts", py::cast<std::string>(py::repr(contact)));
    }
    out.contacts.push_back(py::cast<Contact>(contact));
  }
  out.coupled_limit = in.index<int>("coupled_limit", kMaxCoupledLimits);
  if (out.q_is_solution != (out.proof == Proof::answer)) {
    in.refuse("proof", "answer where there is one, and only there", enum_name(out.proof));
  }
  if (out.joint >= out.q.size()) in.refuse("joint", "one of q's", std::to_string(out.joint));
  if (out.q_is_solution && (out.q.size() == 0 || !(out.position_error >= 0))) {
    in.refuse("q_is_solution", "False without joint values and errors", "True");
  }
  return out;
}

/// None of no joint values.
py::object array_or_none(const JointVector& q) {
  return q.size() == 0 ? py::object(py::none()) : to_array(q);
}

}  // namespace

void bind_diagnosis(py::module_& m) {
  using D = Diagnosis;
  bind_enum<Cause>(m);
  py::class_<D> cls(
      m, "Diagnosis",
      "What Solver.diagnose found; true if q_is_solution. Numbers that do not belong to the "
      "cause are NaN.");
  add_property(cls, "cause", &D::cause, "Why there is no answer; `none` if there is one.");
  add_property(cls, "message", &D::message,
               "What is wrong and what to do about it, in a sentence.");
  add_property(
      cls, "proof", &D::proof,
      "How certain it is that there is no answer, as Result.proof; `answer` if there is one.");
  add_property(
      cls, "proven", [](const D& self) { return is_proven(self.proof); },
      "Whether there is certainly no answer: `proof` is `reach`, `closed_form` or `target`.");
  add_property(cls, "attempts", &D::attempts,
               "Seeds that were tried to find the cause; 0 where `proof` is `closed_form`: the "
               "branches say it.");
  add_property(cls, "beyond_reach", &D::beyond_reach,
               "out_of_reach: distance from the nearest position that was reached [m]. no_branch: "
               "how much too long or too short the distance is that `joint`, an elbow, would have "
               "to bend for; NaN if it is no elbow.");
  add_property(cls, "rotation_gap", &D::rotation_gap,
               "orientation: least rotation error that was reached with the position held "
               "[rad].");
  add_property(cls, "joint", &D::joint,
               "joint_limits: index of the joint that lies farthest outside its limits in the "
               "answer that violates them least. no_branch: of the joint of which there is no "
               "angle. -1 otherwise.");
  add_property(cls, "coupled_limit", &D::coupled_limit,
               "joint_limits: index of the coupled limit that lies farthest outside, if that is "
               "farther than any joint; `joint` is -1 then. -1 otherwise.");
  add_property(
      cls, "limit_violation", &D::limit_violation,
      "joint_limits: by how much that joint, or the sum of the coupled limit, lies outside "
      "[rad or m].");
  add_property(
      cls, "branch",
      [](const D& self) {
        return py::reinterpret_borrow<OptionalJoints>(array_or_none(self.branch));
      },
      "joint_limits: that answer, which reaches the target outside the limits, (dof,) [rad or m]; "
      "None otherwise.");
  add_property(cls, "refused", &D::refused,
               "rejected, collision: how many answers the filter or the scene refused.");
  add_property(cls, "contacts", &D::contacts,
               "collision: what touches at q, the answer that collides least, the deepest first; "
               "empty otherwise.");
  add_property(cls, "least_singular_value", &D::least_singular_value,
               "Least singular value of the Jacobian at q [mixed units]: small where it is "
               "close to a singularity.");
  add_property(
      cls, "q",
      [](const D& self) { return py::reinterpret_borrow<OptionalJoints>(array_or_none(self.q)); },
      "Best effort inside the limits, (dof,) [rad or m]. NO SOLUTION unless q_is_solution.");
  add_property(cls, "position_error", &D::position_error, "Position error of q [m].");
  add_property(cls, "rotation_error", &D::rotation_error, "Rotation error of q [rad].");
  add_property(cls, "q_is_solution", &D::q_is_solution,
               "Whether q is an answer: within the tolerances, inside the limits, passed by "
               "the scene and the filter.");
  cls.def("__bool__", [](const D& self) { return self.q_is_solution; });
  cls.def(py::pickle(&diagnosis_state, &diagnosis_from_state));
  cls.def("__repr__", [](const D& self) {
    return std::string("Diagnosis(") + enum_name(self.cause) + ": " + self.message + ")";
  });
}

}  // namespace iksel::python
