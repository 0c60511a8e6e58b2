// SPDX-License-Identifier: BSD-3-Clause
// Every choice of the pipeline query -> rank -> iterate -> re-select, with its one default.
#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>

#include "iksel/export.hpp"
#include "iksel/task.hpp"
#include "iksel/types.hpp"

namespace iksel {

/// How the joint samples of a database are spread over the limits.
enum class Sampling {
  grid,             ///< Cartesian product of interior points (the paper)
  cvt,              ///< centroidal Voronoi tessellation, MacQueen updates (the paper's revision)
  low_discrepancy,  ///< additive recurrence R_d (generalised golden ratio)
  random,           ///< uniform, seeded
  kmeans,           ///< centroids of random configurations, Lloyd's rounds (paper(2026))
};

/// Size of a grid, and of other samplings whose `samples` is 0 (paper, Table "KDTree sizes").
enum class Scale { small, medium, large };

/// What of a pose the database's key holds.
enum class KeyScheme {
  full,     ///< all of it: position and rotation (the paper)
  reduced,  ///< what the first and last joint cannot change, so that they need no samples
};

/// How the KD-tree's key writes the rotation of a pose (paper, footnote 1).
enum class RotationKey {
  rotation_vector,  ///< 3 numbers [rad]
  quaternion,       ///< 4 numbers (w, x, y, z), w >= 0
  matrix,           ///< 9 numbers
  euler,            ///< 3 numbers, roll-pitch-yaw [rad]
  /// 8 numbers for the whole pose, position included: the real part r (w, x, y, z), w >= 0, of a
  /// unit dual quaternion, and its dual part, half the product of the position and r [m].
  dual_quaternion,
};

/// How a database is built.
struct IKSEL_EXPORT DatabaseOptions {
  /// How the samples are spread over the limits.
  Sampling sampling = Sampling::low_discrepancy;
  /// Counts of a grid; for the other samplings only if `samples` is 0.
  Scale scale = Scale::medium;
  /// Number of samples unless `sampling` is grid; 0 takes the grid's count at `scale`.
  std::size_t samples = 2'000;
  /// What of a pose the key holds.
  KeyScheme key_scheme = KeyScheme::reduced;
  /// How a full key writes a rotation.
  RotationKey rotation_key = RotationKey::rotation_vector;
  /// Length that one unit of the key's rotation part counts as in the tree's distance [m]; 0: a
  /// quarter of the reach.
  double rotation_weight = 0.0;
  /// Singular values below this part of the largest are cut off in the pseudo-inverses.
  double pinv_cutoff = 1e-4;
  /// Updates of MacQueen's method (cvt only).
  std::size_t cvt_updates = 1'000'000;
  /// Random configurations whose centroids the samples are; only read by kmeans.
  std::size_t kmeans_pool = 200'000;
  /// Rounds in which each of these goes to the nearest sample, and each sample to the mean of its
  /// own; only read by kmeans.
  int kmeans_rounds = 20;
  /// Seed of all samplings but grid.
  std::uint64_t seed = 0;
  /// Threads that work; 0: one per core. The result has the same bits for any number.
  int threads = 0;

  /// The paper's: grid, medium, rotation vectors, unweighted. Of 2026: 2,048 samples by kmeans.
  /// Throws InvalidArgumentError on a year other than 2025 and 2026.
  [[nodiscard]] static DatabaseOptions paper(int year = 2025);
  /// Throws InvalidArgumentError naming the first option out of range.
  void validate() const;
};

/// How the neighbours of a target are put in order.
enum class Ranking {
  nearest,           ///< distance of the keys, Eq. (2)
  joint_adjustment,  ///< norm of J^+ (x_target - x_i), Eq. (5)
};

/// The rotation part of x_target - x_i in Eq. (4).
enum class RotationDifference {
  rotation_vector,  ///< w_target - w_i, as in the paper
  geodesic,         ///< rotvec(R_target R_i^T), the same error that iterations reduce
};

/// One scheme of numerical iteration (paper, Table II; formulas in refine/schemes.hpp).
enum class Iteration {
  dls,      ///< damped least squares; truncated least squares if `damping` is 0
  pinv,     ///< truncated pseudo-inverse
  pinv_rr,  ///< as pinv; restarts at random on a limit violation or local minimum
  cwln,     ///< clamping weighted least-norm (Huang et al. 2016)
  cwpi,     ///< as cwln with the truncated pseudo-inverse
  lm,       ///< Levenberg-Marquardt with the limits inside the step
};

/// Which seed follows a failed one.
enum class Reselection {
  none,      ///< give up after the first
  next,      ///< the next in the ranking
  farthest,  ///< the candidate farthest in joint space from the failed ones (the paper)
};

/// Whether an attempt is given up when both errors have grown.
enum class GrowthStop {
  /// Yes for dls, pinv and pinv_rr; no for cwln and cwpi, as the paper's text says (its reference
  /// implementation gives cwpi up, too), and for lm.
  by_scheme,
  on,
  off,
};

/// Seeds in SIMD lanes, many at once, by Levenberg-Marquardt with the limits inside the step: the
/// recommended strategy. Where the chain has a closed form (find_structure), seeds come from that
/// first. Over a database with a full key the same scheme takes one seed at a time.
struct IKSEL_EXPORT Lanes {
  /// Samples nearest to the target that are all tried, before the better half of the others and
  /// seeds at random.
  int neighbours = 200;
  /// Factor on |e|^2, which is added to the diagonal of J J^T [mixed units; lengths in metres, of
  /// arms that reach less than 0.35 m or more than 11 m in a power of 32 of them].
  double damping = 1e-3;

  /// Throws InvalidArgumentError naming the first option out of range.
  void validate() const;
};

/// The pipeline of the paper: query, rank, iterate, re-select, one seed at a time. The defaults are
/// the paper's: k = 200, Eq. (5), best 20, farthest first, DLS, KDL's kinematics.
struct IKSEL_EXPORT Paper {
  /// Neighbours asked from the KD-tree (k).
  int neighbours = 200;
  /// Samples whose key is farther than this from the target's are no seeds: the root of the
  /// threshold of Eq. (3), in metres with rotations weighted by the database's rotation_weight. 0:
  /// no threshold.
  double neighbour_radius = 0;
  Ranking ranking = Ranking::joint_adjustment;
  /// The rotation part of x_target - x_i in Eq. (4); read where seeds are ranked by Eq. (5) or
  /// limit-aware.
  RotationDifference rotation_difference = RotationDifference::rotation_vector;
  /// Rank candidates whose predicted q + J^+ e leaves the limits behind all others.
  bool limit_aware = false;
  /// Best candidates kept after ranking; read unless re-selection is `none`.
  int candidates = 20;
  Reselection reselection = Reselection::farthest;

  Iteration iteration = Iteration::dls;
  /// dls: added to J J^T [mixed units]; 0: truncated least squares. lm: factor on |e|^2. Read by
  /// these two.
  double damping = 0;
  /// Singular values below this part of the largest are cut off (dls, pinv, pinv_rr, cwpi).
  double pinv_cutoff = 1e-4;
  /// The error fed to one step is shortened to at most this: position [m] and rotation [rad]. Read
  /// by all but lm.
  double position_clamp = 0.1;
  double rotation_clamp = 0.3141592653589793;
  GrowthStop growth_stop = GrowthStop::by_scheme;
  /// An attempt ends, or that of pinv_rr restarts, when |sum of the step| is below this (dls, pinv,
  /// pinv_rr, cwpi) [rad or m].
  double min_step = 1e-6;
  /// An attempt ends once it is within the tolerances, also outside the limits, instead of going
  /// on (dls, pinv, pinv_rr, cwpi; the others always do).
  bool limits_stop = false;
  /// Part of the way to the middle of the limits that each step of a chain of more than six joints
  /// makes besides, as far as the pose lets it: in the Jacobian's null space (dls, pinv, pinv_rr).
  double null_space_gain = 0;
  /// Part of a joint's range, at each end, in which cwln and cwpi hold it back.
  double limit_margin = 0.1;

  /// Bring joints with a range of more than 2 pi inside their limits by whole turns.
  bool whole_turns = false;
  /// What computes FK and Jacobians of the iterations. The kernel agrees to 1e-12, and is faster.
  Kinematics kinematics = Kinematics::kdl;

  /// Throws InvalidArgumentError naming the first option that is out of range, or that differs from
  /// its default though nothing reads it.
  void validate() const;
};

using Strategy = std::variant<Lanes, Paper>;

/// All settings of a Solver. SolverOptions() is the recommended preset, SolverOptions::paper() the
/// paper. What only one strategy reads is a field of that.
struct IKSEL_EXPORT SolverOptions {
  /// An answer's position is at most this far from the target's [m]. Below about 1e-15 of what the
  /// arm reaches a double cannot tell: poses may not be found then, which proves nothing.
  double position_tolerance = 1e-6;
  /// An answer's rotation vector error is at most this long [rad].
  double rotation_tolerance = 1e-6;
  /// What of a pose has to be reached: all of it, or a box with free axes.
  Task task;

  /// Seeds tried at most: 1 + the number of re-selections (#ReA). Given seeds come on top.
  int max_attempts = 1024;
  /// Steps per attempt at most.
  int max_iterations = 20;
  /// Seed of random restarts.
  std::uint64_t seed = 0;

  /// Database that a solver builds for itself when it is given none.
  DatabaseOptions database;

  /// How seeds are selected and iterated: Lanes or Paper.
  Strategy strategy;

  /// The paper's setting: medium grid, the defaults of Paper, one re-selection, 1e-4 m and 1e-3
  /// rad. Of 2026: its authors' newer one as https://github.com/wanweiwei07/one runs it at commit
  /// 96c863f1: 2,048 samples by kmeans, of the 200 nearest the 16 best by Eq. (5) in that order,
  /// 12 configurations each, without stops on growth and small steps, redundant joints towards the
  /// middle of their limits. Throws InvalidArgumentError on another year.
  [[nodiscard]] static SolverOptions paper(int year = 2025);
  /// Throws InvalidArgumentError naming the first option out of range.
  void validate() const;
};

}  // namespace iksel
