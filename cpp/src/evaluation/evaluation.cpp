// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/evaluation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/constants.hpp"
#include "iksel/error.hpp"
#include "kinematics/chain_model.hpp"

namespace iksel {
namespace {

using Clock = std::chrono::steady_clock;

double microseconds(Clock::duration duration) {
  return std::chrono::duration<double, std::micro>(duration).count();
}

/// What of a deviation lies outside an interval.
double outside(double deviation, double lower, double upper) {
  return deviation - std::min(std::max(deviation, lower), upper);
}

/// The axis whose width is unlike the other two's; -1: none.
int twist_axis(const Task& task) {
  const auto width = [&](std::size_t i) {
    return std::min(task.rotation_upper[i] - task.rotation_lower[i], 2 * kPi);
  };
  const double x = width(0);
  const double y = width(1);
  const double z = width(2);
  if (x == y && y == z) return -1;
  const double apart[3] = {std::abs(y - z), std::abs(x - z), std::abs(x - y)};
  const double widths[3] = {x, y, z};
  int odd = 0;
  for (int i = 1; i < 3; ++i) {
    if (apart[i] < apart[odd] || (apart[i] == apart[odd] && widths[i] > widths[odd])) odd = i;
  }
  return odd;
}

/// The errors that a Task's documentation defines, by quaternions: the solver's own formulas are
/// others. [position; rotation] outside of the box.
Eigen::Matrix<double, 6, 1> task_errors(const Task& task, const Pose& target, const Pose& pose) {
  const bool in_tool = task.frame == TaskFrame::tool;
  const Eigen::Quaterniond to(target.linear());
  const Eigen::Quaterniond at(pose.linear());
  Eigen::Vector3d p = pose.translation() - target.translation();
  if (in_tool) p = to.conjugate() * p;
  Eigen::Quaterniond E = in_tool ? to.conjugate() * at : at * to.conjugate();
  if (E.w() < 0) E.coeffs() *= -1;
  const auto vector_of = [](const Eigen::Quaterniond& rotation) -> Eigen::Vector3d {
    const double sine = rotation.vec().norm();
    const double angle = 2 * std::atan2(sine, rotation.w());
    return sine > 0 ? Eigen::Vector3d(angle / sine * rotation.vec()) : Eigen::Vector3d::Zero();
  };
  Eigen::Vector3d r;
  const int axis = twist_axis(task);
  if (axis < 0) {
    r = vector_of(E);
  } else {
    Eigen::Quaterniond twist(E.w(), 0, 0, 0);
    twist.vec()[axis] = E.vec()[axis];
    twist.normalize();
    if (twist.w() < 0) twist.coeffs() *= -1;
    Eigen::Quaterniond swing = E * twist.conjugate();
    if (swing.w() < 0) swing.coeffs() *= -1;
    r = vector_of(swing);
    r[axis] = vector_of(twist)[axis];
  }
  Eigen::Matrix<double, 6, 1> e;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    e[i] = outside(p[i], task.position_lower[k], task.position_upper[k]);
    e[3 + i] = outside(r[i], task.rotation_lower[k], task.rotation_upper[k]);
  }
  return e;
}

/// By KDL and the limits, with nothing of the solver's own.
bool is_solution(KdlChain& kdl, const Solver& solver, const Pose& target, const JointVector& q) {
  // FK in doubles is good to 1e-14 or so, which is what two implementations may differ by.
  constexpr double kRounding = 1e-13;
  if (q.size() != solver.robot().dof() || !q.allFinite()) return false;
  const SolverOptions& options = solver.options();
  Eigen::Matrix<double, 6, 1> e = pose_error(target, kdl.fk(q));
  if (!options.task.is_full_pose()) e = task_errors(options.task, target, kdl.fk(q));
  return e.head<3>().norm() <= options.position_tolerance + kRounding &&
         e.tail<3>().norm() <= options.rotation_tolerance + kRounding &&
         solver.robot().within_limits(q);
}

/// Value at the quantile of sorted times.
double quantile(const std::vector<double>& sorted, double part) {
  const double position = part * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (position - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

/// Passes on to a Progress, but only now and then.
class Pace {
 public:
  explicit Pace(const Progress& progress, std::size_t total) : progress_(progress), total_(total) {}

  void operator()(std::size_t done, Clock::time_point now = Clock::now()) {
    if (!progress_ || now < next_) return;
    next_ = now + std::chrono::milliseconds(30);
    progress_(done, total_);
  }

 private:
  const Progress& progress_;
  std::size_t total_;
  Clock::time_point next_{};
};

}  // namespace

double time_kdl_fk_jacobian(const Robot& robot, std::size_t calls) {
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
                    const Progress& progress) {
  if (targets == 0) throw InvalidArgumentError("targets: at least 1 is needed");
  const Robot& robot = solver.robot();
  const std::unique_ptr<KdlChain> kdl = robot.model().make_kdl();
  const Eigen::MatrixXd q = robot.random_configurations(targets, seed);
  Pace pace(progress, targets);
  std::vector<Pose> poses;
  poses.reserve(targets);
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    poses.push_back(kdl->fk(q.row(i)));
    if (i % 1024 == 0) pace(0);
  }

  Evaluation out;
  out.targets = targets;
  out.seed = seed;
  // The yardstick is taken before and after, so that a machine that speeds up or slows down
  // meanwhile does not tilt the ratio.
  const double kdl_before = time_kdl_fk_jacobian(robot);
  const std::size_t warm_up = std::min<std::size_t>(targets, 200);
  for (std::size_t i = 0; i < warm_up; ++i) {
    static_cast<void>(solver.solve(poses[i]));
    pace(0);
  }

  std::vector<double> times(targets);
  double attempts = 0;
  double iterations = 0;
  for (std::size_t i = 0; i < targets; ++i) {
    const auto start = Clock::now();
    const Result result = solver.solve(poses[i]);
    const auto end = Clock::now();
    times[i] = microseconds(end - start);
    attempts += result.attempts;
    iterations += result.iterations;
    out.max_iterations = std::max(out.max_iterations, result.iterations);
    if (result.success()) {
      ++out.solved;
      if (!is_solution(*kdl, solver, poses[i], result.q)) ++out.false_success;
    }
    pace(i, end);
  }
  out.kdl_fk_jac_us = 0.5 * (kdl_before + time_kdl_fk_jacobian(robot));

  const auto n = static_cast<double>(targets);
  out.success_percent = 100.0 * static_cast<double>(out.solved) / n;
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
  out.mean_attempts = attempts / n;
  out.mean_iterations = iterations / n;
  out.ratio = out.mean_us / out.kdl_fk_jac_us;

  if (stages) {
    StageTimes total;
    for (const Pose& pose : poses) {
      static_cast<void>(solver.solve(pose, {}, &total));
      pace(targets);
    }
    out.query_us = total.query / n / 1e3;
    out.rank_us = total.rank / n / 1e3;
    out.iterate_us = total.iterate / n / 1e3;
    out.reselect_us = total.reselect / n / 1e3;
  }
  if (progress) progress(targets, targets);
  return out;
}

}  // namespace iksel
