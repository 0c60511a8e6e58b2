// SPDX-License-Identifier: BSD-3-Clause
// Forward kinematics and the Jacobian of a flattened chain.
//
// Every joint frame has its motion axis on z. A frame may be turned about its own z by a constant
// that the joint angle takes over, so each constant rotation between two joints (Euler angles ZXZ)
// shrinks to a single Rx(alpha):
//   T_base_tip = base * prod_k [ Trans(p_k) Rx(alpha_k) Rz(angle_k) Tz(slide_k) ] * tip
// This is Denavit and Hartenberg's idea without their common normal, which is ill defined for axes
// that are nearly parallel.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/constants.hpp"
#include "base/motion_curve.hpp"
#include "base/sincos.hpp"

namespace iksel {

/// Its motion is motion_of(joint, q[variable]) [rad or m].
struct KernelJoint : Following {
  double p[3];  ///< from the previous joint's frame [m]
  double cos_alpha, sin_alpha;
  double cos_turn, sin_turn;  ///< constant angle_k of a prismatic joint
  int variable;
  bool prismatic;
};

/// Rotation by columns and position.
struct Frame {
  double x[3], y[3], z[3], p[3];
};

struct KernelChain {
  Frame base;
  std::vector<KernelJoint> joints;
  Frame tip;     ///< last joint -> TCP
  Frame flange;  ///< last joint -> tip link
};

/// For angles of any size.
inline void safe_sincos(double angle, double& sine, double& cosine) {
  if (std::abs(angle) <= kSincosRange) {
    sincos(angle, sine, cosine);
  } else {
    sine = std::sin(angle);
    cosine = std::cos(angle);
  }
}

/// z axes and origins of the joint frames, as the Jacobian needs them.
struct JointAxes {
  double axis[kMaxMovingJoints][3];
  double origin[kMaxMovingJoints][3];
};

/// (u, v) <- (c u + s v, c v - s u): turns two columns of a rotation about the third.
inline void turn_columns(double (&u)[3], double (&v)[3], double c, double s) {
  for (int i = 0; i < 3; ++i) {
    const double a = u[i];
    u[i] = c * a + s * v[i];
    v[i] = c * v[i] - s * a;
  }
}

/// frame <- frame * local, for a constant `local`.
inline void append(Frame& frame, const Frame& local) {
  const Frame f = frame;
  for (int i = 0; i < 3; ++i) {
    frame.x[i] = f.x[i] * local.x[0] + f.y[i] * local.x[1] + f.z[i] * local.x[2];
    frame.y[i] = f.x[i] * local.y[0] + f.y[i] * local.y[1] + f.z[i] * local.y[2];
    frame.z[i] = f.x[i] * local.z[0] + f.y[i] * local.z[1] + f.z[i] * local.z[2];
    frame.p[i] = f.p[i] + f.x[i] * local.p[0] + f.y[i] * local.p[1] + f.z[i] * local.p[2];
  }
}

/// Pose of the last joint's frame; `axes` may be null.
inline Frame forward_to_last_joint(const KernelChain& chain, const double* q, JointAxes* axes) {
  Frame f = chain.base;
  // The joints' sines first: they do not depend on each other.
  double sine[kMaxMovingJoints];
  double cosine[kMaxMovingJoints];
  double motion[kMaxMovingJoints];
  int k = 0;
  for (const KernelJoint& joint : chain.joints) {
    motion[k] = motion_of(joint, q[joint.variable]);
    safe_sincos(motion[k], sine[k], cosine[k]);
    ++k;
  }
  k = 0;
  for (const KernelJoint& joint : chain.joints) {
    for (int i = 0; i < 3; ++i) {
      f.p[i] += f.x[i] * joint.p[0] + f.y[i] * joint.p[1] + f.z[i] * joint.p[2];
    }
    turn_columns(f.y, f.z, joint.cos_alpha, joint.sin_alpha);
    if (joint.prismatic) {
      turn_columns(f.x, f.y, joint.cos_turn, joint.sin_turn);
      for (int i = 0; i < 3; ++i) f.p[i] += f.z[i] * motion[k];
    } else {
      turn_columns(f.x, f.y, cosine[k], sine[k]);
    }
    if (axes != nullptr) {
      std::copy_n(f.z, 3, axes->axis[k]);
      std::copy_n(f.p, 3, axes->origin[k]);
    }
    ++k;
  }
  return f;
}

/// Pose of the TCP.
inline Frame forward(const KernelChain& chain, const double* q) {
  Frame f = forward_to_last_joint(chain, q, nullptr);
  append(f, chain.tip);
  return f;
}

/// Pose of `end` (chain.tip or chain.flange), and its Jacobian column by column:
/// jacobian[6 * variable + row], `dof` columns.
inline Frame forward_jacobian(const KernelChain& chain, const Frame& end, int dof, const double* q,
                              double* jacobian) {
  JointAxes axes;
  Frame f = forward_to_last_joint(chain, q, &axes);
  append(f, end);
  std::fill_n(jacobian, 6 * dof, 0.0);
  int k = 0;
  for (const KernelJoint& joint : chain.joints) {
    double* column = jacobian + 6 * joint.variable;
    const double* z = axes.axis[k];
    const double m = motion_slope(joint, q[joint.variable]);
    if (joint.prismatic) {
      for (int i = 0; i < 3; ++i) column[i] += z[i] * m;
    } else {
      const double* o = axes.origin[k];
      const double r[3] = {f.p[0] - o[0], f.p[1] - o[1], f.p[2] - o[2]};
      column[0] += (z[1] * r[2] - z[2] * r[1]) * m;
      column[1] += (z[2] * r[0] - z[0] * r[2]) * m;
      column[2] += (z[0] * r[1] - z[1] * r[0]) * m;
      for (int i = 0; i < 3; ++i) column[3 + i] += z[i] * m;
    }
    ++k;
  }
  return f;
}

}  // namespace iksel
