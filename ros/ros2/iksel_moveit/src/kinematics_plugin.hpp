// SPDX-License-Identifier: BSD-3-Clause
// IKSel behind MoveIt's interface of kinematics solvers.
#pragma once

#include <iksel/iksel.hpp>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "joint_map.hpp"
#include "moveit_headers.hpp"

namespace iksel_moveit {

/// Solves a group that is a chain of joints with one variable each. Every answer is the nearest to
/// the seed state that is found, within the limits of consistency, that the callback passes. Its
/// const methods may be called from many threads at once.
class KinematicsPlugin : public kinematics::KinematicsBase {
 public:
  using Pose = geometry_msgs::msg::Pose;
  using ErrorCode = moveit_msgs::msg::MoveItErrorCodes;
  using Options = kinematics::KinematicsQueryOptions;
  using Values = std::vector<double>;
  // Those of many tips.
  using KinematicsBase::getPositionIK;
  using KinematicsBase::searchPositionIK;

  bool initialize(const rclcpp::Node::SharedPtr& node, const moveit::core::RobotModel& robot_model,
                  const std::string& group_name, const std::string& base_frame,
                  const std::vector<std::string>& tip_frames,
                  double search_discretization) override;

  bool getPositionIK(const Pose& ik_pose, const Values& ik_seed_state, Values& solution,
                     ErrorCode& error_code, const Options& options = Options()) const override;
  /// All solutions, nearest to the seed state first.
  bool getPositionIK(const std::vector<Pose>& ik_poses, const Values& ik_seed_state,
                     std::vector<Values>& solutions, kinematics::KinematicsResult& result,
                     const Options& options) const override;

  bool searchPositionIK(const Pose& ik_pose, const Values& ik_seed_state, double timeout,
                        Values& solution, ErrorCode& error_code,
                        const Options& options = Options()) const override;
  bool searchPositionIK(const Pose& ik_pose, const Values& ik_seed_state, double timeout,
                        const Values& consistency_limits, Values& solution, ErrorCode& error_code,
                        const Options& options = Options()) const override;
  bool searchPositionIK(const Pose& ik_pose, const Values& ik_seed_state, double timeout,
                        Values& solution, const IKCallbackFn& solution_callback,
                        ErrorCode& error_code, const Options& options = Options()) const override;
  bool searchPositionIK(const Pose& ik_pose, const Values& ik_seed_state, double timeout,
                        const Values& consistency_limits, Values& solution,
                        const IKCallbackFn& solution_callback, ErrorCode& error_code,
                        const Options& options = Options()) const override;

  bool getPositionFK(const std::vector<std::string>& link_names, const Values& joint_angles,
                     std::vector<Pose>& poses) const override;

  const std::vector<std::string>& getJointNames() const override { return joints_.names(); }
  const std::vector<std::string>& getLinkNames() const override { return getTipFrames(); }

 private:
  /// What is asked; the references are the caller's.
  struct Query {
    const Pose& pose;
    const Values& seed;
    double timeout;  ///< [s]; 0: none
    const Values& consistency_limits;
    const IKCallbackFn& callback;
    const Options& options;
  };

  bool solve(const Query& query, Values& solution, ErrorCode& error_code) const;
  void check(const Query& query) const;
  [[nodiscard]] iksel::SolveRequest request_of(const Query& query, const iksel::Robot& robot) const;
  [[nodiscard]] iksel::Filter filter_of(const Query& query, const iksel::Robot& robot) const;
  [[nodiscard]] iksel::Solver solver_for(const Query& query) const;
  [[nodiscard]] std::string task_name() const;

  JointMap joints_;
  iksel::SolverOptions options_;
  std::optional<iksel::Solver> solver_;
  /// With the redundant joints locked where they were the last time.
  mutable std::optional<iksel::Solver> locked_;
  mutable std::mutex locked_mutex_;
};

}  // namespace iksel_moveit
