// SPDX-License-Identifier: BSD-3-Clause
// The pairs of links that may not touch, as the kernel of collisions takes them.
#pragma once

#include <vector>

#include "simd/scene_types.hpp"

namespace iksel {

class PairTable {
 public:
  void add(const lanes::ScenePair& pair);

  /// Sets what of a view belongs to the pairs; it holds as long as none is added.
  void show(lanes::SceneView& view) const;

  [[nodiscard]] const std::vector<lanes::ScenePair>& pairs() const { return pairs_; }

 private:
  std::vector<lanes::ScenePair> pairs_;
  std::vector<lanes::ScenePairBlock> blocks_;
};

}  // namespace iksel
