// SPDX-License-Identifier: BSD-3-Clause
#include "html.hpp"

#include <iomanip>
#include <locale>
#include <sstream>

namespace iksel::python {

namespace {

std::string escape(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string row(const std::vector<std::string>& cells, const std::string& tag) {
  std::string out = "<tr>";
  for (const std::string& cell : cells) out += "<" + tag + ">" + escape(cell) + "</" + tag + ">";
  return out + "</tr>";
}

}  // namespace

std::string short_number(double value, int digits) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::setprecision(digits) << value;
  return text.str();
}

std::string short_numbers(const double* values, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += (i == 0 ? "" : ", ") + short_number(values[i]);
  return "[" + text + "]";
}

HtmlTable::HtmlTable(const std::string& caption, const std::vector<std::string>& header)
    : body_("<table><caption>" + escape(caption) + "</caption><thead>" + row(header, "th") +
            "</thead><tbody>") {}

void HtmlTable::add_row(const std::vector<std::string>& cells) { body_ += row(cells, "td"); }

void HtmlTable::add_rest(std::size_t left_out) {
  if (left_out > 0) add_row({"... and " + std::to_string(left_out) + " more"});
}

}  // namespace iksel::python
