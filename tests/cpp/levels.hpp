// SPDX-License-Identifier: BSD-3-Clause
// The instruction sets that there are lane kernels for.
#pragma once

#include <cstdlib>
#include <iksel/iksel.hpp>
#include <optional>
#include <string>
#include <vector>

namespace iksel_test {

/// Forces a level for as long as it lives.
class ForcedLevel {
 public:
  explicit ForcedLevel(const std::string& level) {
    if (const char* value = std::getenv("IKSEL_SIMD")) before_ = value;
    ::setenv("IKSEL_SIMD", level.c_str(), 1);
  }
  ForcedLevel(const ForcedLevel&) = delete;
  ForcedLevel& operator=(const ForcedLevel&) = delete;
  ~ForcedLevel() {
    if (before_) {
      ::setenv("IKSEL_SIMD", before_->c_str(), 1);
    } else {
      ::unsetenv("IKSEL_SIMD");
    }
  }

 private:
  std::optional<std::string> before_;
};

/// Levels that this machine has.
inline std::vector<std::string> levels() {
  std::vector<std::string> found;
  for (const char* level : {"avx512", "avx2", "sse2", "neon", "scalar"}) {
    const ForcedLevel forced(level);
    try {
      iksel::simd_level();
      found.emplace_back(level);
    } catch (const iksel::InvalidArgumentError&) {
      continue;
    }
  }
  return found;
}

}  // namespace iksel_test
