// SPDX-License-Identifier: BSD-3-Clause
#include "goal/task_space.hpp"

#include <cmath>

#include "base/rotation.hpp"

namespace iksel {
namespace {

/// The axis whose width is unlike the other two's; -1 if all are equal.
int odd_axis(const Task& task) {
  double width[3];
  int order[3] = {0, 1, 2};
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    width[i] = std::min(task.rotation_upper[k] - task.rotation_lower[k], kTwoPi);
  }
  std::sort(order, order + 3, [&](int a, int b) { return width[a] < width[b]; });
  const double below = width[order[1]] - width[order[0]];
  const double above = width[order[2]] - width[order[1]];
  if (below == 0 && above == 0) return -1;
  return above >= below ? order[2] : order[0];
}

/// Inverse of the left Jacobian of SO(3): w' = J^-1 omega for the rotation vector w of E.
Eigen::Matrix3d inverse_left_jacobian(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  const Eigen::Matrix3d K = cross_matrix(w);
  // (1 - (t/2) cot(t/2)) / t^2 -> 1/12.
  const double half = 0.5 * angle;
  const double factor =
      angle < 1e-4 ? 1.0 / 12 : (1 - half * std::cos(half) / std::sin(half)) / (angle * angle);
  return Eigen::Matrix3d::Identity() - 0.5 * K + factor * K * K;
}

}  // namespace

TaskSpace::TaskSpace(const Task& task, double position_tolerance, double rotation_tolerance)
    : task_(task),
      position_tolerance_(position_tolerance),
      rotation_tolerance_(rotation_tolerance),
      full_pose_(task.is_full_pose()),
      twist_(odd_axis(task)) {
  // Three axes may add up their distances, hence the root.
  const double root = std::sqrt(3.0);
  for (int i = 0; i < 6; ++i) {
    const auto k = static_cast<std::size_t>(i % 3);
    lower_[i] = i < 3 ? task.position_lower[k] : task.rotation_lower[k];
    upper_[i] = i < 3 ? task.position_upper[k] : task.rotation_upper[k];
    const double margin = std::min(root * (i < 3 ? position_tolerance : rotation_tolerance),
                                   0.5 * (upper_[i] - lower_[i]));
    aim_lower_[i] = lower_[i] + margin;
    aim_upper_[i] = upper_[i] - margin;
  }
  rotation_free_ = !(lower_.tail<3>().array().isFinite().any());
}

Eigen::Vector3d TaskSpace::rotation_part(const Eigen::Matrix3d& E, Eigen::Matrix3d* map) const {
  if (rotation_free_) {
    if (map != nullptr) map->setZero();
    return Eigen::Vector3d::Zero();
  }
  if (twist_ < 0) {
    Eigen::Vector3d w = to_rotation_vector(E);
    if (map != nullptr) *map = inverse_left_jacobian(w);
    return w;
  }
  const Eigen::Vector3d a = Eigen::Vector3d::Unit(twist_);
  const Eigen::Vector3d u = E.col(twist_);
  const Eigen::Vector3d normal = a.cross(u);
  const double sine = normal.norm();
  const double phi = std::atan2(sine, u[twist_]);
  // Where a and u are (anti)parallel any axis across them serves.
  const Eigen::Vector3d n =
      sine > 1e-12 ? Eigen::Vector3d(normal / sine) : Eigen::Vector3d::Unit((twist_ + 1) % 3);
  const Eigen::Vector3d m = n.cross(a);
  const Eigen::Matrix3d twist = Eigen::AngleAxisd(-phi, n).toRotationMatrix() * E;
  const int b = (twist_ + 1) % 3;
  const int c = (twist_ + 2) % 3;
  Eigen::Vector3d part = phi * n;
  part[twist_] = std::atan2(twist(c, b) - twist(b, c), twist(b, b) + twist(c, c));
  if (map != nullptr) {
    // phi cot(phi) -> 1; a tool that points the other way has no derivative, only a large one.
    const double cotangent = sine > 1e-9 ? phi * u[twist_] / sine : (u[twist_] > 0 ? 1.0 : 0.0);
    *map = n * n.transpose() + m * (cotangent * m - phi * a).transpose();
    const double half = u[twist_] > -1 + 1e-9 ? sine / (1 + u[twist_]) : 0.0;
    map->row(twist_) = (a + half * m).transpose();
  }
  return part;
}

Vector6 TaskSpace::deviation(const Pose& target, const Pose& pose) const {
  Vector6 d;
  const Eigen::Vector3d p = pose.translation() - target.translation();
  if (task_.frame == TaskFrame::tool) {
    d << target.linear().transpose() * p,
        rotation_part(target.linear().transpose() * pose.linear(), nullptr);
  } else {
    d << p, rotation_part(pose.linear() * target.linear().transpose(), nullptr);
  }
  return d;
}

Vector6 TaskSpace::deviation(const Pose& target, const Pose& pose, JacobianMatrix& J) const {
  Vector6 d;
  Eigen::Matrix3d map;
  const Eigen::Vector3d p = pose.translation() - target.translation();
  if (task_.frame == TaskFrame::tool) {
    const Eigen::Matrix3d to_target = target.linear().transpose();
    d << to_target * p, rotation_part(to_target * pose.linear(), &map);
    map = map * to_target;
    J.topRows<3>() = to_target * J.topRows<3>().eval();
  } else {
    d << p, rotation_part(pose.linear() * target.linear().transpose(), &map);
  }
  J.bottomRows<3>() = map * J.bottomRows<3>().eval();
  return d;
}

Pose TaskSpace::pose_at(const Pose& target, const Vector6& d) const {
  Eigen::Matrix3d E;
  if (twist_ < 0) {
    E = from_rotation_vector(d.tail<3>());
  } else {
    Eigen::Vector3d swing = d.tail<3>();
    swing[twist_] = 0;
    E = from_rotation_vector(swing) *
        Eigen::AngleAxisd(d[3 + twist_], Eigen::Vector3d::Unit(twist_)).toRotationMatrix();
  }
  Pose pose = Pose::Identity();
  if (task_.frame == TaskFrame::tool) {
    pose.translation() = target * Eigen::Vector3d(d.head<3>());
    pose.linear() = target.linear() * E;
  } else {
    pose.translation() = target.translation() + d.head<3>();
    pose.linear() = E * target.linear();
  }
  return pose;
}

void TaskSpace::measure(const Pose& target, const Pose& pose, double& position,
                        double& rotation) const {
  const Vector6 out = outside(deviation(target, pose));
  position = length_of(out.head<3>());
  rotation = out.tail<3>().norm();
}

double TaskSpace::distance_from(const Pose& target, const Eigen::Vector3d& point) const {
  const Eigen::Vector3d p = point - target.translation();
  const Eigen::Vector3d d =
      task_.frame == TaskFrame::tool ? Eigen::Vector3d(target.linear().transpose() * p) : p;
  return (d - d.cwiseMax(lower_.head<3>()).cwiseMin(upper_.head<3>())).norm();
}

}  // namespace iksel
