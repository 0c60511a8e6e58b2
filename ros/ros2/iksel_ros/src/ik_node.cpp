// SPDX-License-Identifier: BSD-3-Clause
// The node: reads the robot, offers the service ~/solve_ik, follows the topic ~/target.
#include <exception>
#include <memory>
#include <rclcpp/rclcpp.hpp>
#include <string>

#include "ik_server.hpp"
#include "markers.hpp"

namespace iksel_ros {
namespace {

constexpr int kWarningPeriod = 1000;  // [ms]

iksel::Robot read_robot(rclcpp::Node& node) {
  const auto urdf = node.declare_parameter<std::string>("robot_description", "");
  if (urdf.empty()) throw iksel::UrdfError("there is no parameter robot_description");
  iksel::RobotOptions links;
  links.base_link = node.declare_parameter<std::string>("base_link", "");
  links.tip_link = node.declare_parameter<std::string>("tip_link", "");
  return iksel::Robot::from_urdf_string(urdf, links);
}

class IkNode : public rclcpp::Node {
 public:
  IkNode() : Node("iksel"), robot_(read_robot(*this)), server_(robot_), markers_(robot_) {
    marker_topic_ =
        create_publisher<messages::MarkerArray>("~/markers", rclcpp::QoS(1).transient_local());
    answer_topic_ = create_publisher<messages::JointState>("~/answer", 1);
    state_topic_ = create_subscription<messages::JointState>(
        "joint_states", rclcpp::SensorDataQoS().keep_last(1),
        [this](const messages::JointState& state) { on_state(state); });
    target_topic_ = create_subscription<messages::PoseStamped>(
        "~/target", 1, [this](const messages::PoseStamped& pose) { on_target(pose); });
    service_ = create_service<messages::SolveIK>(
        "~/solve_ik", [this](std::shared_ptr<messages::SolveIK::Request> request,
                             std::shared_ptr<messages::SolveIK::Response> response) {
          answer(*request, *response);
        });
    RCLCPP_INFO(get_logger(), "%s: %d joints, %s to %s", robot_.name().c_str(), robot_.dof(),
                robot_.base_link().c_str(), robot_.tip_link().c_str());
  }

 private:
  void answer(const messages::SolveIK::Request& request, messages::SolveIK::Response& response) {
    iksel::JointVector shown;
    server_.solve(request, response, shown);
    response.joints.header.stamp = now();
    if (response.status != kInvalidRequest && marker_topic_->get_subscription_count() > 0) {
      marker_topic_->publish(markers_.draw(request.pose.pose, shown, response.success,
                                           response.success ? response.status : response.reason));
    }
  }

  // Each answer is near to where the arm is; where nothing says so, to the last answer.
  void on_target(const messages::PoseStamped& pose) {
    messages::SolveIK::Request request;
    request.pose = pose;
    if (state_topic_->get_publisher_count() > 0) {
      request.near_current = true;
    } else {
      request.near = last_;
    }
    messages::SolveIK::Response response;
    answer(request, response);
    if (!response.success) {
      RCLCPP_WARN_THROTTLE(get_logger(), *get_clock(), kWarningPeriod, "%s",
                           response.reason.c_str());
      return;
    }
    last_ = response.joints;
    answer_topic_->publish(last_);
  }

  void on_state(const messages::JointState& state) {
    try {
      server_.update(state);
    } catch (const iksel::Error& error) {
      RCLCPP_WARN_THROTTLE(get_logger(), *get_clock(), kWarningPeriod, "%s", error.what());
    }
  }

  iksel::Robot robot_;
  IkServer server_;
  Markers markers_;
  messages::JointState last_;
  rclcpp::Publisher<messages::MarkerArray>::SharedPtr marker_topic_;
  rclcpp::Publisher<messages::JointState>::SharedPtr answer_topic_;
  rclcpp::Subscription<messages::JointState>::SharedPtr state_topic_;
  rclcpp::Subscription<messages::PoseStamped>::SharedPtr target_topic_;
  rclcpp::Service<messages::SolveIK>::SharedPtr service_;
};

}  // namespace
}  // namespace iksel_ros

int main(int argc, char** argv) {
  rclcpp::init(argc, argv);
  int status = 0;
  try {
    rclcpp::spin(std::make_shared<iksel_ros::IkNode>());
  } catch (const std::exception& error) {
    RCLCPP_FATAL(rclcpp::get_logger("iksel"), "%s", error.what());
    status = 2;
  }
  rclcpp::shutdown();
  return status;
}
