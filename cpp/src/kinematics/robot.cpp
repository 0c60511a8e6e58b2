// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/robot.hpp"
#include "iksel/pose.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "base/message_text.hpp"
#include "base/pseudo_inverse.hpp"
#include "base/rotation.hpp"
#include "iksel/error.hpp"
#include "kinematics/chain_model.hpp"
#include "urdf/dh.hpp"
#include "urdf/parse.hpp"

namespace iksel {

Robot::Robot(std::shared_ptr<const ChainModel> model) : model_(std::move(model)) {}

Robot Robot::from_urdf_file(const std::filesystem::path& path, const RobotOptions& options) {
  return read_with_path(path,
                        [&](const std::string& xml) { return from_urdf_string(xml, options); });
}

Robot Robot::from_urdf_string(const std::string& xml, const RobotOptions& options) {
  return Robot(std::make_shared<ChainModel>(xml, options));
}

Robot Robot::from_dh(const DhTable& table, const RobotOptions& options) {
  return from_urdf_string(urdf_of_dh(table), options);
}

Robot Robot::with_tcp(const Pose& T_tip_tcp) const { return Robot(model_->with_tcp(T_tip_tcp)); }

Robot Robot::without_limits() const { return Robot(model_->without_limits()); }

const std::string& Robot::name() const { return model_->spec.robot_name; }
const std::string& Robot::base_link() const { return model_->options.base_link; }
const std::string& Robot::tip_link() const { return model_->options.tip_link; }
const std::vector<std::string>& Robot::link_names() const { return model_->spec.link_names; }
const std::string& Robot::urdf() const { return model_->urdf; }
const RobotOptions& Robot::options() const { return model_->options; }
Pose Robot::tcp() const { return Pose(model_->tcp); }
int Robot::dof() const { return model_->dof; }
const std::vector<std::string>& Robot::joint_names() const { return model_->joints.names; }
const std::vector<JointType>& Robot::joint_types() const { return model_->joints.types; }
const JointVector& Robot::lower() const { return model_->joints.lower; }
const JointVector& Robot::upper() const { return model_->joints.upper; }
const JointVector& Robot::velocity_limit() const { return model_->joints.velocity; }
const JointVector& Robot::soft_lower() const { return model_->soft_lower; }
const JointVector& Robot::soft_upper() const { return model_->soft_upper; }

bool Robot::within_limits(const JointVector& q) const {
  check_joints(q, dof(), "q");
  return model_->joints.contains(q.data());
}

Pose Robot::fk(const JointVector& q, Kinematics kinematics) const {
  check_joints(q, dof(), "q");
  if (kinematics == Kinematics::kdl) return model_->make_kdl()->fk(q);
  return model_->fk(q.data());
}

Jacobian Robot::jacobian(const JointVector& q, Kinematics kinematics) const {
  check_joints(q, dof(), "q");
  if (kinematics == Kinematics::kdl) return model_->make_kdl()->jacobian(q);
  Jacobian J;
  model_->fk_jacobian(q.data(), J);
  return J;
}

std::vector<Pose> Robot::link_poses(const JointVector& q,
                                    const std::map<std::string, double>& other_joints) const {
  check_joints(q, dof(), "q");
  std::vector<Pose> poses(link_names().size());
  model_->link_poses->with(*model_, other_joints,
                           [&](const LinkPoses& links) { links.at(q.data(), poses.data()); });
  return poses;
}

void Robot::link_poses(const double* q, std::size_t count,
                       const std::map<std::string, double>& other_joints,
                       double* T_base_link) const {
  using RowMajor = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
  std::vector<Pose> poses(link_names().size());
  model_->link_poses->with(*model_, other_joints, [&](const LinkPoses& links) {
    for (std::size_t i = 0; i < count; ++i, q += dof()) {
      links.at(q, poses.data());
      for (const Pose& pose : poses) {
        Eigen::Map<RowMajor>{T_base_link} = pose.matrix();
        T_base_link += 16;
      }
    }
  });
}

Matrix Robot::inverse_jacobian(const JointVector& q, double damping) const {
  if (!(damping >= 0 && std::isfinite(damping))) {
    throw InvalidArgumentError("damping: " + number_text(damping) + " is not 0 or more");
  }
  const JacobianMatrix J = jacobian(q);
  constexpr double kCutoff = 1e-9;
  if (damping == 0) return TruncatedSvd(J, kCutoff).inverse();
  return damped_inverse(J, damping * damping);
}

Matrix Robot::random_configurations(std::size_t n, std::uint64_t seed,
                                    const Progress& progress) const {
  return model_->joints.samples(n, seed, progress);
}

double Robot::reach() const { return model_->reach_of_tcp(); }
Eigen::Vector3d Robot::reach_centre() const { return model_->reach_centre; }
std::uint64_t Robot::chain_hash() const { return model_->hash; }

Eigen::Matrix<double, 6, 1> pose_error(const Pose& target, const Pose& pose) {
  Eigen::Matrix<double, 6, 1> error;
  error << target.translation() - pose.translation(),
      to_rotation_vector(target.linear() * pose.linear().transpose());
  return error;
}

}  // namespace iksel
