// SPDX-License-Identifier: BSD-3-Clause
#include "base/message_text.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "iksel/error.hpp"

namespace iksel {
namespace {

/// Number of characters to insert, remove or replace between two words (Levenshtein 1966).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  const std::size_t longer = std::max(a.size(), b.size());
  if (longer > 100) return longer;  // it takes the product of the lengths
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row[b.size()];
}

/// Up to three known names that `name` may mean, the most alike first: a third of the characters
/// may differ, or one contains the other, if that is no shorter than three characters.
std::vector<std::string> similar_names(const std::string& name,
                                       const std::vector<std::string>& known) {
  const std::string wanted = lower_case(name);
  std::vector<std::pair<std::size_t, std::string>> found;
  for (const std::string& candidate : known) {
    const std::string have = lower_case(candidate);
    const std::size_t distance = edit_distance(wanted, have);
    const bool contained =
        std::min(wanted.size(), have.size()) >= 3 &&
        (have.find(wanted) != std::string::npos || wanted.find(have) != std::string::npos);
    if (contained || distance <= wanted.size() / 3) found.emplace_back(distance, candidate);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> names;
  for (std::size_t i = 0; i < found.size() && i < 3; ++i) names.push_back(found[i].second);
  return names;
}

}  // namespace

std::string lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

std::string number_text(double value, int digits) {
  MessageStream text;
  text.precision(digits);
  text << value;
  return text.str();
}

std::string too_large_text(double value, const std::string& unit) {
  return number_text(value) + (unit.empty() ? "" : " " + unit) + "; at most " +
         number_text(kMaxCoordinate) + " can be computed with";
}

void throw_unknown_name(const std::string& problem, const std::string& name,
                        const std::vector<std::string>& known) {
  std::string hint;
  for (const std::string& similar : similar_names(name, known)) {
    hint += (hint.empty() ? "did you mean '" : " or '") + similar + "'";
  }
  throw UnknownNameError(
      problem + "; " + (hint.empty() ? "it has: " : hint + "? It has: ") + list_names(known),
      known);
}

std::string list_names(const std::vector<std::string>& names) {
  const std::size_t listed = std::min<std::size_t>(names.size(), 20);
  std::string text;
  for (std::size_t i = 0; i < listed; ++i) text += (i > 0 ? ", " : "") + names[i];
  if (listed < names.size()) text += " and " + std::to_string(names.size() - listed) + " more";
  return text;
}

void throw_invalid(const char* name, std::ptrdiff_t index, const std::string& what) {
  std::string text = name;
  if (index >= 0) text += "[" + std::to_string(index) + "]";
  throw InvalidArgumentError(text + ": " + what);
}

void check_joints(const JointVector& q, int dof, const char* name) {
  if (q.size() != dof) {
    throw_invalid(
        name, -1,
        "expected " + std::to_string(dof) + " joint values, got " + std::to_string(q.size()));
  }
  for (int i = 0; i < dof; ++i) {
    if (!std::isfinite(q[i])) throw_invalid(name, i, "not finite");
  }
}

}  // namespace iksel
