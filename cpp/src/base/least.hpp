// SPDX-License-Identifier: BSD-3-Clause
// The least of many, in order.
#pragma once

#include <array>
#include <cstddef>

namespace iksel {

/// The least of all items that were added, at most so many. Items are ordered by `value`.
template <typename Item, std::size_t kMost>
class Least {
 public:
  void clear() { size_ = 0; }
  void add(const Item& item) {
    if (size_ == kMost && !(item.value < items_[kMost - 1].value)) return;
    if (size_ < kMost) ++size_;
    std::size_t at = size_ - 1;
    for (; at > 0 && item.value < items_[at - 1].value; --at) items_[at] = items_[at - 1];
    items_[at] = item;
  }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const Item& operator[](std::size_t i) const { return items_[i]; }
  [[nodiscard]] const Item* begin() const { return items_.data(); }
  [[nodiscard]] const Item* end() const { return items_.data() + size_; }

 private:
  std::array<Item, kMost> items_{};
  std::size_t size_ = 0;
};

}  // namespace iksel
