// SPDX-License-Identifier: BSD-3-Clause
// What joint values may be, and how far they are from each other: limits, whole turns, samples.
//
// A joint with a range of a whole turn or more takes its limits by periodic images: values that
// differ by whole turns put the arm into the same pose. But they count in the sums that coupled
// limits bound, so of joints in these the images are chosen together.
#pragma once

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

/// lower <= c . q <= upper
struct CoupledRow {
  int given = 0;        ///< its number in the options
  JointVector c;        ///< coefficients, one for each joint
  double lower, upper;  ///< [rad or m]; no farther than the joints' own limits let the sum go
  double size = 0;      ///< sum of the coefficients' sizes
  double rounding = 0;  ///< what is held to a bound is held so far inside of it

  [[nodiscard]] double sum(const double* q) const;
  /// How far a sum lies outside, below 0 if it lies inside; as far as one joint alone, of the mean
  /// coefficient, would have to move by.
  [[nodiscard]] double beyond(double sum) const {
    return std::max(lower - sum, sum - upper) / size;
  }
};

/// A column for each of some coupled limits.
using CoupledNormals =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor | Eigen::DontAlign,
                  kMaxDof, kMaxCoupledLimits>;

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

  /// Whether a joint may turn on and on in a search, to be wrapped at the end.
  [[nodiscard]] bool winds(int joint) const {
    return is_periodic(joint) && !has_coupled_images(joint);
  }

  /// True if every joint lies inside its limits, both ends included, and so do all coupled sums.
  [[nodiscard]] bool contains(const double* q) const;
  /// Each joint at its limit if it is beyond; and where a coupled limit is violated then, moved
  /// along it until it is not.
  [[nodiscard]] JointVector clamp(const JointVector& q) const {
    JointVector inside = q.cwiseMax(lower).cwiseMin(upper);
    if (!coupled.empty()) hold_coupled(inside);
    return inside;
  }
  /// How far each joint lies outside its limits, 0 inside [rad or m].
  [[nodiscard]] JointVector violations(const JointVector& q) const {
    return (lower - q).cwiseMax(q - upper).cwiseMax(0.0);
  }
  /// How far the coupled sum that is farthest lies outside, as CoupledRow::beyond; -infinity
  /// without any. Of joints with images, at those where that is least.
  [[nodiscard]] double beyond_coupled(const double* q) const;
  /// Whether all coupled sums lie inside.
  [[nodiscard]] bool holds_coupled(const double* q) const;
  /// Moves q, whose joints in coupled limits lie inside their own, into the coupled ones too.
  void hold_coupled(JointVector& q) const;
  /// Unit vectors, across each other, along the coupled limits' coefficients of which q stands at
  /// the limit and is led beyond by `pull`; over the joints only where `free` is 1, not 0.
  [[nodiscard]] CoupledNormals coupled_normals(const JointVector& q, JointVector pull,
                                               const JointVector& free) const;
  /// Whether whole turns of a joint change a coupled sum, and may lie inside the limits.
  [[nodiscard]] bool has_coupled_images(int joint) const {
    return !coupled_turning.empty() && std::find(coupled_turning.begin(), coupled_turning.end(),
                                                 joint) != coupled_turning.end();
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
  /// and the joint held to the limit. True if one was. Images of joints in coupled limits are
  /// nearest together, by the `length` of the way; without, by the root of the sum of squares.
  bool wrap_nearest(const JointVector& near, double slack, JointVector& q) const;
  using Length = FunctionRef<double(const JointVector&)>;
  bool wrap_nearest(const JointVector& near, double slack, const Length& length,
                    JointVector& q) const;
  /// Brings each periodic joint to its first image inside the limits, or into [-pi, pi) if there
  /// are none.
  void first_image(JointVector& q) const;
  /// Moves to the next combination of images inside the limits; false after the last, which leaves
  /// q at the first. Starts from first_image.
  bool next_image(JointVector& q) const;

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
  /// Writes a configuration uniform in that range to q[0], q[1], ...; with coupled limits, of what
  /// lies inside of these too.
  template <typename Q>
  void sample(Random& random, Q&& q) const {
    for (int j = 0; j < dof(); ++j) q[j] = random.uniform(sample_lower(j), sample_upper(j));
    if (coupled.empty()) return;
    JointVector drawn(dof());
    for (int j = 0; j < dof(); ++j) drawn[j] = q[j];
    if (holds_coupled(drawn.data())) return;
    sample_coupled(random, drawn);
    for (int j = 0; j < dof(); ++j) q[j] = drawn[j];
  }

  /// n of them, one per row.
  [[nodiscard]] Matrix samples(std::size_t n, std::uint64_t seed, const Progress& progress) const;

  std::vector<std::string> names;
  std::vector<JointType> types;
  JointVector lower, upper;  ///< [rad or m]; infinite for continuous joints
  JointVector velocity;      ///< [rad/s or m/s]
  std::vector<CoupledRow> coupled;
  /// Joints whose images change a coupled sum; and their images together, each as whole turns on
  /// top of those nearest to the middle of the limits: numbers at these joints, 0 at the others.
  std::vector<int> coupled_turning;
  std::vector<JointVector> coupled_images;
  /// Well inside all limits, if some are coupled.
  JointVector interior;

 private:
  /// first_image and next_image, whatever is coupled.
  void lowest_image(JointVector& q) const;
  bool next_combination(JointVector& q) const;
  /// Another draw, until one lies inside.
  void sample_coupled(Random& random, JointVector& q) const;
  /// Of the joints in coupled limits the images nearest by `length` that lie inside by up to
  /// `slack`; where there are none and `takes_any`, those that lie outside least.
  void turn_coupled(double slack, bool takes_any, const Length& length, JointVector& q) const;
};

}  // namespace iksel
