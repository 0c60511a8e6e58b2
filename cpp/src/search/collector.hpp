// SPDX-License-Identifier: BSD-3-Clause
// The answers of a search that continues after the first: every distinct solution is kept.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "base/constants.hpp"
#include "base/function_ref.hpp"
#include "goal/coaxial_joints.hpp"
#include "goal/joint_move.hpp"
#include "goal/screen.hpp"
#include "search/search.hpp"
#include "search/search_state.hpp"
#include "search/solution_set.hpp"

namespace iksel {

/// Whether some answers to the request are better than others.
inline bool ranks_answers(const SolveRequest& request) {
  return request.near || request.objective.is_set();
}

/// Solutions of several tips whose move is no more than so many times the least are moved along
/// their self-motion to where it is least, and may lead to nearer ones beside them. With 1.1 and
/// without a bound as many of 600 moves of two Pandas on a joint were longer than by brute force,
/// with 1 more; it takes a third of the time (python -m bench hands pairs).
inline constexpr double kWorthDescending = 1.1;
/// The best solutions of a redundant arm that are brought to a least cost.
inline constexpr std::size_t kDescents = 4;
/// The same where solutions come in families: the nearest may be on that of the sixth (python -m
/// bench laws right_angles_6 --poses 100); with 4, 5 of 2,820 moves of arms whose self-motions are
/// no curves are longer than brute force, with 16 none (python -m bench random right_angles_7).
inline constexpr std::size_t kFamilyDescents = 16;

/// What a Collector writes to. Memory is taken at construction, none later.
struct CollectorMemory {
  explicit CollectorMemory(const RobotModel& model) : found(model) { partners.reserve(kPartners); }

  SolutionSet found;
  /// Predicted partners of solutions that were found, still to be tried (fold_partner.hpp).
  std::vector<JointVector> partners;
  /// Room for that many; there are fewer solutions that come in pairs.
  static constexpr std::size_t kPartners = 64;
  /// Of one tip.
  std::optional<CoaxialJoints> coaxial;
};

class Collector : public SearchState {
 public:
  /// What a search looks for.
  struct Aim {
    /// Solutions nearer than this in every joint are one [rad or m].
    double min_distance;
    /// Whether the search ends when it has most likely found all.
    bool until_complete;
    /// Of a redundant arm, so many solutions spread evenly over its self-motion will do; 0: no.
    int spread = 0;
    /// Where the nearest is wanted, nothing that is farther away is of use.
    double within = kInfinity;
  };

  /// `is_satisfied` is asked between stages. All must outlive this.
  Collector(const Goal& goal, const SolveRequest& request, const Aim& aim,
            FunctionRef<bool(const Collector&)> is_satisfied, int max_attempts,
            CollectorMemory& memory);

  Verdict offer(int lane, JointVector& q);
  /// Where the arm stands, if it stands at the goal.
  void offer_near();
  /// Whether q is on its way to a solution that is known.
  template <typename Q>
  [[nodiscard]] bool knows(const Q& q) const {
    return basin_radius_ > 0 && found_.is_near_known(q, basin_radius_);
  }
  /// Whether one of those that were found lies nearer to q than `radius` in every joint.
  [[nodiscard]] bool has_beside(const JointVector& q, double radius) const {
    return found_.is_near_known(q, radius);
  }
  [[nodiscard]] bool should_continue();

  /// The next predicted partner, if there is one.
  bool pop_partner(JointVector& q) const;
  [[nodiscard]] bool has_any() const { return found_.size() > 0; }
  [[nodiscard]] std::size_t count() const { return found_.size(); }
  /// Whether partners of solutions are to be looked for: not while branches are tried, which are
  /// all as a rule. Where they were not, those of what was found meanwhile are.
  void look_for_partners(bool look);
  /// Says that all branches in closed form were tried: what is left lies around those in doubt.
  void set_all_branches_tried() { has_all_branches_ = true; }
  /// Says that the nearest is looked for on families of solutions that are no curves.
  void set_surfaces() { are_surfaces_ = true; }
  [[nodiscard]] bool are_surfaces() const { return are_surfaces_; }
  /// Looks for an answer that is reached from `near`: of a family of them, where the arm is
  /// singular, the one beside it need not be among the branches.
  void converge_from_near();
  /// Looks for the answer beside q to which the move is least.
  void descend_from(JointVector q);
  /// The same from those that are nearest of what was found, so many at most; what is nearest then
  /// is settled.
  void descend_from_nearest(std::size_t most);
  /// Whether a solution may be one of a family: the arm is redundant, or singular there, or almost.
  [[nodiscard]] bool is_singular(const JointVector& q) const;
  /// Whether all there are are wanted.
  [[nodiscard]] bool wants_all() const { return aim_.until_complete; }
  /// Whether more than the first answer is wanted.
  [[nodiscard]] bool wants_more() const { return aim_.until_complete || ranks_answers(request_); }
  /// Whether of answers the nearest is the best.
  [[nodiscard]] bool ranks_by_move() const { return !aim_.until_complete && nearest_to_; }
  /// Whether nothing but the nearest is wanted, and nothing may refuse it.
  [[nodiscard]] bool wants_nearest() const { return ranks_by_move() && !screens_answers(request_); }
  /// To what then; else null.
  [[nodiscard]] const JointVector* only_nearest_to() const {
    return wants_nearest() ? &nearest_to_->from : nullptr;
  }
  /// Whether nothing is wanted but the nearest of those that a scene and a filter let through.
  [[nodiscard]] bool wants_nearest_passing() const {
    return ranks_by_move() && screens_answers(request_) && !request_.exact;
  }
  /// To what, if it wants that.
  [[nodiscard]] const NearestTo& nearest_to() const { return *nearest_to_; }
  /// Of what was found, where the nearest is wanted; infinite if nothing was.
  [[nodiscard]] double least_move() const {
    if (counts_moves_ || !has_any() || !nearest_to_) return found_.least_cost();
    return move_to(nearest());
  }
  /// What a move must be less than to be of use; infinite if all are.
  [[nodiscard]] double within() const { return aim_.within; }
  /// And to be the nearest of these.
  [[nodiscard]] double move_to_beat() const { return std::min(least_move(), within()); }
  /// Which of those that were found, of one at least, is nearest to what the nearest is wanted to.
  [[nodiscard]] std::size_t nearest() const {
    std::size_t least = 0;
    for (std::size_t i = 1; i < found_.size(); ++i) {
      if (move_to(i) < move_to(least)) least = i;
    }
    return least;
  }
  /// How many solutions are to be spread over the self-motion, and how near to each other; 0: they
  /// need not be.
  [[nodiscard]] int spread() const { return aim_.spread; }
  [[nodiscard]] double min_distance() const { return aim_.min_distance; }
  [[nodiscard]] bool is_complete() const { return aim_.until_complete && is_likely_complete(); }
  /// Whether all there is has most likely been found: many seeds in a row led to nothing new.
  [[nodiscard]] bool is_likely_complete() const;
  [[nodiscard]] const double* solution(std::size_t i) const { return found_.q(i); }

  /// Says whether the nearest that was found is the least move already.
  void settle(bool is_settled) { is_settled_ = is_settled; }
  [[nodiscard]] bool is_settled() const { return is_settled_; }

  /// Says that the search is over, and what is proven of solutions besides those found.
  void conclude(Proof proof) {
    result_.proof = proof;
    result_.attempts = work.all_attempts();
    result_.iterations = work.iterations;
  }
  /// What it came to, without any of the answers.
  [[nodiscard]] const Result& result() const { return result_; }
  [[nodiscard]] bool is_out_of_time() const { return is_out_of_time_; }
  /// Why there is no answer, where that would be `found`: unproven, a want of time comes before it.
  [[nodiscard]] Status reason(Status found, Proof proof) const {
    return is_out_of_time_ && proof == Proof::none ? Status::out_of_time : found;
  }

 private:
  [[nodiscard]] double move_of(const JointVector& q) const {
    return nearest_to_->move.length(q - nearest_to_->from);
  }
  [[nodiscard]] double move_to(std::size_t i) const { return move_of(found_.at(i)); }
  /// Brings a success to the image nearest to `near`, where it still is one.
  void wrap_near(const JointVector& near, Result& answer) const;
  /// Brings a success to the nearest that joints about one axis make of it.
  void share_turns(Result& answer) const;
  void look_for_partner(const Jacobian& J, const JointVector& q);
  /// Adds a success to what was found; false if it was known.
  bool keep(const Result& answer);
  /// Also keeps where the move is least along the self-motion of a success: of several tips each
  /// solution is one of a family, and those near to its best are looked for around that.
  void keep_nearer(Result answer);

  const RobotModel& model_;
  Aim aim_;
  FunctionRef<bool(const Collector&)> is_satisfied_;
  SolutionSet& found_;
  std::vector<JointVector>& partners_;
  std::optional<NearestTo> nearest_to_;
  const CoaxialJoints* coaxial_;  ///< null: there are none, or they stay as they are
  /// Solutions are brought to their images nearest to this.
  JointVector images_near_;
  bool counts_moves_;
  bool comes_in_pairs_;
  bool looks_for_partners_ = true;
  bool has_all_branches_ = false;
  bool are_surfaces_ = false;
  bool has_converged_ = false;  ///< from `near`
  bool is_settled_ = false;
  bool is_out_of_time_ = false;
  double basin_radius_;
  std::size_t paired_ = 0;  ///< of what was found, partners of so many were looked for
  int last_new_ = 0;        ///< seeds tried until the last new solution
};

}  // namespace iksel
