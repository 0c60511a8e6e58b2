// SPDX-License-Identifier: BSD-3-Clause
// How long seeds of which kind are iterated.
#pragma once

#include <limits>

#include "refine/lane_refiner.hpp"

namespace iksel {

inline constexpr int kMostIterations = std::numeric_limits<int>::max();
/// Of a seed that is held by a limit beside an answer the error stays as it is: beside a fold,
/// where steps are slowest, its square falls to a sixteenth each time.
inline constexpr int kStalled = 2;
/// Where any answer will do.
inline constexpr Patience kFirst{8, kMostIterations};
/// The same before roots or a sweep, which find what a slow seed would have: a pose of random arms
/// without an answer waits an eighth less, one that can be reached as long, and none is lost
/// (python -m bench lost --random 20 --targets 20000).
inline constexpr Patience kBeforeFamilies{5, kMostIterations, 0, kStalled};
/// Where a seed more or less does not matter: solutions arrive after 4 iterations in the mean, and
/// what is far off after 6 costs more than what it finds.
inline constexpr Patience kAll{6, kMostIterations, 2};
/// Where seeds were iterated before in single precision.
inline constexpr Patience kScreened{4, kMostIterations, 0, kStalled};
/// Where seeds are answers, or as near to one as a singularity or a limit lets it be told.
inline constexpr Patience kNearAnswer{8, 64, 0, kStalled};

}  // namespace iksel
