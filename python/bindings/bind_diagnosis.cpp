// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"
#include "scene_types.hpp"

namespace iksel::python {

template <>
struct FieldTable<Diagnosis> : HeaderTable<Diagnosis> {
  using D = Diagnosis;
  static std::vector<Field> fields() {
    return HeaderFields<D>()
        .hide({"unreachable_tip"})
        .check<&may_be_length>({"beyond_reach", "rotation_gap", "limit_violation",
                                "least_singular_value", "position_error", "rotation_error"})
        .check<&is_index<kMaxDof>>({"joint"})
        .check<&is_index<kMaxCoupledLimits>>({"coupled_limit"})
        .check<&is_index<kMaxTips>>({"unreachable_tip"})
        .check<&is_count>({"refused", "attempts"})
        .all();
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
  bind_enums<Cause>(m);
  auto cls = bind_fields<Diagnosis>(m, "Solver.diagnose");
  def_proven(cls);
  add_property(cls, "unreachable_tip",
               [](const Diagnosis& self) { return optional_index(self.unreachable_tip); });
  def(cls, "__bool__", "", [](const Diagnosis& self) { return self.q_is_solution; });
}

}  // namespace iksel::python
