// SPDX-License-Identifier: BSD-3-Clause
#include "refine/remainder.hpp"

namespace iksel {
namespace {

/// Between the ends of a difference that stands for a derivative [rad or m].
constexpr double kDifference = 1e-6;

/// The second derivative by differences of the gradient.
SquareMatrix difference_gradients(const Remainder& remainder, const JointVector& q,
                                  const JointVector& gradient) {
  const auto n = q.size();
  SquareMatrix H(n, n);
  JointVector moved = q;
  JointVector there(n);
  JointVector ignored(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    moved[j] = q[j] + kDifference;
    remainder.value(moved, there, ignored);
    H.col(j) = (there - gradient) / kDifference;
    moved[j] = q[j];
  }
  return 0.5 * (H + SquareMatrix(H.transpose()));
}

}  // namespace

Vector6 to_vector(const PoseWeights& weights, double rotation) {
  Vector6 all;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    all[row] = weights.position[i];
    all[row + 3] = weights.rotation ? (*weights.rotation)[i] : rotation;
  }
  return all;
}

double Remainder::value_of_tips(const JointVector& q, JointVector* gradient,
                                JointVector* diagonal) const {
  const TipsGoal& tips = *goal_.tips();
  TipsGoal::Linear at;
  tips.linearize(q, /*exact=*/true, at);
  if (gradient != nullptr) {
    gradient->setZero(q.size());
    diagonal->setZero(q.size());
  }
  double sum = 0;
  for (int tip = 0; tip < tips.count(); ++tip) {
    const TaskSpace& task = tips.task(tip);
    const Vector6 outside = task.outside(Vector6(at.deviation.segment<6>(6 * tip)));
    sum += 0.5 * outside.dot(weights2_.cwiseProduct(outside));
    for (int i = 0; i < 6 && gradient != nullptr; ++i) {
      if (outside[i] == 0 && task.lower()[i] < task.upper()[i]) continue;
      const JointVector row = at.J.row(6 * tip + i);
      *gradient += weights2_[i] * outside[i] * row;
      *diagonal += weights2_[i] * row.cwiseAbs2();
    }
  }
  return sum;
}

double Remainder::value(const JointVector& q) const {
  if (goal_.tips() != nullptr) return value_of_tips(q, nullptr, nullptr);
  const Vector6 d = goal_.task().deviation(goal_.target(), model_.fk(q.data()));
  const Vector6 outside = goal_.task().outside(d);
  return 0.5 * outside.dot(weights2_.cwiseProduct(outside));
}

Remainder::AtPose Remainder::at(const Pose& pose) const {
  AtPose out;
  out.map = Matrix6::Identity();
  const TaskSpace& task = goal_.task();
  const Vector6 d = task.deviation(goal_.target(), pose, out.map);
  const Vector6 outside = task.outside(d);
  out.active = weights2_;
  for (int i = 0; i < 6; ++i) {
    if (outside[i] == 0 && task.lower()[i] < task.upper()[i]) out.active[i] = 0;
  }
  const Vector6 weighted = weights2_.cwiseProduct(outside);
  out.pull = out.map.transpose() * weighted;
  out.value = 0.5 * outside.dot(weighted);
  return out;
}

Matrix6 Remainder::stiffness(const Pose& pose, const AtPose& at) const {
  Matrix6 K = Matrix6::Zero();
  const Eigen::Matrix3d moves = at.map.topLeftCorner<3, 3>();
  K.topLeftCorner<3, 3>() = moves.transpose() * at.active.head<3>().asDiagonal() * moves;
  if (goal_.is_full_pose() && turns_alike_) {
    // The pull is along the rotation's own axis, which the map leaves as it is.
    const bool in_tool = goal_.task().task().frame == TaskFrame::tool;
    const Eigen::Matrix3d axes =
        in_tool ? Eigen::Matrix3d(goal_.target().linear()) : Eigen::Matrix3d::Identity();
    K.bottomRightCorner<3, 3>() = weights2_[3] * axes * at.map.bottomRightCorner<3, 3>();
    return K;
  }
  // The task's swing and twist make a long formula of the rotation's.
  Pose turned = pose;
  for (int k = 0; k < 3; ++k) {
    turned.linear() =
        Eigen::AngleAxisd(kDifference, Eigen::Vector3d::Unit(k)).toRotationMatrix() * pose.linear();
    K.block<3, 1>(3, 3 + k) = (this->at(turned).pull - at.pull).tail<3>() / kDifference;
  }
  return K;
}

double Remainder::value(const JointVector& q, JointVector& gradient, JointVector& diagonal,
                        SquareMatrix* second) const {
  if (goal_.tips() != nullptr) {
    const double here = value_of_tips(q, &gradient, &diagonal);
    if (second != nullptr) *second = difference_gradients(*this, q, gradient);
    return here;
  }
  Jacobian of_pose;
  const Pose pose = to_pose(model_.fk_jacobian(q.data(), of_pose));
  const JacobianMatrix J = of_pose;
  const AtPose here = at(pose);
  gradient = J.transpose() * here.pull;
  diagonal = (here.map * J).cwiseAbs2().transpose() * here.active;
  if (second == nullptr) return here.value;
  if (!is_simple_) {
    *second = difference_gradients(*this, q, gradient);
    return here.value;
  }
  // What joint i does to the twist of a joint j behind it, besides moving the TCP: turns it.
  const JacobianMatrix stiff = stiffness(pose, here) * J;
  second->resize(model_.dof, model_.dof);
  for (int j = 0; j < model_.dof; ++j) {
    const Eigen::Vector3d L = J.col(j).head<3>();
    const Eigen::Vector3d z = J.col(j).tail<3>();
    const Eigen::Vector3d turning = L.cross(Eigen::Vector3d(here.pull.head<3>())) +
                                    z.cross(Eigen::Vector3d(here.pull.tail<3>()));
    for (int i = 0; i <= j; ++i) {
      const double part = J.col(j).dot(stiff.col(i)) + J.col(i).tail<3>().dot(turning);
      (*second)(i, j) = (*second)(j, i) = part;
    }
  }
  return here.value;
}

}  // namespace iksel
