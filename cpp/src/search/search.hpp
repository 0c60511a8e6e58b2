// SPDX-License-Identifier: BSD-3-Clause
// The one search: while a lane is free and there is a seed, load it; refine; offer what arrives;
// until the answers ask for no more.
//
// What takes part is chosen by the caller:
//   Refiner  width(), advance(busy), has_arrived, stays, is_spent, is_to_be_looked_at, at and q
//            of a lane (lane_refiner.hpp, single_refiner.hpp);
//   Seeds    bool next_stage(), false if there are no more; bool load(refiner, lane), false if the
//            stage has no more for this lane (seeds/);
//   Answers  Verdict offer(lane, q); bool knows(q), where a seed need not be followed any further;
//            bool should_continue(), asked before each stage and after the last (first_answer.hpp,
//            collector.hpp).
#pragma once

#include "base/work.hpp"
#include "iksel/types.hpp"

namespace iksel {

/// What is to be done after a lane has arrived.
enum class Verdict {
  stop,    ///< nothing more is wanted
  next,    ///< this seed is finished; continue with others
  refine,  ///< it is not quite there; iterate it further
};

/// Returns whether the answers want no more; else the seeds have come to their end.
template <typename Refiner, typename Seeds, typename Answers>
bool search(Refiner& refiner, Seeds& seeds, Answers& answers, Work& work) {
  const int width = refiner.width();
  unsigned busy = 0;
  const auto bit = [](int lane) { return 1U << static_cast<unsigned>(lane); };
  const auto refill = [&](int lane) {
    busy = seeds.load(refiner, lane) ? busy | bit(lane) : busy & ~bit(lane);
  };
  while (true) {
    if (!answers.should_continue()) return true;
    if (!seeds.next_stage()) return false;
    for (int lane = 0; lane < width; ++lane) refill(lane);
    // NOLINTNEXTLINE(bugprone-infinite-loop): refill() ends it.
    while (busy != 0) {
      work.iterations += refiner.advance(busy);
      for (int lane = 0; lane < width; ++lane) {
        if ((busy & bit(lane)) == 0) continue;
        bool finished = refiner.is_spent(lane);
        if (refiner.is_to_be_looked_at(lane) && !finished && answers.knows(refiner.at(lane))) {
          finished = true;
        } else if (refiner.has_arrived(lane)) {
          JointVector q = refiner.q(lane);
          const Verdict verdict = answers.offer(lane, q);
          if (verdict == Verdict::stop) return true;
          work.arrivals += verdict == Verdict::next ? 1 : 0;
          finished = verdict == Verdict::refine ? refiner.stays(lane) || finished : true;
        }
        if (finished) refill(lane);
      }
    }
  }
}

}  // namespace iksel
