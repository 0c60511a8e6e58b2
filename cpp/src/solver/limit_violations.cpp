// SPDX-License-Identifier: BSD-3-Clause
#include "solver/limit_violations.hpp"

#include <algorithm>
#include <vector>

#include "base/message_text.hpp"

namespace iksel {
namespace {

/// "joint 'a'", or "the sum a + b".
std::string name_of(const ChainModel& model, const Limit& limit) {
  if (limit.joint >= 0) return "joint '" + model.joints.name(limit.joint) + "'";
  const auto given = static_cast<std::size_t>(limit.coupled_limit);
  return "the sum " + to_string(model.options.coupled_limits[given]);
}

/// That of the first joint in the limit.
std::string unit_of(const JointSpace& joints, const Limit& limit) {
  const JointVector c = limit.row(joints.dof());
  const auto first = std::find_if(c.begin(), c.end(), [](double each) { return each != 0; });
  return joints.is_slide(static_cast<int>(first - c.begin())) ? " m" : " rad";
}

/// " at 3.3 rad, 0.2 rad beyond its upper limit"
std::string place_text(const Limit& limit, double value, const std::string& unit) {
  return " at " + number_text(value, kShownDigits) + unit + ", " +
         number_text(limit.beyond(value), kShownDigits) + unit + " beyond its " +
         (value > limit.upper ? "upper" : "lower") + " limit";
}

}  // namespace

double worst_violation(const JointSpace& joints, const JointVector& q) {
  Diagnosis ignored;
  return set_violation(joints, q, ignored);
}

double set_violation(const JointSpace& joints, const JointVector& q, Diagnosis& out) {
  double worst = -kInfinity;
  joints.visit_limits([&](const Limit& limit) {
    const double beyond = std::max(limit.beyond(limit.value(q.data())), 0.0);
    if (beyond / limit.size <= worst) return;
    worst = beyond / limit.size;
    out.joint = limit.joint;
    out.coupled_limit = limit.coupled_limit;
    out.limit_violation = beyond;
  });
  return worst;
}

std::string describe_violation(const ChainModel& model, const Diagnosis& diagnosis) {
  const Limit limit = model.joints.limit(diagnosis.joint, diagnosis.coupled_limit);
  return name_of(model, limit) + " would have to go beyond by " +
         number_text(diagnosis.limit_violation, kShownDigits) + unit_of(model.joints, limit);
}

std::string list_violations(const ChainModel& model, const JointVector& q) {
  const auto beyond = [&](const Limit& limit) { return limit.beyond(limit.value(q.data())); };
  std::vector<Limit> outside;
  model.joints.visit_limits([&](const Limit& limit) {
    if (beyond(limit) > 0) outside.push_back(limit);
  });
  std::stable_sort(outside.begin(), outside.end(), [&](const Limit& a, const Limit& b) {
    const bool is_same_kind = (a.joint < 0) == (b.joint < 0);
    return is_same_kind ? beyond(a) > beyond(b) : b.joint < 0;
  });
  std::string list;
  for (const Limit& limit : outside) {
    const bool is_first = list.empty();
    if (!is_first) list += ", ";
    list += limit.joint < 0 || is_first ? name_of(model, limit)
                                        : "'" + model.joints.name(limit.joint) + "'";
    if (is_first) list += " would have to be";
    list += place_text(limit, limit.value(q.data()), unit_of(model.joints, limit));
  }
  return list;
}

}  // namespace iksel
