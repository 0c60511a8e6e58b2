// SPDX-License-Identifier: BSD-3-Clause
// What the options' validate() share.
#pragma once

#include <algorithm>

#include "base/message_text.hpp"
#include "iksel/error.hpp"

namespace iksel {

/// Throws unless low <= value <= high; NaN fails.
template <typename T>
void check_range(const char* name, T value, T low, T high) {
  if (value >= low && value <= high) return;
  MessageStream text;
  text << "option " << name << ": " << value << " is not in " << low << " .. " << high;
  throw InvalidArgumentError(text.str());
}

/// The same for an enum whose last value is `last`.
template <typename Enum>
void check_enum(const char* name, Enum value, Enum last) {
  check_range(name, static_cast<int>(value), 0, static_cast<int>(last));
}

}  // namespace iksel
