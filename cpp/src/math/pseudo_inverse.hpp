// SPDX-License-Identifier: BSD-3-Clause
// Truncated and damped solves with a Jacobian, without a heap allocation.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/SVD>

#include "iksel/types.hpp"

namespace iksel {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
/// dof x 6.
using PseudoInverse = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::DontAlign, kMaxDof, 6>;
/// 6 x dof, as Eigen's decompositions want it.
using JacobianMatrix = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxDof>;

/// Singular value decomposition of a Jacobian with singular values under `cutoff` * largest cut
/// off.
class TruncatedSvd {
 public:
  TruncatedSvd(const JacobianMatrix& J, double cutoff)
      // Full U, which is 6 x 6 for any arm: a thin one does not fit the type for fewer than 6
      // joints.
      : svd_(J, Eigen::ComputeFullU | Eigen::ComputeThinV) {
    const auto& sigma = svd_.singularValues();
    inverse_sigma_.resize(sigma.size());
    for (Eigen::Index i = 0; i < sigma.size(); ++i) {
      inverse_sigma_[i] = sigma[i] > cutoff * sigma[0] && sigma[i] > 0 ? 1.0 / sigma[i] : 0.0;
    }
  }

  /// J^+ e, the least-squares step of least norm.
  [[nodiscard]] JointVector solve(const Vector6& e) const {
    const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1> scaled =
        inverse_sigma_.cwiseProduct(svd_.matrixU().leftCols(inverse_sigma_.size()).transpose() * e);
    return svd_.matrixV() * scaled;
  }

  /// J^+.
  [[nodiscard]] PseudoInverse inverse() const {
    return svd_.matrixV() * inverse_sigma_.asDiagonal() *
           svd_.matrixU().leftCols(inverse_sigma_.size()).transpose();
  }

 private:
  Eigen::JacobiSVD<JacobianMatrix> svd_;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1> inverse_sigma_;
};

/// J^T (J J^T + lambda I)^-1 e.
inline JointVector damped_solve(const JacobianMatrix& J, double lambda, const Vector6& e) {
  Matrix6 A = J * J.transpose();
  A.diagonal().array() += lambda;
  return J.transpose() * A.ldlt().solve(e);
}

}  // namespace iksel
