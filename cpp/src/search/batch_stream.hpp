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
    find_coming();
  }

  /// Whether target i is left to be solved by itself.
  [[nodiscard]] bool is_left(std::size_t i) const { return left_[i - first_]; }

  bool next_stage() {
    const bool is_first = !begun_;
    begun_ = true;
    return is_first && coming_.is_open;
  }

  bool load(LaneRefiner& /*refiner*/, int lane) {
    Lane& in = lanes_[lane];
    if (in.is_open) in.iterations += refiner_.age(lane);
    if (!in.is_open || in.seeds == most_seeds_) {
      if (in.is_open) left_.set(in.index - first_);
      in.is_open = false;
      if (!coming_.is_open) return false;
      in = coming_;
      find_coming();
      if (task_.is_full_pose()) {
        refiner_.set_pose(lane, in.Y);
      } else {
        refiner_.set_task(lane, in.target);
      }
    }
    lanes::SeedPack& seeds = query_.packs[0];
    query_.prepare_leaf(in.Y, in.leaf, seeds);
    load_ranked(seeds, in.seeds++, refiner_, lane);
    return true;
  }

  Verdict offer(int lane, JointVector& q) {
    Lane& in = lanes_[lane];
    model_.joints.wrap(q.data());
    Result result;
    if (!Goal(model_, task_, in.target).check(q, result)) return Verdict::refine;
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
    Pose target;
    Pose Y;  ///< of the pose nearest to it that the task allows (reduction.hpp)
    const float* leaf = nullptr;
    int seeds = 0;
    int iterations = 0;    ///< of the seeds before
    bool is_open = false;  ///< not solved yet
  };

  /// The target that the next free lane takes. Its samples come from memory while others are
  /// iterated.
  void find_coming() {
    coming_.is_open = false;
    for (; next_ < last_ && !coming_.is_open; ++next_) {
      coming_.index = next_;
      coming_.target = target_(next_);
      const Goal goal(model_, task_, coming_.target);
      coming_.is_open = !goal.is_out_of_reach();
      if (!coming_.is_open) {
        left_.set(next_ - first_);
        continue;
      }
      coming_.Y = query_.reduce(task_.is_full_pose() ? coming_.target : goal.nearest_pose());
      coming_.leaf = query_.fetch_leaf(coming_.Y);
    }
  }

  const ChainModel& model_;
  const TaskSpace& task_;
  int most_seeds_;
  LaneRefiner& refiner_;
  LaneQuery& query_;
  std::size_t first_, last_, next_;
  const Target& target_;
  const OnResult& on_result_;
  bool begun_ = false;
  Lane coming_;
  Lane lanes_[lanes::kWidth];
  std::bitset<kMost> left_;
};

}  // namespace iksel
