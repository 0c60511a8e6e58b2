// SPDX-License-Identifier: BSD-3-Clause
// The strategy of a solver: one of two classes.
#include <string>
#include <variant>

#include "option_fields.hpp"

namespace iksel::python {
namespace {

constexpr const char* kNameKey = "name";
constexpr const char* kLanes = "lanes";
constexpr const char* kPaper = "paper";

Strategy by_name(const std::string& text, const char* name) {
  if (text == kLanes) return Lanes{};
  if (text == kPaper) return Paper{};
  throw InvalidArgumentError(std::string(name) + ": no strategy '" + text +
                             "'; there are: " + kLanes + ", " + kPaper);
}

const StructType& type_of(const Strategy& value) {
  return std::holds_alternative<Lanes>(value) ? struct_type<Lanes>() : struct_type<Paper>();
}

void* held(Strategy& value) {
  return std::visit([](auto& each) -> void* { return &each; }, value);
}
const void* held(const Strategy& value) {
  return std::visit([](const auto& each) -> const void* { return &each; }, value);
}

bool has_field(const StructType& type, const std::string& name) {
  for (const Field& field : type.fields) {
    if (name == field.name) return true;
  }
  return false;
}

}  // namespace

Strategy FromPython<Strategy>::convert(py::handle value, const char* name) {
  if (is_a<Lanes>(value)) return made<Lanes>(value);
  if (is_a<Paper>(value)) return made<Paper>(value);
  if (py::isinstance<py::str>(value)) return by_name(py::cast<std::string>(value), name);
  if (!py::hasattr(value, "keys")) {
    throw_wrong_type(name, "Lanes, Paper, their name, or a mapping of it and fields", value);
  }
  py::dict fields(py::reinterpret_borrow<py::object>(value));
  if (!fields.contains(kNameKey) || !py::isinstance<py::str>(fields[kNameKey])) {
    throw InvalidArgumentError(std::string(name) + ": a mapping needs '" + kNameKey + "', " +
                               kLanes + " or " + kPaper);
  }
  fields = fields.attr("copy")();
  Strategy out = by_name(py::cast<std::string>(fields.attr("pop")(kNameKey)), name);
  assign(held(out), type_of(out), fields);
  return out;
}

py::object ValueOf<Strategy>::get(const Strategy& value, py::handle /*owner*/) {
  return std::visit([](const auto& each) { return py::cast(each); }, value);
}

py::object ValueOf<Strategy>::to_plain(const Strategy& value) {
  py::dict out;
  out[kNameKey] = std::holds_alternative<Lanes>(value) ? kLanes : kPaper;
  out.attr("update")(to_dict(held(value), type_of(value)));
  return out;
}

std::string FieldTable<SolverOptions>::hint(const std::string& name) {
  const bool in_lanes = has_field(struct_type<Lanes>(), name);
  if (!in_lanes && !has_field(struct_type<Paper>(), name)) return "";
  return std::string("; it belongs to the strategy: SolverOptions(strategy=Paper(") + name +
         "=...))" + (in_lanes ? ", or Lanes" : "");
}

}  // namespace iksel::python
