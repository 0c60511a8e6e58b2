// SPDX-License-Identifier: BSD-3-Clause
// One step of each iteration scheme: the joint adjustment for an error e at q (paper, Table II).
#pragma once

#include "base/pseudo_inverse.hpp"
#include "iksel/options.hpp"
#include "kinematics/chain_model.hpp"

namespace iksel {

/// dls: J^T (J J^T + damping I)^-1 e; truncated least squares in the undamped limit.
JointVector dls_step(const JacobianMatrix& J, const Vector6& e, const Paper& scheme);

/// pinv, pinv_rr: J^+ e.
JointVector pinv_step(const JacobianMatrix& J, const Vector6& e, const Paper& scheme);

/// Either of them, for a redundant chain c + J^+ (e - J c) with a gain: c = gain (middle of the
/// limits - q), so that what the pose leaves open, (I - J^+ J) c, leads there.
JointVector inverse_step(const ChainModel& model, const JointVector& q, const JacobianMatrix& J,
                         const Vector6& e, const Paper& scheme);

/// Weight of each joint in cwln and cwpi: 1 inside, falling as 3 s^2 - 2 s^3 to 0 over the margin
/// at each end of the range, s the distance to the limit over the margin (Huang et al. 2016).
JointVector joint_weights(const ChainModel& model, const JointVector& q, double margin);

/// cwln, with a pull-back c towards mid-range: c + W J^T (J W J^T + 1e-9 I)^-1 (e - J c).
JointVector cwln_step(const ChainModel& model, const JointVector& q, const JacobianMatrix& J,
                      const Vector6& e, const Paper& scheme);

/// cwpi: c + W^1/2 (J W^1/2)^+ (e - J c).
JointVector cwpi_step(const ChainModel& model, const JointVector& q, const JacobianMatrix& J,
                      const Vector6& e, const Paper& scheme);

}  // namespace iksel
