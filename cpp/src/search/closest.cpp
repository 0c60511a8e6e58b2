// SPDX-License-Identifier: BSD-3-Clause
#include "search/closest.hpp"

#include <algorithm>
#include <vector>

#include "base/constants.hpp"
#include "goal/joint_move.hpp"
#include "goal/screen.hpp"
#include "refine/closest_descent.hpp"
#include "seeds/closest_screen.hpp"

namespace iksel {
namespace {

/// Seeds that are followed to the end: of the screen's those that have not much more left than the
/// best; where there is no screen, at random.
constexpr int kScreenedDescents = 4;
constexpr float kHopeful = 1.5F;
/// Where less is left, the arm almost reaches the target: more are followed, of single precision's
/// rounding as many as it leaves open, and what the sweep of a joint found nearest [rad^2].
constexpr float kAlmost = 3e-4F;
constexpr float kSingle = 2e-6F;
constexpr int kAlmostDescents = 8;
constexpr std::size_t kSweptDescents = 2;
/// At random, of goals that the screen does not measure: tests/python/test_closest_laws.py. Without
/// them 28 of 242 answers to tasks were more than 1 % farther than 100 descents come, and where
/// rotations weigh unlike 47 of 965.
constexpr int kBesideScreen = 24;
/// Remainders that differ by less, relative to them, are the same.
constexpr double kSameRemainder = 1e-6;

/// Local minima of what is missing, from seeds of all kinds.
class Minima {
 public:
  Minima(const Remainder& remainder, const SolveRequest& request, std::vector<LocalMinimum>& found,
         Result& result)
      : remainder_(remainder),
        request_(request),
        move_(remainder.goal().robot().dof, request),
        only_best_counts_(!request.near && !screens_answers(request)),
        found_(found),
        result_(result) {
    found_.clear();
  }

  void descend(const JointVector& seed) {
    LocalMinimum end{0, 0, static_cast<int>(found_.size()), seed};
    end.remainder = descend_from_seed(remainder_, /*most=*/40, end.q, result_.iterations, best_);
    if (only_best_counts_) best_ = std::min(best_, end.remainder);
    ++result_.attempts;
    if (request_.near) {
      remainder_.goal().joints().wrap_nearest(
          *request_.near, 0, [&](const JointVector& d) { return move_.length(d); }, end.q);
      end.move = move_.length(end.q - *request_.near);
    }
    found_.push_back(end);
  }

  /// Whether no other minimum than the least is asked for.
  [[nodiscard]] bool only_best_counts() const { return only_best_counts_; }

  /// The least first, and of the same ones that with the smallest move.
  const std::vector<LocalMinimum>& sorted() {
    const auto sort = [&](auto first, auto last, double LocalMinimum::*key) {
      std::sort(first, last, [&](const LocalMinimum& a, const LocalMinimum& b) {
        return a.*key < b.*key || (a.*key == b.*key && a.number < b.number);
      });
    };
    sort(found_.begin(), found_.end(), &LocalMinimum::remainder);
    auto first = found_.begin();
    while (first != found_.end()) {
      const double most = first->remainder * (1 + kSameRemainder);
      const auto last = std::find_if(
          first, found_.end(), [&](const LocalMinimum& each) { return each.remainder > most; });
      sort(first, last, &LocalMinimum::move);
      first = last;
    }
    return found_;
  }

 private:
  const Remainder& remainder_;
  const SolveRequest& request_;
  JointMove move_;
  /// Else the others are needed as well: those as good, and where the best are refused.
  bool only_best_counts_;
  double best_ = kInfinity;
  std::vector<LocalMinimum>& found_;
  Result& result_;
};

/// The seeds of the screen that are worth it.
void descend_from_screen(const Goal& goal, const Vector6& weights, Workspace::InLanes& lanes,
                         Minima& minima, Result& result) {
  ClosestScreen& screen = lanes.closest;
  screen.find(goal, weights, lanes.query);
  const bool is_almost_reached = screen.remainder(0) < kAlmost;
  const int most = is_almost_reached ? kAlmostDescents : kScreenedDescents;
  JointVector tried[kAlmostDescents];
  int count = 0;
  for (int i = 0; i < ClosestScreen::size() && count < most; ++i) {
    if (screen.remainder(i) > kHopeful * screen.remainder(0) + kSingle) break;
    const float expected =
        screen.remainder(i) - static_cast<float>(kHopefulSteps) * screen.gained(i);
    if (minima.only_best_counts() && expected > screen.remainder(0) + kSingle) continue;
    const JointVector seed = screen.q(i);
    const bool is_known = std::any_of(tried, tried + count, [&](const JointVector& other) {
      return goal.joints().are_near(seed, other, kBasinRadius);
    });
    if (is_known) continue;
    tried[count++] = seed;
    minima.descend(seed);
  }
  result.attempts += ClosestScreen::moved();
  if (!is_almost_reached || !goal.is_full_pose() || !lanes.sweep) return;
  lanes.sweep->visit_nearest(lanes.query.reduce(goal.target()), kSweptDescents,
                             [&](const JointVector& seed) { minima.descend(seed); });
}

}  // namespace

void set_closest(const Goal& goal, const JointVector& q, Result& result) {
  // What searches have missed.
  if (goal.check(q, result)) {
    result.unreachable_tip = -1;
    return;
  }
  result.status = Status::closest;
  result.q = q;
  goal.measure(q, result.position_error, result.rotation_error);
}

void give_closest(const SolverOptions& options, const Goal& goal, const SolveRequest& request,
                  const Vector6& weights, Workspace& workspace, Result& result) {
  const Remainder remainder(goal, weights);
  Minima minima(remainder, request, workspace.minima, result);
  if (request.near) minima.descend(*request.near);
  const auto given = std::min(request.seeds.size(), static_cast<std::size_t>(options.max_attempts));
  for (std::size_t i = 0; i < given; ++i) minima.descend(request.seeds[i]);
  int at_random = request.database_seeds ? kRandomDescents : 0;
  if (request.database_seeds && workspace.lanes) {
    descend_from_screen(goal, weights, *workspace.lanes, minima, result);
    at_random = workspace.lanes->closest.is_measured() ? 0 : kBesideScreen;
  }
  Random random(options.seed);
  for (int i = 0; i < at_random; ++i) minima.descend(goal.joints().sample(random));
  Screen screen(request, goal.robot().dof);
  for (const LocalMinimum& minimum : minima.sorted()) {
    bool keep = true;
    screen.apply(minimum.q.data(), 1, &keep);
    if (!keep) continue;
    set_closest(goal, minimum.q, result);
    if (request.near) result.move = minimum.move;
    return;
  }
}

}  // namespace iksel
