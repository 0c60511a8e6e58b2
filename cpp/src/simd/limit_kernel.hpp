// SPDX-License-Identifier: BSD-3-Clause
// Limits of sums of joint values, in lanes: how far branches lie outside, and steps along them.
#pragma once

#include "simd/branch_types.hpp"
#include "simd/lane_math.hpp"

namespace iksel::lanes {

/// Joint values at an image: whole turns of joints for which they count.
template <typename T>
IKSEL_INLINE void turn_to_image(const SumForm& form, int image, const T (&q)[7], T (&at)[7]) {
  for (int j = 0; j < 7; ++j) at[j] = q[j];
  for (int k = 0; k < form.turning; ++k) {
    const int j = form.joint[k];
    const T turns = nearest_integer((T(form.middle[j]) - q[j]) * T(1 / kTwoPi));
    at[j] = q[j] + turns * T(kTwoPi) + T(form.turned[image][j]);
  }
}

/// How far the sum that is farthest lies outside there, or a joint whose whole turns count.
template <typename T>
IKSEL_INLINE T beyond_at(const SumForm& form, const T (&at)[7]) {
  T beyond = T(-1e30);
  for (int k = 0; k < form.turning; ++k) {
    const int j = form.joint[k];
    beyond = max(beyond, abs(at[j] - T(form.middle[j])) - T(form.reach[j]));
  }
  for (int r = 0; r < form.rows; ++r) {
    T sum = T(0.0);
    for (int j = 0; j < 7; ++j) sum = sum + T(form.coefficient[r][j]) * at[j];
    beyond = max(beyond, max(T(form.lower[r]) - sum, sum - T(form.upper[r])));
  }
  return beyond;
}

/// The same at the image where that is least, 0 or less if no sum lies outside. `q`: six joint
/// values, and the held angle [rad].
template <typename T>
[[gnu::noinline]] T beyond_sums(const SumForm& form, const T (&q)[7]) {
  T least = T(1e30);
  for (int i = 0; i < form.images; ++i) {
    T at[7];
    turn_to_image(form, i, q, at);
    least = min(least, beyond_at(form, at));
  }
  return least;
}

/// The same of a form: it, or `beyond` if that is more or no sum is limited.
template <typename T>
IKSEL_INLINE T beyond_with_sums(const ClosedForm& form, const T& beyond, const T (&of_six)[6],
                                const T& held) {
  if (form.sums == nullptr) return beyond;
  const T q[7] = {of_six[0], of_six[1], of_six[2], of_six[3], of_six[4], of_six[5], held};
  return max(beyond, beyond_sums(*form.sums, q));
}

/// The sum that a row of a chain bounds.
template <typename T>
IKSEL_INLINE T sum_of(const LaneChainOf<NumberOf<T>>& chain, int row, const T* q) {
  T sum = T(0.0);
  for (int j = 0; j < chain.n; ++j) sum = sum + T(chain.sum[row].c[j]) * q[j];
  return sum;
}

/// Moves the lanes whose sums are outside along these inside, as far as the joints' own limits let
/// them.
template <typename T>
[[gnu::noinline]] void hold_sums(const LaneChainOf<NumberOf<T>>& chain, T* q) {
  // After one the joints that were in the way stand at their limits.
  for (int round = 0; round < 3; ++round) {
    for (int r = 0; r < chain.sums; ++r) {
      const auto& row = chain.sum[r];
      const T sum = sum_of(chain, r, q);
      const T excess = max(sum - T(row.upper), T(0.0)) + min(sum - T(row.lower), T(0.0));
      if (!any(abs(excess) > T(0.0))) continue;
      T free[kMaxJoints];
      T norm2 = T(0.0);
      for (int j = 0; j < chain.n; ++j) {
        const auto& variable = chain.variable[j];
        const T down = excess * T(row.c[j]);
        const auto stays = ((q[j] <= T(variable.lower)) & (down > T(0.0))) |
                           ((q[j] >= T(variable.upper)) & (down < T(0.0)));
        free[j] = select(stays, T(0.0), T(row.c[j]));
        norm2 = norm2 + free[j] * free[j];
      }
      const T part = excess / max(norm2, T(row.least_norm2));
      for (int j = 0; j < chain.n; ++j) {
        if (row.c[j] == 0) continue;
        const auto& variable = chain.variable[j];
        q[j] = min(max(q[j] - part * free[j], T(variable.lower)), T(variable.upper));
      }
    }
  }
}

/// How far the sum that is farthest outside lies beyond its limit; of those at limits about 0.
template <typename T>
IKSEL_INLINE T excess_of_sums(const LaneChainOf<NumberOf<T>>& chain, const T* q) {
  T most = T(-1e30);
  for (int r = 0; r < chain.sums; ++r) {
    const auto& row = chain.sum[r];
    const T sum = sum_of(chain, r, q);
    const T rounding = T(row.upper) - T(row.high);
    most = max(most, max(sum - T(row.upper), T(row.lower) - sum) - rounding);
  }
  return most;
}

/// Takes out of the columns of J, in lanes whose sums are at limits which the error e pulls at,
/// what would leave them: steps J^T y then go along these.
template <typename T>
[[gnu::noinline]] void hold_columns(const LaneChainOf<NumberOf<T>>& chain, const T* q,
                                    const T (&e)[6], T (*J)[6]) {
  T normal[kMostSums][kMaxJoints];
  for (int r = 0; r < chain.sums; ++r) {
    const auto& row = chain.sum[r];
    const T sum = sum_of(chain, r, q);
    const auto low = sum <= T(row.low);
    const auto high = sum >= T(row.high);
    for (int j = 0; j < chain.n; ++j) normal[r][j] = T(0.0);
    if (!any(low | high)) continue;
    // Of the joints that may move: none whose column was taken out at its own limit.
    T slope = T(0.0);
    T size2 = T(0.0);
    for (int j = 0; j < chain.n; ++j) {
      if (row.c[j] == 0) continue;
      T gradient = T(0.0);
      T column2 = T(0.0);
      for (int i = 0; i < 6; ++i) {
        gradient = gradient + J[j][i] * e[i];
        column2 = column2 + J[j][i] * J[j][i];
      }
      const auto& variable = chain.variable[j];
      const auto is_held =
          (column2 <= T(0.0)) & ((q[j] <= T(variable.lower)) | (q[j] >= T(variable.upper)));
      normal[r][j] = select(is_held, T(0.0), T(row.c[j]));
      slope = slope + gradient * T(row.c[j]);
      size2 = size2 + normal[r][j] * normal[r][j];
    }
    // Across the rows before.
    for (int s = 0; s < r; ++s) {
      T along = T(0.0);
      for (int j = 0; j < chain.n; ++j) along = along + normal[r][j] * normal[s][j];
      for (int j = 0; j < chain.n; ++j) normal[r][j] = normal[r][j] - along * normal[s][j];
    }
    T norm2 = T(0.0);
    for (int j = 0; j < chain.n; ++j) norm2 = norm2 + normal[r][j] * normal[r][j];
    const auto leaves =
        ((low & (slope < T(0.0))) | (high & (slope > T(0.0)))) & (norm2 > T(1e-6) * size2);
    const T scale = select(leaves, T(1.0) / sqrt(max(norm2, T(row.least_norm2))), T(0.0));
    T across[6] = {T(0.0), T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)};
    for (int j = 0; j < chain.n; ++j) {
      normal[r][j] = normal[r][j] * scale;
      for (int i = 0; i < 6; ++i) across[i] = across[i] + J[j][i] * normal[r][j];
    }
    for (int j = 0; j < chain.n; ++j) {
      for (int i = 0; i < 6; ++i) J[j][i] = J[j][i] - across[i] * normal[r][j];
    }
  }
}

/// Takes out of a slope, in lanes whose sums are at limits which a descent would leave, what leads
/// out of them, and makes H, whose lower half is given, steep there: steps then go along these.
/// `scale`: H's order of magnitude, by joints.
template <typename T>
[[gnu::noinline]] void hold_descent(const LaneChainOf<NumberOf<T>>& chain, const T* q,
                                    const T* scale, T* slope, T (*H)[kMaxJoints]) {
  // Multipliers one after the other (Hildreth): a joint held at its own limit comes free where a
  // row pushes it inside.
  T multiplier[kMostSums];
  for (int round = 0; round < 4; ++round) {
    for (int r = 0; r < chain.sums; ++r) {
      const auto& row = chain.sum[r];
      const T sum = sum_of(chain, r, q);
      const T least = select(sum >= T(row.high), T(-1e30), T(0.0));
      const T most = select(sum <= T(row.low), T(1e30), T(0.0));
      if (round == 0) multiplier[r] = T(0.0);
      if (!any(least < most)) continue;
      T along = T(0.0);
      T norm2 = T(0.0);
      for (int j = 0; j < chain.n; ++j) {
        const auto& variable = chain.variable[j];
        const auto is_held = ((q[j] <= T(variable.lower)) & (slope[j] > T(0.0))) |
                             ((q[j] >= T(variable.upper)) & (slope[j] < T(0.0)));
        const T c = select(is_held, T(0.0), T(row.c[j]));
        along = along + c * slope[j] / (scale[j] + T(1e-9));
        norm2 = norm2 + c * c / (scale[j] + T(1e-9));
      }
      const T ideal = multiplier[r] + along / max(norm2, T(row.least_norm2));
      const T change = min(max(ideal, least), most) - multiplier[r];
      multiplier[r] = multiplier[r] + change;
      for (int j = 0; j < chain.n; ++j) slope[j] = slope[j] - change * T(row.c[j]);
    }
  }
  for (int r = 0; r < chain.sums; ++r) {
    const auto& row = chain.sum[r];
    T weighted = T(0.0);
    T size2 = T(0.0);
    for (int j = 0; j < chain.n; ++j) {
      weighted = weighted + scale[j] * T(row.c[j]) * T(row.c[j]);
      size2 = size2 + T(row.c[j]) * T(row.c[j]);
    }
    const T steep = T(100.0) * weighted / (size2 * size2);
    const T held = select(abs(multiplier[r]) > T(0.0), steep, T(0.0));
    for (int j = 0; j < chain.n; ++j) {
      for (int i = 0; i <= j; ++i) H[j][i] = H[j][i] + held * T(row.c[j]) * T(row.c[i]);
    }
  }
}

}  // namespace iksel::lanes
