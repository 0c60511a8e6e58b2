// SPDX-License-Identifier: BSD-3-Clause
#include "markers.hpp"

#include <map>
#include <utility>

namespace iksel_ros {
namespace {

using messages::Marker;

constexpr double kAxisLength = 0.1;   // [m]
constexpr double kLineWidth = 0.005;  // [m]
constexpr double kLinkWidth = 0.02;   // [m]
constexpr double kTextHeight = 0.04;  // [m]

messages::ColorRGBA color(float r, float g, float b) {
  messages::ColorRGBA c;
  c.r = r;
  c.g = g;
  c.b = b;
  c.a = 1;
  return c;
}

messages::Point point(const Eigen::Vector3d& p) {
  messages::Point message;
  message.x = p.x();
  message.y = p.y();
  message.z = p.z();
  return message;
}

Marker make(const std::string& name, int type, double width) {
  Marker marker;
  marker.ns = name;
  marker.type = type;
  marker.action = Marker::ADD;
  marker.scale.x = width;
  marker.pose.orientation.w = 1;
  return marker;
}

Marker axes(const messages::Pose& target) {
  Marker marker = make("target", Marker::LINE_LIST, kLineWidth);
  marker.pose = target;
  for (int i = 0; i < 3; ++i) {
    marker.points.push_back(point(Eigen::Vector3d::Zero()));
    marker.points.push_back(point(kAxisLength * Eigen::Vector3d::Unit(i)));
    const auto on = [i](int axis) { return i == axis ? 1.0F : 0.0F; };
    marker.colors.insert(marker.colors.end(), 2, color(on(0), on(1), on(2)));
  }
  return marker;
}

}  // namespace

Markers::Markers(const iksel::Robot& robot)
    : robot_(robot), tree_(iksel::LinkTree::from_urdf_string(robot.urdf())) {}

messages::MarkerArray Markers::draw(const messages::Pose& target, const iksel::JointVector& q,
                                    bool success, const std::string& text) const {
  Marker arm = make("arm", Marker::LINE_LIST, kLinkWidth);
  arm.color = success ? color(0, 0.7F, 0) : color(0.8F, 0, 0);
  if (q.size() == 0) {
    arm.action = Marker::DELETE;
  } else {
    std::map<std::string, messages::Point> origins;
    const std::vector<iksel::Pose> poses = robot_.link_poses(q);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      origins[robot_.link_names()[i]] = point(poses[i].translation());
    }
    for (const iksel::LinkTreeJoint& joint : tree_.joints) {
      arm.points.push_back(origins[joint.parent_link]);
      arm.points.push_back(origins[joint.child_link]);
    }
  }

  Marker words = make("reason", Marker::TEXT_VIEW_FACING, 0);
  words.scale.z = kTextHeight;
  words.pose.position = target.position;
  words.color = arm.color;
  words.text = text;

  messages::MarkerArray all;
  all.markers = {axes(target), std::move(arm), std::move(words)};
  for (Marker& marker : all.markers) marker.header.frame_id = robot_.base_link();
  return all;
}

}  // namespace iksel_ros
