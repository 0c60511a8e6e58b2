// SPDX-License-Identifier: BSD-3-Clause
#include "math/pseudo_inverse.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SVD>

namespace iksel {

TruncatedSvd::TruncatedSvd(const JacobianMatrix& J, double cutoff) {
  // Full U, which is 6 x 6 for any arm: a thin one does not fit the type for fewer than 6 joints.
  const Eigen::JacobiSVD<JacobianMatrix> svd(J, Eigen::ComputeFullU | Eigen::ComputeThinV);
  const auto& sigma = svd.singularValues();
  U_ = svd.matrixU().leftCols(sigma.size());
  V_ = svd.matrixV();
  inverse_sigma_.resize(sigma.size());
  for (Eigen::Index i = 0; i < sigma.size(); ++i) {
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

PseudoInverse damped_inverse(const JacobianMatrix& J, double lambda) {
  Matrix6 A = J * J.transpose();
  A.diagonal().array() += lambda;
  return A.ldlt().solve(J).transpose();
}

JointVector damped_solve(const JacobianMatrix& J, double lambda, const Vector6& e) {
  Matrix6 A = J * J.transpose();
  A.diagonal().array() += lambda;
  return J.transpose() * A.ldlt().solve(e);
}

}  // namespace iksel
