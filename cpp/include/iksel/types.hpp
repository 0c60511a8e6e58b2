// SPDX-License-Identifier: BSD-3-Clause
// The conventions of the whole library, stated once:
//   * A pose is that of the TCP, or of the tip link if there is no tool, written T_base_tip: it
//     takes coordinates in that frame to coordinates in the base frame. Lengths are metres, angles
//     radians.
//   * A twist is [linear; angular] in base axes, taken at the TCP; a Jacobian maps joint
//     velocities to it.
//   * The rotation error between a target and a pose is the rotation vector of R_target * R^T.
//   * Quaternions in helpers are (w, x, y, z).
//   * A pose that comes in may be rounded: one whose rotation is off by kRigidTolerance or less
//     stands for the rigid one nearest to it, by which all answers are measured.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <functional>

namespace iksel {

/// Most joints (degrees of freedom) a chain may have.
inline constexpr int kMaxDof = 32;

/// Largest length [m] and joint value [rad or m] that a robot may have: at 1e8 doubles are 1.5e-8
/// apart, so that the forward kinematics of kMaxDof joints errs by less than 1e-6; far below the
/// 1e18 whose squares leave the single-precision keys of a database.
inline constexpr double kMaxCoordinate = 1e8;

/// Joint values [rad or m], one per degree of freedom, base to tip. Holds its storage inside, so
/// that it is never on the heap; unaligned, so that its layout does not depend on the caller's SIMD
/// flags.
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::DontAlign, kMaxDof, 1>;

/// Geometric Jacobian, 6 x dof: rows [linear; angular] in base axes at the TCP.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::DontAlign, 6, kMaxDof>;

/// A matrix on the heap. Unaligned too: what the library allocates, the caller's Eigen must be able
/// to free, and with other SIMD flags it would free aligned memory in another way.
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::DontAlign>;

/// Rigid transform, here always T_base_tip or a part of it.
using Pose = Eigen::Isometry3d;

/// Largest element of |R^T R - I| up to which R is taken for a rounded rotation: poses printed with
/// four decimals or more pass, a sheared or scaled one does not.
inline constexpr double kRigidTolerance = 1e-3;

/// A pose as a struct member: unaligned for the same reason as JointVector. Converts to Pose.
using StoredPose = Eigen::Transform<double, 3, Eigen::Isometry, Eigen::DontAlign>;

/// Which implementation computes forward kinematics and Jacobians; they agree to 1e-12.
enum class Kinematics {
  kernel,  ///< the library's flattened chain
  kdl,     ///< Orocos KDL, the reference
};

/// How a degree of freedom moves.
enum class JointType {
  revolute,    ///< turns between limits [rad]
  continuous,  ///< turns without limits [rad]
  prismatic,   ///< slides between limits [m]
};

/// Called now and then by the thread that works, with what is done and what there is in all. An
/// exception it throws ends the work and reaches the caller.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

}  // namespace iksel
