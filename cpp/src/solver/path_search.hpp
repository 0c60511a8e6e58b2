// SPDX-License-Identifier: BSD-3-Clause
// Paths as shortest paths: a layer of candidates per waypoint, the cost of an edge is the move
// between its ends, and edges that are too fast are none, or are made slower at last.
#pragma once

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "base/constants.hpp"
#include "goal/joint_move.hpp"
#include "goal/screen.hpp"
#include "iksel/path.hpp"
#include "refine/self_motion.hpp"
#include "search/context.hpp"
#include "search/row_answers.hpp"

namespace iksel {

/// Candidates nearer than this in every joint are one [rad or m].
inline constexpr double kSameCandidate = 1e-4;

/// A configuration that a path may pass at a waypoint, and the cheapest way to it.
struct PathCandidate {
  JointVector q;
  double cost;
  std::size_t parent;  ///< index in the layer before
};

/// The candidates of one waypoint.
using Layer = std::vector<PathCandidate>;

/// Adds a candidate unless it is there; periodic images are candidates of their own.
inline void add(const JointVector& q, Layer& layer) {
  const auto is_near = [](double a, double b) { return std::abs(a - b) < kSameCandidate; };
  const bool is_known = std::any_of(layer.begin(), layer.end(), [&](const PathCandidate& known) {
    return std::equal(q.begin(), q.end(), known.q.begin(), is_near);
  });
  if (!is_known) layer.push_back({q, 0, 0});
}

/// Whether a step that is too fast is none, or is one, to be made slower at last.
enum class Speeds { kept, made_up_for };

class PathSearch {
 public:
  PathSearch(const RobotModel& model, const PathOptions& options, Speeds speeds)
      : model_(model),
        options_(options),
        request_(make_request(options)),
        screen_(options, model.dof),
        longest_(model.joints.longest_moves(options.dt)),
        speeds_(speeds),
        asked_(model.dof, request_),
        move_(speeds == Speeds::kept ? asked_
                                     : JointMove(weights_of_time(longest_), MoveNorm::max)),
        middle_(model.joints.middle()) {
    for (int j = 0; j < model.dof; ++j) has_images_ = has_images_ || model.joints.is_periodic(j);
  }

  [[nodiscard]] const SolveRequest& request() const { return request_; }
  /// Whether steps may be too fast until the last.
  [[nodiscard]] bool makes_up() const { return speeds_ == Speeds::made_up_for; }

  /// What the candidates of the layer before lead to at the next waypoint. Returns whether the
  /// cheapest of them leads anywhere.
  bool add_continuations(const Goal& goal, const Layer& before, Layer& layer) const {
    // Images of a configuration lead to images: only one of them is iterated.
    std::vector<JointVector> origins;
    std::vector<JointVector> moves;
    bool leads_on = false;
    for (const auto& [from, cost, parent] : before) {
      std::size_t same = 0;
      while (same < origins.size() && !model_.joints.are_near(origins[same], from, kRounding))
        ++same;
      if (same == origins.size()) {
        JointVector q = from;
        if (!converge(goal, kStepsToNext, q)) continue;
        origins.push_back(from);
        moves.emplace_back(q - from);
      }
      const JointVector q = from + moves[same];
      if (!model_.joints.contains(q.data())) continue;
      add(q, layer);
      leads_on = leads_on || &from == &before.front().q;
    }
    return leads_on;
  }

  /// The same for an arm that is swept, all candidates at once in lanes, and if asked for with them
  /// some of the self-motion's other configurations, at each waypoint others.
  void add_on_curve(const Goal& goal, const Layer& before, std::size_t waypoint, bool with_others,
                    Workspace::InLanes& lanes, Layer& layer) const {
    const Pose Y = lanes.query.reduce(goal.target());
    std::vector<double> q = joint_values(before);
    if (with_others) {
      const int stride = Sweep::kSamples / 8;
      std::vector<Sweep::Sample> samples;
      lanes.sweep->set_target(Y);
      lanes.sweep->add_samples(static_cast<int>(waypoint % stride), stride, q, samples);
    }
    const auto dof = static_cast<std::size_t>(model_.dof);
    Work work(0);
    RowSeeds seeds(q.data(), q.size() / dof, dof, /*are_answers=*/false, work);
    const RowAnswers answers =
        refine_rows(seeds, goal, Y, {kFirst.far_off, kStepsToNext}, lanes.refiner, work);
    for (std::size_t row = 0; row < seeds.count(); ++row) {
      const Result& answer = answers.at(row);
      if (!answer.success()) continue;
      if (row < before.size()) {
        add(answer.q, layer);
      } else {
        add_nearest_images(answer.q, before, layer);
      }
    }
  }

  /// Where nothing is reached in time: what the candidates before lead to, along the self-motion to
  /// where the joint that is latest is least so.
  void add_in_time(const Goal& goal, const Layer& before, Layer& layer) const {
    for (const PathCandidate& from : before) {
      JointVector q = from.q;
      if (!converge(goal, kStepsToNext, q)) continue;
      descend_in_time(goal, longest_, from.q, q);
      add(q, layer);
    }
  }

  /// The solutions found for the first waypoint of a path without a start, at all images; those
  /// nearest to the middle of the limits first, should there be too many.
  void add_first_solutions(const SolutionSet& found, Layer& layer) const {
    for (std::size_t i = 0; i < found.size(); ++i) {
      JointVector q = found.at(i);
      model_.joints.wrap_nearest(middle_, 0, q);
      add(q, layer);
    }
    for (std::size_t i = 0; i < found.size(); ++i) {
      model_.joints.visit_images(found.at(i), [&](const JointVector& image) {
        add(image, layer);
        return layer.size() < kMostImages;
      });
    }
  }

  /// A solution at the images nearest to where the path may come from.
  void add_nearest_images(const JointVector& solution, const Layer& before, Layer& layer) const {
    if (!has_images_) {
      add(solution, layer);
      return;
    }
    JointVector q = solution;
    // Many that the path may come from have the same nearest image.
    std::set<std::vector<long>> known;
    std::vector<long> turns(static_cast<std::size_t>(model_.dof));
    for (const PathCandidate& from : before) {
      model_.joints.wrap_nearest(from.q, 0, q);
      for (std::size_t j = 0; j < turns.size(); ++j) {
        const auto joint = static_cast<Eigen::Index>(j);
        turns[j] = std::lround((q[joint] - solution[joint]) / kTwoPi);
      }
      if (!known.insert(turns).second) continue;
      // From the database at a later waypoint, at most.
      if (layer.size() >= 2 * kMostImages) return;
      add(q, layer);
    }
  }

  /// Leaves only what the scene and the filter let through.
  void screen(Layer& layer) { screen_.keep_passed(layer, /*by_scene=*/true); }
  /// Why a waypoint has no candidate, where all were refused.
  [[nodiscard]] Status refusal() const { return screen_.refusal(); }

  /// The cheapest way to each candidate; keeps those only that can be reached, the cheapest first.
  /// `at_last` moves cost the squares of their lengths: then no jump is cheaper than the long way
  /// about it.
  void connect(const Layer* before, Layer& layer, bool at_last = false) const {
    for (auto& [q, cost, parent] : layer) {
      // A path that begins anywhere costs the same at all its images: of those, the one that begins
      // nearest to the middle of the limits. Small beside all costs, and large beside their
      // rounding.
      cost = before == nullptr ? 1e-9 * (q - middle_).norm() : kInfinity;
      parent = 0;
      for (std::size_t k = 0; before != nullptr && k < before->size(); ++k) {
        const PathCandidate& from = (*before)[k];
        if (from.cost >= cost) break;
        const double left = cost - from.cost;
        if (is_too_far(from.q, q, at_last ? std::sqrt(left) : left)) continue;
        const double length = move_.length(q - from.q);
        const double by_way_of_it = from.cost + (at_last ? length * length : length);
        if (by_way_of_it >= cost) continue;
        cost = by_way_of_it;
        parent = k;
      }
    }
    layer.erase(std::remove_if(layer.begin(), layer.end(),
                               [](const PathCandidate& each) { return !(each.cost < kInfinity); }),
                layer.end());
    std::stable_sort(
        layer.begin(), layer.end(),
        [](const PathCandidate& a, const PathCandidate& b) { return a.cost < b.cost; });
  }

  /// The same, and keeps the cheapest only; false if there are none.
  bool connect_best(const Layer* before, Layer& layer) {
    connect(before, layer);
    // Without a start all candidates of the first waypoint are needed.
    if (before == nullptr) first_layer_ = layer.size();
    const std::size_t most = std::max(static_cast<std::size_t>(options_.candidates), first_layer_);
    if (layer.size() > most) layer.resize(most);
    return !layer.empty();
  }
  /// The same of those that are let through.
  bool keep_best(const Layer* before, Layer& layer) {
    screen(layer);
    return connect_best(before, layer);
  }

  /// Walks back from the cheapest end, and says if a step is too fast still.
  void trace(const std::vector<Layer>& layers, PathResult& result) const {
    if (layers.empty()) return;
    result.q.resize(layers.size());
    std::size_t i = 0;
    for (std::size_t w = layers.size(); w-- > 0;) {
      result.q[w] = layers[w][i].q;
      i = layers[w][i].parent;
    }
    for (std::size_t w = options_.start ? 0 : 1; w < result.q.size(); ++w) {
      const JointVector step = result.q[w] - (w == 0 ? *options_.start : result.q[w - 1]);
      result.move += asked_.length(step);
      const bool is_too_fast = (step.array().abs() > longest_.array()).any();
      if (makes_up() && is_too_fast) result.status = Status::too_fast;
      int joint = 0;
      const double largest = step.cwiseAbs().maxCoeff(&joint);
      if (result.largest_step_joint >= 0 && largest <= result.largest_step) continue;
      result.largest_step = largest;
      result.largest_step_joint = joint;
      result.largest_step_waypoint = static_cast<std::ptrdiff_t>(w);
    }
  }

 private:
  /// Whether a joint has to move farther than it can, most often the first already; or so far that
  /// the whole move has that length.
  [[nodiscard]] bool is_too_far(const JointVector& a, const JointVector& b, double length) const {
    for (int j = 0; j < model_.dof; ++j) {
      const double move = std::abs(a[j] - b[j]);
      const bool is_too_fast = !makes_up() && move > longest_[j];
      if (is_too_fast || move * move_.weights()[j] >= length) return true;
    }
    return false;
  }

  /// Images at the first waypoint, at most: those of sixteen solutions, of seven joints that have
  /// two images each.
  static constexpr std::size_t kMostImages = 2048;

  static SolveRequest make_request(const PathOptions& options) {
    SolveRequest request;
    static_cast<AnswerCriteria&>(request) = options;
    // Of whole layers at once.
    request.scene.reset();
    request.filter = request.exact = nullptr;
    return request;
  }

  const RobotModel& model_;
  const PathOptions& options_;
  SolveRequest request_;
  Screen screen_;
  JointVector longest_;
  Speeds speeds_;
  JointMove asked_;
  JointMove move_;  ///< by which edges cost
  JointVector middle_;
  bool has_images_ = false;
  /// Candidates of the first waypoint, if the path has no start.
  std::size_t first_layer_ = 0;
};

}  // namespace iksel
