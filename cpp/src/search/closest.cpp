// SPDX-License-Identifier: BSD-3-Clause
#include "search/closest.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "goal/joint_move.hpp"
#include "goal/screen.hpp"
#include "refine/closest_descent.hpp"
#include "seeds/closest_screen.hpp"

namespace iksel {
namespace {

/// Seeds that are followed to the end: of the screen's, and where there is none, at random.
constexpr int kScreenedDescents = 2;
constexpr int kRandomDescents = 48;
constexpr int kDescentSteps = 40;
/// Seeds of the screen nearer than this in every joint end at the same place [rad or m].
constexpr double kSameSeed = 0.1;
/// Remainders that differ by less, relative to them, are the same.
constexpr double kSameRemainder = 1e-6;

struct Minimum {
  double remainder;
  double move;  ///< from `near`, if there is one
  JointVector q;
};

/// Local minima of what is missing, from seeds of all kinds.
class Minima {
 public:
  Minima(const ChainModel& model, const Remainder& remainder, const SolveRequest& request,
         Result& result)
      : model_(model),
        remainder_(remainder),
        request_(request),
        move_(model.dof, request),
        result_(result) {}

  void descend(const JointVector& seed) {
    JointVector q = model_.joints.clamp(seed);
    const double remainder =
        descend_to_closest(model_, remainder_, kDescentSteps, q, result_.iterations);
    ++result_.attempts;
    double move = 0;
    // Steps may have turned a joint many times; whole turns matter only to joints that follow it.
    JointVector principal = q;
    model_.joints.wrap(principal.data());
    if (remainder_.value(principal) <= remainder * (1 + kSameRemainder)) q = principal;
    if (request_.near) {
      model_.joints.wrap_nearest(*request_.near, 0, q);
      move = move_.length(q - *request_.near);
    }
    found_.push_back({remainder, move, std::move(q)});
  }

  /// The least first, and of the same ones that with the smallest move.
  const std::vector<Minimum>& sorted() {
    std::stable_sort(found_.begin(), found_.end(),
                     [](const Minimum& a, const Minimum& b) { return a.remainder < b.remainder; });
    auto first = found_.begin();
    while (first != found_.end()) {
      const double most = first->remainder * (1 + kSameRemainder);
      const auto last = std::find_if(first, found_.end(),
                                     [&](const Minimum& each) { return each.remainder > most; });
      std::stable_sort(first, last,
                       [](const Minimum& a, const Minimum& b) { return a.move < b.move; });
      first = last;
    }
    return found_;
  }

 private:
  const ChainModel& model_;
  const Remainder& remainder_;
  const SolveRequest& request_;
  JointMove move_;
  Result& result_;
  std::vector<Minimum> found_;
};

/// The seeds of the screen that are worth it.
void descend_from_screen(const ChainModel& model, const Goal& goal, const Vector6& weights,
                         LaneQuery& query, Random& random, Minima& minima, Result& result) {
  ClosestScreen screen(model, weights);
  std::vector<const JointVector*> tried;
  for (const JointVector& seed : screen.find(goal, query, random)) {
    if (tried.size() == kScreenedDescents) break;
    const bool is_known = std::any_of(tried.begin(), tried.end(), [&](const JointVector* other) {
      return model.joints.distance(seed, *other, kSameSeed) < kSameSeed;
    });
    if (is_known) continue;
    tried.push_back(&seed);
    minima.descend(seed);
  }
  result.attempts += ClosestScreen::count();
}

}  // namespace

Vector6 to_vector(const PoseWeights& weights, const DatabaseData& data) {
  Vector6 all;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    all[row] = weights.position[i];
    all[row + 3] = weights.rotation ? (*weights.rotation)[i] : data.weight;
  }
  return all;
}

void set_closest(const Goal& goal, const JointVector& q, Result& result) {
  result.status = Status::closest;
  result.q = q;
  goal.measure(q, result.position_error, result.rotation_error);
}

void give_closest(const ChainModel& model, const SolverOptions& options, const Goal& goal,
                  const SolveRequest& request, const Vector6& weights, Workspace& workspace,
                  Result& result) {
  const Remainder remainder(model, goal, weights);
  Random random(options.seed);
  Minima minima(model, remainder, request, result);
  if (request.near) minima.descend(*request.near);
  const auto given = std::min(request.seeds.size(), static_cast<std::size_t>(options.max_attempts));
  for (std::size_t i = 0; i < given; ++i) minima.descend(request.seeds[i]);
  if (request.database_seeds && workspace.lanes) {
    descend_from_screen(model, goal, weights, workspace.lanes->query, random, minima, result);
  } else if (request.database_seeds) {
    JointVector seed(model.dof);
    for (int i = 0; i < kRandomDescents; ++i) {
      model.joints.sample(random, seed);
      minima.descend(seed);
    }
  }
  Screen screen(request.scene, request.exact, request.filter, model.dof);
  for (const Minimum& minimum : minima.sorted()) {
    bool keep = true;
    screen.apply(minimum.q.data(), 1, &keep);
    if (!keep) continue;
    set_closest(goal, minimum.q, result);
    if (request.near) result.move = minimum.move;
    return;
  }
}

}  // namespace iksel
