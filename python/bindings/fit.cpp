// SPDX-License-Identifier: BSD-3-Clause
// Why a call does not fit, in a sentence.
#include <pybind11/stl.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "did_you_mean.hpp"
#include "function.hpp"
#include "option_fields.hpp"

namespace iksel::python {

namespace {

using Names = std::vector<std::string>;

bool contains(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string join(const Names& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// What other libraries, and this one once, call something.
struct OtherNames {
  const char* argument;  ///< what it is called here
  Names names;
  const char* hint;
};
const std::vector<OtherNames> kOtherNames = {
    {"seeds",
     {"seed", "q_init", "q0", "x0", "q_start", "initial_guess", "guess", "init", "q_seed",
      "ik_seed", "seed_state", "initial_q"},
     "; write seeds=[q] for where the search begins, or near=q for what the answer is to be close "
     "to"},
    {"deadline",
     {"timeout", "time_out", "timeout_s", "time_limit", "max_time"},
     "; write deadline=... for after how many seconds the search ends"},
};

/// Where a keyword belongs that is a field of the solver's options; or nothing.
std::string of_options(const std::string& keyword) {
  Names names;
  for (const Field& field : struct_type<SolverOptions>().fields) names.emplace_back(field.name);
  std::string fields =
      contains(names, keyword) ? "'" + keyword + "'" : did_you_mean(keyword, names);
  const std::size_t quote = fields.find('\'');
  if (quote == std::string::npos) return "";
  fields = fields.substr(quote, fields.rfind('\'') + 1 - quote);
  return "; the solver's options have " + fields + ": Solver(robot, SolverOptions(...))";
}

/// A call that does not fit.
struct Misfit {
  const Function& function;
  std::size_t count;  ///< of arguments by position
  Names keywords;
  Names known;

  /// "(pose, *, near, weights)"
  [[nodiscard]] std::string form() const {
    Names shown = known;
    if (function.positional < shown.size()) {
      shown.insert(shown.begin() + static_cast<std::ptrdiff_t>(function.positional), "*");
    }
    return "(" + join(shown) + ")";
  }

  [[nodiscard]] std::string unknown(const std::string& keyword) const {
    std::string hint;
    for (const OtherNames& other : kOtherNames) {
      if (contains(other.names, keyword) && contains(known, other.argument)) hint = other.hint;
    }
    if (hint.empty()) hint = did_you_mean(keyword, known);
    // Of what solves, which is what takes seeds.
    if (hint.empty() && contains(known, "seeds")) hint = of_options(keyword);
    return "has no argument '" + keyword + "'" + hint +
           " (possible: " + (known.empty() ? "none" : join(known)) + ")";
  }

  [[nodiscard]] std::string too_many() const {
    const bool one = function.positional == 1;
    // solve(pose, q) had a seed there once.
    const bool has_seeds = one && contains(known, "seeds");
    return "takes at most " + std::to_string(function.positional) +
           (one ? " argument" : " arguments") + " by position, got " + std::to_string(count) +
           (has_seeds ? "; write seeds=[q] for where the search begins" : "") +
           "; possible: " + form();
  }

  [[nodiscard]] std::string sentence() const {
    for (const std::string& keyword : keywords) {
      if (!contains(known, keyword)) return unknown(keyword);
    }
    if (count > function.positional) return too_many();
    for (std::size_t i = 0; i < known.size(); ++i) {
      const bool is_named = contains(keywords, known[i]);
      if (i < count && is_named) return "is given '" + known[i] + "' twice";
      if (i < count || is_named || function.parameters[i].by_default) continue;
      return "needs '" + known[i] + "': " + function.full_name() + form();
    }
    return "is called with what does not fit";
  }
};

}  // namespace

std::string Function::full_name() const {
  if (name == "__init__") return owner;
  return owner.empty() ? name : owner + "." + name;
}

void Function::refuse(std::size_t count, PyObject* keywords) const {
  Misfit misfit{*this, count, {}, {}};
  if (keywords != nullptr) misfit.keywords = py::cast<Names>(py::handle(keywords));
  for (const Parameter& parameter : parameters) misfit.known.push_back(parameter.name);
  throw SignatureError(full_name() + "() " + misfit.sentence());
}

void Function::check_self(PyObject* const* arguments, std::size_t count, PyTypeObject* type) const {
  if (count > 0 && PyObject_TypeCheck(arguments[0], type) != 0) return;
  if (count == 0) throw SignatureError(full_name() + "() needs 'self', a " + owner);
  throw SignatureError(full_name() + "() is of a " + owner + ", not of " + describe(arguments[0]));
}

}  // namespace iksel::python
