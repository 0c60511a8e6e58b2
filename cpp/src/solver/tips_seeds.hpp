// SPDX-License-Identifier: BSD-3-Clause
// Sources of seeds for several tips at once, made of what the solvers of the chains know.
#pragma once

#include <utility>
#include <vector>

#include "base/constants.hpp"
#include "base/function_ref.hpp"
#include "search/collector.hpp"
#include "search/first_answer.hpp"
#include "seeds/row_seeds.hpp"
#include "solver/arm_search.hpp"

namespace iksel {

/// Values of the shared joints spread evenly over the limits, from their middle on. Where the
/// nearest is wanted, only as far as they may lead to something nearer, and before these the values
/// of what it is wanted nearest to, and each joint at both ends. `steps`: low_discrepancy_steps of
/// so many joints.
class SharedValues {
 public:
  /// `most` over the whole of the limits; `to` may be null. All must outlive this.
  SharedValues(const TipsModel& model, const std::vector<double>& steps, int most,
               const NearestTo* to);

  /// Writes the next ones to q, whose shared joints are those that the nearest is wanted to; false
  /// if there are none left. `best` is the least move so far.
  bool next(double best, JointVector& q);
  /// The part of the limits that may lead to less than `best`.
  [[nodiscard]] double part(double best) const {
    double product = 1;
    for (const int joint : model_.shared) {
      const auto [lower, upper] = range(joint, best);
      const auto [lowest, uppermost] = range(joint, kInfinity);
      if (uppermost > lowest) product *= (upper - lower) / (uppermost - lowest);
    }
    return product;
  }
  /// Whether few values leave nothing between them: of one joint. Behind values of more, arms with
  /// narrow limits have answers at so few that what lies beside `near` is looked for from there
  /// too.
  static bool are_dense(const TipsModel& model) { return model.shared.size() <= 1; }

 private:
  /// Moves the shared joints inside all limits that are of these alone.
  void hold_stems(JointVector& q) const;
  /// What of a joint's range is of use.
  [[nodiscard]] std::pair<double, double> range(int joint, double best) const;

  const TipsModel& model_;
  const NearestTo* to_;
  int most_;
  /// Negative: those before what is spread.
  int index_;
  const std::vector<double>& steps_;
};

/// The arms solved behind one value of the shared joints after another; a stage has one value. Only
/// where all arms could be solved are there seeds, which are answers already: one, or where many
/// are wanted or a scene may refuse some, combinations of several solutions of each arm.
///
/// Behind a value the nearest of all is the nearest of each arm. What is known of each is good for
/// values beside it too: where one arm's nearest begins, or ends, between two values and another's
/// as well, both are there for a short way only, or not at any value that is tried.
class ArmSeeds {
 public:
  /// `collector` gets what is found; null: the first answer is enough. With little effort values
  /// are left at once where an arm is not solved with little. All must outlive this.
  ArmSeeds(const Goal& goal, ArmSearch& arms, const std::vector<double>& steps, Effort effort,
           const Collector* collector, Work& work);

  /// Whether nothing but the nearest is wanted, and is to be found by the nearest of each arm.
  static bool knows_nearest(const ArmSearch& arms, const Collector* collector) {
    return collector != nullptr && collector->wants_nearest() && arms.knows_nearest();
  }

  bool next_stage();
  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (next_ == seeds_.size()) return false;
    refiner.load_seed(lane, seeds_[next_++].data());
    return true;
  }

 private:
  [[nodiscard]] bool wants_many() const { return collector_ != nullptr && to_ == nullptr; }
  /// Values of the shared joints, as in q, and of those arms that were solved behind them the
  /// solutions; where the nearest are wanted those that were of use by then.
  struct Behind {
    JointVector q;
    std::vector<std::optional<std::vector<JointVector>>> arms;
  };
  /// Solves the arms from number `k` of the order on, with those before as in q, and adds all
  /// combinations.
  void extend(std::size_t k, JointVector q);
  /// The joint values of a tip's arm, with the others as in q.
  const std::vector<JointVector>& solve(int tip, const JointVector& q, Behind& behind);
  /// Adds what lies between the last values and those beside: of each joint the nearest below, and
  /// above.
  void add_between();
  /// Adds the arms behind `a`, but of tips whose bits are set those behind `b`, if both some of
  /// these and some of the others jump from `a` to `b`.
  void add_mixed(Behind& a, Behind& b, unsigned tips_of_b);
  /// Leaves those that are free, and where the nearest is wanted the nearest first.
  void sort_out();
  /// Of what does not keep to all sums nothing is of use where something does.
  void keep_sums();
  /// What the others may move by, where the joints of q that are set so far move as they do: the
  /// shared ones, and those of the first `arms` arms of the order. 0: these move too far.
  [[nodiscard]] double left(std::size_t arms, const JointVector& q) const;

  const Goal& goal_;
  const TipsModel& model_;
  ArmSearch& arms_;
  Effort effort_;
  const Collector* collector_;
  Work& work_;
  /// What the nearest is wanted to; null if it is not.
  const NearestTo* to_;
  bool knows_nearest_;
  SharedValues values_;
  /// The least move so far, beyond which nothing is of use.
  double last_best_ = kInfinity;
  /// Solutions of each arm that are combined.
  int of_each_;
  /// The tips' arms as they are solved one after the other: that which could not be solved last
  /// time is first, unless a target is in another tip's frame.
  std::vector<int> order_;
  std::size_t failed_ = 0;  ///< number in the order
  /// The last values at the end; before them those that they are mixed with.
  std::vector<Behind> behind_;
  std::vector<JointVector> seeds_;
  std::size_t next_ = 0;
};

/// Seeds for all joints together. One chain after another is solved as a whole, which sets the
/// shared joints; the arms of the others are brought as close as they come behind it, or where
/// there are none they are at random. (What ArmSeeds could solve in part is no better to begin
/// from: of 84,000 reachable targets of seven pairs of arms none is lost either way.) With little
/// effort they are a few, from chains at random, and arms that are not solved at once are at random
/// too.
class ChainSeeds : public RowSeeds {
 public:
  /// Told about a chain that cannot be solved by itself; gives the proof of that.
  using Unreachable = FunctionRef<Proof(int tip, const Result& alone)>;
  /// No more stages where `is_enough`. All must outlive this.
  ChainSeeds(const TipsGoal& goal, ArmSearch& arms, Effort effort, std::uint64_t seed, Work& work,
             const Unreachable& unreachable, const FunctionRef<bool()>& is_enough)
      : RowSeeds(work, &Work::take_counted),
        goal_(goal),
        arms_(arms),
        effort_(effort),
        random_(seed),
        unreachable_(unreachable),
        is_enough_(is_enough) {}

  /// That of a chain that cannot be solved by itself.
  [[nodiscard]] Proof proof() const { return proof_; }

  bool next_stage();

 private:
  /// Brings the other tips near behind a chain that was solved.
  void bring_others(int lead);

  const TipsGoal& goal_;
  ArmSearch& arms_;
  Effort effort_;
  Random random_;
  Unreachable unreachable_;
  FunctionRef<bool()> is_enough_;
  Proof proof_ = Proof::none;
  int index_ = 0;
  JointVector q_;
};

}  // namespace iksel
