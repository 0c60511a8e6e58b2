// SPDX-License-Identifier: BSD-3-Clause
// The fields of the option structs, as iksel/options.hpp declares them.
#pragma once

#include "fields.hpp"
#include "iksel/options.hpp"
#include "task_fields.hpp"

namespace iksel::python {

template <>
struct FieldTable<DatabaseOptions> {
  using O = DatabaseOptions;
  static constexpr const char* kName = "DatabaseOptions";
  static constexpr const char* kDoc =
      "How a database is built. Enums may be given by name, as in sampling='grid'.";
  static std::vector<Field> fields() {
    return {
        field("sampling", &O::sampling, "How the samples are spread over the limits."),
        field("scale", &O::scale,
              "Counts of a grid; for the other samplings only if `samples` is 0."),
        field("samples", &O::samples,
              "Number of samples unless `sampling` is grid; 0 takes the grid's count at `scale`."),
        field("key_scheme", &O::key_scheme,
              "What of a pose the key holds; a chain with mimic joints has a full key always."),
        field("rotation_key", &O::rotation_key, "How a full key writes a rotation."),
        field("rotation_weight", &O::rotation_weight,
              "Length that one unit of the key's rotation part counts as in the tree's distance "
              "[m]; 0: a quarter of the reach."),
        field("pinv_cutoff", &O::pinv_cutoff,
              "Singular values below this part of the largest are cut off in the "
              "pseudo-inverses."),
        field("cvt_updates", &O::cvt_updates, "Updates of MacQueen's method (cvt only)."),
        field("seed", &O::seed, "Seed of the random, cvt and low_discrepancy samplings."),
        field("threads", &O::threads,
              "Threads that build; 0: one per core. The result has the same bits for any number.")};
  }
};

template <>
struct FieldTable<SolverOptions> {
  using O = SolverOptions;
  static constexpr const char* kName = "SolverOptions";
  static constexpr const char* kDoc =
      "All settings of a Solver. SolverOptions() is the recommended preset, SolverOptions.paper() "
      "the paper. Enums may be given by name, as in iteration='dls'.";
  static std::vector<Field> fields() {
    return {
        field("position_tolerance", &O::position_tolerance,
              "An answer's position is at most this far from the target's [m]."),
        field("rotation_tolerance", &O::rotation_tolerance,
              "An answer's rotation vector error is at most this long [rad]."),
        field("task", &O::task,
              "What of a pose has to be reached: all of it, or a box with free axes."),
        field("database", &O::database,
              "Database that a solver builds for itself when it is given none."),
        field("neighbours", &O::neighbours,
              "Neighbours asked from the KD-tree (k); lanes take them in widening stages."),
        field("ranking", &O::ranking, "How the neighbours are put in order."),
        field("rotation_difference", &O::rotation_difference,
              "The rotation part of x_target - x_i in Eq. (4)."),
        field("limit_aware", &O::limit_aware,
              "Rank candidates whose predicted q + J^+ e leaves the limits behind all others."),
        field("candidates", &O::candidates, "Best candidates kept after ranking."),
        field("reselection", &O::reselection, "Which seed follows a failed one."),
        field("max_attempts", &O::max_attempts,
              "Seeds tried at most: 1 + the number of re-selections. Given seeds come on top."),
        field("iteration", &O::iteration, "Scheme of numerical iteration."),
        field("max_iterations", &O::max_iterations, "Steps per attempt at most."),
        field("damping", &O::damping,
              "dls: added to J J^T; 0: truncated least squares. lm: factor on |e|^2."),
        field("pinv_cutoff", &O::pinv_cutoff,
              "Singular values below this part of the largest are cut off (truncated solves)."),
        field("position_clamp", &O::position_clamp,
              "The position error fed to one step is shortened to at most this [m]."),
        field("rotation_clamp", &O::rotation_clamp,
              "The rotation error fed to one step is shortened to at most this [rad]."),
        field("growth_stop", &O::growth_stop,
              "Whether an attempt is given up when both errors have grown."),
        field("min_step", &O::min_step,
              "An attempt ends when |sum of the step| is below this (dls, pinv, pinv_rr) "
              "[rad or m]."),
        field("limit_margin", &O::limit_margin,
              "Part of a joint's range, at each end, in which cwln and cwpi hold it back."),
        field("whole_turns", &O::whole_turns,
              "Bring joints with a range of more than 2 pi inside their limits by whole turns."),
        field("kinematics", &O::kinematics, "What computes FK and Jacobians."),
        field("seed", &O::seed, "Seed of random restarts (pinv_rr).")};
  }
};

}  // namespace iksel::python
