// SPDX-License-Identifier: BSD-3-Clause
// What goes into and comes out of a pack of lanes: plain numbers, so that files compiled for
// different instruction sets agree on them.
#pragma once

namespace iksel::lanes {

inline constexpr int kMaxJoints = 32;
/// Seeds that a leaf or a stage of neighbours hands over at a time; a multiple of every pack's
/// lanes.
inline constexpr int kGroup = 8;

/// A joint of a chain whose degrees of freedom are its joints, one to one.
struct LaneJoint {
  double p[3];
  double cos_alpha, sin_alpha;
  double cos_turn, sin_turn;
  double offset;
  double lower, upper;
  bool limited;  ///< false: a whole turn or more of range, wrapped at the end
  bool prismatic;
};

/// The chain between the frames of its first and last joint.
struct LaneChain {
  int n;
  double lever;  ///< distance of the TCP from the last joint's frame [m]
  LaneJoint joint[kMaxJoints];
};

struct LaneOptions {
  double position_tolerance, rotation_tolerance;
  double damping;
  int max_iterations;
};

/// Pose of the last joint's frame to reach, seen from the first one's: columns x, y, z and
/// position.
struct LaneTarget {
  double x[3], y[3], z[3], p[3];
};

/// How a side of the chain is left out of the samples (DESIGN: reduction.hpp).
enum class Side : int { none, rotation, translation };

/// Samples in groups, lane by lane: row r of a group is kGroup numbers. Rows: position (3), columns
/// x (3), y (3), z (3) of the sample's pose seen from the first joint, then its n joint values, of
/// which those left out are not read.
inline constexpr int kPoseRows = 12;
constexpr int group_rows(int n) { return kPoseRows + n; }

/// What seeds are prepared with.
struct LaneReduction {
  Side left, right;
  double weight2;  ///< squared rotation weight of the key [m^2]
};

/// How a group or pack ended.
struct PackResult {
  int lane;        ///< the first that converged, or -1
  int iterations;  ///< of the whole pack
};

/// Iterates as many seeds as there are lanes (joint j of seed s at seeds[j * kGroup + s]) until one
/// converges; its joint values go to q.
using SolvePack = PackResult (*)(const LaneChain& chain, const LaneTarget& target,
                                 const LaneOptions& options, const double* seeds, double* q);

/// Makes the seeds of a group for a target: the left-out joints are set to bring each sample's pose
/// as near to it as they can. Bit s of the answer is set if seed s lies inside the limits.
using PrepareSeeds = unsigned (*)(const LaneChain& chain, const LaneTarget& target,
                                  const LaneReduction& reduction, const double* group,
                                  double* seeds);

/// The kernels of one instruction set.
struct LaneKernels {
  const char* name;
  int lanes;
  /// By number of joints; [0] serves any number.
  SolvePack solve[11];
  PrepareSeeds prepare;
};

}  // namespace iksel::lanes
