// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>

#include "error_check.hpp"
#include "iksel/error.hpp"
#include "solver/solver_impl.hpp"
#include "util/parallel.hpp"

namespace iksel {
namespace {

void write_row(const Result& result, std::size_t row, int dof, const BatchView& out) {
  double* q = out.q + row * static_cast<std::size_t>(dof);
  if (result.success()) {
    std::copy_n(result.q.data(), dof, q);
  } else {
    std::fill_n(q, dof, std::numeric_limits<double>::quiet_NaN());
  }
  out.status[row] = static_cast<std::uint8_t>(result.status);
  out.position_error[row] = result.position_error;
  out.rotation_error[row] = result.rotation_error;
  out.attempts[row] = result.attempts;
  out.iterations[row] = result.iterations;
  if (out.move != nullptr) out.move[row] = result.move;
}

void check_poses(const std::vector<Pose>& poses) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> rows = poses[i].matrix();
    check_matrix(rows.data(), "poses", static_cast<std::ptrdiff_t>(i));
  }
}

}  // namespace

template <typename Target, typename Near, typename Settle>
void Solver::Impl::solve_many(std::size_t first, std::size_t last, SolveRequest& request,
                              Workspace& workspace, const Target& target, const Near& near,
                              const Settle& settle) const {
  const auto solve_one = [&](std::size_t i) {
    if (const double* values = near(i)) {
      request.near = JointVector(Eigen::Map<const Eigen::VectorXd>(values, robot.dof()));
    }
    return solve(target(i), request, workspace);
  };
  // With a deadline every target has one search only.
  if (!request.filter || std::isfinite(request.deadline)) {
    for (std::size_t i = first; i < last; ++i) settle(i, solve_one(i));
    return;
  }

  // What is found without the filter is put before it in one go.
  std::vector<Result> answers(last - first);
  Filter filter;
  filter.swap(request.filter);
  if (near(first) == nullptr && !request.has_wishes()) {
    solve_many(first, last, workspace, target,
               [&](std::size_t i, const Result& result) { answers[i - first] = result; });
  } else {
    for (std::size_t i = first; i < last; ++i) answers[i - first] = solve_one(i);
  }
  filter.swap(request.filter);

  std::vector<double> candidates;
  for (const Result& answer : answers) {
    candidates.insert(candidates.end(), answer.q.data(), answer.q.data() + answer.q.size());
  }
  std::array<bool, kMany> keep{};
  const std::size_t count = candidates.size() / static_cast<std::size_t>(robot.dof());
  if (count > 0) request.filter(candidates.data(), count, keep.data());

  std::size_t asked = 0;
  for (std::size_t i = first; i < last; ++i) {
    Result& answer = answers[i - first];
    if (answer.success() && !keep[asked++]) {
      const Result other = solve_one(i);
      const int attempts = answer.attempts + other.attempts;
      const int iterations = answer.iterations + other.iterations;
      answer = other;
      answer.attempts = attempts;
      answer.iterations = iterations;
    }
    settle(i, answer);
  }
}

std::vector<Result> Solver::solve_batch(const std::vector<Pose>& T_base_tip, int threads) const {
  threads = resolve_threads(threads);
  check_poses(T_base_tip);
  std::vector<Result> results(T_base_tip.size());
  parallel_for(results.size(), Impl::kMany, threads, [&] {
    return [&, lease = std::make_shared<Impl::Lease>(*impl_)](std::size_t begin, std::size_t end) {
      impl_->solve_many(
          begin, end, lease->get(), [&](std::size_t i) -> const Pose& { return T_base_tip[i]; },
          [&](std::size_t i, const Result& result) { results[i] = result; });
    };
  });
  return results;
}

void Solver::solve_batch(const double* T_base_tip, std::size_t count, const BatchView& out,
                         int threads, const Progress& progress) const {
  threads = resolve_threads(threads);
  for (std::size_t i = 0; i < count; ++i) {
    check_matrix(T_base_tip + 16 * i, "poses", static_cast<std::ptrdiff_t>(i));
  }
  const int dof = robot().dof();
  const auto make_worker = [&] {
    return [&, lease = std::make_shared<Impl::Lease>(*impl_)](std::size_t begin, std::size_t end) {
      impl_->solve_many(
          begin, end, lease->get(), [&](std::size_t i) { return to_pose(T_base_tip + 16 * i); },
          [&](std::size_t i, const Result& result) { write_row(result, i, dof, out); });
    };
  };
  parallel_for(count, Impl::kMany, threads, make_worker, [&](std::size_t done) {
    if (progress) progress(done, count);
  });
}

template <typename Target, typename Near, typename Settle, typename OnProgress>
void Solver::Impl::solve_batch(std::size_t count, const SolveRequest& request, int threads,
                               const Target& target, const Near& near, const Settle& settle,
                               const OnProgress& on_progress) const {
  std::mutex turn;
  SolveRequest wishes = request;
  if (request.filter) {
    wishes.filter = [&](const double* q, std::size_t n, bool* keep) {
      const std::lock_guard<std::mutex> lock(turn);
      request.filter(q, n, keep);
    };
  }
  // Few at a time keep all threads busy, many are for the filter.
  constexpr std::size_t kFew = 8;
  const std::size_t chunk = request.filter ? kMany : kFew;
  const auto make_worker = [&] {
    return [&, own = wishes, lease = std::make_shared<Lease>(*this)](std::size_t begin,
                                                                     std::size_t end) mutable {
      solve_many(begin, end, own, lease->get(), target, near, settle);
    };
  };
  parallel_for(count, chunk, threads, make_worker, on_progress);
}

std::vector<Result> Solver::solve_batch(const std::vector<Pose>& T_base_tip,
                                        const SolveRequest& request,
                                        const std::vector<JointVector>& near, int threads) const {
  impl_->check(request);
  if (!request.has_wishes() && near.empty()) return solve_batch(T_base_tip, threads);
  threads = resolve_threads(threads);
  check_poses(T_base_tip);
  if (!near.empty() && near.size() != T_base_tip.size()) {
    throw InvalidArgumentError("near: expected none, or one for each of the " +
                               std::to_string(T_base_tip.size()) + " poses, got " +
                               std::to_string(near.size()));
  }
  for (std::size_t i = 0; i < near.size(); ++i) {
    const std::string name = "near[" + std::to_string(i) + "]";
    check_joints(near[i], robot().dof(), name.c_str());
    impl_->check_angles(near[i], name.c_str());
  }
  std::vector<Result> results(T_base_tip.size());
  impl_->solve_batch(
      results.size(), request, threads, [&](std::size_t i) -> const Pose& { return T_base_tip[i]; },
      [&](std::size_t i) { return near.empty() ? nullptr : near[i].data(); },
      [&](std::size_t i, const Result& result) { results[i] = result; }, [](std::size_t) {});
  return results;
}

void Solver::solve_batch(const double* T_base_tip, std::size_t count, const SolveRequest& request,
                         const double* near, const BatchView& out, int threads,
                         const Progress& progress) const {
  const int dof = robot().dof();
  impl_->check(request);
  if (!request.has_wishes() && near == nullptr) {
    solve_batch(T_base_tip, count, out, threads, progress);
    return;
  }
  threads = resolve_threads(threads);
  for (std::size_t i = 0; i < count; ++i) {
    check_matrix(T_base_tip + 16 * i, "poses", static_cast<std::ptrdiff_t>(i));
  }
  const auto near_of = [&](std::size_t i) {
    return near == nullptr ? nullptr : near + i * static_cast<std::size_t>(dof);
  };
  for (std::size_t i = 0; near != nullptr && i < count; ++i) {
    const JointVector row = Eigen::Map<const Eigen::VectorXd>(near_of(i), dof);
    const std::string name = "near[" + std::to_string(i) + "]";
    check_joints(row, dof, name.c_str());
    impl_->check_angles(row, name.c_str());
  }
  impl_->solve_batch(
      count, request, threads, [&](std::size_t i) { return to_pose(T_base_tip + 16 * i); }, near_of,
      [&](std::size_t i, const Result& result) { write_row(result, i, dof, out); },
      [&](std::size_t done) {
        if (progress) progress(done, count);
      });
}

}  // namespace iksel
