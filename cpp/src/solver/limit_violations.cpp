// SPDX-License-Identifier: BSD-3-Clause
#include "solver/limit_violations.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "base/message_text.hpp"

namespace iksel {
namespace {

/// "at 3.3 rad, 0.2 rad beyond its upper limit"
std::string place_text(double value, double outside, bool is_upper, const std::string& unit) {
  return " at " + number_text(value, kShownDigits) + unit + ", " +
         number_text(outside, kShownDigits) + unit + " beyond its " +
         (is_upper ? "upper" : "lower") + " limit";
}

std::string unit_of(const JointSpace& joints, int joint) {
  return joints.is_slide(joint) ? " m" : " rad";
}

/// That of the first joint in the sum.
std::string unit_of(const JointSpace& joints, const CoupledRow& row) {
  int first = 0;
  while (row.c[first] == 0) ++first;
  return unit_of(joints, first);
}

const CoupledLimit& given(const ChainModel& model, int index) {
  return model.options.coupled_limits[static_cast<std::size_t>(index)];
}

}  // namespace

double worst_violation(const JointSpace& joints, const JointVector& q) {
  double worst = joints.violations(q).maxCoeff();
  for (const CoupledRow& row : joints.coupled) {
    worst = std::max(worst, row.beyond(row.sum(q.data())));
  }
  return worst;
}

void set_violation(const JointSpace& joints, const JointVector& q, Diagnosis& out) {
  out.limit_violation = joints.violations(q).maxCoeff(&out.joint);
  out.coupled_limit = -1;
  double worst = out.limit_violation;
  for (const CoupledRow& row : joints.coupled) {
    const double beyond = row.beyond(row.sum(q.data()));
    if (beyond <= worst) continue;
    worst = beyond;
    out.joint = -1;
    out.coupled_limit = row.given;
    out.limit_violation = beyond * row.size;
  }
}

std::string describe_violation(const ChainModel& model, const Diagnosis& diagnosis) {
  const JointSpace& joints = model.joints;
  std::string who;
  std::string unit;
  if (diagnosis.coupled_limit < 0) {
    who = "joint '" + joints.name(diagnosis.joint) + "'";
    unit = unit_of(joints, diagnosis.joint);
  } else {
    who = "the sum " + to_string(given(model, diagnosis.coupled_limit));
    const auto row =
        std::find_if(joints.coupled.begin(), joints.coupled.end(),
                     [&](const CoupledRow& each) { return each.given == diagnosis.coupled_limit; });
    unit = unit_of(joints, *row);
  }
  return who + " would have to go beyond by " +
         number_text(diagnosis.limit_violation, kShownDigits) + unit;
}

std::string list_violations(const ChainModel& model, const JointVector& q) {
  const JointSpace& joints = model.joints;
  const JointVector outside = joints.violations(q);
  std::vector<int> order(static_cast<std::size_t>(model.dof));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return outside[a] > outside[b]; });
  std::string list;
  const auto add = [&](const std::string& kind, const std::string& name, const std::string& place) {
    const std::string would = list.empty() ? " would have to be" : "";
    list += (list.empty() ? "" : ", ") + kind + name + would + place;
  };
  for (const int j : order) {
    if (!(outside[j] > 0)) break;
    add(list.empty() ? "joint " : "", "'" + joints.name(j) + "'",
        place_text(q[j], outside[j], q[j] > joints.upper[j], unit_of(joints, j)));
  }
  for (const CoupledRow& row : joints.coupled) {
    const double sum = row.sum(q.data());
    const double beyond = std::max(row.lower - sum, sum - row.upper);
    if (!(beyond > 0)) continue;
    add("the sum ", to_string(given(model, row.given)),
        place_text(sum, beyond, sum > row.upper, unit_of(joints, row)));
  }
  return list;
}

}  // namespace iksel
