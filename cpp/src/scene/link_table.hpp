// SPDX-License-Identifier: BSD-3-Clause
// The balls of links in trees, and the pairs of links that may not touch, as the kernel of
// collisions takes them.
#pragma once

#include <array>
#include <vector>

#include "base/plain_vector.hpp"
#include "iksel/robot_spheres.hpp"
#include "simd/scene_types.hpp"

namespace iksel {

class LinkTable {
 public:
  /// Adds a link of a body, of one sphere at least, and returns its index.
  int add(int body, std::vector<Sphere> spheres);
  void add_pair(const lanes::ScenePair& pair);

  /// Sets what of a view belongs to the links and pairs; it holds as long as none is added.
  void show(lanes::SceneView& view) const;

  [[nodiscard]] const std::vector<lanes::SceneLink>& links() const { return links_; }
  [[nodiscard]] const std::vector<lanes::ScenePair>& pairs() const { return pairs_; }

 private:
  /// Fills a node, and adds those below it, for spheres `first` to `last - 1` of a link, which it
  /// puts in order.
  void fill(int node, std::vector<Sphere>& spheres, int first, int last);

  std::vector<lanes::SceneLink> links_;
  std::vector<lanes::SceneLinkRun> runs_;
  std::array<std::vector<double>, 4> around_;  ///< as SceneView has it
  std::vector<lanes::SceneNode> nodes_;
  std::vector<lanes::ScenePair> pairs_;
  std::vector<lanes::ScenePairBlock> blocks_;  ///< of pairs
};

}  // namespace iksel
