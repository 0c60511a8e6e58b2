// SPDX-License-Identifier: BSD-3-Clause
#include "fit.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "option_fields.hpp"
#include "signature.hpp"

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

/// The arguments of one overload, without self.
struct Form {
  Names names;
  Names required;
  std::size_t positional = 0;

  explicit Form(const py::detail::function_record& record) {
    const std::size_t own = record.is_method ? 1 : 0;
    positional = record.nargs_pos - own;
    for (std::size_t i = own; i < record.args.size(); ++i) {
      names.emplace_back(record.args[i].name);
      if (!record.args[i].value) required.emplace_back(record.args[i].name);
    }
  }

  /// "(pose, *, near, weights)"
  [[nodiscard]] std::string text() const {
    Names shown = names;
    if (positional < shown.size()) {
      shown.insert(shown.begin() + static_cast<std::ptrdiff_t>(positional), "*");
    }
    return "(" + join(shown) + ")";
  }
};

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

struct MisfitCall {
  std::string function;
  std::vector<Form> forms;
  std::size_t positional;  ///< arguments given by position, without self
  Names keywords;

  [[nodiscard]] Names all_names() const {
    Names all;
    for (const Form& form : forms) {
      for (const std::string& name : form.names) {
        if (!contains(all, name)) all.push_back(name);
      }
    }
    return all;
  }

  /// The sentence, or nothing if the names fit and only a type does not.
  [[nodiscard]] std::string sentence() const {
    const Names known = all_names();
    for (const std::string& keyword : keywords) {
      if (!contains(known, keyword)) return unknown_keyword(keyword, known);
    }
    std::vector<Form> possible;
    for (const Form& form : forms) {
      const bool takes_all =
          std::all_of(keywords.begin(), keywords.end(),
                      [&](const auto& keyword) { return contains(form.names, keyword); });
      if (takes_all) possible.push_back(form);
    }
    if (possible.empty()) return no_form_takes_all();
    return misfit(
        *std::max_element(possible.begin(), possible.end(), [](const Form& a, const Form& b) {
          return std::make_pair(a.positional, a.names.size()) <
                 std::make_pair(b.positional, b.names.size());
        }));
  }

 private:
  [[nodiscard]] std::string unknown_keyword(const std::string& keyword, const Names& known) const {
    std::string hint;
    for (const OtherNames& other : kOtherNames) {
      if (contains(other.names, keyword) && contains(known, other.argument)) hint = other.hint;
    }
    if (hint.empty()) hint = did_you_mean(keyword, known);
    // Of what solves, which is what takes seeds.
    if (hint.empty() && contains(known, "seeds")) hint = of_options(keyword);
    const std::string possible = known.empty() ? "none" : join(known);
    return function + "() has no argument '" + keyword + "'" + hint + " (possible: " + possible +
           ")";
  }

  [[nodiscard]] std::string no_form_takes_all() const {
    std::string text = function + "() does not take " + join(keywords) + " together; possible: ";
    for (std::size_t i = 0; i < forms.size(); ++i) text += (i == 0 ? "" : " or ") + forms[i].text();
    return text;
  }

  [[nodiscard]] std::string misfit(const Form& form) const {
    if (positional > form.positional) {
      const bool one = form.positional == 1;
      // solve(pose, q) had a seed there once.
      const bool has_seeds = one && contains(form.names, "seeds");
      return function + "() takes at most " + std::to_string(form.positional) +
             (one ? " argument" : " arguments") + " by position, got " +
             std::to_string(positional) +
             (has_seeds ? "; write seeds=[q] for where the search begins" : "") +
             "; possible: " + form.text();
    }
    const Names given(form.names.begin(), form.names.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                                   positional, form.names.size())));
    for (const std::string& name : given) {
      if (contains(keywords, name)) return function + "() is given '" + name + "' twice";
    }
    for (const std::string& name : form.required) {
      if (!contains(given, name) && !contains(keywords, name)) {
        return function + "() needs '" + name + "': " + function + form.text();
      }
    }
    return "";
  }
};

std::string type_names(PyObject* const* args, std::size_t count) {
  Names names;
  for (std::size_t i = 0; i < count; ++i) names.emplace_back(Py_TYPE(args[i])->tp_name);
  return join(names);
}

/// As the docstring says it where the types of C++ are not known (method.hpp).
std::string signature_of(const py::detail::function_record& record) {
  const std::string name = record.name;
  for (const auto* r = &record; r != nullptr; r = r->next) {
    const std::string doc = r->doc == nullptr ? "" : r->doc;
    if (doc.rfind(name + "(", 0) == 0) return doc.substr(0, doc.find('\n'));
  }
  return name + record.signature;
}

std::string explain(const py::detail::function_record& record, PyObject* const* args,
                    std::size_t count, const Names& keywords) {
  std::string function = record.name;
  if (record.scope && PyType_Check(record.scope.ptr()) != 0) {
    const auto scope = py::cast<std::string>(record.scope.attr("__name__"));
    function = record.is_constructor ? scope : scope + "." + function;
  }
  const std::size_t own = record.is_method ? 1 : 0;
  MisfitCall call{function, {}, count < own ? 0 : count - own, keywords};
  for (const auto* r = &record; r != nullptr; r = r->next) {
    // One that takes any keyword stands before one that lists them (keywords.hpp).
    if (!r->has_kwargs || r->next == nullptr) call.forms.emplace_back(*r);
  }
  const std::string sentence = call.sentence();
  if (!sentence.empty()) return sentence;
  return function + "() does not take (" + type_names(args, count + keywords.size()) + "); it is " +
         signature_of(record);
}

}  // namespace

void explain_misfit(PyObject* self, PyObject* const* args, Py_ssize_t count,
                    PyObject* keywords) noexcept {
  py::error_already_set original;
  try {
    const auto* record = py::detail::function_record_ptr_from_PyObject(self);
    const std::string words = std::string(record->name) + "(): incompatible ";
    if (py::cast<std::string>(py::str(original.value())).rfind(words, 0) == 0) {
      Names names;
      if (keywords != nullptr) names = py::cast<Names>(py::handle(keywords));
      const std::string text = explain(*record, args, static_cast<std::size_t>(count), names);
      PyErr_SetString(py::module_::import("iksel_cpp").attr("SignatureError").ptr(), text.c_str());
      return;
    }
  } catch (...) {  // the original says enough
  }
  original.restore();
}

}  // namespace iksel::python
