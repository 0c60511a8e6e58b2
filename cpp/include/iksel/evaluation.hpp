// SPDX-License-Identifier: BSD-3-Clause
// The paper's experiment protocol: success and time over random reachable targets.
#pragma once

#include <cstddef>
#include <cstdint>

#include "iksel/export.hpp"
#include "iksel/solver.hpp"

namespace iksel {

/// Outcome of `evaluate`. Times are per solve call, failures included [us].
struct Evaluation {
  std::size_t targets = 0;  ///< targets tried
  std::uint64_t seed = 0;   ///< seed of the targets
  std::size_t solved = 0;   ///< targets solved
  /// Results that say success and are none, by KDL's FK and the limits. Always to be 0.
  std::size_t false_success = 0;
  double success_percent = 0;  ///< 100 solved / targets
  double mean_us = 0;          ///< mean time per solve [us]
  double std_us = 0;           ///< standard deviation of the time [us]
  double min_us = 0;           ///< shortest time [us]
  double max_us = 0;           ///< longest time [us]
  double median_us = 0;        ///< median time [us]
  double p99_us = 0;           ///< 99th percentile of the time [us]
  double p999_us = 0;          ///< 99.9th percentile of the time [us]
  double mean_attempts = 0;    ///< mean number of seeds tried
  double mean_iterations = 0;  ///< mean number of iteration steps
  /// Most iteration steps that a solve took; Solver::work_bound is the bound.
  int max_iterations = 0;
  /// Mean time of one KDL forward kinematics plus one KDL Jacobian on the same robot [us].
  double kdl_fk_jac_us = 0;
  /// mean_us / kdl_fk_jac_us: how speed is compared between machines.
  double ratio = 0;
  double query_us = 0;     ///< mean time of the KD-tree query [us]; 0 unless asked for
  double rank_us = 0;      ///< mean time of the ranking [us]; 0 unless asked for
  double iterate_us = 0;   ///< mean time of the iterations [us]; 0 unless asked for
  double reselect_us = 0;  ///< mean time of the re-selections [us]; 0 unless asked for
};

/// Most bytes of other memory that `evaluate` touches between solves.
inline constexpr std::size_t kMostTouched = std::size_t{1} << 30U;

/// Solves `targets` poses FK(q), q uniform inside the limits, one after another on the calling
/// thread, timing each solve. With `stages`, a second pass takes the time of each stage. `touched`
/// bytes of other memory are written before each timed solve, not counted in its time: from some
/// times the processor's caches on, a solve finds nothing in them, as in a control loop beside
/// other work.
IKSEL_EXPORT Evaluation evaluate(const Solver& solver, std::size_t targets, std::uint64_t seed,
                                 bool stages = false, const Progress& progress = {},
                                 std::size_t touched = 0);

/// Mean time of one KDL FK plus one KDL Jacobian over random configurations [us].
IKSEL_EXPORT double time_kdl_fk_jacobian(const Robot& robot, std::size_t calls = 20'000);

}  // namespace iksel
