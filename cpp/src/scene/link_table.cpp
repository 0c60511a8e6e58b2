// SPDX-License-Identifier: BSD-3-Clause
#include "scene/link_table.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace iksel {
namespace {

using Spheres = std::vector<Sphere>;

lanes::SceneBall to_ball(const Sphere& sphere) {
  lanes::SceneBall ball{{}, sphere.radius};
  copy_vector(sphere.centre, ball.centre);
  return ball;
}

/// A ball around the spheres, of which there is one at least: close to the smallest (steps towards
/// the farthest, ever smaller: Badoiu and Clarkson, "Smaller core-sets for balls", 2003).
Sphere ball_around(const Spheres& spheres) {
  if (spheres.size() == 1) return spheres.front();
  const auto reach = [](const Eigen::Vector3d& from, const Sphere& to) {
    return (to.centre - from).norm() + to.radius;
  };
  Sphere ball{spheres.front().centre, 0};
  const auto farthest = [&] {
    return *std::max_element(spheres.begin(), spheres.end(), [&](const auto& a, const auto& b) {
      return reach(ball.centre, a) < reach(ball.centre, b);
    });
  };
  for (int i = 1; i <= 200; ++i) {
    const Sphere far = farthest();
    const Eigen::Vector3d way = far.centre - ball.centre;
    const double distance = way.norm();
    // Towards the point of that sphere that is farthest away.
    if (distance > 0) ball.centre += way * ((1 + far.radius / distance) / (i + 1));
  }
  // Rounding included.
  ball.radius = reach(ball.centre, farthest()) * (1 + 1e-12);
  return ball;
}

/// Orders spheres `first` to `last - 1` into parts that lie close together, by halves across the
/// longest extent; `ends` gets where each part ends.
void part(Spheres& spheres, int first, int last, int parts, std::vector<int>& ends) {
  if (parts == 1 || last - first <= lanes::kWidth) {
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

void LinkTable::fill(int node, Spheres& spheres, int first, int last) {
  std::vector<int> ends;
  const bool is_leaf = last - first <= lanes::kWidth;
  if (is_leaf) {
    for (int i = first; i < last; ++i) ends.push_back(i + 1);
  } else {
    part(spheres, first, last, lanes::kWidth, ends);
  }
  const auto count = static_cast<int>(ends.size());
  const int below = is_leaf ? first : static_cast<int>(nodes_.size());
  nodes_[static_cast<std::size_t>(node)].first = below;
  nodes_[static_cast<std::size_t>(node)].count = count;
  nodes_[static_cast<std::size_t>(node)].is_leaf = is_leaf;
  if (!is_leaf) nodes_.resize(nodes_.size() + ends.size());
  for (int k = 0, begin = first; k < count; begin = ends[static_cast<std::size_t>(k++)]) {
    const int end = ends[static_cast<std::size_t>(k)];
    const Sphere around = ball_around(Spheres(spheres.begin() + begin, spheres.begin() + end));
    lanes::SceneNode& at = nodes_[static_cast<std::size_t>(node)];
    at.x[k] = around.centre.x();
    at.y[k] = around.centre.y();
    at.z[k] = around.centre.z();
    at.radius[k] = around.radius;
    if (!is_leaf) fill(below + k, spheres, begin, end);
  }
}

int LinkTable::add(int body, Spheres spheres) {
  const std::size_t root = nodes_.size();
  nodes_.emplace_back();
  const lanes::SceneBall around = to_ball(ball_around(spheres));
  fill(static_cast<int>(root), spheres, 0, static_cast<int>(spheres.size()));
  links_.push_back({body, static_cast<int>(root), around});
  const std::size_t link = links_.size() - 1;
  if (runs_.empty() || runs_.back().body != body)
    runs_.push_back({body, static_cast<int>(link), 0});
  ++runs_.back().count;
  for (std::size_t i = 0; i < around_.size(); ++i) {
    around_[i].resize(links_.size() + lanes::kWidth);
    around_[i][link] = i < 3 ? around.centre[i] : around.radius;
  }
  return static_cast<int>(link);
}

void LinkTable::add_pair(const lanes::ScenePair& pair) {
  const auto block_of = [&](int one, int other) {
    return std::find_if(blocks_.begin(), blocks_.end(), [&](const lanes::ScenePairBlock& block) {
      return block.one == one && block.first == other / lanes::kWidth * lanes::kWidth;
    });
  };
  // Either link can be the one that others are held against: few blocks are few to look at.
  int one = pair.a;
  int other = pair.b;
  auto block = block_of(one, other);
  if (block == blocks_.end() && block_of(other, one) != blocks_.end()) {
    std::swap(one, other);
    block = block_of(one, other);
  }
  if (block == blocks_.end()) {
    blocks_.push_back({one, other / lanes::kWidth * lanes::kWidth, 0, {}});
    block = blocks_.end() - 1;
  }
  const int lane = other - block->first;
  block->mask |= 1U << static_cast<unsigned>(lane);
  block->pair[lane] = static_cast<int>(pairs_.size());
  pairs_.push_back(pair);
}

void LinkTable::show(lanes::SceneView& view) const {
  view.links = static_cast<int>(links_.size());
  view.link = links_.data();
  view.link_runs = static_cast<int>(runs_.size());
  view.link_run = runs_.data();
  for (std::size_t i = 0; i < around_.size(); ++i) view.around[i] = around_[i].data();
  view.node = nodes_.data();
  view.pairs = static_cast<int>(pairs_.size());
  view.pair = pairs_.data();
  view.pair_blocks = static_cast<int>(blocks_.size());
  view.pair_block = blocks_.data();
}

}  // namespace iksel
