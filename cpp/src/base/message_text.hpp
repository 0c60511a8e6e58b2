// SPDX-License-Identifier: BSD-3-Clause
// The words of error messages: numbers, lists of names, the name that may have been meant, and
// which element of an argument is wrong.
#pragma once

#include <cstddef>
#include <locale>
#include <sstream>
#include <string>
#include <vector>

#include "iksel/types.hpp"

namespace iksel {

/// A stream for messages, whose numbers are the same in every locale.
class MessageStream : public std::ostringstream {
 public:
  MessageStream() { imbue(std::locale::classic()); }
};

/// ASCII letters in lower case.
std::string lower_case(std::string text);

/// A number with that many significant digits, the same in every locale.
std::string number_text(double value, int digits = 6);

/// "1e+09 m; at most 1e+08 can be computed with", of what is beyond kMaxCoordinate.
std::string too_large_text(double value, const std::string& unit = "");

/// "a, b, c" (the first 20, and how many more).
std::string list_names(const std::vector<std::string>& names);

/// Throws UnknownNameError: `problem`, the known names that `name` may mean, and those there are.
[[noreturn]] void throw_unknown_name(const std::string& problem, const std::string& name,
                                     const std::vector<std::string>& known);

/// Throws InvalidArgumentError "name[index]: what"; without the index if that is negative.
[[noreturn]] void throw_invalid(const char* name, std::ptrdiff_t index, const std::string& what);

/// Throws InvalidArgumentError unless q has `dof` finite elements.
void check_joints(const JointVector& q, int dof, const char* name);

}  // namespace iksel
