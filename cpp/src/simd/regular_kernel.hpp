// SPDX-License-Identifier: BSD-3-Clause
// How well branches in closed form are determined, by their angles alone: a branch in each lane.
#pragma once

#include "simd/branch_arm.hpp"

namespace iksel::lanes {

/// The Frobenius norm of the inverse of matrices of `columns`, which become orthonormal: of the
/// triangle that is left by Gram-Schmidt, the columns of its inverse, from the last row up. Not
/// finite where there is none.
template <typename T>
IKSEL_INLINE T inverse_norm(T (&columns)[6][6]) {
  T R[6][6];
  T inverse[6];  // of the diagonal
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) {
    T square(0.0);
    for (const T& x : columns[j]) square = square + x * x;
    inverse[j] = T(1.0) / sqrt(square);
    for (T& x : columns[j]) x = x * inverse[j];
#pragma GCC unroll 6
    for (int k = j + 1; k < 6; ++k) {
      T along(0.0);
      for (int i = 0; i < 6; ++i) along = along + columns[j][i] * columns[k][i];
      for (int i = 0; i < 6; ++i) columns[k][i] = columns[k][i] - along * columns[j][i];
      R[j][k] = along;
    }
  }
  T sum(0.0);
#pragma GCC unroll 6
  for (int k = 0; k < 6; ++k) {
    T x[6];
    x[k] = inverse[k];
    sum = sum + x[k] * x[k];
#pragma GCC unroll 6
    for (int j = k - 1; j >= 0; --j) {
      T rest(0.0);
      for (int i = j + 1; i <= k; ++i) rest = rest - R[j][i] * x[i];
      x[j] = rest * inverse[j];
      sum = sum + x[j] * x[j];
    }
  }
  return sqrt(sum);
}

/// The axes of a branch and the points on them, and what it makes of the basis.
template <typename T>
struct PlacedAxes {
  Vec<T> axis[6], point[6];
  Vec<T> basis[3];
};

template <typename T>
IKSEL_INLINE PlacedAxes<T> place_axes(const ClosedForm& form, const BranchPack& pack, int first) {
  PlacedAxes<T> out;
  // R_1 ... R_j, by its columns.
  Vec<T> R[3] = {{T(1.0), T(0.0), T(0.0)}, {T(0.0), T(1.0), T(0.0)}, {T(0.0), T(0.0), T(1.0)}};
  const auto moved = [&](const double(&v)[3]) {
    return add(add(scaled(T(v[0]), R[0]), T(v[1]), R[1]), T(v[2]), R[2]);
  };
  out.point[0] = {T(0.0), T(0.0), T(0.0)};
  for (int j = 0; j < 6; ++j) {
    out.axis[j] = moved(form.h[j]);
    if (j > 0) out.point[j] = add(out.point[j - 1], T(1.0), moved(form.p[j - 1]));
    Angle<T> t;
    sincos(Lanes<T>::load(pack.q[j] + first) + T(form.offset[j]), t.s, t.c);
    for (Vec<T>& column : R) column = turned(out.axis[j], t, column);
  }
  for (int k = 0; k < 3; ++k) out.basis[k] = moved(form.basis[k]);
  return out;
}

template <typename T>
void measure_regularity(const ClosedForm& form, const BranchPack& pack, Regularity& out) {
  for (int first = 0; first < kWidth; first += Lanes<T>::kCount) {
    const PlacedAxes<T> arm = place_axes<T>(form, pack, first);
    const BranchTarget<T> target = load_target<T>(pack, first);
    const auto off2 = [](const Vec<T>& v, const Vec<T>& from) {
      const Vec<T> d = add(v, T(-1.0), from);
      return dot(d, d);
    };
    T most = off2(arm.point[5], target.w);
    most = max(most, off2(arm.basis[0], target.X));
    most = max(most, off2(arm.basis[1], target.Y));
    most = max(most, off2(arm.basis[2], target.Z));
    T columns[6][6];
    for (int j = 0; j < 6; ++j) {
      const Vec<T>& axis = arm.axis[j];
      const Vec<T> moved = cross(axis, add(arm.point[5], T(-1.0), arm.point[j]));
      columns[j][0] = moved.x;
      columns[j][1] = moved.y;
      columns[j][2] = moved.z;
      columns[j][3] = axis.x;
      columns[j][4] = axis.y;
      columns[j][5] = axis.z;
    }
    Lanes<T>::store(sqrt(most), out.off + first);
    Lanes<T>::store(inverse_norm(columns), out.inverse_norm + first);
  }
}

}  // namespace iksel::lanes
