// SPDX-License-Identifier: BSD-3-Clause
// Seven joints along their self-motions: a step along the tangent, and back to the pose by the
// pseudo-inverse; one Jacobian serves for both and for the next tangent.
//
// The tangent is the null vector n_m = (-1)^m det(J without column m), which gives each curve one
// direction. It turns round where the curve goes through a singularity, and between the two curves
// that part before one: a step that finds it turned round has gone over to the other, and is taken
// back.
#pragma once

#include "base/symmetric.hpp"
#include "simd/lane_frames.hpp"
#include "simd/lane_goal.hpp"
#include "simd/lane_math.hpp"

namespace iksel::lanes {

/// Of six columns of six rows each, by the minors of the upper three rows and of the lower three
/// (Laplace).
template <typename T>
IKSEL_INLINE T determinant(const T (&columns)[6][6]) {
  const auto minor = [&](int a, int b, int c, int row) {
    const T(&x)[6] = columns[a];
    const T(&y)[6] = columns[b];
    const T(&z)[6] = columns[c];
    return x[row] * (y[row + 1] * z[row + 2] - y[row + 2] * z[row + 1]) -
           y[row] * (x[row + 1] * z[row + 2] - x[row + 2] * z[row + 1]) +
           z[row] * (x[row + 1] * y[row + 2] - x[row + 2] * y[row + 1]);
  };
  // Ten of the ways to choose three columns; the others are the rest of each.
  static constexpr int kThree[10][6] = {{0, 1, 2, 3, 4, 5}, {0, 1, 3, 2, 4, 5}, {0, 1, 4, 2, 3, 5},
                                        {0, 1, 5, 2, 3, 4}, {0, 2, 3, 1, 4, 5}, {0, 2, 4, 1, 3, 5},
                                        {0, 2, 5, 1, 3, 4}, {0, 3, 4, 1, 2, 5}, {0, 3, 5, 1, 2, 4},
                                        {0, 4, 5, 1, 2, 3}};
  static constexpr double kSign[10] = {1, -1, 1, -1, 1, -1, 1, 1, -1, 1};
  T sum = T(0.0);
  for (int i = 0; i < 10; ++i) {
    const int(&k)[6] = kThree[i];
    const T upper = minor(k[0], k[1], k[2], 0) * minor(k[3], k[4], k[5], 3);
    const T lower = minor(k[3], k[4], k[5], 0) * minor(k[0], k[1], k[2], 3);
    sum = sum + T(kSign[i]) * (upper - lower);
  }
  return sum;
}

template <typename T>
struct CurvePlace {
  T J[kMaxJoints][6];
  T error[6];
};

template <typename T>
IKSEL_INLINE void place(const LaneChain& chain, FullPose<T, CurvePack>& goal, const T* q,
                        CurvePlace<T>& at) {
  LaneFrame<T> frame;
  place_joints(chain, q, at.J, frame, kCurveJoints);
  goal.measure(frame, at.error);
  for (int j = 0; j < kCurveJoints; ++j) make_twist(chain.joint[j], frame.p, at.J[j]);
}

/// J J^T, damped above rounding and factorised; `A` is its memory.
template <typename T>
IKSEL_INLINE SymmetricFactors<T> factorize(const CurvePlace<T>& at, T (&A)[6][6]) {
  multiply_by_transposed(kCurveJoints, at.J, A);
  return SymmetricFactors<T>(A, T(1e-14));
}

/// q + J^+ error.
template <typename T>
IKSEL_INLINE T correct(const CurvePlace<T>& at, const SymmetricFactors<T>& factors, T* q) {
  T y[6];
  factors.solve(at.error, y);
  T length2 = T(0.0);
  for (int j = 0; j < kCurveJoints; ++j) {
    T dq = at.J[j][0] * y[0];
    for (int i = 1; i < 6; ++i) dq = dq + at.J[j][i] * y[i];
    length2 = length2 + dq * dq;
    q[j] = q[j] + dq;
  }
  return length2;
}

/// Brings all lanes nearer to the pose, and finds the tangents there, oriented and scaled to 1.
template <typename T>
void orient_curves(const LaneChain& chain, CurvePack& pack) {
  FullPose<T, CurvePack> goal(pack, nullptr);
  for (int first = 0; first < kWidth; first += Lanes<T>::kCount) {
    T q[kCurveJoints];
    for (int j = 0; j < kCurveJoints; ++j) q[j] = Lanes<T>::load(pack.q[j] + first);
    CurvePlace<T> at;
    place(chain, goal, q, at);
    T A[6][6];
    correct(at, factorize(at, A), q);
    T n[kCurveJoints];
    T n2 = T(0.0);
    for (int m = 0; m < kCurveJoints; ++m) {
      T others[6][6];
      for (int k = 0; k < 6; ++k) {
        for (int i = 0; i < 6; ++i) others[k][i] = at.J[k < m ? k : k + 1][i];
      }
      n[m] = determinant(others);
      if (m % 2 == 1) n[m] = T(0.0) - n[m];
      n2 = n2 + n[m] * n[m];
    }
    const T scale = T(1.0) / sqrt(max(n2, T(1e-300)));
    for (int j = 0; j < kCurveJoints; ++j) {
      Lanes<T>::store(q[j], pack.q[j] + first);
      Lanes<T>::store(n[j] * scale, pack.tangent[j] + first);
    }
  }
}

/// The sign by which n is turned round against the orientation, times a number above 0.
template <typename T>
IKSEL_INLINE T orientation(const CurvePlace<T>& at, const T (&n)[kCurveJoints]) {
  // By the component that is largest.
  T largest = n[0];
  T others[6][6];
  for (int k = 0; k < 6; ++k) {
    for (int i = 0; i < 6; ++i) others[k][i] = at.J[k + 1][i];
  }
  for (int m = 1; m < kCurveJoints; ++m) {
    const T signed_n = m % 2 == 1 ? T(0.0) - n[m] : n[m];
    const auto is_larger = abs(n[m]) > abs(largest);
    if (!any(is_larger)) continue;
    largest = select(is_larger, signed_n, largest);
    for (int k = 0; k < 6; ++k) {
      const int from = k < m ? k : k + 1;
      for (int i = 0; i < 6; ++i) {
        others[k][i] = select(is_larger, at.J[from][i], others[k][i]);
      }
    }
  }
  return determinant(others) * largest;
}

/// A step of each lane, unless the curve turns too far on the way or another is met: then the next
/// is shorter. After the step the way back to the curve is gone twice, of which the second has to
/// be far shorter than the first. The numbers below are measured on random arms by
/// tests/python/test_laws.py, test_no_answer_lies_off_the_arcs.
template <typename T>
unsigned follow_curves(const LaneChain& chain, CurvePack& pack) {
  // Of the angle between the tangents: what is refused, and what is so little that steps grow.
  constexpr double kLeastCosine = 0.955;
  constexpr double kStraight = 0.99;
  // Squared: of the first way back, in parts of the step; of the second, in parts of the first.
  constexpr double kMostCorrection2 = 0.09;
  constexpr double kContraction2 = 0.04;
  constexpr double kRounding2 = 1e-16;
  constexpr double kShorter = 0.4;
  constexpr double kLonger = 1.7;
  unsigned went = 0;
  FullPose<T, CurvePack> goal(pack, nullptr);
  for (int first = 0; first < kWidth; first += Lanes<T>::kCount) {
    const T step = Lanes<T>::load(pack.step + first);
    T from[kCurveJoints];
    T t[kCurveJoints];
    T q[kCurveJoints];
    for (int j = 0; j < kCurveJoints; ++j) {
      from[j] = Lanes<T>::load(pack.q[j] + first);
      t[j] = Lanes<T>::load(pack.tangent[j] + first);
      q[j] = from[j] + step * t[j];
    }
    CurvePlace<T> at;
    T A[6][6];
    place(chain, goal, q, at);
    const T way2 = correct(at, factorize(at, A), q);
    place(chain, goal, q, at);
    const SymmetricFactors<T> factors = factorize(at, A);
    const T rest2 = correct(at, factors, q);
    // n = t - J^+ J t
    T along[6];
    for (int i = 0; i < 6; ++i) {
      along[i] = at.J[0][i] * t[0];
      for (int j = 1; j < kCurveJoints; ++j) along[i] = along[i] + at.J[j][i] * t[j];
    }
    T y[6];
    factors.solve(along, y);
    T n[kCurveJoints];
    T n2 = T(0.0);
    for (int j = 0; j < kCurveJoints; ++j) {
      n[j] = t[j];
      for (int i = 0; i < 6; ++i) n[j] = n[j] - at.J[j][i] * y[i];
      n2 = n2 + n[j] * n[j];
    }
    const T side = Lanes<T>::load(pack.side + first);
    // Written so that NaN is refused.
    const auto goes = (n2 >= T(kLeastCosine * kLeastCosine)) &
                      (way2 <= T(kMostCorrection2) * step * step + T(kRounding2)) &
                      (rest2 <= T(kContraction2) * way2 + T(kRounding2)) &
                      (orientation(at, n) * side > T(0.0));
    const T scale = T(1.0) / sqrt(max(n2, T(1e-300)));
    for (int j = 0; j < kCurveJoints; ++j) {
      Lanes<T>::store(select(goes, q[j], from[j]), pack.q[j] + first);
      Lanes<T>::store(select(goes, n[j] * scale, t[j]), pack.tangent[j] + first);
    }
    const T longer = select(n2 >= T(kStraight * kStraight), step * T(kLonger), step);
    const T next = select(goes, min(longer, T(pack.longest)), step * T(kShorter));
    Lanes<T>::store(next, pack.step + first);
    went |= to_bits<T>(goes) << static_cast<unsigned>(first);
  }
  return went;
}

}  // namespace iksel::lanes
