// SPDX-License-Identifier: BSD-3-Clause
#include "base/pseudo_inverse.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/symmetric.hpp"

namespace iksel {
namespace {

/// For square matrices alone: the others would have it instantiate two QR decompositions, which
/// takes a compiler longer than all the rest of this file.
using SquareSvd = Eigen::JacobiSVD<Matrix6, Eigen::NoQRPreconditioner>;

/// J^T = Q R with orthonormal columns (or zero ones) in Q, for more than 6 joints. Gram-Schmidt,
/// each column twice: orthogonal to double precision (Giraud et al. 2005).
Matrix6 decompose_transposed(const JacobianMatrix& J, PseudoInverse& Q) {
  Matrix6 R = Matrix6::Zero();
  Q = J.transpose();
  for (int column = 0; column < 6; ++column) {
    auto v = Q.col(column);
    const double length = v.norm();
    for (int pass = 0; pass < 2; ++pass) {
      for (int i = 0; i < column; ++i) {
        const double part = Q.col(i).dot(v);
        R(i, column) += part;
        v -= part * Q.col(i);
      }
    }
    // What is left of a dependent column is rounding.
    const double rest = v.norm();
    const bool independent = rest > 1e-15 * length;
    R(column, column) = independent ? rest : 0.0;
    v *= independent ? 1 / rest : 0.0;
  }
  return R;
}

/// A 6 x 6 matrix with the singular values of J: J itself, with columns of zeros if there are fewer
/// than 6 joints; with more, R^T of J^T = Q R.
Matrix6 square(const JacobianMatrix& J, PseudoInverse* Q = nullptr) {
  if (J.cols() > 6) {
    PseudoInverse own;
    return decompose_transposed(J, Q != nullptr ? *Q : own).transpose();
  }
  Matrix6 padded = Matrix6::Zero();
  padded.leftCols(J.cols()) = J;
  return padded;
}

}  // namespace

TruncatedSvd::TruncatedSvd(const JacobianMatrix& J, double cutoff) {
  const Eigen::Index dof = J.cols();
  const Eigen::Index count = std::min<Eigen::Index>(dof, 6);
  PseudoInverse Q;
  const SquareSvd svd(square(J, &Q), Eigen::ComputeFullU | Eigen::ComputeFullV);
  const auto& sigma = svd.singularValues();
  U_ = svd.matrixU().leftCols(count);
  if (dof > 6) {
    V_.noalias() = Q * svd.matrixV();
  } else {
    V_ = svd.matrixV().topLeftCorner(dof, count);
  }
  inverse_sigma_.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    inverse_sigma_[i] = sigma[i] > cutoff * sigma[0] && sigma[i] > 0 ? 1.0 / sigma[i] : 0.0;
  }
}

JointVector TruncatedSvd::solve(const Vector6& e) const {
  const Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1> scaled =
      inverse_sigma_.cwiseProduct(U_.transpose() * e);
  return V_ * scaled;
}

PseudoInverse TruncatedSvd::inverse() const {
  return V_ * inverse_sigma_.asDiagonal() * U_.transpose();
}

Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1> singular_values(
    const JacobianMatrix& J) {
  return SquareSvd(square(J)).singularValues().head(std::min<Eigen::Index>(J.cols(), 6));
}

int rank_of(const JacobianMatrix& J) {
  const auto sigma = singular_values(J);
  return static_cast<int>((sigma.array() > 1e-4 * sigma[0]).count());
}

Vector6 solve_symmetric(const Matrix6& A, const Vector6& b) { return A.ldlt().solve(b); }

PseudoInverse damped_inverse(const JacobianMatrix& J, double lambda) {
  Matrix6 A = J * J.transpose();
  A.diagonal().array() += lambda;
  return A.ldlt().solve(J).transpose();
}

JointVector damped_solve(const JacobianMatrix& J, double lambda, const Vector6& e) {
  Matrix6 A = J * J.transpose();
  A.diagonal().array() += lambda;
  return J.transpose() * solve_symmetric(A, e);
}

Matrix6 inverse_of(const Matrix6& A) {
  // Gauss and Jordan, in place: where a column of A has gone, one of the inverse is.
  double row[6][6];
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> rows(*row);
  rows = A;
  int swapped[6];
  for (int k = 0; k < 6; ++k) {
    int largest = k;
    for (int r = k + 1; r < 6; ++r) {
      if (std::abs(row[r][k]) > std::abs(row[largest][k])) largest = r;
    }
    swapped[k] = largest;
    if (largest != k) std::swap(row[k], row[largest]);
    const double inverse = 1 / row[k][k];
    row[k][k] = 1;
    for (double& value : row[k]) value *= inverse;
    for (int r = 0; r < 6; ++r) {
      if (r == k) continue;
      const double factor = row[r][k];
      row[r][k] = 0;
      for (int i = 0; i < 6; ++i) row[r][i] -= factor * row[k][i];
    }
  }
  Matrix6 inverse = rows;
  for (int k = 6; k-- > 0;) {
    if (swapped[k] != k) inverse.col(k).swap(inverse.col(swapped[k]));
  }
  return inverse;
}

bool is_almost_singular(const JacobianMatrix& J) {
  /// python -m bench laws right_angles_6 middle_sphere --arms 200 --poses 100
  constexpr double kVolume = 1e-4;
  // Of joints that are not there, the products of a 1 and zeros.
  Matrix6 products = Matrix6::Identity();
  if (J.cols() > 6) {
    products = J * J.transpose();
  } else {
    products.topLeftCorner(J.cols(), J.cols()) = J.transpose() * J;
  }
  double rows[6][6];
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) {
      rows[i][k] = products(i, k) / std::sqrt(products(i, i) * products(k, k));
    }
  }
  // Written so that NaN is singular.
  return !(SymmetricFactors<double>(rows, 0.0).determinant() > kVolume * kVolume);
}

}  // namespace iksel
