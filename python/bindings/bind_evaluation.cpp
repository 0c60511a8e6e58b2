// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"

namespace iksel::python {

template <>
struct FieldTable<Evaluation> : HeaderTable<Evaluation> {};

namespace {

Evaluation evaluate_solver(const Solver& solver, std::size_t targets, std::uint64_t seed,
                           bool stages, const std::optional<ProgressCallable>& progress,
                           std::size_t touched) {
  const Progress report = make_progress(progress);
  return without_gil([&] { return evaluate(solver, targets, seed, stages, report, touched); });
}

py::dict stage_times(const Solver& solver, const Pose& pose) {
  StageTimes ns;
  without_gil([&] { static_cast<void>(solver.solve(pose, {}, &ns)); });
  return py::dict("query_us"_a = ns.query / 1e3, "rank_us"_a = ns.rank / 1e3,
                  "iterate_us"_a = ns.iterate / 1e3, "reselect_us"_a = ns.reselect / 1e3);
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
  def(m, "stage_times", "solver, pose", fn<&stage_times>,
      "Where the time of one solve of a pose goes [us]: finding seeds or what is known of the "
      "solutions (query_us), ranking (rank_us), iterating (iterate_us) and choosing seeds again "
      "(reselect_us). Evaluation has the means of many.");
  def(m, "time_kdl_fk_jacobian", "robot",
      [](const Robot& robot) { return without_gil([&] { return time_kdl_fk_jacobian(robot); }); });
  def(m, "simd_level", "", [] { return std::string(simd_level()); });
}

}  // namespace iksel::python
