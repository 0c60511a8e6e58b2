// SPDX-License-Identifier: BSD-3-Clause
#include "request_keywords.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "angle_warning.hpp"
#include "array_checks.hpp"
#include "filter.hpp"
#include "iksel/path.hpp"
#include "objective.hpp"
#include "pose_arguments.hpp"
#include "sequence_of.hpp"
#include "task_fields.hpp"

namespace iksel::python {

namespace {

/// Numbers of tips; None is -1.
std::vector<int> as_frames(py::handle value, const char* name) {
  std::vector<int> frames;
  for (const py::handle& item :
       read_sequence(value, name, "a list of numbers of tips or None, one for each tip",
                     [](py::handle each, const char* /*name*/) {
                       return py::reinterpret_borrow<py::object>(each);
                     })) {
    frames.push_back(item.is_none() ? -1 : from_python<int>(item, name));
  }
  return frames;
}

/// Configurations, one or an (N, dof) array of them.
std::vector<JointVector> as_seeds(py::handle value, const char* name, int dof) {
  const DoubleArray array = as_doubles(value, name);
  if (array.ndim() == 1 && array.shape(0) == dof) return {as_joints(array, dof, name)};
  if (array.ndim() != 2 || array.shape(1) != dof) {
    const std::string n = std::to_string(dof);
    throw_wrong_shape(name, "a (" + n + ",) or (N, " + n + ") array", array);
  }
  std::vector<JointVector> seeds;
  seeds.reserve(static_cast<std::size_t>(array.shape(0)));
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    check_finite(array.data(i), dof, std::string(name) + "[" + std::to_string(i) + "]");
    seeds.emplace_back(Eigen::Map<const Eigen::VectorXd>(array.data(i), dof));
  }
  return seeds;
}

}  // namespace

template <>
struct ArgumentOf<JointVector> {
  static std::string text() { return "numpy.typing.ArrayLike"; }
  static JointVector read(py::handle given, const char* name, int dof) {
    return as_joints(given, dof, name);
  }
};

template <>
struct ArgumentOf<std::vector<JointVector>> {
  static std::string text() { return "numpy.typing.ArrayLike"; }
  static std::vector<JointVector> read(py::handle given, const char* name, int dof) {
    return as_seeds(given, name, dof);
  }
};

template <>
struct ArgumentOf<std::vector<Task>> {
  static std::string text() {
    return "collections.abc.Sequence[Task | collections.abc.Mapping[str, object]]";
  }
  static std::vector<Task> read(py::handle given, const char* name, int /*dof*/) {
    return read_sequence(given, name, "a list of Tasks, one for each tip", from_python<Task>);
  }
};

template <>
struct ArgumentOf<std::vector<int>> {
  static std::string text() { return "collections.abc.Sequence[int | None]"; }
  static std::vector<int> read(py::handle given, const char* name, int /*dof*/) {
    return as_frames(given, name);
  }
};

template <>
struct ArgumentOf<Filter> {
  static std::string text() {
    return "collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], object]";
  }
  static Filter read(py::handle given, const char* name, int dof) {
    return make_filter(given, name, dof);
  }
};

template <>
struct ArgumentOf<Objective> {
  static std::string text() {
    return "iksel_cpp.Objective | str | collections.abc.Callable[[numpy.ndarray], float]";
  }
  static Objective read(py::handle given, const char* /*name*/, int /*dof*/) {
    return as_objective(given);
  }
};

template <class T>
struct ArgumentOf<std::optional<T>> {
  static std::string text() { return ArgumentOf<T>::text(); }
  static std::optional<T> read(py::handle given, const char* name, int dof) {
    return ArgumentOf<T>::read(given, name, dof);
  }
};

template <>
struct ArgumentOf<std::optional<PoseWeights>> {
  static std::string text() { return "bool | numpy.typing.ArrayLike"; }
  static std::optional<PoseWeights> read(py::handle given, const char* /*name*/, int /*dof*/) {
    return as_closest(given);
  }
};

constexpr const char* kClosestDoc =
    "what a target without an answer gets, with Status.closest: the configuration inside the "
    "limits that is nearest to it, the best of the local minima that a bounded search comes to. "
    "True: a metre counts 1, a radian as the database weighs rotations, by default a quarter of "
    "the arm's reach in metres. Or six weights, of position [1/m] and rotation [1/rad] along the "
    "axes of the task. Of equally near ones the nearest to `near`. Takes some 100 us on top, "
    "whatever the deadline; a scene and a filter refuse it too.";
constexpr const char* kExactDoc =
    "a second opinion on the scene, an iksel.exact.ExactCollision of it: called with candidates "
    "(n, dof) that collide by the scene's spheres, returns n truth values, which of them are free "
    "all the same.";
constexpr const char* kFilterDoc =
    "called with candidates (n, dof), each at the pose, inside the limits and free in the scene; "
    "returns n truth "
    "values. The search continues within its bounds while all are refused. In a batch it is asked "
    "about the first answers of up to 256 targets at once, along a path about one waypoint's.";

template <class Struct>
std::vector<Keyword> criteria_keywords(const char* scene_doc) {
  using S = Struct;
  return {
      keyword<S>("weights", &S::weights,
                 "factor on each joint's part of a move, (dof,), >= 0; None: all 1."),
      keyword<S>("norm", &S::norm, "how a move is measured."),
      keyword<S>("scene", &S::scene, scene_doc),
      keyword<S>("exact", &S::exact, kExactDoc),
      keyword<S>("filter", &S::filter, kFilterDoc),
      keyword<S>("task", &S::task,
                 "what of the pose has to be reached, of several tips of each; None: what the "
                 "solver's options say."),
      keyword<S>("tasks", &S::tasks, "of several tips, a Task for each in the place of `task`."),
      keyword<S>("in_frame_of", &S::in_frame_of,
                 "of several tips, for each the number of the tip in whose frame, that of its TCP, "
                 "its pose is given; None: in the base frame. So two hands keep what they carry "
                 "between them. No tip may follow itself by way of others."),
  };
}

std::optional<PoseWeights> as_closest(py::handle given) {
  if (given.is_none() || given.ptr() == Py_False) return std::nullopt;
  PoseWeights weights;
  if (given.ptr() == Py_True) return weights;
  const DoubleArray six = as_doubles(given, "closest");
  if (six.ndim() != 1 || six.shape(0) != 6) {
    throw_wrong_shape("closest", "True or six weights, of position and rotation", six);
  }
  weights.rotation.emplace();
  std::copy_n(six.data(), 3, weights.position.begin());
  std::copy_n(six.data() + 3, 3, weights.rotation->begin());
  weights.validate();
  return weights;
}

std::vector<Keyword> request_keywords() {
  using R = SolveRequest;
  std::vector<Keyword> all = criteria_keywords<R>(
      "what answers may not collide with; of a robot with the same chains. The search continues "
      "within its bounds while all collide.");
  const std::vector<Keyword> own = {
      keyword<R>(
          "near", &R::near,
          "configuration to stay near, (dof,) [rad or m], for a batch also (N, dof), one for "
          "each target; may lie outside the limits. The answer is the one with the smallest "
          "joint move of all that are found, whole turns considered; a redundant arm's is "
          "moved along its self-motion to where the move is smallest. Angles here, in `seeds` "
          "and in a posture that are too large for a double to tell poses apart to a tenth "
          "of the tolerances are refused: 1.5e8 rad for an arm of six joints and 1 m at the "
          "default tolerances, never less than 100 rad."),
      keyword<R>("seeds", &R::seeds,
                 "joint values to iterate from, (dof,) or (N, dof) [rad or m]; may lie outside the "
                 "limits. They are ranked as the database's seeds, and tried before them: up to "
                 "max_attempts, and as many of the database's on top."),
      keyword<R>(
          "database_seeds", &R::database_seeds,
          "whether other seeds follow the given ones: the database's, random ones, and those "
          "that a closed form gives."),
      keyword<R>(
          "deadline", &R::deadline,
          "wall-clock time after which the search for a target ends [s]; checked between its "
          "stages."),
      keyword<R>(
          "objective", &R::objective,
          "what the answer is to be good at besides: an Objective, 'limits', "
          "'manipulability', or a function of joint values (dof,) that returns a cost. Comes "
          "before `near`. Of the answers found, the cheapest; a redundant arm's is moved along "
          "its self-motion to a local minimum."),
      keyword<R>("closest", &R::closest, kClosestDoc),
      keyword<R>("on_invalid_pose", &R::on_invalid_pose,
                 "what a row does that is no pose (see check_pose): \"status\", "
                 "Status.invalid_pose for it and NaN for its q; \"raise\", an error that names the "
                 "first, and none is solved."),
  };
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

std::vector<Keyword> solve_all_keywords() {
  using O = SolveAllOptions;
  std::vector<Keyword> all = {
      keyword<O>("max", &O::max, "solutions given at most."),
      keyword<O>("min_distance", &O::min_distance,
                 "solutions that differ by less in every joint are one [rad or m]."),
      keyword<O>(
          "whole_turns", &O::whole_turns,
          "whether periodic images inside the limits count as solutions of their own; "
          "otherwise each comes once, at the image nearest to `near` or to the middle of the "
          "limits."),
      keyword<O>(
          "order", &O::order,
          "what comes first; left alone where there is an objective, which decides it then."),
  };
  for (const Keyword& each : request_keywords()) all.push_back(each);
  return all;
}

std::vector<Keyword> path_keywords() {
  using O = PathOptions;
  std::vector<Keyword> all = criteria_keywords<O>(
      "what waypoints may not collide with; the moves between them are not looked at.");
  const std::vector<Keyword> own = {
      keyword<O>("start", &O::start,
                 "where the arm is one time step before the first waypoint, (dof,) [rad or m]; "
                 "None: the path may begin anywhere, and of its periodic images the one that "
                 "begins nearest to the middle of the limits is taken."),
      keyword<O>("dt", &O::dt,
                 "time from one waypoint to the next [s], in which no joint moves farther than its "
                 "velocity limit allows; 0: speeds are not limited."),
      keyword<O>("candidates", &O::candidates, "candidates kept per waypoint at most."),
  };
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

namespace {

/// What a position alone stands for, if it is the same task for all tips; else null.
const Task* common_task(const Solver& solver, const AnswerCriteria& criteria) {
  if (criteria.tasks.empty()) return &task_of(solver, criteria);
  for (const Task& task : criteria.tasks) {
    if (task != criteria.tasks.front()) return nullptr;
  }
  return &criteria.tasks.front();
}

}  // namespace

std::vector<Pose> as_targets(const Solver& solver, py::handle poses,
                             const AnswerCriteria& criteria) {
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

DoubleArray as_rows(const Solver& solver, py::handle poses, const AnswerCriteria& criteria) {
  const int tips = solver.robot().tips();
  if (tips == 1) return as_poses(poses, "poses", common_task(solver, criteria));
  const DoubleArray array = as_doubles(poses, "poses");
  if (array.ndim() != 4 || array.shape(1) != tips || array.shape(2) != 4 || array.shape(3) != 4) {
    throw_wrong_shape("poses", "an (N, " + std::to_string(tips) + ", 4, 4) array", array);
  }
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
