// SPDX-License-Identifier: BSD-3-Clause
#include "kinematics/kdl_chain.hpp"

#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <utility>

namespace iksel {
namespace {

KDL::Vector to_kdl(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

KDL::Frame to_kdl(const Eigen::Isometry3d& T) {
  const auto& R = T.linear();
  return {KDL::Rotation(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1),
                        R(2, 2)),
          to_kdl(Eigen::Vector3d(T.translation()))};
}

KDL::Chain to_kdl_chain(const std::vector<ChainJoint>& joints, const Pose& T_tip_tcp) {
  KDL::Chain chain;
  for (const ChainJoint& joint : joints) {
    if (joint.fixed) {
      chain.addSegment(
          KDL::Segment(KDL::Joint(KDL::Joint::None), to_kdl(joint.before * joint.after)));
      continue;
    }
    // The segment's motion happens at the end of `before`; KDL wants the axis in the frame ahead of
    // it and the pose of the segment's end at zero.
    const Eigen::Vector3d origin = joint.before.translation();
    const Eigen::Vector3d axis = joint.before.linear() * joint.axis;
    const auto type = joint.prismatic ? KDL::Joint::TransAxis : KDL::Joint::RotAxis;
    chain.addSegment(KDL::Segment(KDL::Joint(joint.name, to_kdl(origin), to_kdl(axis), type),
                                  to_kdl(joint.before * joint.after)));
  }
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), to_kdl(T_tip_tcp)));
  return chain;
}

}  // namespace

struct KdlChain::Impl {
  Impl(const std::vector<ChainJoint>& joints, int dof_in, const Pose& T_tip_tcp)
      : chain(to_kdl_chain(joints, T_tip_tcp)),
        fk_solver(chain),
        jacobian_solver(chain),
        q(chain.getNrOfJoints()),
        jacobian(chain.getNrOfJoints()),
        dof(dof_in) {
    for (const ChainJoint& joint : joints) {
      if (!joint.fixed) motions.push_back(joint);
    }
  }

  void set(const JointVector& values) {
    for (std::size_t k = 0; k < motions.size(); ++k) {
      const ChainJoint& m = motions[k];
      q(static_cast<unsigned>(k)) = motion_of(m, values[m.variable]);
    }
  }

  KDL::Chain chain;
  KDL::ChainFkSolverPos_recursive fk_solver;
  KDL::ChainJntToJacSolver jacobian_solver;
  KDL::JntArray q;
  KDL::Jacobian jacobian;
  KDL::Frame frame;
  std::vector<ChainJoint> motions;
  int dof;
};

KdlChain::KdlChain(const std::vector<ChainJoint>& joints, int dof, const Pose& T_tip_tcp)
    : impl_(std::make_unique<Impl>(joints, dof, T_tip_tcp)) {}
KdlChain::~KdlChain() = default;

Pose KdlChain::fk(const JointVector& q) {
  impl_->set(q);
  impl_->fk_solver.JntToCart(impl_->q, impl_->frame);
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Map<const Eigen::Matrix3d>(impl_->frame.M.data).transpose();  // by rows
  pose.translation() = Eigen::Map<const Eigen::Vector3d>(impl_->frame.p.data);
  return pose;
}

Jacobian KdlChain::jacobian(const JointVector& q) {
  impl_->set(q);
  impl_->jacobian_solver.JntToJac(impl_->q, impl_->jacobian);
  Jacobian J = Jacobian::Zero(6, impl_->dof);
  for (std::size_t k = 0; k < impl_->motions.size(); ++k) {
    const ChainJoint& m = impl_->motions[k];
    J.col(m.variable) +=
        motion_slope(m, q[m.variable]) * impl_->jacobian.data.col(static_cast<Eigen::Index>(k));
  }
  return J;
}

double KdlChain::fk_and_jacobian(const JointVector& q) {
  impl_->set(q);
  impl_->fk_solver.JntToCart(impl_->q, impl_->frame);
  impl_->jacobian_solver.JntToJac(impl_->q, impl_->jacobian);
  return impl_->frame.p(0) + impl_->jacobian(0, 0);
}

}  // namespace iksel
