// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/path.hpp"

#include "base/message_text.hpp"
#include "base/pose_check.hpp"
#include "iksel/error.hpp"
#include "solver/path_search.hpp"
#include "solver/solver_impl.hpp"

namespace iksel {
namespace {

/// Makes a layer by continuation and search; why there is nothing in it if so.
Status search_layer(const Solver::Impl& solver, const Goal& goal, const Layer* before,
                    const PathOptions& path, PathSearch& search, Workspace& workspace,
                    Layer& layer) {
  // Of several tips a search takes far longer than what goes on from the waypoint before.
  constexpr std::size_t kEnoughForTips = 8;
  if (before != nullptr && !search.add_continuations(goal, *before, layer) && goal.is_redundant()) {
    // Another way on from the cheapest, past what its iteration met, may be short.
    SolveRequest nearest = search.request();
    nearest.near = before->at(0);
    const Result result = solver.find_answer(goal, nearest, workspace, nullptr);
    if (result.success()) layer.add(result.q);
  }
  if (goal.tips() != nullptr && layer.size() >= kEnoughForTips) {
    search.screen(layer);
    search.connect(before, layer);
    if (layer.size() > 0) return Status::solved;
  }
  const SolutionSet& found = workspace.collected.found;
  // Of an arm that is not redundant all, which are few but where axes line up.
  constexpr std::size_t kBranches = 64;
  const auto candidates = static_cast<std::size_t>(path.candidates);
  const std::size_t most = goal.is_redundant() ? candidates : std::max(candidates, kBranches);
  const auto is_satisfied = [&](const Collector&) { return found.size() >= most; };
  const Collector::Aim aim{kSameSolution, true, goal.is_redundant() ? path.candidates : 0};
  Collector collector(solver.robot.all(), goal, search.request(), aim, is_satisfied,
                      solver.options.max_attempts, workspace.collected);
  solver.collect(collector, workspace);
  if (before != nullptr) {
    search.add_solutions(found, *before, layer);
  } else {
    search.add_first_solutions(found, layer);
  }
  layer.keep_if([&](std::size_t i) { return goal.is_solution(layer.at(i)); });
  const bool any = layer.size() > 0;
  search.screen(layer);
  const bool kept = layer.size() > 0;
  search.connect(before, layer);
  return kept                                   ? Status::too_fast
         : any                                  ? search.refusal()
         : collector.status() == Status::solved ? Status::not_converged
                                                : collector.status();
}

/// The same path begun a little beside on the self-motion, if that makes it shorter: candidates of
/// the first waypoint lie far apart.
void improve_start(const ChainModel& model, const TaskSpace& task, const std::vector<Pose>& targets,
                   const PathOptions& path, Workspace::InLanes& lanes, PathResult& result) {
  PathSearch search(model, path);
  std::vector<Layer> layers;
  layers.reserve(targets.size());
  const auto dof = static_cast<std::size_t>(model.dof);
  for (std::size_t w = 0; w < targets.size(); ++w) {
    const Goal goal(model, task, targets[w]);
    Layer layer{dof, {}, {}, {}};
    if (w == 0) {
      search.add_beside(goal, result.q[0], lanes, layer);
    } else {
      search.add_on_curve(goal, layers.back(), w, /*with_others=*/false, lanes, layer);
    }
    search.screen(layer);
    search.connect(w == 0 ? nullptr : &layers.back(), layer);
    if (layer.size() == 0) return;
    layers.push_back(std::move(layer));
  }
  PathResult other;
  other.status = Status::solved;
  search.trace(layers, other);
  if (other.move < result.move) result = std::move(other);
}

}  // namespace

PathResult Solver::Impl::solve_path(const std::vector<Pose>& targets, const PathOptions& path,
                                    Workspace& workspace) const {
  const auto dof = static_cast<std::size_t>(robot.dof());
  const auto each = static_cast<std::size_t>(robot.tips());
  const std::size_t count = targets.size() / each;
  PathSearch search(robot.all(), path);
  const Layer start = path.start
                          ? Layer{dof, {path.start->data(), path.start->data() + dof}, {0.0}, {0}}
                          : Layer{dof, {}, {}, {}};
  const TaskSpace of_path = task_of(path);
  const bool is_swept =
      !tips && of_path.is_full_pose() && workspace.lanes && workspace.lanes->sweep;

  std::vector<Layer> layers;
  layers.reserve(count);
  PathResult result;
  result.status = Status::solved;
  for (std::size_t w = 0; w < count && result.success(); ++w) {
    const Layer* before = !layers.empty() ? &layers.back() : path.start ? &start : nullptr;
    Layer layer{dof, {}, {}, {}};
    result.status = with_goal(&targets[w * each], path, nullptr, [&](const Goal& goal) {
      if (before != nullptr && is_swept) {
        search.add_on_curve(goal, *before, w, /*with_others=*/true, *workspace.lanes, layer);
        search.screen(layer);
        search.connect(before, layer);
        if (layer.size() > 0) return Status::solved;
      }
      const Status status = search_layer(*this, goal, before, path, search, workspace, layer);
      return layer.size() > 0 ? Status::solved : status;
    });
    if (!result.success()) {
      result.first_unreachable = static_cast<std::ptrdiff_t>(w);
      break;
    }
    layers.push_back(std::move(layer));
    if (path.progress) path.progress(w + 1, count);
  }
  search.trace(layers, result);
  if (result.success() && !path.start && is_swept) {
    improve_start(model(), of_path, targets, path, *workspace.lanes, result);
  }
  return result;
}

PathResult Solver::solve_path(const std::vector<Pose>& T_base_tip,
                              const PathOptions& options) const {
  if (T_base_tip.empty()) throw InvalidArgumentError("poses: there are none");
  impl_->check_rows(T_base_tip.size());
  std::vector<Pose> targets(T_base_tip);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    Pose nearest;
    targets[i] = to_rigid(targets[i], nearest, "poses", static_cast<std::ptrdiff_t>(i));
  }
  options.validate(robot().dof(), robot().tips());
  if (options.scene) options.scene->check_fits(robot());
  if (options.start) impl_->angles.check(*options.start, "start");
  const WorkspacePool::Lease lease(impl_->workspaces);
  return impl_->solve_path(targets, options, lease.get());
}

}  // namespace iksel
