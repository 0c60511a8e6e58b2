// SPDX-License-Identifier: BSD-3-Clause
// The node: reads the robot, offers the service ~solve_ik, follows the topic ~target.
#include <ros/ros.h>

#include <string>

#include "ik_server.hpp"
#include "markers.hpp"

namespace iksel_ros {
namespace {

iksel::Robot read_robot(const ros::NodeHandle& own) {
  std::string name;
  std::string urdf;
  if (!own.searchParam("robot_description", name) || !own.getParam(name, urdf)) {
    throw iksel::UrdfError("there is no parameter robot_description");
  }
  iksel::RobotOptions links;
  own.param<std::string>("base_link", links.base_link, "");
  own.param<std::string>("tip_link", links.tip_link, "");
  return iksel::Robot::from_urdf_string(urdf, links);
}

class IkNode {
 public:
  explicit IkNode(const iksel::Robot& robot)
      : server_(robot),
        markers_(robot),
        marker_topic_(own_.advertise<messages::MarkerArray>("markers", 1, true)),
        answer_topic_(own_.advertise<messages::JointState>("answer", 1)),
        state_topic_(any_.subscribe("joint_states", 1, &IkNode::on_state, this)),
        target_topic_(own_.subscribe("target", 1, &IkNode::on_target, this)),
        service_(own_.advertiseService("solve_ik", &IkNode::on_request, this)) {}

 private:
  bool on_request(messages::SolveIK::Request& request, messages::SolveIK::Response& response) {
    iksel::JointVector shown;
    server_.solve(request, response, shown);
    response.joints.header.stamp = ros::Time::now();
    if (response.status != kInvalidRequest && marker_topic_.getNumSubscribers() > 0) {
      marker_topic_.publish(markers_.draw(request.pose.pose, shown, response.success,
                                          response.success ? response.status : response.reason));
    }
    // An answer or none: the call itself succeeds.
    return true;
  }

  // Each answer is near to where the arm is; where nothing says so, to the last answer.
  void on_target(const messages::PoseStamped& pose) {
    messages::SolveIK::Request request;
    request.pose = pose;
    if (state_topic_.getNumPublishers() > 0) {
      request.near_current = true;
    } else {
      request.near = last_;
    }
    messages::SolveIK::Response response;
    on_request(request, response);
    if (!response.success) {
      ROS_WARN_STREAM_THROTTLE(1, response.reason);
      return;
    }
    last_ = response.joints;
    answer_topic_.publish(last_);
  }

  void on_state(const messages::JointState& state) {
    try {
      server_.update(state);
    } catch (const iksel::Error& error) {
      ROS_WARN_STREAM_THROTTLE(1, error.what());
    }
  }

  ros::NodeHandle any_;
  ros::NodeHandle own_{"~"};
  IkServer server_;
  Markers markers_;
  messages::JointState last_;
  ros::Publisher marker_topic_;
  ros::Publisher answer_topic_;
  ros::Subscriber state_topic_;
  ros::Subscriber target_topic_;
  ros::ServiceServer service_;
};

}  // namespace
}  // namespace iksel_ros

int main(int argc, char** argv) {
  ros::init(argc, argv, "iksel");
  try {
    const iksel::Robot robot = iksel_ros::read_robot(ros::NodeHandle("~"));
    const iksel_ros::IkNode node(robot);
    ROS_INFO("%s: %d joints, %s to %s", robot.name().c_str(), robot.dof(),
             robot.base_link().c_str(), robot.tip_link().c_str());
    ros::spin();
    return 0;
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 2;
  }
}
