// SPDX-License-Identifier: BSD-3-Clause
// What the residual kernel works on: six joints and a pose, by one angle.
#pragma once

namespace iksel::lanes {

/// x = one + c cos(t) + s sin(t), where t is the angle that is swept.
struct Linear {
  double one, c, s;
};

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
