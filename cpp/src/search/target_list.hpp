// SPDX-License-Identifier: BSD-3-Clause
// Numbers of the targets of a part of a batch: those that a stage is to solve, or has left.
#pragma once

#include <array>
#include <cstddef>

namespace iksel {

class TargetList {
 public:
  /// Most targets of one list.
  static constexpr std::size_t kMost = 256;

  void add(std::size_t target) { targets_[size_++] = target; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t operator[](std::size_t i) const { return targets_[i]; }
  [[nodiscard]] const std::size_t* begin() const { return targets_.data(); }
  [[nodiscard]] const std::size_t* end() const { return targets_.data() + size_; }

 private:
  std::array<std::size_t, kMost> targets_;
  std::size_t size_ = 0;
};

}  // namespace iksel
