// SPDX-License-Identifier: BSD-3-Clause
// Numbers and tables for people to read.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace iksel::python {

/// "0.0123", with at most `digits` significant digits.
std::string short_number(double value, int digits = 5);

/// "[0.3, -1.2, 1.5]", rounded.
std::string short_numbers(const double* values, std::size_t count);

/// A small HTML table for notebooks; whatever text it is given is escaped.
class HtmlTable {
 public:
  /// Rows that a table of many answers shows.
  static constexpr std::size_t kMostRows = 20;

  HtmlTable(const std::string& caption, const std::vector<std::string>& header);
  void add_row(const std::vector<std::string>& cells);
  /// Says how many rows were left out, if any.
  void add_rest(std::size_t left_out);
  [[nodiscard]] std::string text() const { return body_ + "</tbody></table>"; }

 private:
  std::string body_;
};

}  // namespace iksel::python
