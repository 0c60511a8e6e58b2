// SPDX-License-Identifier: BSD-3-Clause
#include "ik_server.hpp"

#include <chrono>
#include <limits>

#include "pose_message.hpp"
#include "task_name.hpp"

namespace iksel_ros {
namespace {

using Positions = std::map<std::string, double>;

[[noreturn]] void refuse(const std::string& message) { throw iksel::InvalidArgumentError(message); }

void note_positions(const messages::JointState& state, Positions& positions) {
  if (state.position.size() != state.name.size()) {
    refuse("joint state: " + std::to_string(state.name.size()) + " names, but " +
           std::to_string(state.position.size()) + " positions");
  }
  for (std::size_t i = 0; i < state.name.size(); ++i) positions[state.name[i]] = state.position[i];
}

iksel::JointVector in_order(const Positions& positions, const iksel::Robot& robot,
                            const std::string& whose) {
  iksel::JointVector q(robot.dof());
  for (int i = 0; i < robot.dof(); ++i) {
    const std::string& name = robot.joint_names()[static_cast<std::size_t>(i)];
    const auto found = positions.find(name);
    if (found == positions.end()) refuse(whose + ": no position of joint '" + name + "'");
    q[i] = found->second;
  }
  return q;
}

}  // namespace

iksel::Pose IkServer::read_target(const messages::SolveIK::Request& request) const {
  const std::string& given = request.pose.header.frame_id;
  const std::string frame = given.substr(!given.empty() && given[0] == '/' ? 1 : 0);
  if (!frame.empty() && frame != robot().base_link()) {
    refuse("frame '" + frame + "' is not the base link, '" + robot().base_link() +
           "': transform the pose first");
  }
  return to_pose(request.pose.pose);
}

iksel::SolveRequest IkServer::read_request(const messages::SolveIK::Request& request) const {
  iksel::SolveRequest wanted;
  if (!request.near.name.empty()) {
    Positions positions;
    note_positions(request.near, positions);
    wanted.near = in_order(positions, robot(), "near");
  } else if (request.near_current) {
    wanted.near = in_order(positions_, robot(), "near_current, joint_states so far");
  }
  wanted.task = task_of(request.task);
  return wanted;
}

void IkServer::solve(const messages::SolveIK::Request& request,
                     messages::SolveIK::Response& response, iksel::JointVector& shown) const {
  response = {};
  response.position_error = response.rotation_error = std::numeric_limits<double>::quiet_NaN();
  shown.resize(0);
  try {
    const iksel::Pose target = read_target(request);
    const iksel::SolveRequest wanted = read_request(request);
    const auto begin = std::chrono::steady_clock::now();
    const iksel::Result result = solver_.solve(target, wanted);
    const std::chrono::duration<double, std::micro> taken =
        std::chrono::steady_clock::now() - begin;
    response.microseconds = taken.count();
    response.success = result.success();
    response.status = iksel::to_string(result.status);
    if (!result.success()) {
      const iksel::Diagnosis why = solver_.diagnose(target, wanted);
      response.reason = why.message;
      shown = why.q;
      return;
    }
    response.joints.name = robot().joint_names();
    response.joints.position.assign(result.q.begin(), result.q.end());
    response.position_error = result.position_error;
    response.rotation_error = result.rotation_error;
    shown = result.q;
  } catch (const iksel::Error& error) {
    response.status = kInvalidRequest;
    response.reason = error.what();
  }
}

void IkServer::update(const messages::JointState& state) { note_positions(state, positions_); }

}  // namespace iksel_ros
