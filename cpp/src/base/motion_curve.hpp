// SPDX-License-Identifier: BSD-3-Clause
// A smooth curve through points, by which a joint follows another.
#pragma once

#include <memory>
#include <vector>

namespace iksel {

/// Cubics between points (Hermite's), and straight lines beyond the first and the last.
class MotionCurve {
 public:
  /// Two or more points, q ascending. No slopes: those of the cubic spline through the points.
  MotionCurve(std::vector<double> q, std::vector<double> values, std::vector<double> slopes);

  struct Point {
    double value, slope;
  };
  [[nodiscard]] Point at(double q) const;

  [[nodiscard]] double lower() const { return q_.front(); }
  [[nodiscard]] double upper() const { return q_.back(); }

  struct Interval {
    double lower, upper;
  };
  /// Around all values between two of q; no value lies outside, though the ends may not be taken.
  [[nodiscard]] Interval values_between(double lower, double upper) const;
  /// No slope is steeper.
  [[nodiscard]] double steepest() const;

  [[nodiscard]] const std::vector<double>& q() const { return q_; }
  [[nodiscard]] const std::vector<double>& values() const { return values_; }
  [[nodiscard]] const std::vector<double>& slopes() const { return slopes_; }

 private:
  std::vector<double> q_, values_, slopes_;
};

/// How a joint follows a degree of freedom, as motion_of says.
struct Following {
  double multiplier = 1.0;
  double offset = 0.0;
  std::shared_ptr<const MotionCurve> curve;  ///< null: a straight line
};

/// The value of a joint by the degree of freedom that moves it: multiplier * f(q) + offset, where f
/// is its curve, if it has one.
template <class Joint>
double motion_of(const Joint& joint, double q) {
  if (joint.curve != nullptr) q = joint.curve->at(q).value;
  return q * joint.multiplier + joint.offset;
}

/// Its derivative.
template <class Joint>
double motion_slope(const Joint& joint, double q) {
  return joint.curve == nullptr ? joint.multiplier : joint.multiplier * joint.curve->at(q).slope;
}

/// Around all values of a joint while its degree of freedom stays between two values.
template <class Joint>
MotionCurve::Interval motion_between(const Joint& joint, double lower, double upper) {
  if (joint.multiplier == 0) return {joint.offset, joint.offset};  // also of infinities
  MotionCurve::Interval of = {lower, upper};
  if (joint.curve != nullptr) of = joint.curve->values_between(lower, upper);
  const double a = joint.multiplier * of.lower + joint.offset;
  const double b = joint.multiplier * of.upper + joint.offset;
  return a < b ? MotionCurve::Interval{a, b} : MotionCurve::Interval{b, a};
}

}  // namespace iksel
