// SPDX-License-Identifier: BSD-3-Clause
// What joint values may be, and how far they are from each other: limits, whole turns, samples.
//
// Limits are rows, lower <= c . q <= upper: of a joint, whose c is a one among zeros and is not
// stored, and of sums of joint values, which coupled limits bound.
//
// A joint with a range of a whole turn or more takes its limits by periodic images: values that
// differ by whole turns put the arm into the same pose. But they count in sums that are limited, so
// of joints in these the images are chosen together.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "base/angle.hpp"
#include "base/constants.hpp"
#include "base/function_ref.hpp"
#include "base/random.hpp"
#include "iksel/coupled_limit.hpp"
#include "iksel/types.hpp"

namespace iksel {

struct Limit {
  int joint = -1;          ///< -1: of a sum
  int coupled_limit = -1;  ///< of a sum: its number in RobotOptions::coupled_limits
  JointVector c;           ///< of a sum: coefficients, one for each joint
  double lower, upper;     ///< [rad or m]; of a sum no farther than the joints' own let it go
  double size = 1;         ///< sum of the coefficients' sizes
  double rounding = 0;     ///< what is held to a bound is held so far inside of it

  [[nodiscard]] double value(const double* q) const { return joint < 0 ? sum(q) : q[joint]; }
  [[nodiscard]] double sum(const double* q) const;
  /// How far a value lies outside, below 0 if it lies inside [rad or m].
  [[nodiscard]] double beyond(double value) const { return std::max(lower - value, value - upper); }
  /// What is held to a bound.
  [[nodiscard]] double held_at(bool at_upper) const {
    return at_upper ? upper - rounding : lower + rounding;
  }
  /// The coefficients of all joints.
  [[nodiscard]] JointVector row(int dof) const {
    return joint < 0 ? c : JointVector(JointVector::Unit(dof, joint));
  }
};

/// Whether all values lie inside.
bool contain(const std::vector<Limit>& limits, const double* q);

/// So often a configuration is drawn again whose sums are outside.
inline constexpr int kMostDraws = 1000;

/// The limits that a configuration stands at and is led beyond.
struct ActiveLimits {
  JointVector free;  ///< of each joint 0 if its own is one of them, else 1
  /// Of the sums, over the joints that are free: a column for each, unit vectors across each other.
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor | Eigen::DontAlign, kMaxDof,
                kMaxCoupledLimits>
      across;
};

class JointSpace {
 public:
  [[nodiscard]] int dof() const { return static_cast<int>(lower.size()); }

  [[nodiscard]] JointType type(int joint) const { return types[static_cast<std::size_t>(joint)]; }
  [[nodiscard]] const std::string& name(int joint) const {
    return names[static_cast<std::size_t>(joint)];
  }
  /// The joint of a name; -1 if there is none.
  [[nodiscard]] int find(const std::string& wanted) const {
    const auto at = std::find(names.begin(), names.end(), wanted);
    return at == names.end() ? -1 : static_cast<int>(at - names.begin());
  }
  [[nodiscard]] bool is_slide(int joint) const { return type(joint) == JointType::prismatic; }
  /// True where a whole turn of the joint leads to the same pose, and may lie inside the limits.
  [[nodiscard]] bool is_periodic(int joint) const {
    return repeats[static_cast<std::size_t>(joint)] && !(upper[joint] - lower[joint] < kTwoPi);
  }

  /// Whether a joint may turn on and on in a search, to be wrapped at the end.
  [[nodiscard]] bool winds(int joint) const { return is_periodic(joint) && !turns_in_sum(joint); }

  /// Whether whole turns of a joint change a sum that is limited, and may lie inside the limits.
  [[nodiscard]] bool turns_in_sum(int joint) const {
    return !turning.empty() && std::find(turning.begin(), turning.end(), joint) != turning.end();
  }
  /// Calls visit(limit) with that of each joint, then with that of each sum.
  template <typename Visit>
  void visit_limits(const Visit& visit) const {
    for (int j = 0; j < dof(); ++j) visit(Limit{j, -1, {}, lower[j], upper[j]});
    for (const Limit& sum : sums) visit(sum);
  }
  /// That of a joint, or with -1 that of a coupled limit.
  [[nodiscard]] Limit limit(int joint, int coupled_limit) const;

  /// True if every value lies inside, both ends included.
  [[nodiscard]] bool contains(const double* q) const;
  /// Whether all sums lie inside.
  [[nodiscard]] bool contains_sums(const double* q) const { return contain(sums, q); }
  /// Each joint at its limit if it is beyond; and where a sum is outside then, moved along its
  /// coefficients until none is.
  [[nodiscard]] JointVector clamp(const JointVector& q) const {
    JointVector inside = q.cwiseMax(lower).cwiseMin(upper);
    if (!sums.empty()) hold_sums(inside);
    return inside;
  }
  /// Moves q, whose joints lie inside their own limits, so that sums do too.
  void hold_sums(JointVector& q) const;
  /// How far each joint lies outside its own limits, 0 inside [rad or m].
  [[nodiscard]] JointVector violations(const JointVector& q) const {
    return (lower - q).cwiseMax(q - upper).cwiseMax(0.0);
  }
  /// The limits that q stands at and that `pull` leads it beyond. `is_held(joint)`: false where the
  /// joint's own is to be passed over.
  template <typename IsHeld>
  [[nodiscard]] ActiveLimits active(const JointVector& q, JointVector pull,
                                    const IsHeld& is_held) const {
    ActiveLimits at{JointVector::Ones(dof()), {}};
    for (int j = 0; j < dof(); ++j) {
      const bool leaves = (q[j] <= lower[j] && pull[j] < 0) || (q[j] >= upper[j] && pull[j] > 0);
      if (leaves && is_held(j)) at.free[j] = pull[j] = 0;
    }
    if (!sums.empty()) add_active_sums(q, pull, at);
    return at;
  }
  /// The middle of the limits; 0 where there are none.
  [[nodiscard]] JointVector middle() const;

  /// Each joint of which whole turns lead to the same pose at that nearest to the middle of its
  /// limits, where it violates them least.
  [[nodiscard]] JointVector turned_to_middle(JointVector q) const;
  /// Whether q + step lies outside; a periodic joint never does, as it can be wrapped.
  [[nodiscard]] bool leaves(const double* q, const double* step) const;
  /// Brings joints that are outside inside the limits by whole turns, to their nearest image, and
  /// those without limits to (-pi, pi]; where no image lies inside, the value stays.
  void wrap(double* q) const;
  /// The same where joints turn in sums, for then what is inside joint by joint need not be; else
  /// nothing, and false.
  bool wrap_sums(double* q) const {
    if (turning.empty()) return false;
    wrap(q);
    return true;
  }
  /// Brings each periodic joint to the image nearest to `near` inside the limits; q lies inside
  /// them before and after. An image that lies outside by no more than `slack` [rad] is taken too,
  /// and the joint held to the limit. True if one was. Images of joints that turn in sums are
  /// nearest together, by the `length` of the way; without, by the root of the sum of squares.
  bool wrap_nearest(const JointVector& near, double slack, JointVector& q) const;
  using Length = FunctionRef<double(const JointVector&)>;
  bool wrap_nearest(const JointVector& near, double slack, const Length& length,
                    JointVector& q) const;
  /// Calls use(image) with each combination of the joints' images inside the limits, from the
  /// lowest on, as long as it returns true; of joints without limits in [-pi, pi). Images that lie
  /// outside by rounding are held to the limits.
  template <typename Use>
  void visit_images(JointVector q, const Use& use) const {
    for (int j = 0; j < dof(); ++j) {
      if (is_periodic(j)) q[j] = lowest_image(j, q[j]);
    }
    do {
      if (contains_sums(q.data()) && !use(clamp(q))) return;
    } while (next_combination(q));
  }

  /// By how much a joint's values differ, whole turns counting nothing where it is periodic.
  [[nodiscard]] double difference(int joint, double from, double to) const {
    const double d = to - from;
    return std::abs(d) > kPi && is_periodic(joint) ? without_turns(d) : d;
  }
  /// The same of all joints.
  template <typename A, typename B>
  [[nodiscard]] JointVector difference(const A& from, const B& to) const {
    JointVector d(dof());
    for (int j = 0; j < dof(); ++j) {
      const auto i = static_cast<std::size_t>(j);
      d[j] = difference(j, from[i], to[i]);
    }
    return d;
  }
  /// The largest of these; or anything not below `bound` if it is not below.
  template <typename A, typename B>
  [[nodiscard]] double distance(const A& a, const B& b, double bound = kInfinity) const {
    double largest = 0;
    for (int j = 0; j < dof(); ++j) {
      const auto i = static_cast<std::size_t>(j);
      largest = std::max(largest, std::abs(difference(j, b[i], a[i])));
      if (largest >= bound) return largest;
    }
    return largest;
  }

  /// Whether they differ by less in every joint.
  template <typename A, typename B>
  [[nodiscard]] bool are_near(const A& a, const B& b, double within) const {
    return distance(a, b, within) < within;
  }

  /// The farthest that each joint may move in a time step by its velocity limit; infinite where
  /// dt is 0.
  [[nodiscard]] JointVector longest_moves(double dt) const;

  /// Range that samples are taken from: the limits, or [-pi, pi) where there are none.
  [[nodiscard]] double sample_lower(int joint) const {
    return type(joint) == JointType::continuous ? -kPi : lower[joint];
  }
  [[nodiscard]] double sample_upper(int joint) const {
    return type(joint) == JointType::continuous ? kPi : upper[joint];
  }
  /// A configuration uniform in that range, and inside the limits.
  [[nodiscard]] JointVector sample(Random& random) const;
  /// n of them, one per row.
  [[nodiscard]] Matrix samples(std::size_t n, std::uint64_t seed, const Progress& progress) const;

  std::vector<std::string> names;
  std::vector<JointType> types;
  JointVector lower, upper;   ///< of joints [rad or m]; infinite for continuous ones
  std::vector<bool> repeats;  ///< whether a whole turn of a joint leads to the same pose
  JointVector velocity;       ///< [rad/s or m/s]
  std::vector<Limit> sums;
  JointVector interior;  ///< well inside all limits, if there are sums
  /// Joints that turn in a sum that is limited, and their images together, each as whole turns on
  /// top of those nearest to the middle of the limits: numbers at these joints, 0 at the others.
  std::vector<int> turning;
  std::vector<JointVector> images;

 private:
  void add_active_sums(const JointVector& q, JointVector& pull, ActiveLimits& at) const;
  /// Of a periodic joint, if it has one inside its limits.
  [[nodiscard]] double lowest_image(int joint, double value) const;
  /// The next combination of images inside the joints' own limits, whatever the sums are; false
  /// after the last, which leaves q at the first.
  bool next_combination(JointVector& q) const;
  /// Of the joints that turn in sums the images nearest by `length` that lie inside by up to
  /// `slack`; where there are none, those that lie outside least.
  void choose_images(double slack, const Length& length, JointVector& q) const;
};

}  // namespace iksel
