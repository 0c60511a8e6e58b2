// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/robot.hpp"
#include "iksel/pose.hpp"

#include <cmath>
#include <utility>

#include "base/message_text.hpp"
#include "base/pseudo_inverse.hpp"
#include "base/rotation.hpp"
#include "iksel/error.hpp"
#include "kinematics/chain_model.hpp"
#include "kinematics/tips_model.hpp"
#include "urdf/parse.hpp"
#include "urdf/urdf_text.hpp"

namespace iksel {

namespace {

void check_tip(const RobotModel& model, int tip) {
  if (tip >= 0 && tip < model.tip_count()) return;
  throw InvalidArgumentError("tip: " + std::to_string(tip) + " is not in 0 .. " +
                             std::to_string(model.tip_count() - 1) + " (" +
                             list_names(model.tip_links) + ")");
}

/// With the only one of tip_links as the tip link.
RobotOptions with_one_tip(RobotOptions options) {
  if (options.tip_links.empty() && options.tcps.empty()) return options;
  if (!options.tip_link.empty() || options.tip_links.size() != 1 || options.tcps.size() > 1) {
    throw InvalidArgumentError(
        "tip_links: " + std::to_string(options.tip_links.size()) + " links and " +
        std::to_string(options.tcps.size()) +
        " tcps; expected a tip_link, or tip_links with as many tcps or none");
  }
  options.tip_link = options.tip_links.front();
  if (!options.tcps.empty()) options.tcp = options.tcps.front();
  options.tip_links.clear();
  options.tcps.clear();
  return options;
}

}  // namespace

Robot::Robot(std::shared_ptr<const ChainModel> chain)
    : model_(std::move(chain)), chain_(static_cast<const ChainModel*>(model_.get())) {}

Robot::Robot(std::shared_ptr<const TipsModel> several)
    : model_(std::move(several)), several_(static_cast<const TipsModel*>(model_.get())) {}

Robot Robot::from_urdf_file(const std::filesystem::path& path, const RobotOptions& options) {
  return read_with_path(path,
                        [&](const std::string& xml) { return from_urdf_string(xml, options); });
}

Robot Robot::from_urdf_string(const std::string& xml, const RobotOptions& options) {
  if (options.tip_links.size() > 1) return Robot(std::make_shared<const TipsModel>(xml, options));
  return Robot(std::make_shared<const ChainModel>(xml, with_one_tip(options)));
}

Robot Robot::from_dh(const DhTable& table, const RobotOptions& options) {
  return from_urdf_string(urdf_of_dh(table), options);
}

Robot Robot::with_tcp(const Pose& T_tip_tcp) const { return Robot(model().with_tcp(T_tip_tcp)); }

Robot Robot::without_limits() const { return Robot(model().without_limits()); }

const std::string& Robot::name() const { return model_->name; }
const std::string& Robot::base_link() const { return model_->options.base_link; }
const std::string& Robot::tip_link() const { return model().options.tip_link; }
const std::vector<std::string>& Robot::link_names() const { return model_->link_names; }
const std::string& Robot::urdf() const { return model_->urdf; }
const RobotOptions& Robot::options() const { return model_->options; }
Pose Robot::tcp() const { return Pose(model().tcp); }
int Robot::dof() const { return model_->dof; }
const std::vector<std::string>& Robot::joint_names() const { return model_->joints.names; }
const std::vector<JointType>& Robot::joint_types() const { return model_->joints.types; }
const JointVector& Robot::lower() const { return model_->joints.lower; }
const JointVector& Robot::upper() const { return model_->joints.upper; }
const JointVector& Robot::velocity_limit() const { return model_->joints.velocity; }
const JointVector& Robot::soft_lower() const { return model_->soft_lower; }
const JointVector& Robot::soft_upper() const { return model_->soft_upper; }

int Robot::tips() const { return model_->tip_count(); }
const std::vector<std::string>& Robot::tip_links() const { return model_->tip_links; }
const std::vector<int>& Robot::shared_joints() const { return model_->shared; }

const Robot& Robot::chain(int tip) const {
  check_tip(*model_, tip);
  return several_ == nullptr ? *this : several_->tip(tip).chain.robot;
}

const std::vector<int>& Robot::joints_of(int tip) const {
  check_tip(*model_, tip);
  return model_->joints_of_tip[static_cast<std::size_t>(tip)];
}

void Robot::refuse_several_tips() const {
  throw InvalidArgumentError("robot '" + name() + "' has " + std::to_string(tips()) + " tips (" +
                             list_names(tip_links()) +
                             "), and this is about one; take the chain to one of them");
}

bool Robot::within_limits(const JointVector& q) const {
  check_joints(q, dof(), "q");
  return model_->joints.contains(q.data());
}

Pose Robot::fk(const JointVector& q, Kinematics kinematics) const {
  check_joints(q, dof(), "q");
  if (kinematics == Kinematics::kdl) return model().make_kdl()->fk(q);
  return model().fk(q.data());
}

Jacobian Robot::jacobian(const JointVector& q, Kinematics kinematics) const {
  check_joints(q, dof(), "q");
  if (kinematics == Kinematics::kdl) return model().make_kdl()->jacobian(q);
  Jacobian J;
  model().fk_jacobian(q.data(), J);
  return J;
}

std::vector<Pose> Robot::tip_poses(const JointVector& q, Kinematics kinematics) const {
  check_joints(q, dof(), "q");
  std::vector<Pose> poses;
  poses.reserve(static_cast<std::size_t>(tips()));
  for (int i = 0; i < tips(); ++i)
    poses.push_back(chain(i).fk(picked(q, joints_of(i)), kinematics));
  return poses;
}

Matrix Robot::tip_jacobians(const JointVector& q, Kinematics kinematics) const {
  check_joints(q, dof(), "q");
  Matrix all = Matrix::Zero(6 * tips(), dof());
  for (int i = 0; i < tips(); ++i) {
    const std::vector<int>& joints = joints_of(i);
    put_columns(chain(i).jacobian(picked(q, joints), kinematics), joints, all.middleRows<6>(6 * i));
  }
  return all;
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
  if (damping == 0) return TruncatedSvd(J, /*cutoff=*/1e-9).inverse();
  return damped_inverse(J, damping * damping);
}

Matrix Robot::random_configurations(std::size_t n, std::uint64_t seed,
                                    const Progress& progress) const {
  return model_->joints.samples(n, seed, progress);
}

double Robot::reach() const { return model().reach_of_tcp(); }
Eigen::Vector3d Robot::reach_centre() const { return model().reach_centre; }
std::uint64_t Robot::chain_hash() const { return model_->hash; }

Eigen::Matrix<double, 6, 1> pose_error(const Pose& target, const Pose& pose) {
  Eigen::Matrix<double, 6, 1> error;
  error << target.translation() - pose.translation(),
      to_rotation_vector(target.linear() * pose.linear().transpose());
  return error;
}

}  // namespace iksel
