// SPDX-License-Identifier: BSD-3-Clause
#include "structure/closed_form.hpp"
namespace iksel {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A vector by the angle that is swept: columns of what is constant, goes by its cosine, and by its
/// sine.
using Swept = Matrix3d;

Swept constant(const Vector3d& v) {
  Swept swept = Swept::Zero();
  swept.col(0) = v;
  return swept;
}

/// R(h, t) v
Swept turned(const Vector3d& h, const Vector3d& v) {
  Swept swept;
  swept.col(0) = h.dot(v) * h;
  swept.col(1) = v - swept.col(0);
  swept.col(2) = h.cross(v);
  return swept;
}

using Row = Eigen::Matrix<double, 1, 3>;

lanes::Linear linear(const Row& row) { return {row[0], row[1], row[2]}; }

/// R_1^T v by the angle of joint 1: what is constant, goes by its cosine, and by its sine.
struct BehindBase {
  Swept one, c, s;
  BehindBase(const Vector3d& h1, const Swept& v)
      : one(h1 * (h1.transpose() * v)), c(v - one), s(v.colwise().cross(h1)) {}
  void write(int row, lanes::Linear (&out)[3]) const {
    out[0] = linear(one.row(row));
    out[1] = linear(c.row(row));
    out[2] = linear(s.row(row));
  }
};

}  // namespace

lanes::ResidualForm make_residual(const ClosedFormChain& chain, const lanes::BranchPack& pack) {
  const lanes::ClosedForm& form = chain.form;
  const auto h = [&](int joint) { return Vector3d(form.h[joint - 1]); };
  const auto p = [&](int joint) { return Vector3d(form.p[joint - 1]); };
  const auto rows = [&](int first) {
    return Vector3d(pack.target[first][0], pack.target[first + 1][0], pack.target[first + 2][0]);
  };
  Matrix3d columns;  // R_06 E
  for (int k = 0; k < 3; ++k) columns.col(k) = rows(3 * k);
  const Vector3d w = rows(9);
  Swept P, d, a, k;
  double along = form.along56;
  if (form.closure == lanes::Closure::sweep_4) {
    P = constant(w);
    d = constant(columns.col(2));
    a = constant(p(3)) + turned(h(4), p(4));
    k = turned(h(4), h(5));
  } else {
    Matrix3d E;
    for (int i = 0; i < 3; ++i) E.col(i) = Vector3d(form.basis[i]);
    const Matrix3d R_06 = columns * E.transpose();
    P = constant(w) - R_06 * turned(-h(6), p(5));
    d = R_06 * turned(-h(6), h(5));
    a = constant(p(3));
    k = constant(h(4));
    along = form.along45;
  }
  // From here on as seen along axis 2.
  Matrix3d F;
  F.row(0) = Vector3d(form.across);
  F.row(2) = h(2);
  F.row(1) = F.row(2).cross(F.row(0));
  const Vector3d h1 = F * h(1);
  const Vector3d p12 = F * p(1);
  const Vector3d p23 = F * p(2);
  const BehindBase w1(h1, F * P);
  const BehindBase d1(h1, F * d);
  a = F * a;
  k = F * k;
  lanes::ResidualForm out;
  out.A = linear(w1.c.row(2));
  out.B = linear(w1.s.row(2));
  Row C = a.row(2) - w1.one.row(2);
  C[0] += p12[2] + p23[2];
  out.C = linear(C);
  for (int row = 0; row < 2; ++row) {
    w1.write(row, out.w[row]);
    out.w[row][0].one -= p12[row];
    out.a[row] = linear(a.row(row));
  }
  for (int row = 0; row < 3; ++row) {
    d1.write(row, out.d[row]);
    out.k[row] = linear(k.row(row));
  }
  out.along = along;
  out.p23_2 = p23.head<2>().squaredNorm();
  return out;
}

}  // namespace iksel
