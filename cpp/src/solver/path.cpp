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
  if (before != nullptr && !search.add_continuations(goal, *before, layer) && goal.is_redundant()) {
    // Another way on from the cheapest, past what its iteration met, may be short.
    SolveRequest nearest = search.request();
    nearest.near = before->front().q;
    const Result result = solver.find_answer(goal, nearest, workspace, nullptr);
    if (result.success()) add(result.q, layer);
  }
  // Of several tips a search takes far longer than what goes on from the waypoint before.
  if (goal.tips() != nullptr && layer.size() >= 8 && search.keep_best(before, layer)) {
    return Status::solved;
  }
  const SolutionSet& found = workspace.collected.found;
  // Of an arm that is not redundant all, which are few but where axes line up.
  const auto most = static_cast<std::size_t>(goal.is_redundant() ? path.candidates
                                                                 : std::max(path.candidates, 64));
  const auto is_satisfied = [&](const Collector&) { return found.size() >= most; };
  // Solutions of the database that differ by less in every joint are one.
  const Collector::Aim aim{20 * kSameCandidate, true, goal.is_redundant() ? path.candidates : 0};
  Collector collector(goal, search.request(), aim, is_satisfied, solver.options.max_attempts,
                      workspace.collected);
  solver.collect(collector, workspace);
  if (before != nullptr) {
    for (std::size_t i = 0; i < found.size(); ++i) {
      search.add_nearest_images(found.at(i), *before, layer);
    }
  } else {
    search.add_first_solutions(found, layer);
  }
  layer.erase(std::remove_if(layer.begin(), layer.end(),
                             [&](const PathCandidate& each) { return !goal.is_solution(each.q); }),
              layer.end());
  const bool any = !layer.empty();
  search.screen(layer);
  const bool kept = !layer.empty();
  if (!search.connect_best(before, layer) && kept && goal.is_redundant()) {
    search.add_in_time(goal, *before, layer);
    search.keep_best(before, layer);
  }
  return kept                                   ? Status::too_fast
         : any                                  ? search.refusal()
         : collector.status() == Status::solved ? Status::not_converged
                                                : collector.status();
}

/// A path in the making.
class PathPlan {
  // What is deduced stands before its use.
  template <typename Use>
  auto with_goal(std::size_t w, const Use& use) const {
    const Pose* targets = &targets_[w * static_cast<std::size_t>(solver_.robot.tips())];
    return solver_.with_goal(targets, path_, nullptr, use);
  }

 public:
  /// All must outlive this.
  PathPlan(const Solver::Impl& solver, const std::vector<Pose>& targets, const PathOptions& path,
           Speeds speeds, Workspace& workspace)
      : solver_(solver),
        targets_(targets),
        path_(path),
        workspace_(workspace),
        search_(solver.robot.all(), path, speeds),
        count_(targets.size() / static_cast<std::size_t>(solver.robot.tips())) {
    if (path.start) add(*path.start, start_);
    is_swept_ = !solver.tips && solver.task_of(path).is_full_pose() && workspace.lanes &&
                workspace.lanes->sweep;
    layers_.reserve(count_);
  }

  PathResult solve() {
    PathResult result;
    result.status = Status::solved;
    for (std::size_t w = 0; w < count_ && result.success(); ++w) {
      Layer layer;
      result.status = with_goal(w, [&](const Goal& goal) {
        is_redundant_ = goal.is_redundant();
        return add_layer(goal, w, layer);
      });
      if (!result.success()) {
        result.first_unreachable = static_cast<std::ptrdiff_t>(w);
        break;
      }
      layers_.push_back(std::move(layer));
      if (path_.progress) path_.progress(w + 1, count_);
    }
    const bool has_ways = result.success() && count_ > 1 && (is_redundant_ || search_.makes_up());
    if (has_ways) continue_back();
    search_.trace(layers_, result);
    if (has_ways || jumps(result)) shorten(result);
    return result;
  }

  /// Whether the arm could go otherwise to a waypoint that it cannot reach in time.
  [[nodiscard]] bool has_other_ways(const PathResult& result) {
    if (result.status != Status::too_fast) return false;
    const auto w = static_cast<std::size_t>(result.first_unreachable);
    if (is_redundant_) return w > 0;
    // Or through a singularity: of what led there nothing is left.
    Layer there;
    add_next(*before(w, layers_), w, there);
    return std::any_of(there.begin(), there.end(),
                       [&](const PathCandidate& each) { return is_singular(each.q); }) ||
           std::any_of(result.q.begin(), result.q.end(),
                       [&](const JointVector& q) { return is_singular(q); });
  }

 private:
  /// Where the path comes from; null at its beginning if that may be anywhere.
  [[nodiscard]] const Layer* before(std::size_t w, const std::vector<Layer>& layers) const {
    return w > 0 ? &layers[w - 1] : path_.start ? &start_ : nullptr;
  }

  /// Whether a pose has a family of solutions there, of which what is found is any.
  [[nodiscard]] bool is_singular(const JointVector& q) const {
    const Robot& robot = solver_.robot;
    bool is = false;
    for (int i = 0; i < robot.tips(); ++i) {
      const JointVector of_chain = picked(q, robot.joints_of(i));
      is = is || robot.chain(i).model().is_almost_singular(of_chain.data());
    }
    return is;
  }

  /// Whether the longest step begins or ends there, and would be shorter by another of the family.
  [[nodiscard]] bool jumps(const PathResult& result) {
    // Beside a singularity the longest step is long by itself. Of 480 motions of six joints (60 of
    // irb120, vs060, cvr038 and five random arms) 25 would be made shorter in vain without, 1 is.
    if (!result.success() || count_ == 1 || result.largest_step_waypoint < 0) return false;
    const auto w = static_cast<std::size_t>(result.largest_step_waypoint);
    const JointVector& from = w == 0 ? *path_.start : result.q[w - 1];
    const auto is_shorter = [&](std::size_t at, const JointVector& other) {
      Layer layer;
      if (is_singular(result.q[at])) add_next(halfway(result.q, at), at, layer);
      return std::any_of(layer.begin(), layer.end(), [&](const PathCandidate& each) {
        return (each.q - other).cwiseAbs().maxCoeff() < 0.9 * result.largest_step;
      });
    };
    return is_shorter(w, from) || (w > 0 && is_shorter(w - 1, result.q[w]));
  }

  Status add_layer(const Goal& goal, std::size_t w, Layer& layer) {
    const Layer* before = this->before(w, layers_);
    if (before != nullptr && is_swept_) {
      search_.add_on_curve(goal, *before, w, /*with_others=*/true, *workspace_.lanes, layer);
      if (search_.keep_best(before, layer)) return Status::solved;
    }
    const Status status = search_layer(solver_, goal, before, path_, search_, workspace_, layer);
    return layer.empty() ? status : Status::solved;
  }

  /// Adds what configurations lead to at that waypoint.
  void add_next(const Layer& from, std::size_t w, Layer& layer) {
    with_goal(w, [&](const Goal& goal) {
      if (is_swept_) {
        search_.add_on_curve(goal, from, w, /*with_others=*/false, *workspace_.lanes, layer);
      } else {
        search_.add_continuations(goal, from, layer);
      }
    });
    search_.screen(layer);
  }

  /// Follows the candidates at the end back to the beginning. On the way there candidates end at
  /// limits, and what the search finds in their place begins with a jump: from the end it may go
  /// back without.
  void continue_back() {
    Layer from = layers_.back();
    const auto most = static_cast<std::size_t>(path_.candidates);
    if (from.size() > most) from.resize(most);
    for (std::size_t w = count_ - 1; w-- > 0;) {
      Layer next;
      add_next(from, w, next);
      for (const PathCandidate& each : next) add(each.q, layers_[w]);
      from = next.empty() ? layers_[w] : std::move(next);
    }
    for (std::size_t w = 0; w < count_; ++w) {
      search_.connect(before(w, layers_), layers_[w], /*at_last=*/true);
    }
  }

  /// Puts waypoints halfway between those on either side, the next or farther ones, where that
  /// makes the path shorter: jumps become steps, and what drifted comes back; or slower, till no
  /// step is too fast.
  void shorten(PathResult& result) {
    // A round that makes less of it is the last. With 0.97 random pairs of arms moved 1.032 times
    // as far as a known motion, with 0.99 1.009, with 0.997 0.996 times in a quarter more of the
    // time; 4 rounds did 1.018 (python -m bench hands pairs --near 0 --paths 20 --seed 2).
    const bool makes_up = search_.makes_up();
    for (int round = 0; round < 32; ++round) {
      if (makes_up && result.success()) return;
      std::vector<Layer> layers;
      layers.reserve(count_);
      for (std::size_t w = 0; w < count_; ++w) {
        Layer layer;
        add(result.q[w], layer);
        add_next(halfway(result.q, w), w, layer);
        search_.connect(before(w, layers), layer, makes_up);
        // What the path passed is in it, unless the filter has changed its mind.
        if (layer.empty()) return;
        layers.push_back(std::move(layer));
      }
      PathResult other;
      other.status = Status::solved;
      search_.trace(layers, other);
      const double last = result.move;
      if (makes_up || other.move < last) result = std::move(other);
      if (!makes_up && !(result.move < 0.99 * last)) return;
    }
  }

  /// Halfway between waypoints that are as far before as behind; about an end where the path may
  /// end anywhere both are on the one side.
  [[nodiscard]] Layer halfway(const std::vector<JointVector>& q, std::size_t w) const {
    const auto last = static_cast<std::ptrdiff_t>(count_) - 1;
    Layer layer;
    for (std::ptrdiff_t stride = 1; stride <= last; stride *= 2) {
      const auto at = [&](std::ptrdiff_t i) {
        return q[static_cast<std::size_t>(i < 0 ? -i : i > last ? 2 * last - i : i)];
      };
      const std::ptrdiff_t a = static_cast<std::ptrdiff_t>(w) - stride;
      if (path_.start && a < -1) break;
      add((path_.start && a < 0 ? *path_.start : at(a)) / 2 + at(a + 2 * stride) / 2, layer);
    }
    return layer;
  }

  const Solver::Impl& solver_;
  const std::vector<Pose>& targets_;
  const PathOptions& path_;
  Workspace& workspace_;
  PathSearch search_;
  Layer start_;
  std::size_t count_;
  bool is_swept_;
  bool is_redundant_ = false;
  std::vector<Layer> layers_;
};

}  // namespace

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
  PathPlan plan(*impl_, targets, options, Speeds::kept, lease.get());
  PathResult result = plan.solve();
  if (!plan.has_other_ways(result)) return result;
  // What can be reached in time so far ends here. The whole way may need no haste.
  PathResult whole = PathPlan(*impl_, targets, options, Speeds::made_up_for, lease.get()).solve();
  return whole.success() ? whole : result;
}

}  // namespace iksel
