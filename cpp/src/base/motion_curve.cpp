// SPDX-License-Identifier: BSD-3-Clause
#include "base/motion_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace iksel {
namespace {

/// Slope at x[0] of the polynomial through n points, at most four (Newton's divided differences).
double slope_at_first(const double* x, const double* y, int n) {
  double difference[4];
  std::copy_n(y, n, difference);
  double slope = 0;
  double product = 1;
  for (int order = 1; order < n; ++order) {
    for (int i = 0; i + order < n; ++i) {
      difference[i] = (difference[i + 1] - difference[i]) / (x[i + order] - x[i]);
    }
    if (order > 1) product *= x[0] - x[order - 1];
    slope += product * difference[0];
  }
  return slope;
}

/// Slopes of the cubic spline through the points, whose ends rise as the cubic through the four
/// points next to them does.
std::vector<double> spline_slopes(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  const int few = static_cast<int>(std::min<std::size_t>(n, 4));
  std::vector<double> slope(n);
  slope.front() = slope_at_first(x.data(), y.data(), few);
  const std::vector<double> last_x(x.rbegin(), x.rbegin() + few);
  const std::vector<double> last_y(y.rbegin(), y.rbegin() + few);
  slope.back() = slope_at_first(last_x.data(), last_y.data(), few);
  // The second derivative is the same from both sides of each inner point: a tridiagonal system,
  // diagonally dominant, so that elimination needs no pivots.
  std::vector<double> above(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double left = x[i] - x[i - 1];
    const double right = x[i + 1] - x[i];
    const double rise = 3 * (right / left * (y[i] - y[i - 1]) + left / right * (y[i + 1] - y[i]));
    const double diagonal = 2 * (left + right) - right * above[i - 1];
    above[i] = left / diagonal;
    slope[i] = (rise - right * slope[i - 1]) / diagonal;
  }
  for (std::size_t i = n - 1; i-- > 1;) slope[i] -= above[i] * slope[i + 1];
  return slope;
}

}  // namespace

MotionCurve::MotionCurve(std::vector<double> q, std::vector<double> values,
                         std::vector<double> slopes)
    : q_(std::move(q)), values_(std::move(values)), slopes_(std::move(slopes)) {
  if (slopes_.empty()) slopes_ = spline_slopes(q_, values_);
}

MotionCurve::Point MotionCurve::at(double q) const {
  if (!(q > q_.front())) return {values_[0] + slopes_[0] * (q - q_[0]), slopes_[0]};
  if (q >= q_.back()) return {values_.back() + slopes_.back() * (q - q_.back()), slopes_.back()};
  const auto next = std::upper_bound(q_.begin() + 1, q_.end() - 1, q);
  const std::size_t i = static_cast<std::size_t>(next - q_.begin()) - 1;
  const double h = q_[i + 1] - q_[i];
  const double t = (q - q_[i]) / h;
  const double rise = values_[i + 1] - values_[i];
  // value = values[i] + t (s0 + t (c + t d)), of slopes by t.
  const double s0 = slopes_[i] * h;
  const double s1 = slopes_[i + 1] * h;
  const double d = s0 + s1 - 2 * rise;
  const double c = rise - s0 - d;
  return {values_[i] + t * (s0 + t * (c + t * d)), (s0 + t * (2 * c + t * 3 * d)) / h};
}

MotionCurve::Interval MotionCurve::values_between(double lower, double upper) const {
  const double first = at(lower).value;
  const double last = at(upper).value;
  Interval around = {std::min(first, last), std::max(first, last)};
  const auto add = [&](double value) {
    around.lower = std::min(around.lower, value);
    around.upper = std::max(around.upper, value);
  };
  for (std::size_t i = 0; i + 1 < q_.size(); ++i) {
    if (q_[i + 1] <= lower || q_[i] >= upper) continue;
    // A cubic lies between the least and the largest of Bezier's control points.
    const double third = (q_[i + 1] - q_[i]) / 3;
    add(values_[i]);
    add(values_[i] + third * slopes_[i]);
    add(values_[i + 1] - third * slopes_[i + 1]);
    add(values_[i + 1]);
  }
  return around;
}

double MotionCurve::steepest() const {
  double steepest = 0;
  for (std::size_t i = 0; i + 1 < q_.size(); ++i) {
    // The derivative is a parabola; these are its control points.
    const double mean = (values_[i + 1] - values_[i]) / (q_[i + 1] - q_[i]);
    for (const double slope :
         {slopes_[i], slopes_[i + 1], 3 * mean - slopes_[i] - slopes_[i + 1]}) {
      steepest = std::max(steepest, std::abs(slope));
    }
  }
  return steepest;
}

}  // namespace iksel
