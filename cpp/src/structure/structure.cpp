// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/structure.hpp"

#include <algorithm>
#include <initializer_list>
#include <vector>

#include "structure/closed_form.hpp"

namespace iksel {
namespace {

using lanes::Closure;

/// How axes of the form lie that are joints of the chain.
class AxesText {
 public:
  explicit AxesText(const ClosedFormChain& chain) : chain_(chain) {}

  /// "axes 2 and 3 are parallel", counted from 1 along the chain; of more than one such clause the
  /// first says "axes".
  AxesText& add(std::initializer_list<int> axes, const char* how) {
    std::vector<int> joints;
    for (const int i : axes) joints.push_back(chain_.joints[i] + 1);
    std::sort(joints.begin(), joints.end());
    if (joints.back() > chain_.dof) return *this;
    text_ += text_.empty() ? "axes " : ", ";
    for (std::size_t k = 0; k < joints.size(); ++k) {
      if (k > 0) text_ += k + 1 < joints.size() ? ", " : " and ";
      text_ += std::to_string(joints[k]);
    }
    text_ += how;
    return *this;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  const ClosedFormChain& chain_;
  std::string text_;
};

std::string describe_axes(const ClosedFormChain& chain) {
  constexpr const char* kMeet = " meet";
  constexpr const char* kParallel = " are parallel";
  AxesText text(chain);
  switch (chain.form.closure) {
    case Closure::three_parallel:
      return text.add({1, 2, 3}, kParallel).add({4, 5}, kMeet).text();
    case Closure::parallel_23:
      return text.add({3, 4, 5}, kMeet).add({1, 2}, kParallel).text();
    case Closure::parallel_12:
      return text.add({3, 4, 5}, kMeet).add({0, 1}, kParallel).text();
    case Closure::intersect_12:
      return text.add({3, 4, 5}, kMeet).add({0, 1}, kMeet).text();
    case Closure::intersect_23:
      return text.add({3, 4, 5}, kMeet).add({1, 2}, kMeet).text();
    case Closure::sweep_4:
      return text.add({1, 2}, kParallel).add({4, 5}, kMeet).text();
    case Closure::sweep_6:
      return text.add({1, 2}, kParallel).add({3, 4}, kMeet).text();
    case Closure::loop:
      break;
  }
  return {};
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
