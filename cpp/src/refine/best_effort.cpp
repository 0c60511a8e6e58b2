// SPDX-License-Identifier: BSD-3-Clause
#include "refine/best_effort.hpp"

#include <cmath>

#include "base/random.hpp"
#include "options/strategy.hpp"
#include "refine/iterate.hpp"

namespace iksel {

JointVector BestEffort::from(const JointVector& seed) {
  constexpr int kSteps = 200;
  Paper scheme = one_at_a_time(Lanes{});
  scheme.whole_turns = false;
  Random unused(0);
  IterationContext context{model_, scheme, kSteps, goal_, goal_.target(), nullptr, unused};
  context.aim = 1e-6;
  context.steps_at_tcp = true;
  context.descent_length = weight_;
  JointVector q = model_.joints.clamp(seed);
  int steps = 0;
  iterate(context, q, steps);
  // Steps may have turned a joint many times; whole turns matter only to joints that follow it.
  JointVector principal = q;
  model_.joints.wrap(principal.data());
  const double error = error_of(q);
  if (error_of(principal) <= error + 1e-9 * (1 + error)) q = principal;
  if (error < error_) {
    error_ = error;
    q_ = q;
  }
  return q;
}

double BestEffort::error_of(const JointVector& q) const {
  double position = 0;
  double rotation = 0;
  goal_.measure(q, position, rotation);
  return std::hypot(position, weight_ * rotation);
}

std::vector<JointVector> BestEffort::from_anywhere(int n, std::uint64_t seed) {
  Random random(seed);
  JointVector q(model_.dof);
  std::vector<JointVector> ends;
  for (int i = 0; i < n; ++i) {
    model_.joints.sample(random, q);
    ends.push_back(from(q));
  }
  return ends;
}

}  // namespace iksel
