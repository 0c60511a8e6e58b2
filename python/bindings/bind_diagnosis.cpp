// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/diagnosis.hpp"

#include <string>

#include "array_fields.hpp"
#include "bindings.hpp"
#include "obstacle_fields.hpp"
#include "py_result.hpp"

namespace iksel::python {

template <>
struct FieldTable<Diagnosis> {
  using D = Diagnosis;
  static constexpr const char* kName = "Diagnosis";
  static constexpr const char* kDoc =
      "What Solver.diagnose found; true if q_is_solution. Numbers that do not belong to the "
      "cause are NaN.";
  static std::vector<Field> fields() {
    return {
        field("cause", &D::cause, "Why there is no answer; `none` if there is one."),
        field("message", &D::message, "What is wrong and what to do about it, in a sentence."),
        field<&may_be_length>(
            "beyond_reach", &D::beyond_reach,
            "out_of_reach: distance from the nearest position that was reached [m]. no_branch: "
            "how much too long or too short the distance is that `joint`, an elbow, would have "
            "to bend for; NaN if it is no elbow."),
        field<&may_be_length>(
            "rotation_gap", &D::rotation_gap,
            "orientation: least rotation error that was reached with the position held "
            "[rad]."),
        field<&is_index<kMaxDof>>(
            "joint", &D::joint,
            "joint_limits: index of the joint that lies farthest outside its limits in the "
            "answer that violates them least. no_branch: of the joint of which there is no "
            "angle. -1 otherwise."),
        field<&may_be_length>(
            "limit_violation", &D::limit_violation,
            "joint_limits: by how much that joint, or the sum of the coupled limit, lies outside "
            "[rad or m]."),
        field<&is_count>("refused", &D::refused,
                         "rejected, collision: how many answers the filter or the scene refused."),
        field<&may_be_length>(
            "least_singular_value", &D::least_singular_value,
            "Least singular value of the Jacobian at q [mixed units]: small where it is "
            "close to a singularity."),
        field(
            "q", &D::q,
            "Best effort inside the limits, (dof,) [rad or m]. NO SOLUTION unless q_is_solution."),
        field<&may_be_length>("position_error", &D::position_error, "Position error of q [m]."),
        field<&may_be_length>("rotation_error", &D::rotation_error, "Rotation error of q [rad]."),
        field("q_is_solution", &D::q_is_solution,
              "Whether q is an answer: within the tolerances, inside the limits, passed by "
              "the scene and the filter."),
        field<&is_count>(
            "attempts", &D::attempts,
            "Seeds that were tried to find the cause; 0 where `proof` is `closed_form`: the "
            "branches say it."),
        field("branch", &D::branch,
              "joint_limits: that answer, which reaches the target outside the limits, (dof,) [rad "
              "or m]; "
              "None otherwise."),
        field("contacts", &D::contacts,
              "collision: what touches at q, the answer that collides least, the deepest first; "
              "empty otherwise."),
        field<&is_index<kMaxCoupledLimits>>(
            "coupled_limit", &D::coupled_limit,
            "joint_limits: index of the coupled limit that lies farthest outside, if that is "
            "farther than any joint; `joint` is -1 then. -1 otherwise."),
        field("proof", &D::proof,
              "How certain it is that there is no answer, as Result.proof; `answer` if there is "
              "one."),
        field<&is_index<kMaxTips>>("unreachable_tip", &D::unreachable_tip, nullptr)};
  }
  static void check(const D& self) {
    const std::string of = "pickled Diagnosis, ";
    if (self.branch.size() != 0 && self.branch.size() != self.q.size()) {
      refuse_state(of + "branch", "as many joints as q, or none",
                   std::to_string(self.branch.size()));
    }
    if (self.q_is_solution != (self.proof == Proof::answer)) {
      refuse_state(of + "proof", "answer where there is one, and only there",
                   enum_name(self.proof));
    }
    if (self.joint >= self.q.size()) {
      refuse_state(of + "joint", "one of q's", std::to_string(self.joint));
    }
    if (self.q_is_solution && (self.q.size() == 0 || !(self.position_error >= 0))) {
      refuse_state(of + "q_is_solution", "False without joint values and errors", "True");
    }
  }
};

void bind_diagnosis(py::module_& m) {
  bind_enum<Cause>(m);
  auto cls = bind_fields<Diagnosis>(m, "Solver.diagnose");
  add_property(
      cls, "proven", [](const Diagnosis& self) { return is_proven(self.proof); },
      "Whether there is certainly no answer: `proof` is `reach`, `closed_form` or `target`.");
  add_property(
      cls, "unreachable_tip",
      [](const Diagnosis& self) { return optional_index(self.unreachable_tip); },
      "Of several tips: the first that cannot be reached by itself, whose chain the numbers are "
      "about, and q has that chain's joints; None: each can.");
  def(cls, "__bool__", "", [](const Diagnosis& self) { return self.q_is_solution; });
  def(cls, "__repr__", "", [](const Diagnosis& self) {
    return std::string("Diagnosis(") + enum_name(self.cause) + ": " + self.message + ")";
  });
}

}  // namespace iksel::python
