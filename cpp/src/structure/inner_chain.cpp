// SPDX-License-Identifier: BSD-3-Clause
#include "structure/inner_chain.hpp"

#include <algorithm>
#include <string>

#include "simd/lane_chain.hpp"

namespace iksel {

std::vector<InnerChain> InnerChain::of(const ChainModel& whole) {
  std::vector<InnerChain> found;
  if (whole.dof <= kCurveJoints || !is_simple(whole)) return found;
  for (int first = 0; first + kCurveJoints <= whole.dof; ++first) {
    InnerChain inner;
    inner.first = first;
    RobotOptions options = whole.options;
    auto& limits = options.coupled_limits;
    for (int j = 0; j < whole.dof; ++j) {
      if (inner.contains(j)) continue;
      const std::string& name = whole.joints.name(j);
      options.locked_joints[name] = 0;
      // What is coupled with a joint at 0 says nothing of it anywhere else.
      limits.erase(std::remove_if(limits.begin(), limits.end(),
                                  [&](const CoupledLimit& limit) {
                                    return limit.coefficients.count(name) > 0;
                                  }),
                   limits.end());
    }
    inner.model = std::make_shared<const ChainModel>(whole.urdf, options);
    const auto form = find_closed_form(*inner.model);
    if (!form || !form->form.is_held) continue;
    inner.form = *form;
    found.push_back(std::move(inner));
  }
  return found;
}

Pose InnerChain::target(const ChainModel& whole, const Pose& T_base_tcp,
                        const JointVector& q) const {
  // T(before, inner, behind) = A(before) S(inner) C(behind), and of these S is wanted as it is
  // between A(0) and C(0).
  JointVector before = JointVector::Zero(whole.dof);
  JointVector behind = before;
  for (int j = 0; j < whole.dof; ++j) {
    if (!contains(j)) (j < first ? before : behind)[j] = q[j];
  }
  const Pose at_zero = whole.fk(JointVector::Zero(whole.dof).eval().data());
  const Pose T = at_zero * whole.fk(before.data()).inverse() * T_base_tcp *
                 whole.fk(behind.data()).inverse() * at_zero;
  return to_pose(model->kernel.base).inverse() * T * to_pose(model->kernel.tip).inverse();
}

}  // namespace iksel
