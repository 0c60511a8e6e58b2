// SPDX-License-Identifier: BSD-3-Clause
// What the closed-form kernels work on: the geometry of six joints, and poses lane by lane.
#pragma once

#include <cstdint>

#include "base/constants.hpp"
#include "simd/lane_types.hpp"

namespace iksel::lanes {

/// What makes six turning joints solvable in closed form. The first four end in axes 4, 5 and 6
/// that meet in one point. Three are closed for an angle of one joint, but for a
/// residual.
enum class Closure : int {
  parallel_23,     ///< axes 2 and 3 are parallel
  intersect_12,    ///< axes 1 and 2 meet
  intersect_23,    ///< axes 2 and 3 meet
  parallel_12,     ///< axes 1 and 2 are parallel
  three_parallel,  ///< axes 2, 3 and 4 are parallel, 5 and 6 meet
  sweep_4,         ///< axes 2 and 3 are parallel, 5 and 6 meet; for an angle of joint 4
  sweep_6,         ///< axes 2 and 3 are parallel, 4 and 5 meet; for an angle of joint 6
  loop,            ///< anyhow; for an angle of the first in the order of a loop (loop_types.hpp)
};

/// An angle off by more says nothing [rad].
inline constexpr double kVague = 0.3;

/// x . R(k, t) y = a cos(t) + b sin(t) + c, for constant x, k and y.
struct Turned {
  double a, b, c;
  double r2, inverse;  ///< a^2 + b^2, and 1 / r2
};

/// The limits of a joint as an arc of angles: cosines and sines of its middle and of half of it.
struct LimitArc {
  bool ends;  ///< whether there is an angle outside
  double middle_c, middle_s;
  double reach_c, reach_s;
};

/// Limits of sums of six joint values, as a closed form counts them, and the held angle. Scaled
/// so that the sizes of a row's coefficients add up to 1: angles that are off by e take a sum off
/// by no more.
struct SumForm {
  int rows;
  double coefficient[kMostSums][7];
  double lower[kMostSums], upper[kMostSums];
  /// Joints whose whole turns count; the middle of their limits and half their range [rad]; and
  /// their images together: what each adds to those nearest to the middle [rad].
  int turning;
  int joint[7];
  double middle[7], reach[7];
  int images;
  double turned[kMostImagesInSums][7];
};

/// Six joints where their angles are zero, in product-of-exponentials form. Lengths are in units of
/// the chain's reach.
struct ClosedForm {
  Closure closure;
  double error;      ///< relative error of a target that is still the same one
  double offset[6];  ///< what angles are more than joint values [rad]
  /// Middle of each joint's limits, and half their range; of a joint that has none, 0 and pi [rad].
  double middle[6], reach[6];
  LimitArc arc[6];     ///< the same limits, of angles
  double h[6][3];      ///< unit vectors along the axes
  double p[5][3];      ///< from a point on axis j to one on axis j + 1; where axes meet, one point
  double basis[3][3];  ///< right-handed, h6 last
  double across[3];    ///< a unit vector across h2
  double cross12;      ///< h1 . h2
  double cross23;      ///< h2 . h3
  double side3;        ///< of parallel axes 3 and 2: 1, or -1 if they point opposite ways
  double side4;        ///< the same of axes 4 and 2
  double arm2;         ///< |p23|^2 + |p34|^2
  double forearm;      ///< |p34|
  double along45, along56;  ///< h4 . h5 and h5 . h6
  double rest;          ///< what the way along parallel axes adds up to; of intersect_23 |p34|^2 -
                        ///< |p12|^2
  bool is_held;         ///< whether there is a joint before the first, which is held at an angle
  double held_axis[3];  ///< a unit vector along it
  double held_slide;    ///< units of length that it slides per metre; 0 where it turns
  double held_from[3];  ///< from a point on it to that on axis 1
  Turned elbow;         ///< p23 . R(h3) p34
  Turned shoulder;      ///< of parallel_12, h1 . R(h3) p34
  Turned wrist;         ///< h4 . R(h5) h6; of three_parallel, h2 . R(h5) h6
  const SumForm* sums;  ///< null: none is limited
};

/// Poses, and a branch of each, lane by lane. Rows of the target: columns X, Y and Z of R_06 E,
/// where E has the form's basis as columns, and the way from the point on axis 1 to that on axis 6
/// [units]; where a joint is held, as they are at its angle 0.
struct BranchPack {
  alignas(64) double target[12][kWidth];
  /// Angle of the held joint, or of that of sweep_4, sweep_6 or loop, if the form has one; of a
  /// slide the way [rad or m].
  alignas(64) double held[kWidth];
  /// +-1: which of two solutions each of three subproblems takes.
  alignas(64) double sign[3][kWidth];
  /// Of the six joints [rad], by whole turns inside the limits where they can be.
  alignas(64) double q[6][kWidth];
  /// How far one of them lies outside of them, or a sum does, 0 or less if none does [rad].
  alignas(64) double beyond[kWidth];
  /// Subproblems have solutions where a difference of squares is not below 0. The least of these;
  /// and at best and at worst for targets within ClosedForm::error: there is no branch where the
  /// best is below 0, and certainly one where the worst is not. The sizes of these two mean
  /// nothing.
  alignas(64) double least[kWidth];
  /// Of sweep_4 and sweep_6, 0 at solutions: by how much the cosine of the angle between two axes
  /// is off; of loop, by how much it stays open.
  alignas(64) double residual[kWidth];
  alignas(64) double best[kWidth];
  alignas(64) double worst[kWidth];
  /// What such an error may have grown to in the angles, to first order [rad].
  alignas(64) double error[kWidth];
  /// Whether one of the joints lies outside of its limits, whatever that error is in its angle: if
  /// above 0. Its size means nothing.
  alignas(64) double outside[kWidth];
};

/// How well the branches of a pack are determined, lane by lane; NaN says nothing.
struct Regularity {
  /// How far a branch's angles leave it from the target: what is largest of the way and the basis
  /// [units].
  alignas(64) double off[kWidth];
  /// The Frobenius norm of its Jacobian's inverse [rad per unit].
  alignas(64) double inverse_norm[kWidth];
};

/// Seven joints to move from: six as a form counts them, and the held one.
struct MoveForm {
  double from[7];    ///< [rad]
  double weight[7];  ///< what a move of each counts
  /// Whether a joint turns, and whether its whole turns may lie inside the limits; and these,
  /// narrower by the margin [rad or m].
  bool turns[7], has_images[7];
  double lower[7], upper[7];
  double margin;
  bool takes_largest;  ///< else the root of the squares' sum
  /// Of ClosedForm, if images change sums; these joints are then in `turns_in_sum`.
  const SumForm* sums;
  bool turns_in_sum[7];
};

/// How far branches are away, lane by lane.
struct MovePack {
  /// The move by each joint's nearest image, inside the limits or not; but of one that is inside
  /// and has no other image there, by that.
  alignas(64) double loose[kWidth];
  /// By the nearest inside the limits, if the branch is inside of them at all.
  alignas(64) double inside[kWidth];
  /// How far a branch is from being an answer: 0 if it is one [mixed units].
  alignas(64) double off[kWidth];
};

/// A branch at kWidth values of the held joint. Where it is known to lie too far away before all is
/// known of it, `inside` is not less than kFarAway, joints that are not known yet are kUnknown, and
/// `least`, `loose` and `off` are of what was known by then, the last two at least so much. What
/// joints that may be any beside are away, they count less (NearProspect).
inline constexpr double kFarAway = 1e30;
inline constexpr double kUnknown = __builtin_nan("");
struct BranchRow {
  alignas(64) double q[6][kWidth];
  alignas(64) double least[kWidth];
  MovePack moves;
  /// Where a joint lies beyond its lower limit by more than the bound, as bits of the lanes, in the
  /// joint's byte; and beyond its upper one.
  std::uint64_t below, above;
  /// Where `loose` is no more than the most, as bits of the lanes.
  std::uint64_t within;
};

/// x = one + c cos(t) + s sin(t), where t is the angle that is swept.
struct Linear {
  double one, c, s;
};

/// What the residual kernel works on: six joints and a pose, by one angle.
/// Joints 1 to 3, of which 2 and 3 are parallel, carry a point and a direction k that an angle t
/// fixes behind joint 3, to a point P and so that k makes a known angle with a direction d, which t
/// fixes too. Vectors are seen along axis 2: z is on it. Lengths are in units of the reach.
struct ResidualForm {
  /// A cos(q1) + B sin(q1) = C is what brings P to where joints 2 and 3 can carry the point.
  Linear A, B, C;
  /// From axis 2 to P, and the direction d, both as joint 1 leaves them: parts of each coordinate
  /// that are constant, go by cos(q1), and by sin(q1).
  Linear w[2][3], d[3][3];
  Linear a[2];   ///< from axis 3 to the point
  Linear k[3];   ///< the direction that is carried
  double along;  ///< k . d at solutions
  double p23_2;  ///< squared distance of axes 2 and 3
};

}  // namespace iksel::lanes
