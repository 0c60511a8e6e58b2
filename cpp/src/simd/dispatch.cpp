// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>
#include <string>
#include <vector>

#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "iksel/simd.hpp"
#include "simd/kernels.hpp"

namespace iksel {
namespace lanes {
namespace {

/// Widest first.
std::vector<const LaneKernels*> available() {
  std::vector<const LaneKernels*> kernels;
#if defined(__x86_64__)
  __builtin_cpu_init();
#endif
#if defined(IKSEL_SIMD_AVX512)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq")) {
    kernels.push_back(&kKernelsAvx512);
  }
#endif
#if defined(IKSEL_SIMD_AVX2)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    kernels.push_back(&kKernelsAvx2);
  }
#endif
#if defined(IKSEL_SIMD_SSE2)
  kernels.push_back(&kKernelsSse2);
#endif
#if defined(IKSEL_SIMD_NEON)
  kernels.push_back(&kKernelsNeon);
#endif
  kernels.push_back(&kKernelsScalar);
  return kernels;
}

}  // namespace

const LaneKernels& choose_kernels() {
  const auto kernels = available();
  const char* asked = std::getenv("IKSEL_SIMD");
  if (asked == nullptr || *asked == '\0') return *kernels.front();
  std::vector<std::string> names;
  for (const LaneKernels* k : kernels) {
    if (std::string(asked) == k->name) return *k;
    names.emplace_back(k->name);
  }
  throw InvalidArgumentError("IKSEL_SIMD: '" + std::string(asked) +
                             "' is not to be had here; there are: " + list_names(names));
}

}  // namespace lanes

const char* simd_level() { return lanes::choose_kernels().name; }

}  // namespace iksel
