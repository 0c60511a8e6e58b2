// SPDX-License-Identifier: BSD-3-Clause
// The messages of ros/common, as ROS 1 names them.
#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <iksel_ros/SolveIK.h>
#include <sensor_msgs/JointState.h>
#include <visualization_msgs/MarkerArray.h>

namespace iksel_ros::messages {

using geometry_msgs::Point;
using geometry_msgs::Pose;
using geometry_msgs::PoseStamped;
using iksel_ros::SolveIK;
using sensor_msgs::JointState;
using std_msgs::ColorRGBA;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

}  // namespace iksel_ros::messages
