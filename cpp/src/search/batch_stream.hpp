// SPDX-License-Identifier: BSD-3-Clause
// One target in each lane, with its best seeds one after the other; a lane takes the next target as
// soon as it is through with one. These are both the seeds and the answers of a search.
#pragma once

#include <algorithm>
#include <bitset>
#include <cstddef>

#include "goal/goal.hpp"
#include "refine/lane_refiner.hpp"
#include "search/search.hpp"
#include "seeds/lane_query.hpp"

namespace iksel {

/// `target(i)` gives T_base_tcp of targets first to last - 1; `on_result(i, result)` is told of
/// each that was solved.
template <typename Target, typename OnResult>
class BatchStream {
 public:
  /// Most targets of one stream.
  static constexpr std::size_t kMost = 256;

  BatchStream(const ChainModel& model, const TaskSpace& task, int max_attempts,
              LaneRefiner& refiner, LaneQuery& query, std::size_t first, std::size_t last,
              const Target& target, const OnResult& on_result)
      : model_(model),
        task_(task),
        most_seeds_(std::min(kSeeds, max_attempts)),
        refiner_(refiner),
        query_(query),
        first_(first),
        last_(last),
        next_(first),
        target_(target),
        on_result_(on_result) {
    // Any seed is given up after so many iterations.
    constexpr int kPatience = 8;
    refiner.begin(task, {kPatience, kPatience}, Width::wide);
  }

  /// Whether target i is left to be solved by itself.
  [[nodiscard]] bool is_left(std::size_t i) const { return left_[i - first_]; }

  bool next_stage() { return next_ == first_ && first_ < last_; }

  bool load(LaneRefiner& /*refiner*/, int lane) {
    Lane& in = lanes_[lane];
    if (in.is_open) in.iterations += refiner_.age(lane);
    if (!in.is_open || in.seeds == most_seeds_) {
      if (in.is_open) left_.set(in.index - first_);
      in = {};
      if (!take_target(in)) return false;
    }
    const Pose& target = target_(in.index);
    if (task_.is_full_pose()) {
      const Pose Y = query_.reduce(target);
      refiner_.set_pose(lane, Y);
      query_.set_target(Y);
    } else {
      refiner_.set_task(lane, target);
      query_.set_target(query_.reduce(Goal(model_, task_, target).nearest_pose()));
    }
    lanes::SeedPack& seeds = query_.packs[0];
    query_.prepare_leaf(seeds);
    load_ranked(seeds, in.seeds++, refiner_, lane);
    return true;
  }

  Verdict offer(int lane, JointVector& q) {
    Lane& in = lanes_[lane];
    model_.joints.wrap(q.data());
    Result result;
    if (!Goal(model_, task_, target_(in.index)).check(q, result)) return Verdict::refine;
    result.attempts = in.seeds;
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
  /// Seeds that a target is given before it is left.
  static constexpr int kSeeds = 2;

  struct Lane {
    std::size_t index = 0;  ///< of the target
    int seeds = 0;
    int iterations = 0;    ///< of the seeds before
    bool is_open = false;  ///< not solved yet
  };

  bool take_target(Lane& in) {
    for (; next_ < last_; ++next_) {
      if (Goal(model_, task_, target_(next_)).is_out_of_reach()) {
        left_.set(next_ - first_);
        continue;
      }
      in.index = next_++;
      in.is_open = true;
      return true;
    }
    return false;
  }

  const ChainModel& model_;
  const TaskSpace& task_;
  int most_seeds_;
  LaneRefiner& refiner_;
  LaneQuery& query_;
  std::size_t first_, last_, next_;
  const Target& target_;
  const OnResult& on_result_;
  Lane lanes_[lanes::kWidth];
  std::bitset<kMost> left_;
};

}  // namespace iksel
