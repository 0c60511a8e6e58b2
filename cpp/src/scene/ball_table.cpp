// SPDX-License-Identifier: BSD-3-Clause
#include "scene/ball_table.hpp"

#include <algorithm>
#include <cstddef>

#include "scene/bounding_ball.hpp"

namespace iksel {
namespace {

using Spheres = std::vector<Sphere>;

/// Balls of a leaf, at most, and about as many nodes below a node.
constexpr int kFan = 8;

/// Orders spheres `first` to `last - 1` into parts that lie close together, by halves across the
/// longest extent; `ends` gets where each part ends.
void part(Spheres& spheres, int first, int last, int parts, std::vector<int>& ends) {
  if (parts == 1 || last - first <= kFan) {
    ends.push_back(last);
    return;
  }
  const auto at = [&](int i) { return spheres.begin() + i; };
  Eigen::Array3d least = at(first)->centre.array();
  Eigen::Array3d most = least;
  for (auto sphere = at(first); sphere != at(last); ++sphere) {
    least = least.min(sphere->centre.array());
    most = most.max(sphere->centre.array());
  }
  int axis = 0;
  (most - least).maxCoeff(&axis);
  const int middle = first + (last - first) / 2;
  std::nth_element(at(first), at(middle), at(last), [axis](const Sphere& a, const Sphere& b) {
    return a.centre[axis] < b.centre[axis];
  });
  part(spheres, first, middle, parts / 2, ends);
  part(spheres, middle, last, parts / 2, ends);
}

}  // namespace

void BallTable::fill(int node, Spheres& spheres, int first, int last) {
  const auto k = static_cast<std::size_t>(node);
  around_[k] = ball_around(Spheres(spheres.begin() + first, spheres.begin() + last));
  nodes_[k].is_leaf = last - first <= kFan;
  nodes_[k].first = first;
  nodes_[k].count = last - first;
  if (nodes_[k].is_leaf) return;
  std::vector<int> ends;
  part(spheres, first, last, kFan, ends);
  const int below = static_cast<int>(nodes_.size());
  nodes_[k].first = below;
  nodes_[k].count = static_cast<int>(ends.size());
  nodes_.resize(nodes_.size() + ends.size());
  around_.resize(nodes_.size());
  for (std::size_t i = 0; i < ends.size(); ++i) {
    fill(below + static_cast<int>(i), spheres, i == 0 ? first : ends[i - 1], ends[i]);
  }
}

void BallTable::add_ball(const Sphere& sphere) {
  lanes::SceneBall ball{{}, sphere.radius};
  copy_vector(sphere.centre, ball.centre);
  balls_.push_back(ball);
}

int BallTable::add(int body, Spheres spheres) {
  const std::size_t root = nodes_.size();
  nodes_.emplace_back();
  around_.emplace_back();
  fill(static_cast<int>(root), spheres, 0, static_cast<int>(spheres.size()));
  const int first = static_cast<int>(balls_.size());
  for (const Sphere& sphere : spheres) add_ball(sphere);
  for (std::size_t k = root; k < nodes_.size(); ++k) {
    if (nodes_[k].is_leaf) nodes_[k].first += first;
    nodes_[k].ball = static_cast<int>(balls_.size());
    add_ball(around_[k]);
  }
  links_.push_back({body, first, static_cast<int>(spheres.size()), static_cast<int>(root)});
  return static_cast<int>(links_.size()) - 1;
}

Spheres BallTable::spheres_of(const lanes::SceneLink& link) const {
  Spheres spheres;
  for (int b = link.first; b < link.first + link.count; ++b) {
    const lanes::SceneBall& ball = balls_[static_cast<std::size_t>(b)];
    spheres.push_back({to_vector(ball.centre), ball.radius});
  }
  return spheres;
}

void BallTable::show(lanes::SceneView& view) const {
  view.balls = static_cast<int>(balls_.size());
  view.links = static_cast<int>(links_.size());
  view.nodes = static_cast<int>(nodes_.size());
  view.ball = balls_.data();
  view.link = links_.data();
  view.node = nodes_.data();
}

}  // namespace iksel
