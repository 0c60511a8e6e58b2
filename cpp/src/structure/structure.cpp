// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/structure.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "structure/closed_form.hpp"

namespace iksel {
namespace {

using lanes::Closure;

/// "axes 2 and 3 are parallel, 4, 5 and 6 meet", counted from 1 along the chain.
std::string describe_axes(const ClosedFormChain& chain) {
  constexpr const char* kMeet = " meet";
  constexpr const char* kParallel = " are parallel";
  // Axes of the form, counted from 0.
  using Clauses = std::vector<std::pair<std::vector<int>, const char*>>;
  const std::map<Closure, Clauses> all = {
      {Closure::three_parallel, {{{1, 2, 3}, kParallel}, {{4, 5}, kMeet}}},
      {Closure::parallel_23, {{{3, 4, 5}, kMeet}, {{1, 2}, kParallel}}},
      {Closure::parallel_12, {{{3, 4, 5}, kMeet}, {{0, 1}, kParallel}}},
      {Closure::intersect_12, {{{3, 4, 5}, kMeet}, {{0, 1}, kMeet}}},
      {Closure::intersect_23, {{{3, 4, 5}, kMeet}, {{1, 2}, kMeet}}},
      {Closure::sweep_4, {{{1, 2}, kParallel}, {{4, 5}, kMeet}}},
      {Closure::sweep_6, {{{1, 2}, kParallel}, {{3, 4}, kMeet}}},
  };
  std::string text;
  for (const auto& [axes, how] : all.at(chain.form.closure)) {
    std::vector<int> joints;
    for (const int i : axes) joints.push_back(chain.joints[i] + 1);
    std::sort(joints.begin(), joints.end());
    // Those that complete the chain are no joints.
    if (joints.back() > chain.dof) continue;
    text += text.empty() ? "axes " : ", ";
    for (std::size_t k = 0; k < joints.size(); ++k) {
      if (k > 0) text += k + 1 < joints.size() ? ", " : " and ";
      text += std::to_string(joints[k]);
    }
    text += how;
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
