// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace iksel {

/// XXH3 (64 bits) of a block of bytes.
std::uint64_t checksum(const void* bytes, std::size_t size);

/// Hash over a list of numbers, the same on every platform.
class Hash64 {
 public:
  void add(std::uint64_t value) {
    for (int i = 0; i < 8; ++i) bytes_.push_back(static_cast<unsigned char>(value >> (8 * i)));
  }
  void add(double value) {
    // Zero has one hash, whatever its sign.
    if (value == 0) value = 0;
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    add(bits);
  }
  [[nodiscard]] std::uint64_t value() const { return checksum(bytes_.data(), bytes_.size()); }

 private:
  std::vector<unsigned char> bytes_;
};

}  // namespace iksel
