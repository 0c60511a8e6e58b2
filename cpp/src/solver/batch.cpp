// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>

#include "error_check.hpp"
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
}

}  // namespace

std::vector<Result> Solver::solve_batch(const std::vector<Pose>& T_base_tip, int threads) const {
  threads = resolve_threads(threads);
  for (std::size_t i = 0; i < T_base_tip.size(); ++i) {
    const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> rows = T_base_tip[i].matrix();
    check_matrix(rows.data(), "poses", static_cast<std::ptrdiff_t>(i));
  }
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

}  // namespace iksel
