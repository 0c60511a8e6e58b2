// SPDX-License-Identifier: BSD-3-Clause
// One target in each lane, with its seeds one after the other; a lane takes the next target as soon
// as it is through with one. These are both the seeds and the answers of a search.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "goal/goal.hpp"
#include "refine/lane_refiner.hpp"
#include "search/search.hpp"
#include "seeds/lane_query.hpp"

namespace iksel {

/// Numbers of the targets of a part of a batch: those that a stage is to solve, or has left.
using TargetList = std::vector<std::size_t>;

/// What BatchStream gives its targets to start from.
class LeafLanes {
 public:
  LeafLanes(LaneQuery& query, int max_attempts)
      : query_(query), most_(std::min(kSeeds, max_attempts)) {}

  /// The lane's target from now on. Y (reduction.hpp) is that of the pose nearest to it that the
  /// task allows.
  void begin(LaneRefiner& refiner, int lane, const Goal& goal, const Pose& Y) {
    refiner.set_target(lane, Y, goal.target());
    lanes_[lane] = {Y, 0};
  }
  /// Starts the lane at the target's next seed; false if there are no more.
  bool load(LaneRefiner& refiner, int lane) {
    Lane& in = lanes_[lane];
    if (in.seeds == most_) return false;
    query_.set_target(in.Y);
    query_.prepare_leaf();
    query_.load(in.seeds++, refiner, lane);
    return true;
  }
  [[nodiscard]] int attempts(int lane) const { return lanes_[lane].seeds; }
  /// The lane's seed has arrived where there is no answer.
  void refuse(int /*lane*/) {}
  /// What it proves that none of a target's seeds is an answer.
  [[nodiscard]] Proof proof(int /*lane*/) const { return Proof::none; }

 private:
  /// Seeds that a target is given before it is left.
  static constexpr int kSeeds = 2;

  struct Lane {
    Pose Y;
    int seeds;
  };
  LaneQuery& query_;
  int most_;
  Lane lanes_[lanes::kWidth];
};

/// `Seeds` are LeafLanes, or BranchLanes, which refine by themselves; `target(i)` gives T_base_tcp
/// of target i; `on_result(i, result)` is told of each that was solved, or is proven to have no
/// solution.
template <typename Refiner, typename Seeds, typename Target, typename OnResult>
class BatchStream {
 public:
  BatchStream(const ChainModel& model, const TaskSpace& task, const LaneQuery& query,
              Refiner& refiner, Seeds& seeds, const TargetList& targets, const Target& target,
              const OnResult& on_result)
      : model_(model),
        task_(task),
        query_(query),
        refiner_(refiner),
        seeds_(seeds),
        targets_(targets),
        target_(target),
        on_result_(on_result) {
    left_.reserve(targets.size());
  }

  /// Targets that are left to be solved otherwise.
  [[nodiscard]] const TargetList& left() const { return left_; }

  bool next_stage() {
    const bool is_first = !begun_;
    begun_ = true;
    return is_first;
  }

  bool load(Refiner& refiner, int lane) {
    Lane& in = lanes_[lane];
    if (in.is_open) {
      in.iterations += refiner.age(lane);
      if (seeds_.load(refiner, lane)) return true;
      give_up(lane);
    }
    while (next_ < targets_.size()) {
      in.index = targets_[next_++];
      in.target = target_(in.index);
      in.iterations = 0;
      const Goal goal(model_, task_, in.target);
      if (goal.is_out_of_reach()) {
        left_.push_back(in.index);
        continue;
      }
      in.is_open = true;
      const Pose Y = query_.reduce(task_.is_full_pose() ? in.target : goal.nearest_pose());
      seeds_.begin(refiner, lane, goal, Y);
      if (seeds_.load(refiner, lane)) return true;
      give_up(lane);
    }
    return false;
  }

  Verdict offer(int lane, JointVector& q) {
    Lane& in = lanes_[lane];
    model_.joints.wrap(q.data());
    Result result;
    if (!Goal(model_, task_, in.target).check(q, result)) {
      seeds_.refuse(lane);
      return Verdict::refine;
    }
    result.attempts = seeds_.attempts(lane);
    result.iterations = in.iterations + refiner_.age(lane);
    in.is_open = false;
    on_result_(in.index, result);
    return Verdict::next;
  }
  template <typename Q>
  [[nodiscard]] bool knows(const Q& /*q*/) const {
    return false;
  }
  [[nodiscard]] bool should_continue() const { return true; }

 private:
  struct Lane {
    std::size_t index = 0;  ///< of the target
    Pose target;
    int iterations = 0;    ///< of the seeds before
    bool is_open = false;  ///< not solved yet
  };

  /// The lane's target has no more seeds.
  void give_up(int lane) {
    Lane& in = lanes_[lane];
    in.is_open = false;
    Result none;
    none.proof = seeds_.proof(lane);
    if (none.proof == Proof::none) {
      left_.push_back(in.index);
    } else {
      on_result_(in.index, none);
    }
  }

  const ChainModel& model_;
  const TaskSpace& task_;
  const LaneQuery& query_;
  Refiner& refiner_;
  Seeds& seeds_;
  const TargetList& targets_;
  const Target& target_;
  const OnResult& on_result_;
  bool begun_ = false;
  std::size_t next_ = 0;  ///< of targets_
  Lane lanes_[lanes::kWidth];
  TargetList left_;
};

}  // namespace iksel
