// SPDX-License-Identifier: BSD-3-Clause
#include "keywords.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "angle_warning.hpp"

namespace iksel::python {

namespace {

/// "    name: text", in lines of at most 100 columns; a sentence's first word begins small.
std::string argument_doc(const char* name, std::string text) {
  constexpr std::size_t kWidth = 100;
  std::string lines;
  std::string line = std::string("    ") + name + ":";
  if (std::islower(text[1]) != 0 || text[1] == ' ')
    text[0] = static_cast<char>(std::tolower(text[0]));
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (line.size() + 1 + word.size() > kWidth) {
      lines += line + "\n";
      line = std::string(7, ' ');
    }
    line += " " + word;
  }
  return lines + line + "\n";
}

}  // namespace

py::handle Given::operator[](const char* name) const {
  for (std::size_t i = 0; i < keywords_.size(); ++i) {
    const auto& [field, by_default, of] = keywords_[i];
    if (std::strcmp(field.name, name) == 0) return is_empty() ? py::handle(by_default) : values_[i];
  }
  throw std::logic_error(std::string("no keyword ") + name);
}

void Given::read_into(void* out, const std::type_info& type, int dof, const char* except) const {
  for (std::size_t i = 0; i < keywords_.size() && !is_empty(); ++i) {
    const auto& [field, by_default, of] = keywords_[i];
    if (values_[i].ptr() == by_default.ptr() || *of != type) continue;
    if (std::strcmp(field.name, except) == 0) continue;
    field.type->set(field.of(out), values_[i], field.name, dof);
  }
}

void KeywordMethod::describe(const MethodText& text, const std::string& result,
                             const std::vector<Keyword>& known,
                             const std::vector<const char*>& names, std::size_t positional) {
  function.name = text.name;
  function.owner = "Solver";
  function.positional = 1 + positional;
  function.parameters.push_back(new_parameter(text.pose, "numpy.typing.ArrayLike | object", {}));
  std::string doc = std::string(text.summary) + "\n\nArgs:\n";
  doc += argument_doc(text.pose, text.pose_doc);
  for (const char* name : names) {
    const auto keyword = std::find_if(known.begin(), known.end(), [&](const Keyword& each) {
      return std::strcmp(each.field.name, name) == 0;
    });
    if (keyword == known.end()) throw std::logic_error(std::string("no keyword ") + name);
    const py::object& value = keyword->by_default;
    const std::string& type = keyword->field.type->argument;
    function.parameters.push_back(
        new_parameter(name, value.is_none() ? or_none(type) : type, value));
    keywords.push_back(*keyword);
    doc += argument_doc(name, keyword->field.doc);
  }
  if (function.parameters.size() > kMostArguments) throw std::logic_error("too many keywords");
  function.doc = docstring(function, "Solver", result, doc + "\n" + text.rest);
}

using Closest = FromPython<std::optional<PoseWeights>>;

std::optional<PoseWeights> Closest::convert(py::handle value, const char* name) {
  if (value.is_none() || value.ptr() == Py_False) return std::nullopt;
  PoseWeights weights;
  if (value.ptr() == Py_True) return weights;
  const DoubleArray six =
      as_shaped(value, name, {6}, "True or six weights, of position and rotation");
  weights.rotation.emplace();
  std::copy_n(six.data(), 3, weights.position.begin());
  std::copy_n(six.data() + 3, 3, weights.rotation->begin());
  weights.validate();
  return weights;
}

py::object Closest::show(const std::optional<PoseWeights>& weights) {
  if (!weights) return py::none();
  if (!weights->rotation) return py::bool_(true);
  std::vector<double> six(weights->position.begin(), weights->position.end());
  six.insert(six.end(), weights->rotation->begin(), weights->rotation->end());
  return to_array(six);
}

namespace {

/// What a position alone stands for, if it is the same task for all tips; else null.
const Task* common_task(const Solver& solver, const TargetCriteria& criteria) {
  if (criteria.tasks.empty()) return &task_of(solver, criteria);
  for (const Task& task : criteria.tasks) {
    if (task != criteria.tasks.front()) return nullptr;
  }
  return &criteria.tasks.front();
}

}  // namespace

std::vector<Pose> as_targets(const Solver& solver, py::handle poses,
                             const TargetCriteria& criteria) {
  const int tips = solver.robot().tips();
  if (tips == 1) return {as_pose(poses, "pose", common_task(solver, criteria))};
  if (is_doubles(poses)) {
    const auto array = py::reinterpret_borrow<DoubleArray>(poses);
    if (array.ndim() == 4 || (array.ndim() == 2 && array.shape(1) == 4)) {
      throw_wrong_shape("pose", "one pose for each tip, (" + std::to_string(tips) + ", 4, 4)",
                        array, "; solve_batch() takes (N, k, 4, 4)");
    }
  }
  return to_poses(as_poses(poses, "pose", common_task(solver, criteria)));
}

DoubleArray as_rows(const Solver& solver, py::handle poses, const TargetCriteria& criteria) {
  const int tips = solver.robot().tips();
  const bool is_sequence = py::isinstance<py::list>(poses) || py::isinstance<py::tuple>(poses);
  // One of none has no shape.
  if (is_sequence && py::len(poses) == 0) return DoubleArray({0, 4, 4});
  if (tips == 1) return as_poses(poses, "poses", common_task(solver, criteria));
  const std::string expected = "an (N, " + std::to_string(tips) + ", 4, 4) array";
  const DoubleArray array = as_shaped(poses, "poses", {-1, tips, 4, 4}, expected.c_str());
  const std::vector<py::ssize_t> shape = {array.shape(0) * tips, 4, 4};
  return py::array(array).reshape(shape);
}

SolveRequest read_request(const Solver& solver, const Given& given, const char* except) {
  auto request = given.read<SolveRequest>(solver.robot().dof(), except);
  if (request.near) warn_of_degrees(solver.robot(), {*request.near}, "near");
  warn_of_degrees(solver.robot(), request.seeds, "seeds");
  return request;
}

}  // namespace iksel::python
