// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/request.hpp>

namespace iksel_headers {

void use_request(const iksel::Scene& scene) {
  iksel::SolveRequest request;
  request.scene = scene;
  request.objective = iksel::Objective::far_from_limits();
  request.task = iksel::Task::free_spin();
  request.closest = iksel::PoseWeights();
  request.closest->validate();
  request.filter = iksel::filter_each(6, [](const iksel::JointVector& q) { return q[0] > 0; });
  request.validate(6);
  iksel::SolveAllOptions().validate();
  iksel::PathOptions().validate(request.has_requirements() ? 6 : 7);
}

}  // namespace iksel_headers
