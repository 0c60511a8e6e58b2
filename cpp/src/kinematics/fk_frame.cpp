// SPDX-License-Identifier: BSD-3-Clause
#include "kinematics/chain_model.hpp"

namespace iksel {
namespace {

#if defined(__x86_64__)
/// Chains of products and sums are what forward kinematics waits for, and a fused one takes half
/// the time. All is inlined here, for what is called from here would be compiled without.
__attribute__((target("avx2,fma"), flatten)) Frame forward_fused(const KernelChain& chain,
                                                                 const double* q) {
  return forward(chain, q);
}

bool can_fuse() {
  static const bool kCan = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return kCan;
}
#endif

}  // namespace

Frame ChainModel::fk_frame(const double* q) const {
#if defined(__x86_64__)
  if (can_fuse()) return forward_fused(kernel, q);
#endif
  return forward(kernel, q);
}

}  // namespace iksel
