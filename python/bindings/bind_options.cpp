// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"

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

/// Before the options, one of which is a task.
void bind_task(py::module_& m) {
  auto cls = bind_keyword_class<Task>(m, /*writable=*/false);
  def_static(cls, "pose", "", fn<&Task::pose>);
  def_static(cls, "position_only", "", fn<&Task::position_only>);
  def_static(cls, "free_spin", "axis='z'", fn<&Task::free_spin>);
  def_static(cls, "upright", "axis='z'", fn<&Task::upright>);
  def_static(cls, "planar", "normal='z'", fn<&Task::planar>);
  def_static(cls, "box", "position, rotation, frame='tool'", fn<&Task::box>);
  add_properties(cls, "is_full_pose", &Task::is_full_pose, "constrained_axes",
                 &Task::constrained_axes);
  def(cls, "__hash__", "", [](const Task& self) { return py::hash(py::str(to_repr(self))); });
}

}  // namespace

Strategy FromPython<Strategy>::convert(py::handle value, const char* name) {
  if (is_a<Lanes>(value)) return made<Lanes>(value);
  if (is_a<Paper>(value)) return made<Paper>(value);
  if (py::isinstance<py::str>(value)) return by_name(as_text(value, name), name);
  if (!py::hasattr(value, "keys")) {
    throw_wrong_type(name, "Lanes, Paper, their name, or a mapping of it and fields", value);
  }
  py::dict fields(py::reinterpret_borrow<py::object>(value));
  if (!fields.contains(kNameKey) || !py::isinstance<py::str>(fields[kNameKey])) {
    throw InvalidArgumentError(std::string(name) + ": a mapping needs '" + kNameKey + "', " +
                               kLanes + " or " + kPaper);
  }
  fields = fields.attr("copy")();
  Strategy out = by_name(as_text(fields.attr("pop")(kNameKey), name), name);
  std::visit([&](auto& each) { assign(&each, struct_type<Plain<decltype(each)>>(), fields); }, out);
  return out;
}

py::object ValueOf<Strategy>::get(const Strategy& value, py::handle /*owner*/) {
  return std::visit([](const auto& each) { return py::cast(each); }, value);
}

py::object ValueOf<Strategy>::to_plain(const Strategy& value) {
  py::dict out;
  out[kNameKey] = std::holds_alternative<Lanes>(value) ? kLanes : kPaper;
  const auto to_fields = [](const auto& each) {
    return to_dict(&each, struct_type<Plain<decltype(each)>>());
  };
  out.attr("update")(std::visit(to_fields, value));
  return out;
}

void bind_options(py::module_& m) {
  bind_enums<Sampling, Scale, KeyScheme, RotationKey, Ranking, RotationDifference, Iteration,
             Reselection, GrowthStop, TaskFrame, Axis>(m);
  bind_task(m);

  auto database = bind_keyword_class<DatabaseOptions>(m, /*writable=*/true);
  def_static(database, "paper", "year=2025", fn<&DatabaseOptions::paper>);
  def(database, "validate", "", fn<&DatabaseOptions::validate>);

  // Immutable, so that nobody changes the copy that SolverOptions.strategy is.
  auto lanes = bind_keyword_class<Lanes>(m, /*writable=*/false);
  def(lanes, "validate", "", fn<&Lanes::validate>);
  auto paper = bind_keyword_class<Paper>(m, /*writable=*/false);
  def(paper, "validate", "", fn<&Paper::validate>);

  auto solver = bind_keyword_class<SolverOptions>(m, /*writable=*/true);
  def_static(solver, "paper", "year=2025", fn<&SolverOptions::paper>);
  def(solver, "validate", "", fn<&SolverOptions::validate>);
}

}  // namespace iksel::python
