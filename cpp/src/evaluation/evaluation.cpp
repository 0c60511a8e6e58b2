// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/evaluation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "base/pace.hpp"
#include "goal/task_space.hpp"
#include "iksel/error.hpp"
#include "kinematics/chain_model.hpp"

namespace iksel {
namespace {

using Clock = Pace::Clock;

double microseconds(Clock::duration duration) {
  return std::chrono::duration<double, std::micro>(duration).count();
}

/// By KDL's forward kinematics, not by that of the solver, and the limits.
bool is_solution(KdlChain& kdl, const Solver& solver, const Pose& target, const JointVector& q) {
  if (q.size() != solver.robot().dof() || !q.allFinite()) return false;
  const SolverOptions& options = solver.options();
  const TaskSpace space(options.task, options.position_tolerance, options.rotation_tolerance);
  double position = 0;
  double rotation = 0;
  space.measure(target, kdl.fk(q), position, rotation);
  // FK in doubles is good to 1e-14 or so, which is what two implementations may differ by.
  const auto is_within = [](double error, double most) { return error <= most + 1e-13; };
  return is_within(position, options.position_tolerance) &&
         is_within(rotation, options.rotation_tolerance) && solver.robot().within_limits(q);
}

/// Value at the quantile of sorted times.
double quantile(const std::vector<double>& times, double part) {
  const double position = part * static_cast<double>(times.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, times.size() - 1);
  return times[below] + (position - static_cast<double>(below)) * (times[above] - times[below]);
}

/// FK at random configurations, by KDL.
std::vector<Pose> make_targets(const Robot& robot, KdlChain& kdl, std::size_t count,
                               std::uint64_t seed, Pace& pace) {
  const Eigen::MatrixXd q =
      robot.random_configurations(count, seed, [&](std::size_t, std::size_t) { pace(0); });
  std::vector<Pose> targets;
  targets.reserve(count);
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    targets.push_back(kdl.fk(q.row(i)));
    if (i % 1024 == 0) pace(0);
  }
  return targets;
}

/// Solves one target after another, and adds up what they took. Before each, so many bytes of other
/// memory are touched, which take the place of all else in the processor's caches. Returns each
/// call's time [us].
std::vector<double> solve_targets(const Solver& solver, const std::vector<Pose>& targets,
                                  KdlChain& kdl, std::size_t touched, Pace& pace, Evaluation& out) {
  std::vector<unsigned char> other(touched);
  std::vector<double> times(targets.size());
  double attempts = 0;
  double iterations = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    // A byte of each cache line.
    for (std::size_t byte = 0; byte < other.size(); byte += 64) ++other[byte];
    // The clock's own code is no part of a solve.
    static_cast<void>(Clock::now());
    const auto start = Clock::now();
    const Result result = solver.solve(targets[i]);
    const auto end = Clock::now();
    times[i] = microseconds(end - start);
    attempts += result.attempts;
    iterations += result.iterations;
    out.max_iterations = std::max(out.max_iterations, result.iterations);
    if (result.success()) {
      ++out.solved;
      if (!is_solution(kdl, solver, targets[i], result.q)) ++out.false_success;
    }
    pace(i, end);
  }
  const auto n = static_cast<double>(targets.size());
  out.success_percent = 100.0 * static_cast<double>(out.solved) / n;
  out.mean_attempts = attempts / n;
  out.mean_iterations = iterations / n;
  return times;
}

void summarize(std::vector<double> times, Evaluation& out) {
  const auto n = static_cast<double>(times.size());
  out.mean_us = std::accumulate(times.begin(), times.end(), 0.0) / n;
  double squares = 0;
  for (const double t : times) squares += (t - out.mean_us) * (t - out.mean_us);
  out.std_us = std::sqrt(squares / n);
  std::sort(times.begin(), times.end());
  out.min_us = times.front();
  out.max_us = times.back();
  out.median_us = quantile(times, 0.5);
  out.p99_us = quantile(times, 0.99);
  out.p999_us = quantile(times, 0.999);
  out.ratio = out.mean_us / out.kdl_fk_jac_us;
}

/// Solves all again, with a clock at every stage.
void time_stages(const Solver& solver, const std::vector<Pose>& targets, Pace& pace,
                 Evaluation& out) {
  StageTimes total;
  for (const Pose& target : targets) {
    static_cast<void>(solver.solve(target, {}, &total));
    pace(targets.size());
  }
  const auto n = static_cast<double>(targets.size());
  out.query_us = total.query / n / 1e3;
  out.rank_us = total.rank / n / 1e3;
  out.iterate_us = total.iterate / n / 1e3;
  out.reselect_us = total.reselect / n / 1e3;
}

}  // namespace

double time_kdl_fk_jacobian(const Robot& robot, std::size_t calls) {
  if (calls == 0) throw InvalidArgumentError("calls: at least 1 is needed");
  const std::unique_ptr<KdlChain> kdl = robot.model().make_kdl();
  constexpr std::size_t kDistinct = 256;
  const Eigen::MatrixXd q = robot.random_configurations(kDistinct, 0);
  std::vector<JointVector> configurations;
  for (Eigen::Index i = 0; i < q.rows(); ++i) configurations.emplace_back(q.row(i));
  volatile double sink = 0;
  const auto start = Clock::now();
  for (std::size_t i = 0; i < calls; ++i) {
    sink = sink + kdl->fk_and_jacobian(configurations[i % kDistinct]);
  }
  return microseconds(Clock::now() - start) / static_cast<double>(calls);
}

Evaluation evaluate(const Solver& solver, std::size_t targets, std::uint64_t seed, bool stages,
                    const Progress& progress, std::size_t touched) {
  if (targets == 0) throw InvalidArgumentError("targets: at least 1 is needed");
  if (touched > kMostTouched) {
    throw InvalidArgumentError("touched: at most " + std::to_string(kMostTouched) + " bytes, not " +
                               std::to_string(touched));
  }
  const Robot& robot = solver.robot();
  const std::unique_ptr<KdlChain> kdl = robot.model().make_kdl();
  Pace pace(progress, targets);
  const std::vector<Pose> poses = make_targets(robot, *kdl, targets, seed, pace);

  Evaluation out;
  out.targets = targets;
  out.seed = seed;
  // KDL is timed before and after, so that a machine whose speed changes meanwhile does not distort
  // the ratio.
  const double kdl_before = time_kdl_fk_jacobian(robot);
  const std::size_t warm_up = std::min<std::size_t>(targets, 200);
  for (std::size_t i = 0; i < warm_up; ++i) {
    static_cast<void>(solver.solve(poses[i]));
    pace(0);
  }
  std::vector<double> times = solve_targets(solver, poses, *kdl, touched, pace, out);
  out.kdl_fk_jac_us = 0.5 * (kdl_before + time_kdl_fk_jacobian(robot));
  summarize(std::move(times), out);
  if (stages) time_stages(solver, poses, pace, out);
  if (progress) progress(targets, targets);
  return out;
}

}  // namespace iksel
