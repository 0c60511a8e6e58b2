// SPDX-License-Identifier: BSD-3-Clause
// What goes into and comes out of a pack of lanes: plain numbers, so that files compiled for
// different instruction sets agree on them.
#pragma once

#include <cstddef>

#include "base/constants.hpp"
#include "base/motion_curve.hpp"

namespace iksel::lanes {

/// Most degrees of freedom.
inline constexpr int kMaxJoints = 32;
/// Most sums of joint values that are limited.
inline constexpr int kMostSums = 8;
/// Most lanes of a pack.
inline constexpr int kWidth = 8;
/// Samples that a leaf or a stage of neighbours hands over at a time; a multiple of every pack's
/// single-precision lanes.
inline constexpr int kBlock = 16;

/// A joint that moves, as a KernelJoint.
template <typename Number>
struct LaneJointOf {
  Number p[3];
  Number cos_alpha, sin_alpha;
  Number cos_turn, sin_turn;
  Number multiplier, offset;
  Number unit;               ///< that its variable is counted in [rad or m]
  const MotionCurve* curve;  ///< null: a straight line
  int variable;
  bool prismatic;
};

/// A degree of freedom.
template <typename Number>
struct LaneVariableOf {
  Number lower, upper;
  bool limited;  ///< false: a whole turn or more of range, wrapped at the end
};
using LaneVariable = LaneVariableOf<double>;

/// A limit of a sum of joint values: lower <= c . q <= upper.
template <typename Number>
struct LaneSumOf {
  Number c[kMaxJoints];
  Number lower, upper;  ///< what is held to it is held to these
  Number low, high;     ///< from these on it stands at it
  Number least_norm2;   ///< far below that of its coefficients
};

/// The chain between the frames of its first and last joint. Its maker chooses the unit of lengths,
/// which all has to be in that is iterated with it.
template <typename Number>
struct LaneChainOf {
  int n;           ///< degrees of freedom
  int joints;      ///< that they move
  bool is_simple;  ///< they are these, one to one
  LaneVariableOf<Number> variable[kMaxJoints];
  LaneJointOf<Number> joint[kMaxMovingJoints];
  int sums;
  LaneSumOf<Number> sum[kMostSums];
  /// Of each variable [rad or m], and their inverses.
  double unit[kMaxJoints], per_unit[kMaxJoints];

  /// A joint value in metres or radians, as the chain counts it, and back.
  template <typename Value>
  [[nodiscard]] Value to_lane(int j, Value value) const {
    return value * static_cast<Value>(per_unit[j]);
  }
  template <typename Value>
  [[nodiscard]] Value from_lane(int j, Value value) const {
    return value * static_cast<Value>(unit[j]);
  }
};
using LaneChain = LaneChainOf<double>;

/// Numbers of the iteration, squared where they are compared with squares.
struct LaneOptions {
  double damping;                       ///< part of the squared error that is added to J J^T
  double least_damping;                 ///< and what comes on top, above rounding
  double position2, rotation2, lever2;  ///< |error| below these: there already
  double last_step2, last_error2;       ///< a step from below these is the last
};

/// What a task leaves open (goal/task_space.hpp). All vectors are in the first joint's frame.
struct LaneTask {
  double lower[6], upper[6];  ///< bounds to aim at: position and rotation along the task's axes
  bool fixed[6];              ///< without any width
  bool open[6];               ///< without bounds
  int twist;                  ///< axis of the twist; -1: the rotation vector is used
  double tcp[3];              ///< seen from the last joint
};

/// What a pack of lanes works on, lane by lane. Rows of a full pose: position (3), columns x (3),
/// y (3), z (3) of the last joint's frame seen from the first one's. Rows of a task: position (3)
/// of the TCP; columns of W (9), the task's axes; columns of K (9), by which the last joint's frame
/// R gives the deviation E = W^T R K.
inline constexpr int kFullPoseRows = 12;
inline constexpr int kTargetRows = 21;
struct LanePack {
  alignas(64) double target[kTargetRows][kWidth];
  alignas(64) double q[kMaxJoints][kWidth];
  /// Squared error before the last step.
  alignas(64) double error2[kWidth];
};

/// The same in single precision, of one full pose for all lanes.
struct RoughPack {
  float target[kFullPoseRows];
  alignas(64) float q[kMaxJoints][kBlock];
  alignas(64) float error2[kBlock];
};

/// Where the lanes of a pack stand on self-motions of seven joints, and all reach that full pose.
struct CurvePack {
  double target[kFullPoseRows];
  alignas(64) double q[kCurveJoints][kWidth];
  /// Unit vectors along the curves, the way that each lane goes.
  alignas(64) double tangent[kCurveJoints][kWidth];
  /// 1 where tangents are oriented that way, else -1.
  alignas(64) double side[kWidth];
  alignas(64) double step[kWidth];  ///< length of the next step [rad and m]
  double longest;                   ///< what it may become
};

/// How an advance ended.
struct PackResult {
  unsigned done;   ///< bit l: lane l arrived, as far as the step tells
  int iterations;  ///< of the whole pack
};

/// A pose to come near to, and what is missing of it counts (closest_kernel.hpp). In the first
/// joint's frame.
struct ClosestTarget {
  float position[3];
  float metric[3][3];  ///< W, of the position's squared weights
  /// B = K T^-1 in the first joint's frame, with the weights of the axes between these: the last
  /// joint's rotation times it is the deviation's, or one with the same trace.
  float rotation[3][3];
  float trace;      ///< of the weights of the axes
  float rotation2;  ///< the rotation's squared weight
  float tcp[3];     ///< seen from the last joint
};

/// How a side of the chain is left out of the samples (reduction.hpp).
enum class Side : int { none, rotation, translation };

/// Samples in blocks, lane by lane: row r of a block is kBlock numbers. Rows: position (3), columns
/// x (3), y (3), z (3) of the sample's pose seen from the first joint, its n joint values, of which
/// those left out are not read, and its n x 6 pseudo-inverse row by row.
constexpr int block_rows(int n) { return kFullPoseRows + 7 * n; }

/// What seeds are prepared with.
struct SeedChain {
  int n;
  Side left, right;
  float weight2;  ///< squared rotation weight of the key [m^2]
  float offset_first, offset_last;
  float lower[kMaxJoints], upper[kMaxJoints], middle[kMaxJoints];
  bool wraps[kMaxJoints];  ///< turns, so that whole turns change nothing
};

/// A full pose to reach.
template <typename N>
struct SeedTargetOf {
  N target[kFullPoseRows];
};
using SeedTarget = SeedTargetOf<float>;

/// Seeds made from a block.
struct SeedPack {
  /// The joints left out of the samples, as they bring each sample's pose nearest to the target.
  alignas(64) float first[kBlock], last[kBlock];
  /// All joints after the first step, inside the limits.
  alignas(64) float q[kMaxJoints][kBlock];
  alignas(64) float score[kBlock];
  unsigned char order[kBlock];  ///< best score first
};

struct ClosedForm;
struct BranchPack;
struct BranchRow;
struct Regularity;
struct MoveForm;
struct MovePack;
struct ResidualForm;
struct LoopForm;
struct LoopTarget;
struct TrigonometricPolynomial;
struct SceneView;
struct SceneRoom;

/// Iterations of packs of one width.
struct PackKernels {
  int lanes;
  /// Iterates a pack, until a lane of the mask `watched` arrives or the iterations are used up.
  /// `task` is null for full poses.
  PackResult (*advance)(const LaneChain& chain, const LaneOptions& options, const LaneTask* task,
                        unsigned watched, int iterations, LanePack& pack);
  decltype(advance) advance_task;
};

/// The kernels of one instruction set.
struct LaneKernels {
  const char* name;
  /// Lanes iterate in lockstep. `narrow` takes the least time for an iteration, which is what the
  /// first answer for one pose waits for; `wide` the least for each lane.
  PackKernels narrow, wide;
  /// Iterates all lanes of a pack so often: seeds that are mostly going to fail need no precision.
  void (*advance_roughly)(const LaneChainOf<float>& chain, const LaneOptions& options,
                          int iterations, RoughPack& pack);
  /// Moves kBlock seeds so often towards where the least is missing. Of each joint kBlock values in
  /// q follow each other; `remainder` becomes what is missing where they then are.
  void (*approach)(const LaneChainOf<float>& chain, const ClosestTarget& target, int iterations,
                   float* q, float* remainder);
  void (*prepare)(const SeedChain& chain, const SeedTarget& target, const float* block,
                  SeedPack& out);
  /// Blocks of configurations of n joints, kBlock values of each joint one after the other and so
  /// many numbers from block to block, from one more: lowers their `nearest` to the distance in the
  /// joint where that is largest [rad or m]. `per_turn`: 1 / 2 pi for joints whose whole turns
  /// change nothing, else 0.
  void (*add_known)(int n, const float* per_turn, const float* from, const float* q, int blocks,
                    std::ptrdiff_t stride, float* nearest);
  /// Index of the largest of `count` numbers, a multiple of kBlock; of equals the first.
  int (*find_largest)(int count, const float* numbers);

  /// The angles of all lanes of a pack (branch_types.hpp); solve_inside, of all branches of one
  /// target, says no more of those outside the limits than that they are there; find_branches says
  /// less of how certain they are.
  void (*solve_branches)(const ClosedForm& form, BranchPack& pack);
  decltype(solve_branches) solve_inside;
  decltype(solve_branches) find_branches;
  void (*measure_regularity)(const ClosedForm& form, const BranchPack& pack, Regularity& out);
  /// How far branches are from being answers, at kWidth angles of the held joint
  /// (sweep_kernel.hpp).
  void (*rate_branches)(const ClosedForm& form, const BranchPack& pack, double bound,
                        double (&off)[kWidth][kWidth]);
  void (*rate_branch)(const ClosedForm& form, const BranchPack& pack, double bound,
                      double (&off)[kWidth]);
  /// Where branches of two signs, and of each third one, may be inside the limits for some target
  /// within ClosedForm::error of the pack's first: `room` below 0 where there are none in pack.held
  /// +- half of the held joint [rad or m] (enclosure_kernel.hpp).
  void (*enclose_branches)(const ClosedForm& form, const BranchPack& pack, double half,
                           double (&room)[2][kWidth]);
  /// How far all lanes of a pack are away (move_kernel.hpp).
  void (*measure_moves)(const MoveForm& form, const BranchPack& pack, MovePack& out);
  /// All branches at kWidth values of the held joint, and how far they are away; unless that is
  /// more than `most`, or they are more than `bound` from being answers (nearest_kernel.hpp).
  void (*measure_branches)(const ClosedForm& form, const MoveForm& move, const BranchPack& pack,
                           double bound, double most, BranchRow (&rows)[kWidth]);

  /// The residuals of `n` angles, a multiple of kWidth (residual_kernel.hpp). Returns the least of
  /// what they are divided by.
  double (*find_residuals)(const ResidualForm& form, const double* angles, int n,
                           double* residuals);
  /// The number of roots between values beside each other: 0, 1, or 2 if that is not certain.
  void (*count_roots)(const double* values, int n, double apart, double* counts);
  /// The clearance of a configuration (scene_types.hpp).
  double (*find_clearance)(const SceneView& scene, const double* q, SceneRoom& room);
  /// The determinants of six equations at `n` angles, a multiple of kWidth (loop_determinant.hpp).
  void (*find_determinants)(const LoopTarget& target, const double* angles, int n, double* values);
  void (*evaluate_polynomial)(const TrigonometricPolynomial& polynomial, const double* angles,
                              int n, double* values);
  /// The other joints' angles, at kWidth roots.
  void (*close_loops)(const LoopForm& form, const LoopTarget& target, const ClosedForm& limits,
                      bool are_pairs, BranchPack& pack);
  /// C = A B, by columns; so many rows of A and C, a multiple of kWidth.
  void (*multiply)(const double* A, int rows, const double* B, int inner, int columns, double* C);
  /// The tangents of curves where the lanes stand, and a step of each along its curve; returns the
  /// lanes that went (curve_kernel.hpp).
  void (*orient_curves)(const LaneChain& chain, CurvePack& pack);
  unsigned (*follow_curves)(const LaneChain& chain, CurvePack& pack);
};

}  // namespace iksel::lanes
