// SPDX-License-Identifier: BSD-3-Clause
// What joint values may be, and how far they are from each other: limits, whole turns, samples.
//
// A joint with a range of a whole turn or more takes its limits by periodic images: values that
// differ by whole turns put the arm into the same pose.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "base/constants.hpp"
#include "base/random.hpp"
#include "iksel/types.hpp"

namespace iksel {

class JointSpace {
 public:
  /// Without joints, or with so many that have yet to be filled in.
  explicit JointSpace(int dof = 0);

  [[nodiscard]] int dof() const { return static_cast<int>(lower.size()); }
  [[nodiscard]] JointType type(int joint) const { return types[static_cast<std::size_t>(joint)]; }
  [[nodiscard]] const std::string& name(int joint) const {
    return names[static_cast<std::size_t>(joint)];
  }
  [[nodiscard]] bool is_slide(int joint) const { return type(joint) == JointType::prismatic; }
  /// True where a whole turn of the joint leads to the same pose, and may lie inside the limits.
  [[nodiscard]] bool is_periodic(int joint) const {
    return !is_slide(joint) && !(upper[joint] - lower[joint] < kTwoPi);
  }

  /// True if every joint lies inside its limits, both ends included.
  [[nodiscard]] bool contains(const double* q) const;
  /// Each joint at its limit if it is beyond.
  [[nodiscard]] JointVector clamp(const JointVector& q) const {
    return q.cwiseMax(lower).cwiseMin(upper);
  }
  /// How far each joint lies outside its limits, 0 inside [rad or m].
  [[nodiscard]] JointVector violations(const JointVector& q) const {
    return (lower - q).cwiseMax(q - upper).cwiseMax(0.0);
  }
  /// Each joint that turns at the whole turn nearest to the middle of its limits, where it violates
  /// them least.
  [[nodiscard]] JointVector turned_to_middle(JointVector q) const;
  /// Whether q + step lies outside; a periodic joint never does, as it can be wrapped.
  [[nodiscard]] bool leaves(const double* q, const double* step) const;
  /// The middle of the limits; 0 where there are none.
  [[nodiscard]] JointVector middle() const;

  /// Brings joints that are outside inside the limits by whole turns, to their nearest image, and
  /// those without limits to (-pi, pi]; where no image lies inside, the value stays.
  void wrap(double* q) const;
  /// Brings each periodic joint to the image nearest to `near` inside the limits; q lies inside
  /// them before and after. An image that lies outside by no more than `slack` [rad] is taken too,
  /// and the joint held to the limit. True if one was.
  bool wrap_nearest(const JointVector& near, double slack, JointVector& q) const;
  /// Brings each periodic joint to its first image inside the limits, or into [-pi, pi) if there
  /// are none.
  void first_image(JointVector& q) const;
  /// Moves to the next combination of images inside the limits; false after the last, which leaves
  /// q at the first. Starts from first_image.
  bool next_image(JointVector& q) const;

  /// The largest difference of a joint, whole turns counting nothing; or anything not below `bound`
  /// if it is not below.
  template <typename A, typename B>
  [[nodiscard]] double distance(const A& a, const B& b, double bound) const {
    double largest = 0;
    for (int j = 0; j < dof(); ++j) {
      double d = std::abs(a[j] - b[j]);
      if (d >= bound && is_periodic(j)) {
        d = std::abs(d - kTwoPi * static_cast<double>(static_cast<long>(d / kTwoPi + 0.5)));
      }
      largest = std::max(largest, d);
      if (largest >= bound) return largest;
    }
    return largest;
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
  /// Writes a configuration uniform in that range to q[0], q[1], ...
  template <typename Q>
  void sample(Random& random, Q&& q) const {
    for (int j = 0; j < dof(); ++j) q[j] = random.uniform(sample_lower(j), sample_upper(j));
  }

  std::vector<std::string> names;
  std::vector<JointType> types;
  JointVector lower, upper;  ///< [rad or m]; infinite for continuous joints
  JointVector velocity;      ///< [rad/s or m/s]
};

}  // namespace iksel
