// SPDX-License-Identifier: BSD-3-Clause
// The moves to branches in lanes, against all whole turns one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "branches.hpp"
#include "closed_chains.hpp"
#include "robots.hpp"
#include "simd/branch_types.hpp"
#include "simd/kernels.hpp"

namespace {

using iksel::lanes::kWidth;

/// The least |q + 2 pi k - from|, over those inside the limits or over all.
double shortest_turn(const iksel::lanes::MoveForm& form, int j, double q, bool inside) {
  if (!form.turns[j]) return std::abs(q - form.from[j]);
  double least = 100;
  for (int k = -6; k <= 6; ++k) {
    const double image = q + iksel_test::kTwoPi * k;
    if (inside && form.has_images[j] && (image < form.lower[j] || image > form.upper[j])) continue;
    // Of a joint with one image inside the limits, as is one that is inside.
    const bool is_inside = q >= form.lower[j] && q <= form.upper[j];
    if (!form.has_images[j] && (inside || is_inside) && k != 0) continue;
    least = std::min(least, std::abs(image - form.from[j]));
  }
  return least;
}

TEST(Moves, InLanesAreThoseOfEachJointAlone) {
  iksel_test::Dice dice(iksel_test::seed());
  for (int round = 0; round < iksel_test::cases(300); ++round) {
    iksel::lanes::MoveForm form{};
    iksel::lanes::BranchPack pack{};
    iksel::lanes::MovePack found{};
    form.margin = 1e-5;
    form.takes_largest = round % 2 == 0;
    for (int j = 0; j < 7; ++j) {
      form.turns[j] = dice.uniform(0, 1) < 0.8;
      form.has_images[j] = form.turns[j] && dice.uniform(0, 1) < 0.8;
      const double range = form.has_images[j] ? dice.uniform(6.3, 13) : dice.uniform(1, 6);
      form.lower[j] = dice.uniform(-7, 0);
      form.upper[j] = form.lower[j] + range;
      form.from[j] = dice.uniform(form.lower[j] - 0.5, form.upper[j] + 0.5);
      form.weight[j] = dice.uniform(0, 2);
      const double beyond = form.has_images[j] ? 0 : 0.5;
      for (int lane = 0; lane < kWidth; ++lane) {
        (j == 6 ? pack.held : pack.q[j])[lane] =
            dice.uniform(form.lower[j] - beyond, form.upper[j] + beyond);
      }
    }
    for (int lane = 0; lane < kWidth; ++lane) {
      pack.beyond[lane] = dice.uniform(-1, 1);
      pack.least[lane] = dice.uniform(-1, 1);
    }
    iksel::lanes::choose_kernels().measure_moves(form, pack, found);
    for (int lane = 0; lane < kWidth; ++lane) {
      for (const bool inside : {false, true}) {
        double largest = 0;
        double square = 0;
        for (int j = 0; j < 7; ++j) {
          const double q = (j == 6 ? pack.held : pack.q[j])[lane];
          const double move = form.weight[j] * shortest_turn(form, j, q, inside);
          largest = std::max(largest, move);
          square += move * move;
        }
        const double expected = form.takes_largest ? largest : std::sqrt(square);
        EXPECT_NEAR((inside ? found.inside : found.loose)[lane], expected, 1e-12)
            << "inside " << inside << ", seed " << iksel_test::seed();
      }
      const double off =
          std::max(pack.beyond[lane], 0.0) + std::sqrt(std::max(-pack.least[lane], 0.0));
      EXPECT_NEAR(found.off[lane], off, 1e-15);
    }
  }
}

}  // namespace
