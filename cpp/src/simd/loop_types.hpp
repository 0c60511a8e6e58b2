// SPDX-License-Identifier: BSD-3-Clause
// What the loop kernels work on: six joints and a pose as one loop that has to close.
#pragma once

#include "simd/lane_types.hpp"

namespace iksel::lanes {

/// What a loop that closes has to satisfy.
inline constexpr int kEquations = 6;

/// Six joints in the order of the loop, from the one that is swept on: c, d, e, f, a, b. Axes lie
/// as they do where all angles are zero; lengths are in units of the reach.
struct LoopForm {
  /// What f, a and b are to each other. Where they meet in a point, or are parallel, two solutions
  /// share the angles of c, d and e.
  enum class Rest { anyhow, meet, parallel };

  Rest rest;
  /// Part of the kernels too, of which each is of its own instruction set (lane_math.hpp).
  [[nodiscard, gnu::always_inline]] bool has_two_ways() const { return rest != Rest::anyhow; }
  int before;        ///< how many of c, d and e the loop passes before the target
  double h[6][3];    ///< unit vectors along the axes
  double p[6][3];    ///< a point on each
  double across[3];  ///< a unit vector across h of f
};

/// A target, inverted, and the six equations that it leaves for an angle of c.
struct LoopTarget {
  double R[3][3];  ///< its columns
  double t[3];     ///< [units]
  /// By what is constant, goes by the cosine of an angle, and by its sine: of c, of d and of e.
  /// equation[c][i][d][e] is of the i-th.
  double equation[3][kEquations][3][3];
};

/// a[k] cos(k t) + b[k] sin(k t) for all k, added up.
struct TrigonometricPolynomial {
  static constexpr int kDegree = 8;
  double a[kDegree + 1], b[kDegree + 1];
};

}  // namespace iksel::lanes
