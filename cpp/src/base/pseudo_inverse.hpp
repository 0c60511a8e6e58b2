// SPDX-License-Identifier: BSD-3-Clause
// Truncated and damped solves with a Jacobian, without a heap allocation. Eigen's
// decompositions take a compiler long, and so are seen by one source only.
#pragma once

#include <Eigen/Core>

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
  TruncatedSvd(const JacobianMatrix& J, double cutoff);

  /// J^+ e, the least-squares step of least norm.
  [[nodiscard]] JointVector solve(const Vector6& e) const;
  /// J^+.
  [[nodiscard]] PseudoInverse inverse() const;

 private:
  // J = U diag(sigma) V^T with as many columns as J has singular values.
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6> U_;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxDof, 6> V_;
  Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1> inverse_sigma_;
};

/// Singular values, largest first.
Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1> singular_values(
    const JacobianMatrix& J);

/// In how many directions a Jacobian moves the tip, lengths in the unit of the robot: in others
/// files that are rounded do, or the tolerances would move joints by more than 0.01 rad.
int rank_of(const JacobianMatrix& J);

/// A^-1 b for a symmetric A.
Vector6 solve_symmetric(const Matrix6& A, const Vector6& b);

/// J^T (J J^T + lambda I)^-1.
PseudoInverse damped_inverse(const JacobianMatrix& J, double lambda);

/// J^T (J J^T + lambda I)^-1 e.
JointVector damped_solve(const JacobianMatrix& J, double lambda, const Vector6& e);

/// A^-1, by elimination, the largest of a column first. Not finite where A is singular.
Matrix6 inverse_of(const Matrix6& A);

/// Whether the arm is singular, or almost: the volume that the joints' twists span, or of more than
/// six the rows of their Jacobian, is next to nothing of the product of their lengths. Solutions
/// then come in families, as far as the tolerances and rounding tell.
bool is_almost_singular(const JacobianMatrix& J);

}  // namespace iksel
