// SPDX-License-Identifier: BSD-3-Clause
#include "kinematics_plugin.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <pluginlib/class_list_macros.hpp>

#include "chain_urdf.hpp"
#include "pose_message.hpp"
#include "task_name.hpp"

namespace iksel_moveit {
namespace {

using ErrorCode = KinematicsPlugin::ErrorCode;

const KinematicsPlugin::Values kNoLimits;
const KinematicsPlugin::IKCallbackFn kNoCallback;

rclcpp::Logger logger() { return rclcpp::get_logger("iksel_moveit"); }

geometry_msgs::msg::Pose to_message(const iksel::Pose& pose) {
  const Eigen::Quaterniond rotation(pose.linear());
  geometry_msgs::msg::Pose message;
  message.position.x = pose.translation().x();
  message.position.y = pose.translation().y();
  message.position.z = pose.translation().z();
  message.orientation.x = rotation.x();
  message.orientation.y = rotation.y();
  message.orientation.z = rotation.z();
  message.orientation.w = rotation.w();
  return message;
}

}  // namespace

bool KinematicsPlugin::initialize(const rclcpp::Node::SharedPtr& node,
                                  const moveit::core::RobotModel& robot_model,
                                  const std::string& group_name, const std::string& base_frame,
                                  const std::vector<std::string>& tip_frames,
                                  double search_discretization) {
  node_ = node;
  storeValues(robot_model, group_name, base_frame, tip_frames, search_discretization);
  const moveit::core::JointModelGroup* group = robot_model_->getJointModelGroup(group_name);
  if (group == nullptr || !group->isChain() || !group->isSingleDOFJoints() ||
      tip_frames_.size() != 1) {
    RCLCPP_ERROR(logger(), "group '%s' is no chain of joints with one variable each to one tip",
                 group_name.c_str());
    return false;
  }
  try {
    joints_ = JointMap(*group);
    options_.task = iksel_ros::task_of(task_name());
    iksel::RobotOptions links;
    links.base_link = base_frame_;
    links.tip_link = tip_frames_[0];
    const std::string urdf = chain_urdf(robot_model, links.base_link, links.tip_link);
    const auto robot = iksel::Robot::from_urdf_string(urdf, links);
    // All of its joints have to be the group's.
    (void)joints_.pick(robot, Values(joints_.size(), 0.0));
    solver_.emplace(robot, options_);
  } catch (const iksel::Error& error) {
    RCLCPP_ERROR(logger(), "group '%s': %s", group_name.c_str(), error.what());
    return false;
  }
  return true;
}

std::string KinematicsPlugin::task_name() const {
  const std::string name = "robot_description_kinematics." + group_name_ + ".task";
  if (!node_->has_parameter(name)) return node_->declare_parameter<std::string>(name, "pose");
  return node_->get_parameter(name).as_string();
}

void KinematicsPlugin::check(const Query& query) const {
  if (!solver_) throw iksel::InvalidArgumentError("the solver was not initialized");
  const auto expect = [this](const Values& values, const char* name) {
    if (values.size() == joints_.size()) return;
    throw iksel::InvalidArgumentError(std::string(name) + " has " + std::to_string(values.size()) +
                                      " values for " + std::to_string(joints_.size()) + " joints");
  };
  expect(query.seed, "the seed state");
  if (!query.consistency_limits.empty()) expect(query.consistency_limits, "consistency_limits");
}

iksel::Solver KinematicsPlugin::solver_for(const Query& query) const {
  if (!query.options.lock_redundant_joints || redundant_joint_indices_.empty()) return *solver_;
  iksel::RobotOptions locked = solver_->robot().options();
  for (const unsigned int i : redundant_joint_indices_) {
    locked.locked_joints[joints_.names().at(i)] = query.seed.at(i);
  }
  const std::lock_guard<std::mutex> lock(locked_mutex_);
  if (!locked_ || locked_->robot().options().locked_joints != locked.locked_joints) {
    locked_.emplace(iksel::Robot::from_urdf_string(solver_->robot().urdf(), locked), options_);
  }
  return *locked_;
}

iksel::Filter KinematicsPlugin::filter_of(const Query& query, const iksel::Robot& robot) const {
  if (query.consistency_limits.empty() && !query.callback) return {};
  return iksel::filter_each(robot.dof(), [this, query, robot](const iksel::JointVector& q) {
    Values values = query.seed;
    joints_.spread(robot, q.data(), values);
    for (std::size_t i = 0; i < query.consistency_limits.size(); ++i) {
      if (std::abs(values[i] - query.seed[i]) > query.consistency_limits[i]) return false;
    }
    if (!query.callback) return true;
    ErrorCode verdict;
    query.callback(query.pose, values, verdict);
    return verdict.val == ErrorCode::SUCCESS;
  });
}

iksel::SolveRequest KinematicsPlugin::request_of(const Query& query,
                                                 const iksel::Robot& robot) const {
  iksel::SolveRequest request;
  request.near = joints_.pick(robot, query.seed);
  request.filter = filter_of(query, robot);
  if (query.timeout > 0) request.deadline = query.timeout;
  return request;
}

bool KinematicsPlugin::solve(const Query& query, Values& solution, ErrorCode& error_code) const {
  error_code.val = ErrorCode::NO_IK_SOLUTION;
  try {
    check(query);
    const iksel::Solver solver = solver_for(query);
    const iksel::Robot& robot = solver.robot();
    const iksel::SolveRequest request = request_of(query, robot);
    const iksel::Pose target = iksel_ros::to_pose(query.pose);
    const iksel::Result result = solver.solve(target, request);
    iksel::JointVector q = result.q;
    if (!result.success()) {
      if (result.status == iksel::Status::out_of_time) error_code.val = ErrorCode::TIMED_OUT;
      if (!query.options.return_approximate_solution) return false;
      q = solver.diagnose(target, request).q;
      bool keep = q.size() == robot.dof();
      if (keep && request.filter) request.filter(q.data(), 1, &keep);
      if (!keep) return false;
    }
    solution = query.seed;
    joints_.spread(robot, q.data(), solution);
    error_code.val = ErrorCode::SUCCESS;
    return true;
  } catch (const iksel::Error& error) {
    RCLCPP_ERROR(logger(), "group '%s': %s", group_name_.c_str(), error.what());
    return false;
  }
}

bool KinematicsPlugin::getPositionIK(const std::vector<Pose>& ik_poses, const Values& ik_seed_state,
                                     std::vector<Values>& solutions,
                                     kinematics::KinematicsResult& result,
                                     const Options& options) const {
  namespace errors = kinematics::KinematicErrors;
  namespace methods = kinematics::DiscretizationMethods;
  solutions.clear();
  result.solution_percentage = 0;
  if (ik_poses.size() != 1) {
    result.kinematic_error =
        ik_poses.empty() ? errors::EMPTY_TIP_POSES : errors::MULTIPLE_TIPS_NOT_SUPPORTED;
    return false;
  }
  if (options.discretization_method != methods::NO_DISCRETIZATION) {
    result.kinematic_error = errors::UNSUPORTED_DISCRETIZATION_REQUESTED;
    return false;
  }
  result.kinematic_error = errors::NO_SOLUTION;
  const Query query{ik_poses[0], ik_seed_state, 0, kNoLimits, kNoCallback, options};
  try {
    check(query);
    const iksel::Solver solver = solver_for(query);
    const auto found =
        solver.solve_all(iksel_ros::to_pose(query.pose), {}, request_of(query, solver.robot()));
    for (const iksel::Result& one : found.all) {
      solutions.push_back(ik_seed_state);
      joints_.spread(solver.robot(), one.q.data(), solutions.back());
    }
  } catch (const iksel::Error& error) {
    RCLCPP_ERROR(logger(), "group '%s': %s", group_name_.c_str(), error.what());
  }
  if (solutions.empty()) return false;
  result.kinematic_error = errors::OK;
  result.solution_percentage = 1;
  return true;
}

bool KinematicsPlugin::getPositionIK(const Pose& ik_pose, const Values& ik_seed_state,
                                     Values& solution, ErrorCode& error_code,
                                     const Options& options) const {
  return solve({ik_pose, ik_seed_state, 0, kNoLimits, kNoCallback, options}, solution, error_code);
}

bool KinematicsPlugin::searchPositionIK(const Pose& ik_pose, const Values& ik_seed_state,
                                        double timeout, Values& solution, ErrorCode& error_code,
                                        const Options& options) const {
  return solve({ik_pose, ik_seed_state, timeout, kNoLimits, kNoCallback, options}, solution,
               error_code);
}

bool KinematicsPlugin::searchPositionIK(const Pose& ik_pose, const Values& ik_seed_state,
                                        double timeout, const Values& consistency_limits,
                                        Values& solution, ErrorCode& error_code,
                                        const Options& options) const {
  return solve({ik_pose, ik_seed_state, timeout, consistency_limits, kNoCallback, options},
               solution, error_code);
}

bool KinematicsPlugin::searchPositionIK(const Pose& ik_pose, const Values& ik_seed_state,
                                        double timeout, Values& solution,
                                        const IKCallbackFn& solution_callback,
                                        ErrorCode& error_code, const Options& options) const {
  return solve({ik_pose, ik_seed_state, timeout, kNoLimits, solution_callback, options}, solution,
               error_code);
}

bool KinematicsPlugin::searchPositionIK(const Pose& ik_pose, const Values& ik_seed_state,
                                        double timeout, const Values& consistency_limits,
                                        Values& solution, const IKCallbackFn& solution_callback,
                                        ErrorCode& error_code, const Options& options) const {
  return solve({ik_pose, ik_seed_state, timeout, consistency_limits, solution_callback, options},
               solution, error_code);
}

bool KinematicsPlugin::getPositionFK(const std::vector<std::string>& link_names,
                                     const Values& joint_angles, std::vector<Pose>& poses) const {
  if (!solver_ || joint_angles.size() != joints_.size()) {
    RCLCPP_ERROR(logger(), "getPositionFK: not initialized, or %zu values for %zu joints",
                 joint_angles.size(), joints_.size());
    return false;
  }
  const iksel::Robot& robot = solver_->robot();
  const std::vector<iksel::Pose> all = robot.link_poses(joints_.pick(robot, joint_angles));
  poses.clear();
  for (const std::string& name : link_names) {
    const auto& known = robot.link_names();
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      RCLCPP_ERROR(logger(), "getPositionFK: link '%s' is not in the chain", name.c_str());
      return false;
    }
    poses.push_back(to_message(all[static_cast<std::size_t>(found - known.begin())]));
  }
  return true;
}

}  // namespace iksel_moveit

PLUGINLIB_EXPORT_CLASS(iksel_moveit::KinematicsPlugin, kinematics::KinematicsBase)
