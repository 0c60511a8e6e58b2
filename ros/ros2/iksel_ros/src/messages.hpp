// SPDX-License-Identifier: BSD-3-Clause
// The messages of ros/common, as ROS 2 names them.
#pragma once

#include <geometry_msgs/msg/pose_stamped.hpp>
#include <iksel_ros/srv/solve_ik.hpp>
#include <sensor_msgs/msg/joint_state.hpp>
#include <visualization_msgs/msg/marker_array.hpp>

namespace iksel_ros::messages {

using geometry_msgs::msg::Point;
using geometry_msgs::msg::Pose;
using geometry_msgs::msg::PoseStamped;
using iksel_ros::srv::SolveIK;
using sensor_msgs::msg::JointState;
using std_msgs::msg::ColorRGBA;
using visualization_msgs::msg::Marker;
using visualization_msgs::msg::MarkerArray;

}  // namespace iksel_ros::messages
