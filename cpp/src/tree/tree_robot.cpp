// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/tree_robot.hpp"

#include <utility>

#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "tree/tree_model.hpp"
#include "urdf/parse.hpp"

namespace iksel {
namespace {

const TreeTip& tip_at(const TreeModel& model, int tip) {
  if (tip < 0 || tip >= model.tip_count()) {
    throw InvalidArgumentError("tip: " + std::to_string(tip) + " is not in 0 .. " +
                               std::to_string(model.tip_count() - 1) + " (" +
                               list_names(model.options.tip_links) + ")");
  }
  return model.tip(tip);
}

}  // namespace

TreeRobot::TreeRobot(std::shared_ptr<const TreeModel> model) : model_(std::move(model)) {}

TreeRobot TreeRobot::from_urdf_file(const std::filesystem::path& path, const TreeOptions& options) {
  return read_with_path(path,
                        [&](const std::string& xml) { return from_urdf_string(xml, options); });
}

TreeRobot TreeRobot::from_urdf_string(const std::string& xml, const TreeOptions& options) {
  return TreeRobot(std::make_shared<TreeModel>(xml, options));
}

const std::string& TreeRobot::name() const { return model_->tips.front().chain.robot.name(); }
const std::string& TreeRobot::base_link() const { return model_->options.base_link; }
const std::vector<std::string>& TreeRobot::tip_links() const { return model_->options.tip_links; }
const std::string& TreeRobot::urdf() const { return model_->tips.front().chain.robot.urdf(); }
const TreeOptions& TreeRobot::options() const { return model_->options; }
int TreeRobot::tips() const { return model_->tip_count(); }
int TreeRobot::dof() const { return model_->dof(); }
const std::vector<std::string>& TreeRobot::joint_names() const { return model_->joints.names; }
const std::vector<JointType>& TreeRobot::joint_types() const { return model_->joints.types; }
const JointVector& TreeRobot::lower() const { return model_->joints.lower; }
const JointVector& TreeRobot::upper() const { return model_->joints.upper; }
const JointVector& TreeRobot::velocity_limit() const { return model_->joints.velocity; }

bool TreeRobot::within_limits(const JointVector& q) const {
  check_joints(q, dof(), "q");
  return model_->joints.contains(q.data());
}

const Robot& TreeRobot::chain(int tip) const { return tip_at(*model_, tip).chain.robot; }
const std::vector<int>& TreeRobot::joints_of(int tip) const {
  return tip_at(*model_, tip).chain.joints;
}
const std::vector<int>& TreeRobot::shared_joints() const { return model_->shared; }

std::vector<Pose> TreeRobot::fk(const JointVector& q) const {
  check_joints(q, dof(), "q");
  std::vector<Pose> poses;
  for (const TreeTip& tip : model_->tips) poses.push_back(tip.chain.fk(q));
  return poses;
}

Matrix TreeRobot::jacobian(const JointVector& q) const {
  check_joints(q, dof(), "q");
  Matrix all = Matrix::Zero(6 * tips(), dof());
  Jacobian J;
  Eigen::Index row = 0;
  for (const TreeTip& tip : model_->tips) {
    tip.chain.model().fk_jacobian(picked(q, tip.chain.joints).data(), J);
    for (std::size_t j = 0; j < tip.chain.joints.size(); ++j) {
      all.block<6, 1>(row, tip.chain.joints[j]) = J.col(static_cast<Eigen::Index>(j));
    }
    row += 6;
  }
  return all;
}

Matrix TreeRobot::random_configurations(std::size_t n, std::uint64_t seed,
                                        const Progress& progress) const {
  return model_->joints.samples(n, seed, progress);
}

}  // namespace iksel
