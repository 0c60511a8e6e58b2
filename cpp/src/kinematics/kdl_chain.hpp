// SPDX-License-Identifier: BSD-3-Clause
// The chain in Orocos KDL: the reference for kinematics, and what databases are built with.
#pragma once

#include <memory>
#include <vector>

#include "iksel/types.hpp"
#include "urdf/chain_spec.hpp"

namespace iksel {

/// KDL's solvers over one chain. NOT safe to use from two threads at once: KDL::Joint memoises in
/// mutable members. Make one per thread.
class KdlChain {
 public:
  KdlChain(const std::vector<ChainJoint>& joints, int dof, const Pose& T_tip_tcp);
  KdlChain(const KdlChain&) = delete;
  KdlChain& operator=(const KdlChain&) = delete;
  ~KdlChain();

  Pose fk(const JointVector& q);
  Jacobian jacobian(const JointVector& q);
  /// One FK and one Jacobian with nothing around them, to be timed; returns a number of the result.
  double fk_and_jacobian(const JointVector& q);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace iksel
