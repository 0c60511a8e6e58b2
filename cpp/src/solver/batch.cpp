// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <string>
#include <utility>

#include "base/message_text.hpp"
#include "base/parallel.hpp"
#include "goal/screen.hpp"
#include "iksel/error.hpp"
#include "search/batch_stream.hpp"
#include "solver/batch_targets.hpp"
#include "solver/solver_impl.hpp"
#include "solver/tips_search.hpp"

namespace iksel {
namespace {

void write_row(const Result& result, std::size_t row, int dof, const BatchView& out) {
  double* q = out.q + row * static_cast<std::size_t>(dof);
  if (has_joints(result.status)) {
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
  if (out.proof != nullptr) out.proof[row] = static_cast<std::uint8_t>(result.proof);
  if (out.unreachable_tip != nullptr) out.unreachable_tip[row] = result.unreachable_tip;
}

/// Throws InvalidArgumentError about what a row is wanted near to.
void check_near(const Solver::Impl& solver, const JointVector& near, std::size_t row) {
  const std::string name = "near[" + std::to_string(row) + "]";
  check_joints(near, solver.robot.dof(), name.c_str());
  solver.angles.check(near, name.c_str());
}

/// A request for many targets, each with its own `near` perhaps.
template <typename Target, typename Near, typename OnResult>
class Batch {
 public:
  /// `target(i)` for targets 0 to count - 1; `near(i)` may be null. `on_result(i, result)` is told
  /// of each, in any order and from any thread.
  Batch(const Solver::Impl& solver, std::size_t count, const SolveRequest& request,
        const Target& target, const Near& near, const OnResult& on_result)
      : solver_(solver),
        count_(count),
        request_(request),
        target_(target),
        near_(near),
        on_result_(on_result) {}

  template <typename OnProgress>
  void run(int threads, const OnProgress& on_progress) const {
    const bool one_tip = solver_.tips == nullptr;
    const bool plain =
        one_tip && !request_.has_requirements() && (count_ == 0 || near_(0) == nullptr);
    // Few at a time keep all threads busy; many are for the lanes and the filter.
    const bool is_screened =
        one_tip && screens_answers(request_) && !std::isfinite(request_.deadline);
    const std::size_t chunk = plain || is_screened ? kMost : 8;
    std::mutex turn;
    const SolveRequest locked = in_turn(request_, turn);
    const auto make_worker = [&] {
      return [&, own = locked, lease = std::make_shared<WorkspacePool::Lease>(solver_.workspaces)](
                 std::size_t begin, std::size_t end) mutable {
        if (plain) {
          solve_plain(begin, end, lease->get(), on_result_);
        } else if (is_screened) {
          solve_screened(begin, end, own, lease->get());
        } else {
          // With a deadline, or several tips, every target has one search only.
          for (std::size_t i = begin; i < end; ++i) on_result_(i, solve_one(i, own, lease->get()));
        }
      };
    };
    parallel_for(count_, chunk, threads, make_worker, on_progress);
  }

 private:
  /// Targets of a part at most.
  static constexpr std::size_t kMost = 256;

  /// For a request that asks for nothing: the answer for a target does not depend on the others.
  template <typename Tell>
  void solve_plain(std::size_t first, std::size_t last, Workspace& workspace,
                   const Tell& tell) const {
    TargetList left(last - first);
    std::iota(left.begin(), left.end(), first);
    if (workspace.lanes) left = solve_in_lanes(std::move(left), *workspace.lanes, tell);
    const SolveRequest none;
    for (const std::size_t i : left) {
      const Pose& target = target_(i);
      const Goal goal(solver_.model(), solver_.task, target);
      tell(i, solver_.find_first(goal, none, workspace, nullptr));
    }
  }

  /// In closed form where there is one; of six joints nothing is left then but what is in doubt.
  template <typename Tell>
  TargetList solve_in_lanes(TargetList left, Workspace::InLanes& lanes, const Tell& tell) const {
    const TaskSpace& task = solver_.task;
    if (lanes.branch_lanes && task.is_full_pose()) {
      BranchLanes& branches = *lanes.branch_lanes;
      left = stream(left, lanes.query, branches, branches, tell);
    }
    if (lanes.branches_of(task) != nullptr) return left;
    // Any seed is given up after so many iterations.
    lanes.refiner.begin(task, {8, 8}, Width::wide);
    LeafLanes leaves(lanes.query, solver_.options.max_attempts);
    return stream(left, lanes.query, lanes.refiner, leaves, tell);
  }

  template <typename Refiner, typename Seeds, typename Tell>
  TargetList stream(const TargetList& targets, const LaneQuery& query, Refiner& refiner,
                    Seeds& seeds, const Tell& tell) const {
    BatchStream<Refiner, Seeds, Target, Tell> stream(solver_.model(), solver_.task, query, refiner,
                                                     seeds, targets, target_, tell);
    Work work(0);  // each target has its own
    search(refiner, stream, stream, work);
    return stream.left();
  }

  Result solve_one(std::size_t i, SolveRequest& request, Workspace& workspace) const {
    if (const double* values = near_(i)) {
      request.near = JointVector(Eigen::Map<const Eigen::VectorXd>(values, solver_.robot.dof()));
    }
    if (solver_.tips) return solver_.solve(target_.of_tips(i), request, workspace, nullptr);
    const Pose& target = target_(i);
    return solver_.solve(&target, request, workspace, nullptr);
  }

  /// What is found without the scene and the filter is put before them in one go; where they
  /// refuse, the search for that target continues.
  void solve_screened(std::size_t first, std::size_t last, SolveRequest& request,
                      Workspace& workspace) const {
    std::vector<Result> answers(last - first);
    SolveRequest bare = request;
    bare.scene.reset();
    bare.exact = nullptr;
    bare.filter = nullptr;
    if (near_(first) == nullptr && !bare.has_requirements()) {
      solve_plain(first, last, workspace,
                  [&](std::size_t i, const Result& result) { answers[i - first] = result; });
    } else {
      for (std::size_t i = first; i < last; ++i) {
        answers[i - first] = solve_one(i, bare, workspace);
      }
    }
    const std::vector<double> candidates = joint_values(answers);
    std::array<bool, kMost> keep{};
    const std::size_t count = candidates.size() / static_cast<std::size_t>(solver_.robot.dof());
    Screen screen(request, solver_.robot.dof());
    if (count > 0) screen.apply(candidates.data(), count, keep.data());

    std::size_t asked = 0;
    for (std::size_t i = first; i < last; ++i) {
      Result& answer = answers[i - first];
      if (has_joints(answer.status) && !keep[asked++]) {
        Result other = solve_one(i, request, workspace);
        other.attempts += answer.attempts;
        other.iterations += answer.iterations;
        answer = other;
      }
      on_result_(i, answer);
    }
  }

  const Solver::Impl& solver_;
  std::size_t count_;
  const SolveRequest& request_;
  const Target& target_;
  const Near& near_;
  const OnResult& on_result_;
};

/// A batch: `on_row(row, result)` for each row of `pose_at`, in any order and from any thread;
/// near_of(row) may be null.
template <typename PoseAt, typename Near, typename OnRow>
void solve_rows(const Solver::Impl& solver, std::size_t count, const PoseAt& pose_at,
                const SolveRequest& request, const Near& near_of, int threads, const OnRow& on_row,
                const Progress& progress) {
  const BatchTargets<PoseAt> targets(count, solver.robot.tips(), pose_at, request.on_invalid_pose);
  Result no_pose;
  no_pose.status = Status::invalid_pose;
  for (const std::size_t row : targets.invalid_rows()) on_row(row, no_pose);
  const auto on_result = [&](std::size_t i, const Result& result) {
    on_row(targets.row_of(i), result);
  };
  const auto on_progress = [&](std::size_t done) {
    if (progress) progress(done + targets.invalid_rows().size(), count);
  };
  const auto near = [&](std::size_t i) { return near_of(targets.row_of(i)); };
  const Batch batch(solver, targets.size(), request, targets, near, on_result);
  batch.run(threads, on_progress);
}

}  // namespace

std::vector<Result> Solver::solve_batch(const std::vector<Pose>& T_base_tip,
                                        const SolveRequest& request,
                                        const std::vector<JointVector>& near, int threads) const {
  impl_->check(request);
  threads = resolve_threads(threads);
  const std::size_t count = impl_->check_rows(T_base_tip.size());
  if (!near.empty() && near.size() != count) {
    throw InvalidArgumentError("near: expected none, or one for each of the " +
                               std::to_string(count) + (impl_->tips ? " targets" : " poses") +
                               ", got " + std::to_string(near.size()));
  }
  for (std::size_t i = 0; i < near.size(); ++i) check_near(*impl_, near[i], i);
  std::vector<Result> results(count);
  solve_rows(
      *impl_, count, [&](std::size_t i) -> const Pose& { return T_base_tip[i]; }, request,
      [&](std::size_t row) { return near.empty() ? nullptr : near[row].data(); }, threads,
      [&](std::size_t row, const Result& result) { results[row] = result; }, {});
  return results;
}

void Solver::solve_batch(const double* T_base_tip, std::size_t count, const SolveRequest& request,
                         const double* near, const BatchView& out, int threads,
                         const Progress& progress) const {
  const int dof = robot().dof();
  impl_->check(request);
  threads = resolve_threads(threads);
  const auto near_of = [&](std::size_t row) {
    return near == nullptr ? nullptr : near + row * static_cast<std::size_t>(dof);
  };
  for (std::size_t row = 0; near != nullptr && row < count; ++row) {
    check_near(*impl_, Eigen::Map<const Eigen::VectorXd>(near_of(row), dof), row);
  }
  solve_rows(
      *impl_, count, [&](std::size_t i) { return to_pose(T_base_tip + 16 * i); }, request, near_of,
      threads, [&](std::size_t row, const Result& result) { write_row(result, row, dof, out); },
      progress);
}

}  // namespace iksel
