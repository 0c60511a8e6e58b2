// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/structure.hpp"

#include <algorithm>
#include <vector>

#include "structure/closed_form.hpp"

namespace iksel {
namespace {

/// "axes 2 and 3 are parallel, 4, 5 and 6 meet", counted from 1 along the chain.
std::string describe_axes(const ClosedFormChain& chain) {
  const std::vector<AxisRule>& rules = axis_rules();
  const auto rule = std::find_if(rules.begin(), rules.end(), [&](const AxisRule& each) {
    return each.closure == chain.form.closure;
  });
  std::string text;
  for (const AxisRun& run : rule->runs) {
    std::vector<int> joints;
    for (std::size_t i = 0; i < run.count; ++i) joints.push_back(chain.joints[run.first + i] + 1);
    std::sort(joints.begin(), joints.end());
    // Those that complete the chain are no joints.
    if (joints.back() > chain.dof) continue;
    text += text.empty() ? "axes " : ", ";
    for (std::size_t k = 0; k < joints.size(); ++k) {
      if (k > 0) text += k + 1 < joints.size() ? ", " : " and ";
      text += std::to_string(joints[k]);
    }
    text += run.lie == AxisRun::Lie::meet ? " meet" : " are parallel";
  }
  return text;
}

}  // namespace

Structure find_structure(const Robot& robot) {
  auto chain = find_closed_form(robot.model());
  if (!chain) chain = find_residual(robot.model());
  if (!chain) {
    return {StructureKind::searched, "no axes lie so that it would help: solved by search"};
  }
  if (chain->loop) {
    return {StructureKind::swept,
            "axes that lie anyhow: by six equations for each angle of joint " +
                std::to_string(chain->held + 1) + ", which is swept"};
  }
  std::string text = describe_axes(*chain);
  if (chain->held >= 0) {
    const bool slides = chain->form.held_slide != 0;
    return {StructureKind::swept, text + ": in closed form for each " +
                                      (slides ? "place of slide " : "angle of joint ") +
                                      std::to_string(chain->held + 1) + ", which is swept"};
  }
  if (chain->is_completed()) {
    if (!text.empty()) text += ", ";
    text += "only " + std::to_string(chain->dof) + " joints";
  }
  if (chain->is_almost()) {
    return {StructureKind::closed_form,
            text + " nearly: solved in closed form as if they did, and refined"};
  }
  return {StructureKind::closed_form, text + ": solved in closed form"};
}

}  // namespace iksel
