// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "urdf/joint.hpp"
#include "urdf/parse.hpp"

namespace iksel {
namespace {

constexpr std::size_t kMostPoints = 100'000;

std::string text_of(const MimicCurve& curve) {
  return "(joint '" + curve.joint + "' follows '" + curve.follows + "')";
}

double slack_of(double value) { return 1e-9 * std::max(1.0, std::abs(value)); }

/// Written so that NaN is refused.
void check_points(const std::vector<double>& numbers, const char* name, const std::string& culprit,
                  std::size_t expected) {
  if (numbers.size() != expected) {
    throw InvalidArgumentError(culprit + ": " + name + ": expected " + std::to_string(expected) +
                               " numbers, as there are of q, got " +
                               std::to_string(numbers.size()));
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (std::abs(numbers[i]) <= kMaxCoordinate) continue;
    throw InvalidArgumentError(culprit + ": " + name + "[" + std::to_string(i) + "] is " +
                               too_large_text(numbers[i]));
  }
}

void check_numbers_of(const MimicCurve& curve, const std::string& culprit) {
  if (curve.q.size() < 2 || curve.q.size() > kMostPoints) {
    throw InvalidArgumentError(culprit + ": q: expected 2 to " + std::to_string(kMostPoints) +
                               " values, got " + std::to_string(curve.q.size()));
  }
  check_points(curve.q, "q", culprit, curve.q.size());
  check_points(curve.values, "values", culprit, curve.q.size());
  if (!curve.slopes.empty()) check_points(curve.slopes, "slopes", culprit, curve.q.size());
  for (std::size_t i = 1; i < curve.q.size(); ++i) {
    // Closer ones, and their slope is rounding.
    if (curve.q[i] - curve.q[i - 1] >= slack_of(curve.q[i])) continue;
    throw InvalidArgumentError(culprit + ": q[" + std::to_string(i) + "] is " +
                               number_text(curve.q[i]) + " after " + number_text(curve.q[i - 1]) +
                               ": each has to be above the one before");
  }
}

}  // namespace

Motions check_mimic_curves(const urdf::ModelInterface& model,
                           const std::vector<MimicCurve>& curves) {
  Motions checked;
  const auto culprit = [&](std::size_t i) {
    return "mimic_curves[" + std::to_string(i) + "] " + text_of(curves[i]);
  };
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const MimicCurve& curve = curves[i];
    const auto find = [&](const std::string& name) {
      return &find_joint(model, name, culprit(i) + ": '" + name + "' is not in the URDF");
    };
    const urdf::Joint& joint = *find(curve.joint);
    const urdf::Joint& source = *find(curve.follows);
    if (!has_value(joint)) {
      throw InvalidArgumentError(culprit(i) + ": joint '" + curve.joint + "' is " +
                                 joint_type_name(joint.type));
    }
    check_numbers_of(curve, culprit(i));
    auto motion = std::make_shared<const MotionCurve>(curve.q, curve.values, curve.slopes);
    if (!checked.try_emplace(&joint, Motion{{1.0, 0.0, std::move(motion)}, &source}).second) {
      throw InvalidArgumentError(culprit(i) + ": the joint has another curve before it");
    }
  }
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const urdf::Joint& source = *model.joints_.at(curves[i].follows);
    if (!source.mimic && checked.count(&source) == 0) continue;
    throw InvalidArgumentError(
        culprit(i) + ": '" + curves[i].follows +
        "' follows a joint itself: name the one that is followed in the end");
  }
  return checked;
}

bool narrow_to_values(const MotionCurve& curve, double least, double most, double& lower,
                      double& upper) {
  const auto is_inside = [&](double q) {
    const double value = curve.at(q).value;
    return value >= least - slack_of(least) && value <= most + slack_of(most);
  };
  // Where the curve enters or leaves, by halves.
  const auto border = [&](double inside, double outside) {
    for (int i = 0; i < 100 && std::abs(outside - inside) > 1e-15 * std::abs(inside); ++i) {
      const double middle = 0.5 * (inside + outside);
      (is_inside(middle) ? inside : outside) = middle;
    }
    return inside;
  };
  // Points, and so many between them that a cubic's turns are seen.
  std::vector<double> at = {lower, upper};
  for (std::size_t i = 0; i + 1 < curve.q().size(); ++i) {
    for (int k = 0; k < 8; ++k) {
      const double q = curve.q()[i] + k * (curve.q()[i + 1] - curve.q()[i]) / 8;
      if (q > lower && q < upper) at.push_back(q);
    }
  }
  std::sort(at.begin(), at.end());
  int pieces = 0;
  double first = 0;
  double last = 0;
  bool was_inside = false;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const bool inside = is_inside(at[i]);
    if (inside && !was_inside && ++pieces == 1) {
      first = i == 0 ? at[i] : border(at[i], at[i - 1]);
    }
    if (inside) last = at[i];
    if (!inside && was_inside && pieces == 1) last = border(at[i - 1], at[i]);
    was_inside = inside;
  }
  if (pieces != 1) return false;
  lower = first;
  upper = last;
  return true;
}

MimicCurve MimicCurve::sampled(const std::string& joint, const std::string& follows, double lower,
                               double upper, const Function& function) {
  MimicCurve curve;
  curve.joint = joint;
  curve.follows = follows;
  const std::string culprit = "MimicCurve " + text_of(curve);
  if (!(std::abs(lower) <= kMaxCoordinate && std::abs(upper) <= kMaxCoordinate && lower < upper)) {
    throw InvalidArgumentError(culprit + ": lower " + number_text(lower) + ", upper " +
                               number_text(upper) + " are not finite numbers with lower < upper");
  }
  const auto call = [&](double at) {
    const auto point = function(at);
    if (std::isfinite(point.first) && std::isfinite(point.second)) return point;
    throw InvalidArgumentError(culprit + ": the function gives the value " +
                               number_text(point.first) + " and the slope " +
                               number_text(point.second) + " at " + number_text(at));
  };
  double off = 0;
  double off_slope = 0;
  for (std::size_t gaps = 16; gaps <= 8192; gaps *= 2) {
    const double step = (upper - lower) / static_cast<double>(gaps);
    curve.q.clear();
    curve.values.clear();
    curve.slopes.clear();
    for (std::size_t i = 0; i <= gaps; ++i) {
      const double at = i == gaps ? upper : lower + static_cast<double>(i) * step;
      const auto [value, slope] = call(at);
      curve.q.push_back(at);
      curve.values.push_back(value);
      curve.slopes.push_back(slope);
    }
    check_numbers_of(curve, culprit);
    const MotionCurve motion(curve.q, curve.values, curve.slopes);
    off = off_slope = 0;
    for (std::size_t i = 0; i < gaps; ++i) {
      const double at = lower + (static_cast<double>(i) + 0.5) * step;
      const auto [value, slope] = call(at);
      const MotionCurve::Point point = motion.at(at);
      off = std::max(off, std::abs(point.value - value));
      off_slope = std::max(off_slope, std::abs(point.slope - slope));
    }
    if (off <= 1e-10 && off_slope <= 1e-6) return curve;  // [rad or m], and a slope
  }
  throw InvalidArgumentError(culprit + ": with " + std::to_string(curve.q.size() - 1) +
                             " gaps the curve is still " + number_text(off) +
                             " off the function, and " + number_text(off_slope) +
                             " off its slope: the function is not smooth, or its slope is not its "
                             "derivative");
}

}  // namespace iksel
