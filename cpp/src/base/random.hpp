// SPDX-License-Identifier: BSD-3-Clause
// Random numbers with the same bits on every platform and standard library.
#pragma once

#include <cstdint>

namespace iksel {

/// SplitMix64 (Steele, Lea, Flood: "Fast splittable pseudorandom number generators", 2014): one
/// 64-bit state, so that a stream can start anywhere at no cost.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// Independent stream number `stream` of a seed, e.g. one per sample, so that threads do not
  /// matter.
  static Random stream(std::uint64_t seed, std::uint64_t stream) {
    Random mixer(seed ^ (stream * 0xD1B54A32D192ED03ULL));
    return Random(mixer.next());
  }

  std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31U);
  }

  /// Uniform in [0, 1), 53 bits.
  double uniform() { return static_cast<double>(next() >> 11U) * 0x1.0p-53; }
  double uniform(double lower, double upper) { return lower + (upper - lower) * uniform(); }

 private:
  std::uint64_t state_;
};

}  // namespace iksel
