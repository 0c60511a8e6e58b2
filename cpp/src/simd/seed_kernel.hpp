// SPDX-License-Identifier: BSD-3-Clause
// From the samples of a block to seeds for a target: the joints that are left out of the samples
// are set, every seed takes one step by its stored pseudo-inverse, and the seeds are ranked by
// where that step ended; and how far seeds are from what is known. All in single precision: a seed
// need not be exact.
#pragma once

#include "simd/lane_goal.hpp"
#include "simd/lane_types.hpp"

namespace iksel::lanes {

/// q moved by whole turns to within half a turn of `middle`.
template <typename T>
inline T wrap_near(const T& q, float middle) {
  const T turns = nearest_integer((q - T(middle)) * T(0.15915494F));
  return q - turns * T(6.2831853F);
}

/// Joint values left out of the samples, and what they do to the poses.
template <typename T>
struct LeftOut {
  T first = T(0.0F), last = T(0.0F);
  /// Of a rotation on the left; it turns the target back to where the samples are.
  T cosine = T(1.0F), sine = T(0.0F);
  /// Displacement by a translation on the right, along the samples' z.
  T slide = T(0.0F);
};

/// The left side: the first joint's value that brings the sample nearest to the target.
template <typename T>
IKSEL_INLINE void set_first(const SeedChain& chain, const SeedTarget& seed_target,
                            LaneFrame<T>& sample, LeftOut<T>& out) {
  const float* const target = seed_target.target;
  const auto& z = sample.z;
  auto& p = sample.p;
  if (chain.left == Side::rotation) {
    const T w2 = T(chain.weight2);
    T px = p[0];
    T py = p[1];
    float tx = target[0];
    float ty = target[1];
    const float* const tz = target + 9;
    if (chain.right == Side::translation) {
      // The slide moves the position, but not the foot of the perpendicular onto its line.
      const T along = p[0] * z[0] + p[1] * z[1] + p[2] * z[2];
      px = px - along * z[0];
      py = py - along * z[1];
      const float target_along = tx * tz[0] + ty * tz[1] + target[2] * tz[2];
      tx -= target_along * tz[0];
      ty -= target_along * tz[1];
    }
    const T S = px * T(ty) - py * T(tx) + w2 * (z[0] * T(tz[1]) - z[1] * T(tz[0]));
    const T C = px * T(tx) + py * T(ty) + w2 * (z[0] * T(tz[0]) + z[1] * T(tz[1]));
    const T scale = T(1.0F) / sqrt(max(S * S + C * C, T(1e-30F)));
    out.cosine = select(C * C + S * S > T(1e-30F), C * scale, T(1.0F));
    out.sine = S * scale;
    out.first = wrap_near(rough_atan2(S, C) - T(chain.offset_first), chain.middle[0]);
  } else if (chain.left == Side::translation) {
    out.first = T(target[2]) - p[2] - T(chain.offset_first);
    p[2] = T(target[2]);
  }
}

/// The target as the samples see it after set_first.
template <typename T>
IKSEL_INLINE void turn_back(const SeedTarget& target, const LeftOut<T>& left,
                            SeedTargetOf<T>& out) {
  for (int row = 0; row < kFullPoseRows; row += 3) {
    const float* const t = target.target + row;
    T* const to = out.target + row;
    to[0] = left.cosine * T(t[0]) + left.sine * T(t[1]);
    to[1] = left.cosine * T(t[1]) - left.sine * T(t[0]);
    to[2] = T(t[2]);
  }
}

/// The right side: the last joint's value, and the sample's columns turned by it.
template <typename T>
IKSEL_INLINE void set_last(const SeedChain& chain, const SeedTargetOf<T>& target,
                           LaneFrame<T>& sample, LeftOut<T>& out) {
  auto& x = sample.x;
  auto& y = sample.y;
  if (chain.right == Side::rotation) {
    const T* const tx = target.target + 3;
    const T* const ty = target.target + 6;
    const T sine =
        y[0] * tx[0] + y[1] * tx[1] + y[2] * tx[2] - (x[0] * ty[0] + x[1] * ty[1] + x[2] * ty[2]);
    const T cosine =
        x[0] * tx[0] + x[1] * tx[1] + x[2] * tx[2] + y[0] * ty[0] + y[1] * ty[1] + y[2] * ty[2];
    const T square = sine * sine + cosine * cosine;
    const T scale = T(1.0F) / sqrt(max(square, T(1e-30F)));
    const T cn = select(square > T(1e-30F), cosine * scale, T(1.0F));
    const T sn = sine * scale;
    turn(x, y, cn, sn);
    out.last =
        wrap_near(rough_atan2(sine, cosine) - T(chain.offset_last), chain.middle[chain.n - 1]);
  } else if (chain.right == Side::translation) {
    for (int i = 0; i < 3; ++i) {
      out.slide = out.slide + (target.target[i] - sample.p[i]) * sample.z[i];
    }
    out.last = out.slide - T(chain.offset_last);
  }
}

/// What is left of the error, as the iteration measures it, at the sample's own origin, where its
/// pseudo-inverse was taken.
template <typename T>
IKSEL_INLINE void measure_rest(const SeedChain& chain, const SeedTargetOf<T>& target,
                               const LaneFrame<T>& sample, const T& slide, T (&e)[6]) {
  FullPose<T, SeedTargetOf<T>>(target, nullptr).measure(sample, e);
  if (chain.right != Side::translation) return;
  const auto& z = sample.z;
  for (int i = 0; i < 3; ++i) e[i] = e[i] - slide * z[i] - slide * cross_at(i, e + 3, z);
}

/// One step by the stored pseudo-inverse, into the limits, for the samples of the block from
/// `offset` on. Returns the seeds' score: smaller is better.
template <typename T>
IKSEL_INLINE T take_first_step(const SeedChain& chain, const float* block, const LeftOut<T>& left,
                               const T (&e)[6], int offset, SeedPack& out) {
  using L = Lanes<T>;
  const int n = chain.n;
  const int right = n - 1;
  const auto row = [&](int r) { return L::load(block + r * kBlock + offset); };
  T dq[kMaxJoints];
  T dq2 = T(0.0F);
  for (int j = 0; j < n; ++j) {
    const int at = kFullPoseRows + n + 6 * j;
    dq[j] = row(at) * e[0];
    for (int r = 1; r < 6; ++r) dq[j] = dq[j] + row(at + r) * e[r];
    dq2 = dq2 + dq[j] * dq[j];
  }
  // Far from the sample its pseudo-inverse is no guide: only so long a step in its direction [rad
  // or m].
  const T shorten = min(T(1.0F), T(1.0F) / sqrt(max(dq2, T(1e-20F))));
  T outside = T(0.0F);
  for (int j = 0; j < n; ++j) {
    T q = row(kFullPoseRows + j);
    if (j == 0 && chain.left != Side::none) q = left.first;
    if (j == right && chain.right != Side::none) q = left.last;
    q = q + dq[j] * shorten;
    if (chain.wraps[j]) q = wrap_near(q, chain.middle[j]);
    const T inside = min(max(q, T(chain.lower[j])), T(chain.upper[j]));
    outside = outside + (q - inside) * (q - inside);
    L::store(inside, out.q[j] + offset);
  }
  // Whose first step leaves the limits is rarely saved.
  return dq2 + T(1000.0F) * outside;
}

/// Vectors in a block.
template <typename T>
inline constexpr int kVectors = kBlock / Lanes<T>::kCount;

/// Puts the seeds in order. The rank of a seed is how many others are better; of equals the first.
template <typename T>
IKSEL_INLINE void rank_seeds(const T (&score)[kVectors<T>], SeedPack& out) {
  using L = Lanes<T>;
  float entries[kBlock];
  for (int entry = 0; entry < kBlock; ++entry) entries[entry] = static_cast<float>(entry);
  T rank[kVectors<T>];
  for (int v = 0; v < kVectors<T>; ++v) rank[v] = T(0.0F);
  for (int other = 0; other < kBlock; ++other) {
    const T theirs(out.score[other]);
    for (int v = 0; v < kVectors<T>; ++v) {
      const auto better =
          (theirs < score[v]) | ((theirs == score[v]) &
                                 (T(static_cast<float>(other)) < L::load(entries + v * L::kCount)));
      rank[v] = rank[v] + select(better, T(1.0F), T(0.0F));
    }
  }
  float ranks[kBlock];
  for (int v = 0; v < kVectors<T>; ++v) L::store(rank[v], ranks + v * L::kCount);
  for (int entry = 0; entry < kBlock; ++entry) {
    out.order[static_cast<int>(ranks[entry])] = static_cast<unsigned char>(entry);
  }
}

template <typename T>
void prepare_seeds(const SeedChain& chain, const SeedTarget& target, const float* block,
                   SeedPack& out) {
  using L = Lanes<T>;
  T score[kVectors<T>];
  for (int v = 0; v < kVectors<T>; ++v) {
    const int offset = v * L::kCount;
    const auto row = [&](int r) { return L::load(block + r * kBlock + offset); };
    LaneFrame<T> sample = {{row(3), row(4), row(5)},
                           {row(6), row(7), row(8)},
                           {row(9), row(10), row(11)},
                           {row(0), row(1), row(2)}};
    LeftOut<T> left_out;
    SeedTargetOf<T> turned;
    set_first(chain, target, sample, left_out);
    turn_back(target, left_out, turned);
    set_last(chain, turned, sample, left_out);
    L::store(left_out.first, out.first + offset);
    L::store(left_out.last, out.last + offset);

    T e[6];
    measure_rest(chain, turned, sample, left_out.slide, e);
    score[v] = take_first_step(chain, block, left_out, e, offset, out);
    L::store(score[v], out.score + offset);
  }
  rank_seeds(score, out);
}

template <typename T>
void add_known(int n, const float* per_turn, const float* from, const float* q, int blocks,
               std::ptrdiff_t stride, float* nearest) {
  using L = Lanes<T>;
  for (int block = 0; block < blocks; ++block, q += stride, nearest += kBlock) {
    T away[kVectors<T>];
    for (T& each : away) each = T(0.0F);
    for (int j = 0; j < n; ++j) {
      for (int v = 0; v < kVectors<T>; ++v) {
        T d = L::load(q + j * kBlock + v * L::kCount) - T(from[j]);
        if (per_turn[j] > 0) d = d - nearest_integer(d * T(per_turn[j])) * T(6.2831853F);
        away[v] = max(away[v], abs(d));
      }
    }
    for (int v = 0; v < kVectors<T>; ++v) {
      float* at = nearest + v * L::kCount;
      L::store(min(away[v], L::load(at)), at);
    }
  }
}

template <typename T>
int find_largest(int count, const float* numbers) {
  using L = Lanes<T>;
  T columns = L::load(numbers);
  for (int i = L::kCount; i < count; i += L::kCount) columns = max(columns, L::load(numbers + i));
  float rows[L::kCount];
  L::store(columns, rows);
  float largest = rows[0];
  for (int i = 1; i < L::kCount; ++i) largest = max(largest, rows[i]);
  int at = 0;
  while (at + L::kCount < count && !any(L::load(numbers + at) == T(largest))) at += L::kCount;
  while (at + 1 < count && numbers[at] != largest) ++at;
  return at;
}

}  // namespace iksel::lanes
