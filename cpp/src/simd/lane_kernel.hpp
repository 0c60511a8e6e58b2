// SPDX-License-Identifier: BSD-3-Clause
// Levenberg-Marquardt over a pack of lanes, each with its own target, with the limits inside the
// step.
#pragma once

#include "simd/branch_kernel.hpp"
#include "simd/closest_kernel.hpp"
#include "simd/curve_kernel.hpp"
#include "simd/enclosure_kernel.hpp"
#include "simd/lane_frames.hpp"
#include "simd/lane_goal.hpp"
#include "simd/lane_math.hpp"
#include "simd/lane_types.hpp"
#include "simd/limit_kernel.hpp"
#include "simd/loop_kernel.hpp"
#include "simd/move_kernel.hpp"
#include "simd/nearest_kernel.hpp"
#include "simd/regular_kernel.hpp"
#include "simd/residual_kernel.hpp"
#include "simd/scene_kernel.hpp"
#include "simd/seed_kernel.hpp"
#include "simd/sweep_kernel.hpp"

namespace iksel::lanes {

/// From origins and axes of a simple chain's joints, or twists of variables, to the columns of the
/// goal's Jacobian, without what would leave limits that a lane stands at.
template <bool kIsSimple, typename T, typename Goal>
IKSEL_INLINE void make_columns(const LaneChainOf<NumberOf<T>>& chain, const T* q, const Goal& goal,
                               const LaneFrame<T>& f, const T (&e)[6], T (*J)[6]) {
  const int n = chain.n;
  const T* point = goal.point(f);
#pragma GCC unroll 10
  for (int j = 0; j < n; ++j) {
    const auto& variable = chain.variable[j];
    T(&column)[6] = J[j];
    if (kIsSimple) make_twist(chain.joint[j], point, column);
    goal.to_rows(column);
    if (variable.limited) {
      const auto low = q[j] <= T(variable.lower);
      const auto high = q[j] >= T(variable.upper);
      if (any(low | high)) {
        T gradient = column[0] * e[0];
        for (int i = 1; i < 6; ++i) gradient = gradient + column[i] * e[i];
        const auto leaves = (low & (gradient < T(0.0))) | (high & (gradient > T(0.0)));
        for (int i = 0; i < 6; ++i) column[i] = select(leaves, T(0.0), column[i]);
      }
    }
  }
  if (chain.sums > 0) {
    const T error[6] = {e[0], e[1], e[2], e[3], e[4], e[5]};  // so that e stays in registers
    hold_columns(chain, q, error, J);
  }
}

/// Adds J^T y to q, held to the limits; returns the squared length of the step.
template <typename T>
IKSEL_INLINE T move_joints(const LaneChainOf<NumberOf<T>>& chain, const T (*J)[6], const T (&y)[6],
                           T* q) {
  const int n = chain.n;
  T dq2 = T(0.0);
#pragma GCC unroll 10
  for (int j = 0; j < n; ++j) {
    T dq = J[j][0] * y[0];
#pragma GCC unroll 6
    for (int i = 1; i < 6; ++i) dq = dq + J[j][i] * y[i];
    dq2 = dq2 + dq * dq;
    q[j] = q[j] + dq;
    const auto& variable = chain.variable[j];
    if (variable.limited) q[j] = min(max(q[j], T(variable.lower)), T(variable.upper));
  }
  if (chain.sums > 0) hold_sums(chain, q);
  return dq2;
}

/// Iterates the lanes of a pack from `first` on.
template <bool kIsSimple, typename T, typename Goal, typename Pack>
IKSEL_INLINE PackResult iterate(const LaneChainOf<NumberOf<T>>& chain, const LaneOptions& options,
                                Goal& goal, unsigned watched, int iterations, int first,
                                Pack& pack) {
  const int n = chain.n;
  T q[kMaxJoints];
  for (int j = 0; j < n; ++j) q[j] = Lanes<T>::load(pack.q[j] + first);

  for (int iteration = 1;; ++iteration) {
    T J[kMaxMovingJoints][6];
    T slope[kMaxMovingJoints];
    LaneFrame<T> frame;
    if (kIsSimple) {
      place_joints(chain, q, J, frame, n);
    } else {
      place_following_joints(chain, q, J, slope, frame);
    }
    T e[6];
    goal.measure(frame, e);
    if (!kIsSimple) gather_twists(chain, slope, goal.point(frame), J);
    const T ep2 = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
    const T er2 = e[3] * e[3] + e[4] * e[4] + e[5] * e[5];
    const T e2 = ep2 + er2;
    make_columns<kIsSimple>(chain, q, goal, frame, e, J);
    // dq = J^T (J J^T + lambda I)^-1 e.
    T A[6][6];
    multiply_by_transposed(n, J, A);
    const T lambda = T(options.damping) * e2 + T(options.least_damping);
    T step[6];
    goal.solve(A, lambda, e, step);
    // A lane that is there already stays: along a singular direction the step may be long.
    const auto there =
        (ep2 + er2 * T(options.lever2) <= T(options.position2)) & (er2 <= T(options.rotation2));
    for (T& part : step) part = select(there, T(0.0), part);
    const T dq2 = move_joints(chain, J, step, q);

    // Steps shrink quadratically: after a short one the error needs no look.
    const unsigned done =
        watched & to_bits<T>((dq2 <= T(options.last_step2)) & (e2 <= T(options.last_error2)));
    if (done != 0 || iteration >= iterations) {
      for (int j = 0; j < n; ++j) Lanes<T>::store(q[j], pack.q[j] + first);
      Lanes<T>::store(e2, pack.error2 + first);
      return {done, iteration};
    }
  }
}

/// One for any number of joints: made for a known number it was no faster on AVX-512, AVX2 or SSE2.
/// Nothing to be inlined: GCC 12 then keeps a tenth less of it in registers.
template <bool kIsSimple, typename T, typename Goal>
[[gnu::noinline]] PackResult advance_of(const LaneChain& chain, const LaneOptions& options,
                                        const LaneTask* task, unsigned watched, int iterations,
                                        LanePack& pack) {
  Goal goal(pack, task);
  return iterate<kIsSimple, T>(chain, options, goal, watched, iterations, 0, pack);
}

template <typename T, typename Goal>
PackResult advance(const LaneChain& chain, const LaneOptions& options, const LaneTask* task,
                   unsigned watched, int iterations, LanePack& pack) {
  const auto of = chain.is_simple ? advance_of<true, T, Goal> : advance_of<false, T, Goal>;
  return of(chain, options, task, watched, iterations, pack);
}

template <bool kIsSimple, typename T>
[[gnu::noinline]] void advance_roughly_of(const LaneChainOf<float>& chain,
                                          const LaneOptions& options, int iterations,
                                          RoughPack& pack) {
  FullPose<T, RoughPack> goal(pack, nullptr);
  for (int first = 0; first < kBlock; first += Lanes<T>::kCount) {
    iterate<kIsSimple, T>(chain, options, goal, 0, iterations, first, pack);
  }
}

template <typename T>
void advance_roughly(const LaneChainOf<float>& chain, const LaneOptions& options, int iterations,
                     RoughPack& pack) {
  const auto of = chain.is_simple ? advance_roughly_of<true, T> : advance_roughly_of<false, T>;
  of(chain, options, iterations, pack);
}

template <typename T>
constexpr PackKernels make_pack_kernels() {
  return {Lanes<T>::kCount, advance<T, FullPose<T>>, advance<T, TaskGoal<T>>};
}

/// Of packs of doubles, narrow and wide, and of single precision.
template <typename Narrow, typename Wide, typename Single>
constexpr LaneKernels make_kernels(const char* name) {
  return {name,
          make_pack_kernels<Narrow>(),
          make_pack_kernels<Wide>(),
          advance_roughly<Single>,
          approach<Single>,
          prepare_seeds<Single>,
          add_known<Single>,
          find_largest<Single>,
          solve_closed<Wide, /*kOfOneTarget=*/false>,
          solve_closed<Wide, /*kOfOneTarget=*/true>,
          find_branches<Wide>,
          measure_regularity<Wide>,
          rate_branches<Wide>,
          rate_branch<Wide>,
          enclose_branches<Wide>,
          measure_moves<Wide>,
          measure_branches<Wide>,
          find_residuals<Wide>,
          count_roots<Wide>,
          find_clearance<Narrow>,
          find_determinants<Wide>,
          evaluate_polynomial<Wide>,
          close_loops<Wide>,
          multiply<Wide>,
          orient_curves<Wide>,
          follow_curves<Wide>};
}

}  // namespace iksel::lanes
