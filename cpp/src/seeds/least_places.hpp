// SPDX-License-Identifier: BSD-3-Clause
// Where, over places of a swept joint, its branches have the least values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/constants.hpp"
#include "base/least.hpp"
#include "seeds/swept_branches.hpp"

namespace iksel {

/// The least of all branches.
inline double least_of(const SweptBranches::Row& row) {
  double least = row[0];
  for (const double value : row) least = std::min(least, value);
  return least;
}

/// Where a branch has a value that is less than at the places beside.
struct LeastPlace {
  double value;
  int place, branch;
};

/// The least of these, at most so many.
template <std::size_t kMost>
class LeastPlaces : public Least<LeastPlace, kMost> {
 public:
  /// Of values at all places, of every branch; only those up to `bound`, and above `beyond`.
  void find(const Places& places, const std::vector<SweptBranches::Row>& rows, double bound,
            double beyond = -kInfinity) {
    static constexpr SweptBranches::Row kNone{kInfinity, kInfinity, kInfinity, kInfinity,
                                              kInfinity, kInfinity, kInfinity, kInfinity};
    const auto row = [&](int place) -> const SweptBranches::Row& {
      const int at = places.find(place);
      return at < 0 ? kNone : rows[static_cast<std::size_t>(at)];
    };
    this->clear();
    for (int place = 0; place < places.count; ++place) {
      const SweptBranches::Row& here = row(place);
      if (least_of(here) > bound) continue;
      const SweptBranches::Row& before = row(place - 1);
      const SweptBranches::Row& behind = row(place + 1);
      for (std::size_t i = 0; i < here.size(); ++i) {
        // Of conditions one by one few could be foreseen.
        const double least = std::min(bound, std::min(before[i], behind[i]));
        if (here[i] <= least && here[i] > beyond) this->add({here[i], place, static_cast<int>(i)});
      }
    }
  }
};

}  // namespace iksel
