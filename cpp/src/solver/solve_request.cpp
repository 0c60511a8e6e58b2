// SPDX-License-Identifier: BSD-3-Clause
// solve with wishes: the nearest solution, or the first that a filter lets through.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/constants.hpp"
#include "base/pose_check.hpp"
#include "goal/joint_move.hpp"
#include "goal/objective_cost.hpp"
#include "refine/self_motion.hpp"
#include "search/explore.hpp"
#include "solver/solver_impl.hpp"

namespace iksel {
namespace {

/// Seeds for a redundant arm, whose solutions never end.
constexpr int kRedundantSeeds = 64;
/// The nearest solutions of a redundant arm that slide.
constexpr std::size_t kSlides = 4;
/// Solutions nearer than this in every joint are looked at once [rad or m]: how far apart answers
/// of one branch may lie at the default tolerances where the arm is singular.
constexpr double kSame = 2e-3;

/// Copies by whole turns looked at, at most: joints with many turns have more than time allows.
constexpr std::size_t kMostTurns = 65536;

/// Half the squared weighted move, or for the max norm a p-norm near to it. A joint without weight
/// still has a little, so that it does not drift.
class MoveCost {
 public:
  MoveCost(const JointMove& move, const JointVector& near, double power)
      : near_(near), power_(power), weights_(move.weights()) {
    constexpr double kLeast = 1e-6;
    const double least = kLeast * weights_.maxCoeff();
    weights_ = weights_.cwiseMax(least);
  }

  double operator()(const JointVector& q, JointVector* gradient, JointVector* curvature) const {
    const JointVector d = weights_.cwiseProduct(q - near_);
    const double largest = d.cwiseAbs().maxCoeff();
    if (power_ == 2 || largest == 0) {
      if (gradient != nullptr) *gradient = weights_.cwiseProduct(d);
      if (curvature != nullptr) *curvature = weights_.cwiseAbs2();
      return 0.5 * d.squaredNorm();
    }
    // (sum |d|^p)^(1/p), scaled by the largest against overflow. The curvature leaves out the rank
    // one part, and is bounded below to stay positive where d is 0.
    const JointVector r = d.cwiseAbs() / largest;
    const double sum = r.array().pow(power_).sum();
    const double value = largest * std::pow(sum, 1 / power_);
    const double scale = std::pow(sum, 1 / power_ - 1);
    for (Eigen::Index j = 0; j < d.size(); ++j) {
      const double slope = scale * std::pow(r[j], power_ - 1);
      if (gradient != nullptr) (*gradient)[j] = weights_[j] * std::copysign(slope, d[j]);
      if (curvature != nullptr) {
        constexpr double kFloor = 1e-3;
        (*curvature)[j] = weights_[j] * weights_[j] * (power_ - 1) / largest *
                          std::max(scale * std::pow(r[j], power_ - 2), kFloor);
      }
    }
    return value;
  }

 private:
  JointVector near_;
  double power_;
  JointVector weights_;
};

void slide_towards(const ChainModel& model, const SolverOptions& options, const TaskSpace& task,
                   const Pose& T_base_tip, const JointMove& move, const JointVector& near,
                   JointVector& q) {
  constexpr int kSteps = 20;
  const auto slide_by = [&](double power) {
    const MoveCost cost(move, near, power);
    slide(model, options, task, T_base_tip, JointCost(cost), kSteps, q);
  };
  slide_by(2);
  if (move.norm() == MoveNorm::two) return;
  JointVector best = q;
  const auto keep_better = [&] {
    if (move.length(q - near) < move.length(best - near)) best = q;
  };
  // The p-norm tends to the max norm; each is easy to reach from the one before.
  for (const double power : {4.0, 16.0, 64.0}) {
    slide_by(power);
    keep_better();
  }
  q = best;
}

}  // namespace

/// The candidates of one request, judged by its filter and measured by its move.
class Solver::Impl::Judge {
 public:
  Judge(const Impl& solver, const TaskSpace& task, const Pose& T_base_tip,
        const SolveRequest& request, SolutionSet& found)
      : solver_(solver),
        model_(solver.robot.model()),
        task_(task),
        redundant_(model_.dof > task.fixed_axes()),
        T_base_tip_(T_base_tip),
        request_(request),
        ranks_(ranks_answers(request)),
        found_(found),
        move_(model_.dof, request) {}

  /// Puts what was found since the last look before the filter. True if the best of all that passed
  /// is an answer.
  bool look(const Exploration& search) {
    ask_filter();
    if (!ranks_) return first_kept_ < found_.size();
    if (redundant_) return first_kept_ < found_.size() && search.work.attempts >= kRedundantSeeds;
    return first_kept_ < found_.size() && search.is_likely_complete();
  }

  /// Whether the best can only be told when all are known.
  [[nodiscard]] bool wants_all() const { return ranks_ && !redundant_; }

  /// The best of what passed; false if nothing did.
  bool answer(JointVector& q) {
    if (first_kept_ == found_.size()) return answer_among_turns(kInfinity, q);
    if (!ranks_) {
      q = found_.at(first_kept_);
      return true;
    }
    std::array<Ranked, SolutionSet::kMost> ranked;
    std::size_t count = 0;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      if (!kept(i)) continue;
      const double cost = cost_of(found_.at(i));
      if (cost < kInfinity) ranked[count++] = {cost, i};
    }
    if (count == 0) return answer_among_turns(kInfinity, q);
    const std::size_t slides = redundant_ ? std::min(count, kSlides) : 1;
    std::partial_sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(slides),
                      ranked.begin() + static_cast<std::ptrdiff_t>(count));
    q = found_.at(ranked[0].index);
    double best = ranked[0].cost;
    if (redundant_) best = slide_best(ranked.data(), slides, q);
    // A copy by whole turns of one that was refused, or costs infinitely much, may be better still.
    if (count < found_.size()) answer_among_turns(best, q);
    return true;
  }

 private:
  /// Smaller is better; 0 where nothing is.
  [[nodiscard]] double cost_of(const JointVector& q) const {
    if (!ranks_) return 0;
    if (request_.objective.is_set()) return ObjectiveCost(model_, request_.objective).value(q);
    return move_.length(q - *request_.near);
  }

  struct Ranked {
    double cost;
    std::size_t index;
    friend bool operator<(const Ranked& a, const Ranked& b) {
      return a.cost != b.cost ? a.cost < b.cost : a.index < b.index;
    }
  };

  [[nodiscard]] bool kept(std::size_t i) const { return !request_.filter || kept_[i]; }

  void ask_filter() {
    if (request_.filter && asked_ < found_.size()) {
      request_.filter(found_.q(asked_), found_.size() - asked_, &kept_[asked_]);
    }
    asked_ = found_.size();
    while (first_kept_ < asked_ && !kept(first_kept_)) ++first_kept_;
  }

  [[nodiscard]] bool is_solution(const JointVector& q) const {
    Result measured;
    return solver_.finish(task_, T_base_tip_, q, measured);
  }

  /// Slides the best of what passed; q is the best before, and after. Its cost.
  double slide_best(const Ranked* ranked, std::size_t count, JointVector& q) {
    double best = ranked[0].cost;
    for (std::size_t k = 0; k < count; ++k) {
      JointVector slid = found_.at(ranked[k].index);
      if (request_.objective.is_set()) {
        constexpr int kObjectiveSteps = 50;
        const ObjectiveCost cost(model_, request_.objective);
        slide(model_, solver_.options, task_, T_base_tip_, JointCost(cost), kObjectiveSteps, slid);
      } else {
        slide_towards(model_, solver_.options, task_, T_base_tip_, move_, *request_.near, slid);
      }
      const double cost = cost_of(slid);
      if (!(cost < best) || !is_solution(slid)) continue;
      bool keep = true;
      if (request_.filter) request_.filter(slid.data(), 1, &keep);
      if (!keep) continue;
      best = cost;
      q = slid;
    }
    return best;
  }

  /// As answer, among the copies by whole turns whose cost is less than `best`. False if there is
  /// none, and q is what it was.
  bool answer_among_turns(double best, JointVector& q) {
    constexpr std::size_t kChunk = 64;
    const auto dof = static_cast<std::size_t>(model_.dof);
    std::array<double, kChunk* static_cast<std::size_t>(kMaxDof)> copies;
    std::size_t count = 0;
    bool any = false;
    const auto flush = [&] {
      std::array<bool, kChunk> keep{};
      keep.fill(!request_.filter);
      if (count > 0 && request_.filter) request_.filter(copies.data(), count, keep.data());
      for (std::size_t i = 0; i < count; ++i) {
        const JointVector copy =
            Eigen::Map<const Eigen::VectorXd>(copies.data() + i * dof, model_.dof);
        const double cost = cost_of(copy);
        if (!keep[i] || !(cost < best)) continue;
        best = cost;
        q = copy;
        any = true;
      }
      count = 0;
    };
    for (std::size_t i = 0; i < found_.size(); ++i) {
      JointVector copy = found_.at(i);
      model_.joints.first_image(copy);
      std::size_t left = kMostTurns / found_.size();
      do {
        if (!(cost_of(copy) < best) || !is_solution(copy)) continue;
        std::copy_n(copy.data(), dof, copies.data() + count * dof);
        if (++count == kChunk) flush();
      } while (--left > 0 && model_.joints.next_image(copy));
    }
    flush();
    return any;
  }

  const Impl& solver_;
  const ChainModel& model_;
  const TaskSpace& task_;
  bool redundant_;
  const Pose& T_base_tip_;
  const SolveRequest& request_;
  /// Whether some answers are better than others.
  bool ranks_;
  SolutionSet& found_;
  JointMove move_;
  std::array<bool, SolutionSet::kMost> kept_{};
  std::size_t asked_ = 0;
  std::size_t first_kept_ = 0;
};

TaskSpace Solver::Impl::task_of(const SolveRequest& request) const {
  if (!request.task) return task;
  return {*request.task, options.position_tolerance, options.rotation_tolerance};
}

Result Solver::Impl::solve(const Pose& T_base_tip, const SolveRequest& request,
                           Workspace& workspace) const {
  const TaskSpace of_call = task_of(request);
  Judge judge(*this, of_call, T_base_tip, request, workspace.found);
  const auto enough = [&](const Exploration& so_far) { return judge.look(so_far); };
  // With a filter the judge decides: nothing may have passed it yet.
  const bool takes_any = judge.wants_all() && !request.filter;
  Exploration search{
      T_base_tip, of_call, request, kSame, FunctionRef<bool(const Exploration&)>(enough),
      takes_any};
  explore(search, workspace);

  Result result;
  JointVector q;
  if (search.status == Status::solved) {
    if (judge.answer(q) && finish(of_call, T_base_tip, q, result)) {
      if (request.objective.is_set()) {
        result.cost = ObjectiveCost(robot.model(), request.objective).value(q);
      }
      if (request.near) result.move = JointMove(robot.dof(), request).length(q - *request.near);
    } else {
      result.status = Status::rejected;
    }
  } else {
    result.status = search.status;
  }
  if (!result.success() && search.out_of_time) result.status = Status::out_of_time;
  result.attempts = search.work.attempts;
  result.iterations = search.work.iterations;
  return result;
}

Result Solver::solve(const Pose& T_base_tip, const SolveRequest& request) const {
  Pose nearest;
  const Pose& target = to_rigid(T_base_tip, nearest);
  impl_->check(request);
  const Impl::Lease lease(*impl_);
  if (!request.has_wishes()) return impl_->solve(target, nullptr, lease.get(), nullptr);
  return impl_->solve(target, request, lease.get());
}

}  // namespace iksel
