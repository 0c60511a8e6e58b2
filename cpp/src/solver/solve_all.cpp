// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "goal/joint_move.hpp"
#include "goal/objective_cost.hpp"
#include "goal/screen.hpp"
#include "iksel/error.hpp"
#include "seeds/farthest_first.hpp"
#include "solver/solver_impl.hpp"

namespace iksel {
namespace {

/// Solutions of a redundant arm from which the asked for are spread: so many for each.
constexpr std::size_t kChoice = 4;
/// For no more than so many, as a set holds.
constexpr std::size_t kMostSpread = SolutionSet::kMost / kChoice;

/// A solution, or one of its periodic images.
struct Image : Result {
  double rank;           ///< smaller comes first
  std::size_t solution;  ///< of which it is an image
};

bool cheaper(const Image& a, const Image& b) {
  if (a.rank != b.rank) return a.rank < b.rank;
  return std::lexicographical_compare(a.q.data(), a.q.data() + a.q.size(), b.q.data(),
                                      b.q.data() + b.q.size());
}

/// Smallest distance from a limit, relative to the range; joints without limits have none.
double limit_distance(const RobotModel& model, const JointVector& q) {
  double least = 0.5;
  model.joints.visit_limits([&](const Limit& limit) {
    const double range = limit.upper - limit.lower;
    if (!std::isfinite(range) || range <= 0) return;
    const double value = limit.value(q.data());
    least = std::min(least, std::min(value - limit.lower, limit.upper - value) / range);
  });
  return least;
}

/// What puts the solutions of a request in order.
class SolutionRanking {
 public:
  /// All must outlive this.
  SolutionRanking(const RobotModel& model, SolutionOrder order, const SolveRequest& request)
      : model_(model),
        order_(order),
        objective_(request.objective),
        nearest_to_(find_nearest_to(model.dof, request)),
        move_(model.dof, request),
        from_(request.near ? *request.near : model.joints.middle()) {}

  /// Smaller comes first.
  [[nodiscard]] double cost(const JointVector& q) const {
    if (objective_.is_set()) {
      return nearest_to_ ? nearest_to_->move.length(q - nearest_to_->from) : objective(q);
    }
    switch (order_) {
      case SolutionOrder::limit_distance:
        return -limit_distance(model_, q);
      case SolutionOrder::manipulability:
        return -manipulability(model_, q);
      case SolutionOrder::move:
        break;
    }
    return move(q);
  }
  [[nodiscard]] double move(const JointVector& q) const { return move_.length(q - from_); }
  [[nodiscard]] double objective(const JointVector& q) const {
    return ObjectiveCost(model_, objective_).value(q);
  }

 private:
  const RobotModel& model_;
  SolutionOrder order_;
  const Objective& objective_;
  std::optional<NearestTo> nearest_to_;
  JointMove move_;
  JointVector from_;
};

/// The solutions found that are free, each at all its images inside the limits or as it is.
std::vector<Image> images_of(const Goal& goal, const SolutionSet& found, const Screen& screen,
                             bool with_images, const SolutionRanking& ranking) {
  std::vector<Image> images;
  images.reserve(found.size());
  const std::unique_ptr<bool[]> free(new bool[found.size() + 1]());
  if (found.size() > 0) screen.find_free(found.q(0), found.size(), free.get());
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!free[i]) continue;
    const auto add = [&](const Result& answer) {
      images.push_back({answer, ranking.cost(answer.q), i});
    };
    if (!with_images) {
      add(found.result(i));
      continue;
    }
    goal.joints().visit_images(found.at(i), [&](const JointVector& q) {
      // One that was beside a limit, and is held to it, need not be an answer.
      Result image;
      if (goal.check(q, image)) add(image);
      return images.size() < kMostImages;
    });
  }
  return images;
}

/// Of how many solutions these are images, each solution's one after the other.
std::size_t count_solutions(const std::vector<Image>& images) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < images.size(); ++i) {
    count += i == 0 || images[i].solution != images[i - 1].solution ? 1 : 0;
  }
  return count;
}

/// Of the images of each solution, in order, the first.
void take_first_of_each(std::size_t solutions, std::vector<Image>& images) {
  std::vector<bool> seen(solutions);
  images.erase(std::remove_if(images.begin(), images.end(),
                              [&](const Image& image) {
                                const bool again = seen[image.solution];
                                seen[image.solution] = true;
                                return again;
                              }),
               images.end());
}

/// The best of the images, in order, at most so many; true if there were more.
bool take_best(const lanes::LaneKernels& kernels, const JointSpace& joints, std::size_t most,
               bool is_redundant, std::vector<Image>& images) {
  if (images.size() <= most) return false;
  if (is_redundant) {
    // Those that lie far from each other, the first among them.
    std::vector<Image> apart;
    const std::vector<double> q = joint_values(images);
    for (const std::size_t i : farthest_first(kernels, joints, q.data(), images.size(), most)) {
      apart.push_back(std::move(images[i]));
    }
    images = std::move(apart);
    std::sort(images.begin(), images.end(), cheaper);
  } else {
    images.resize(most);
  }
  return true;
}

/// What a search for answers came to, without them.
Solutions without_answers(const Result& none) {
  Solutions solutions;
  solutions.status = none.status;
  solutions.proof = none.proof;
  solutions.attempts = none.attempts;
  solutions.iterations = none.iterations;
  return solutions;
}

}  // namespace

Solutions Solver::Impl::solve_all(const Goal& goal, const SolveAllOptions& all,
                                  const SolveRequest& request, Workspace& workspace) const {
  const auto most = static_cast<std::size_t>(all.max);
  Solutions solutions = find_all(goal, all, request, most, workspace);
  const bool saw_few = request.filter && goal.is_redundant() && most < kMostSpread;
  if (!solutions.all.empty() || !saw_few || workspace.collected.found.size() == 0) return solutions;
  // What a filter lets through may be a little part of a self-motion.
  return find_all(goal, all, request, kMostSpread, workspace);
}

Solutions Solver::Impl::find_all(const Goal& goal, const SolveAllOptions& all,
                                 const SolveRequest& request, std::size_t choice,
                                 Workspace& workspace) const {
  if (!request.exact && goal.is_never_free()) {
    return without_answers(find_first(goal, request, workspace, nullptr));
  }
  const SolutionSet& found = workspace.collected.found;
  const auto is_satisfied = [&](const Collector&) {
    return goal.is_redundant() && found.size() >= std::max<std::size_t>(kChoice * choice, 64);
  };
  Screen screen(request, robot.dof());
  // Over a self-motion; what is refused is replaced by others, no more than a set can hold.
  const std::size_t for_each = screen.is_set() ? kChoice : 1;
  const auto spread = static_cast<int>(for_each * std::min(choice, kMostSpread));
  const Collector::Aim aim{all.min_distance, true, goal.is_redundant() ? spread : 0};
  Collector search(goal, request, aim, is_satisfied, options.max_attempts, workspace.collected);
  collect(search, workspace);

  Solutions solutions = without_answers(search.result());
  const SolutionRanking ranking(robot.all(), all.order, request);
  // Without, each solution is at its best image already.
  const bool with_images =
      all.whole_turns || request.filter || request.objective.kind == Objective::Kind::custom;
  std::vector<Image> images = images_of(goal, found, screen, with_images, ranking);
  const std::size_t free = count_solutions(images);
  bool are_left_out = images.size() >= kMostImages;
  screen.keep_passed(images, /*by_scene=*/false);
  images.erase(std::remove_if(images.begin(), images.end(),
                              [](const Image& image) { return std::isinf(image.rank); }),
               images.end());
  // Of joints without limits there are more images.
  are_left_out |= !goal.joints().upper.allFinite() && count_solutions(images) < free;
  std::sort(images.begin(), images.end(), cheaper);
  if (!all.whole_turns) take_first_of_each(found.size(), images);
  are_left_out |= take_best(workspaces.shared().kernels, goal.joints(),
                            static_cast<std::size_t>(all.max), goal.is_redundant(), images);
  if (are_left_out) solutions.proof = Proof::none;

  solutions.all.reserve(images.size());
  for (Result& result : images) {
    if (request.near) result.move = ranking.move(result.q);
    if (request.objective.is_set()) result.cost = ranking.objective(result.q);
    result.attempts = solutions.attempts;
    result.iterations = solutions.iterations;
    solutions.all.push_back(result);
  }
  if (solutions.all.empty()) {
    if (solutions.status == Status::solved) solutions.status = screen.refusal();
    solutions.status = search.reason(solutions.status, solutions.proof);
  } else if (solutions.proof == Proof::none) {
    solutions.proof = Proof::answer;
  }
  return solutions;
}

Solutions Solver::solve_all(const Pose& T_base_tip, const SolveAllOptions& options,
                            const SolveRequest& request) const {
  return solve_all(std::vector<Pose>{T_base_tip}, options, request);
}

Solutions Solver::solve_all(const std::vector<Pose>& T_base_tip, const SolveAllOptions& options,
                            const SolveRequest& request) const {
  const std::vector<Pose> targets = impl_->check_targets(T_base_tip);
  options.validate();
  impl_->check(request);
  if (request.closest) throw InvalidArgumentError("closest: solve_all gives answers only");
  if (request.objective.is_set() && options.order != SolutionOrder::move) {
    throw InvalidArgumentError("order: with an objective that decides the order; leave out one");
  }
  const WorkspacePool::Lease lease(impl_->workspaces);
  return impl_->with_goal(
      targets.data(), request, request.scene ? &*request.scene : nullptr,
      [&](const Goal& goal) { return impl_->solve_all(goal, options, request, lease.get()); });
}

}  // namespace iksel
