// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/evaluation.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "bindings.hpp"
#include "fields.hpp"
#include "gil.hpp"
#include "iksel/simd.hpp"
#include "progress.hpp"

namespace iksel::python {

template <>
struct FieldTable<Evaluation> {
  using E = Evaluation;
  static constexpr const char* kName = "Evaluation";
  static constexpr const char* kDoc = "Outcome of `evaluate`. Times include failures.";
  static std::vector<Field> fields() {
    return {
        field("targets", &E::targets, "Targets tried."),
        field("seed", &E::seed, "Seed of the targets."),
        field("solved", &E::solved, "Targets solved."),
        field("false_success", &E::false_success,
              "Results that say success and are none, by KDL's FK and the limits; always 0."),
        field("success_percent", &E::success_percent, "100 solved / targets."),
        field("mean_us", &E::mean_us, "Mean time per solve [us]."),
        field("std_us", &E::std_us, "Standard deviation of the time [us]."),
        field("min_us", &E::min_us, "Shortest time [us]."),
        field("max_us", &E::max_us, "Longest time [us]."),
        field("median_us", &E::median_us, "Median time [us]."),
        field("p99_us", &E::p99_us, "99th percentile of the time [us]."),
        field("p999_us", &E::p999_us, "99.9th percentile of the time [us]."),
        field("mean_attempts", &E::mean_attempts, "Mean number of seeds tried."),
        field("mean_iterations", &E::mean_iterations, "Mean number of iteration steps."),
        field("max_iterations", &E::max_iterations,
              "Most iteration steps that a solve took; Solver.work_bound is the bound."),
        field("kdl_fk_jac_us", &E::kdl_fk_jac_us,
              "Mean time of one KDL FK plus one KDL Jacobian on the same robot [us]."),
        field("ratio", &E::ratio,
              "mean_us / kdl_fk_jac_us: how speed is compared between machines."),
        field("query_us", &E::query_us, "Mean time of the KD-tree query [us]; 0 unless asked for."),
        field("rank_us", &E::rank_us, "Mean time of the ranking [us]; 0 unless asked for."),
        field("iterate_us", &E::iterate_us,
              "Mean time of the iterations [us]; 0 unless asked for."),
        field("reselect_us", &E::reselect_us,
              "Mean time of the re-selections [us]; 0 unless asked for.")};
  }
};

namespace {

Evaluation evaluate_solver(const Solver& solver, std::size_t targets, std::uint64_t seed,
                           bool stages, const std::optional<ProgressCallable>& progress,
                           std::size_t touched) {
  const Progress report = make_progress(progress);
  return without_gil([&] { return evaluate(solver, targets, seed, stages, report, touched); });
}

double time_kdl(const Robot& robot) {
  return without_gil([&] { return time_kdl_fk_jacobian(robot); });
}

}  // namespace

void bind_evaluation(py::module_& m) {
  bind_values<Evaluation>(m, "evaluate");
  def(m, "evaluate", "solver, targets, seed, stages=False, progress=None, *, touched=0",
      fn<&evaluate_solver>,
      R"(The paper's experiment protocol: success and time over random reachable targets.

Solves poses FK(q), q uniform inside the limits, one after another on this thread with the GIL
released, timing each solve inside C++.

Args:
    solver: what to evaluate.
    targets: number of targets.
    seed: seed of the targets.
    stages: take the time of each stage in a second pass.
    progress: called now and then with (targets done, targets in all). What it raises ends the
        evaluation. Ctrl-C works.
    touched: bytes of other memory that are touched before each timed solve, not counted; at most
        2**30. From some times the processor's caches on, a solve finds nothing in them, as in a
        control loop beside other work.)");
  def(m, "time_kdl_fk_jacobian", "robot", fn<&time_kdl>,
      "Mean time of one KDL FK plus one KDL Jacobian over random configurations [us].");
  def(
      m, "simd_level", "", [] { return std::string(simd_level()); },
      R"(The instruction set whose lanes solve on this machine.

avx512, avx2, sse2, neon or scalar; the environment variable IKSEL_SIMD forces one.

Raises:
    InvalidArgumentError: IKSEL_SIMD asks for one that is not to be had.)");
}

}  // namespace iksel::python
