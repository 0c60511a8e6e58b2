// SPDX-License-Identifier: BSD-3-Clause
// The fields of the option structs, as iksel/options.hpp declares them.
#pragma once

#include <string>
#include <vector>

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
        field("kmeans_pool", &O::kmeans_pool,
              "Random configurations whose centroids the samples are; only read by kmeans."),
        field("kmeans_rounds", &O::kmeans_rounds,
              "Rounds in which each of these goes to the nearest sample, and each sample to the "
              "mean of its own; only read by kmeans."),
        field("seed", &O::seed, "Seed of all samplings but grid."),
        field("threads", &O::threads,
              "Threads that build; 0: one per core. The result has the same bits for any number.")};
  }
};

template <>
struct FieldTable<Lanes> {
  using O = Lanes;
  static constexpr const char* kName = "Lanes";
  static constexpr const char* kDoc =
      "The recommended strategy: seeds in SIMD lanes, many at once, by Levenberg-Marquardt with "
      "the limits inside the step; for an arm with a closed form (Robot.structure) seeds come from "
      "that first. Over a database with a full key, and for chains with mimic joints, the same "
      "scheme takes one seed at a time.";
  static std::vector<Field> fields() {
    return {
        field("neighbours", &O::neighbours,
              "Samples nearest to the target that are all tried, before the better half of the "
              "others "
              "and seeds at random."),
        field("damping", &O::damping, "Factor on |e|^2, which is added to the diagonal of J J^T."),
    };
  }
};

template <>
struct FieldTable<Paper> {
  using O = Paper;
  static constexpr const char* kName = "Paper";
  static constexpr const char* kDoc =
      "The pipeline of the paper: query, rank, iterate, re-select, one seed at a time. The "
      "defaults "
      "are the paper's. Enums may be given by name, as in iteration='dls'. A field that the chosen "
      "scheme does not read has to be at its default.";
  static std::vector<Field> fields() {
    return {
        field("neighbours", &O::neighbours, "Neighbours asked from the KD-tree (k)."),
        field("neighbour_radius", &O::neighbour_radius,
              "Samples whose key is farther than this from the target's are no seeds: the root of "
              "the threshold of Eq. (3), in metres with rotations weighted by the database's "
              "rotation_weight. 0: no threshold."),
        field("ranking", &O::ranking, "How the neighbours are put in order."),
        field("rotation_difference", &O::rotation_difference,
              "The rotation part of x_target - x_i in Eq. (4); read where seeds are ranked by "
              "Eq. (5) or limit-aware."),
        field("limit_aware", &O::limit_aware,
              "Rank candidates whose predicted q + J^+ e leaves the limits behind all others."),
        field("candidates", &O::candidates,
              "Best candidates kept after ranking; read unless re-selection is 'none'."),
        field("reselection", &O::reselection, "Which seed follows a failed one."),
        field("iteration", &O::iteration, "Scheme of numerical iteration."),
        field("damping", &O::damping,
              "dls: added to J J^T; 0: truncated least squares. lm: factor on |e|^2. Read by these "
              "two."),
        field("pinv_cutoff", &O::pinv_cutoff,
              "Singular values below this part of the largest are cut off (dls, pinv, pinv_rr, "
              "cwpi)."),
        field("position_clamp", &O::position_clamp,
              "The position error fed to one step is shortened to at most this [m]; by all but "
              "lm."),
        field("rotation_clamp", &O::rotation_clamp,
              "The rotation error fed to one step is shortened to at most this [rad]; by all but "
              "lm."),
        field("growth_stop", &O::growth_stop,
              "Whether an attempt is given up when both errors have grown."),
        field("min_step", &O::min_step,
              "An attempt ends, or that of pinv_rr restarts, when |sum of the step| is below this "
              "(dls, pinv, pinv_rr, cwpi) [rad or m]."),
        field("limits_stop", &O::limits_stop,
              "An attempt ends once it is within the tolerances, also outside the limits, instead "
              "of going on (dls, pinv, pinv_rr, cwpi; the others always do)."),
        field("null_space_gain", &O::null_space_gain,
              "Part of the way to the middle of the limits that each step of a chain of more than "
              "six joints makes besides, in the Jacobian's null space (dls, pinv, pinv_rr)."),
        field("limit_margin", &O::limit_margin,
              "Part of a joint's range, at each end, in which cwln and cwpi hold it back."),
        field("whole_turns", &O::whole_turns,
              "Bring joints with a range of more than 2 pi inside their limits by whole turns."),
        field("kinematics", &O::kinematics, "What computes FK and Jacobians."),
    };
  }
};

/// A strategy by its class, by its name, or as a mapping of a name and fields.
template <>
struct FromPython<Strategy> {
  static std::string text() {
    return "iksel_cpp.Lanes | iksel_cpp.Paper | str | collections.abc.Mapping[str, object]";
  }
  static Strategy convert(py::handle value, const char* name);
};

template <>
struct ResultType<Strategy> {
  static std::string text() { return "iksel_cpp.Lanes | iksel_cpp.Paper"; }
};

template <>
struct ValueOf<Strategy> {
  /// A copy: what is held may be of the other class later.
  static py::object get(const Strategy& value, py::handle owner);
  static py::object to_plain(const Strategy& value);
};

template <>
struct FieldTable<SolverOptions> {
  using O = SolverOptions;
  static constexpr const char* kName = "SolverOptions";
  static constexpr const char* kDoc =
      "All settings of a Solver. SolverOptions() is the recommended preset, SolverOptions.paper() "
      "the paper. What only one strategy reads is a field of that: "
      "SolverOptions(strategy=Paper(iteration='dls')).";
  static std::vector<Field> fields() {
    return {
        field("position_tolerance", &O::position_tolerance,
              "An answer's position is at most this far from the target's [m]."),
        field("rotation_tolerance", &O::rotation_tolerance,
              "An answer's rotation vector error is at most this long [rad]."),
        field("task", &O::task,
              "What of a pose has to be reached: all of it, or a box with free axes."),
        field("max_attempts", &O::max_attempts,
              "Seeds tried at most: 1 + the number of re-selections. Given seeds come on top."),
        field("max_iterations", &O::max_iterations, "Steps per attempt at most."),
        field("seed", &O::seed, "Seed of random restarts."),
        field("database", &O::database,
              "Database that a solver builds for itself when it is given none."),
        field("strategy", &O::strategy, "How seeds are selected and iterated: Lanes or Paper."),
    };
  }
  /// Where a field of a strategy belongs.
  static std::string hint(const std::string& name);
};

}  // namespace iksel::python
