// SPDX-License-Identifier: BSD-3-Clause
// Paths as shortest paths: a layer of candidates per waypoint, the cost of an edge is the move
// between its ends, and edges that are too fast are none.
#include "iksel/path.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <string>

#include "base/constants.hpp"
#include "base/message_text.hpp"
#include "base/pose_check.hpp"
#include "goal/joint_move.hpp"
#include "iksel/error.hpp"
#include "refine/self_motion.hpp"
#include "solver/path_layer.hpp"
#include "solver/solver_impl.hpp"

namespace iksel {
namespace {

/// Solutions of the database nearer than this in every joint are one [rad or m].
constexpr double kSameSolution = 20 * kSameCandidate;

bool too_far(const JointVector& move, const JointVector& longest) {
  return (move.array().abs() > longest.array()).any();
}

class PathSearch {
 public:
  PathSearch(const ChainModel& model, const PathOptions& options)
      : model_(model),
        options_(options),
        request_(make_request(options)),
        move_(model.dof, request_),
        longest_(model.joints.longest_moves(options.dt)),
        middle_(model.joints.middle()) {}

  [[nodiscard]] const SolveRequest& request() const { return request_; }

  /// What the candidates of the layer before lead to at the next waypoint.
  void add_continuations(const Goal& goal, const Layer& before, Layer& layer) const {
    // Images of a configuration lead to images: only one of them is iterated.
    constexpr double kCopy = 1e-11;
    std::vector<JointVector> origins;
    std::vector<JointVector> moves;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const JointVector from = before.at(i);
      std::size_t same = 0;
      while (same < origins.size() && model_.joints.distance(origins[same], from, kCopy) >= kCopy) {
        ++same;
      }
      if (same == origins.size()) {
        JointVector q = from;
        if (!converge(model_, goal, kStepsToNext, q)) continue;
        origins.push_back(from);
        moves.emplace_back(q - from);
      }
      const JointVector q = from + moves[same];
      if (model_.joints.contains(q.data())) layer.add(q);
    }
  }

  /// The solutions found for the first waypoint of a path without a start, at all images; those
  /// nearest to the middle of the limits first, should there be too many.
  void add_first_solutions(const SolutionSet& found, Layer& layer) const {
    for (std::size_t i = 0; i < found.size(); ++i) {
      JointVector q = found.at(i);
      model_.joints.wrap_nearest(middle_, 0, q);
      layer.add(q);
    }
    for (std::size_t i = 0; i < found.size(); ++i) {
      JointVector q = found.at(i);
      model_.joints.first_image(q);
      do {
        layer.add(q);
      } while (layer.size() < kMostImages && model_.joints.next_image(q));
    }
  }

  /// The solutions found from the database, each at the images nearest to where the path may come
  /// from.
  void add_solutions(const SolutionSet& found, const Layer& before, Layer& layer) const {
    for (std::size_t i = 0; i < found.size(); ++i) {
      const JointVector solution = found.at(i);
      JointVector q = solution;
      // Many that the path may come from have the same nearest image.
      std::set<std::vector<long>> known;
      std::vector<long> turns(before.dof);
      for (std::size_t k = 0; k < before.size(); ++k) {
        model_.joints.wrap_nearest(before.at(k), 0, q);
        for (std::size_t j = 0; j < turns.size(); ++j) {
          const auto joint = static_cast<Eigen::Index>(j);
          turns[j] = std::lround((q[joint] - solution[joint]) / kTwoPi);
        }
        if (!known.insert(turns).second) continue;
        if (layer.size() >= kMostCandidates) return;
        layer.add(q);
      }
    }
  }

  void apply_filter(Layer& layer) const {
    if (!options_.filter || layer.size() == 0) return;
    const std::unique_ptr<bool[]> keep(new bool[layer.size()]());
    options_.filter(layer.q.data(), layer.size(), keep.get());
    layer.keep_if([&](std::size_t i) { return keep[i]; });
  }

  /// The cheapest way to each candidate; keeps the cheapest, and those only that can be reached.
  void connect(const Layer* before, Layer& layer) {
    struct Edge {
      double cost;
      std::size_t parent;
      std::size_t index;
    };
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < layer.size(); ++i) {
      const JointVector q = layer.at(i);
      Edge best{before == nullptr ? tie_break(q) : kInfinity, 0, i};
      for (std::size_t k = 0; before != nullptr && k < before->size(); ++k) {
        if (before->cost[k] >= best.cost) continue;
        const JointVector difference = q - before->at(k);
        if (too_far(difference, longest_)) continue;
        const double cost = before->cost[k] + move_.length(difference);
        if (cost < best.cost) best = {cost, k, i};
      }
      if (best.cost < kInfinity) edges.push_back(best);
    }
    std::stable_sort(edges.begin(), edges.end(),
                     [](const Edge& a, const Edge& b) { return a.cost < b.cost; });
    // Without a start all candidates of the first waypoint are needed.
    const std::size_t most = std::max(static_cast<std::size_t>(options_.candidates), first_layer_);
    if (before != nullptr && edges.size() > most) edges.resize(most);
    if (before == nullptr) first_layer_ = edges.size();
    Layer kept{layer.dof, {}, {}, {}};
    for (const Edge& edge : edges) {
      const JointVector q = layer.at(edge.index);
      kept.q.insert(kept.q.end(), q.data(), q.data() + model_.dof);
      kept.cost.push_back(edge.cost);
      kept.parent.push_back(edge.parent);
    }
    layer = std::move(kept);
  }

  /// Walks back from the cheapest end.
  void trace(const std::vector<Layer>& layers, PathResult& result) const {
    if (layers.empty()) return;
    result.q.resize(layers.size());
    std::size_t i = 0;
    for (std::size_t w = layers.size(); w-- > 0;) {
      result.q[w] = layers[w].at(i);
      i = layers[w].parent[i];
    }
    const bool from_start = options_.start.has_value();
    for (std::size_t w = from_start ? 0 : 1; w < result.q.size(); ++w) {
      const JointVector step = result.q[w] - (w == 0 ? *options_.start : result.q[w - 1]);
      result.move += move_.length(step);
      int joint = 0;
      const double largest = step.cwiseAbs().maxCoeff(&joint);
      if (result.largest_step_joint >= 0 && largest <= result.largest_step) continue;
      result.largest_step = largest;
      result.largest_step_joint = joint;
      result.largest_step_waypoint = static_cast<std::ptrdiff_t>(w);
    }
  }

 private:
  /// Images at the first waypoint, at most: those of sixteen solutions, of seven joints that have
  /// two images each.
  static constexpr std::size_t kMostImages = 2048;
  /// Candidates from the database at a later waypoint, at most.
  static constexpr std::size_t kMostCandidates = 2 * kMostImages;

  /// A path that begins anywhere costs the same at all its images: of those, the one that begins
  /// nearest to the middle of the limits. Small beside all costs, and large beside their rounding.
  [[nodiscard]] double tie_break(const JointVector& q) const {
    constexpr double kPart = 1e-9;
    return kPart * (q - middle_).norm();
  }

  static SolveRequest make_request(const PathOptions& options) {
    SolveRequest request;
    request.weights = options.weights;
    request.norm = options.norm;
    return request;
  }

  const ChainModel& model_;
  const PathOptions& options_;
  SolveRequest request_;
  JointMove move_;
  JointVector longest_;
  JointVector middle_;
  /// Candidates of the first waypoint, if the path has no start.
  std::size_t first_layer_ = 0;
};

}  // namespace

PathResult Solver::Impl::solve_path(const std::vector<Pose>& targets, const PathOptions& path,
                                    Workspace& workspace) const {
  const auto dof = static_cast<std::size_t>(robot.dof());
  PathSearch search(model(), path);
  const Layer start = path.start
                          ? Layer{dof, {path.start->data(), path.start->data() + dof}, {0.0}, {0}}
                          : Layer{dof, {}, {}, {}};

  std::vector<Layer> layers;
  layers.reserve(targets.size());
  PathResult result;
  result.status = Status::solved;
  for (std::size_t w = 0; w < targets.size(); ++w) {
    const Layer* before = !layers.empty() ? &layers.back() : path.start ? &start : nullptr;
    const Goal goal(model(), task, targets[w]);
    Layer layer{dof, {}, {}, {}};
    if (before != nullptr) search.add_continuations(goal, *before, layer);
    const SolutionSet& found = workspace.collected.found;
    // Of an arm that is not redundant all, which are few but where axes line up.
    constexpr std::size_t kBranches = 64;
    const auto candidates = static_cast<std::size_t>(path.candidates);
    const std::size_t most = goal.is_redundant() ? candidates : std::max(candidates, kBranches);
    const auto is_satisfied = [&](const Collector&) { return found.size() >= most; };
    Collector collector(model(), goal, search.request(), {kSameSolution, true}, is_satisfied,
                        options.max_attempts, workspace.collected);
    collect(model(), options, collector, workspace);
    if (before != nullptr) {
      search.add_solutions(found, *before, layer);
    } else {
      search.add_first_solutions(found, layer);
    }
    layer.keep_if([&](std::size_t i) { return goal.is_solution(layer.at(i)); });
    const bool any = layer.size() > 0;
    search.apply_filter(layer);
    const bool kept = layer.size() > 0;
    search.connect(before, layer);
    if (layer.size() == 0) {
      result.first_unreachable = static_cast<std::ptrdiff_t>(w);
      result.status = kept                                 ? Status::too_fast
                      : any                                ? Status::rejected
                      : collector.status == Status::solved ? Status::not_converged
                                                           : collector.status;
      break;
    }
    layers.push_back(std::move(layer));
    if (path.progress) path.progress(w + 1, targets.size());
  }
  search.trace(layers, result);
  return result;
}

PathResult Solver::solve_path(const std::vector<Pose>& T_base_tip,
                              const PathOptions& options) const {
  if (T_base_tip.empty()) throw InvalidArgumentError("poses: there are none");
  std::vector<Pose> targets(T_base_tip);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    Pose nearest;
    targets[i] = to_rigid(targets[i], nearest, "poses", static_cast<std::ptrdiff_t>(i));
  }
  options.validate(robot().dof());
  if (options.start) impl_->angles.check(*options.start, "start");
  const WorkspacePool::Lease lease(impl_->workspaces);
  return impl_->solve_path(targets, options, lease.get());
}

}  // namespace iksel
