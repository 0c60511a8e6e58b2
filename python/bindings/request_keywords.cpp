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
#include "task_fields.hpp"

namespace iksel::python {

namespace {

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

constexpr const char* kWeightsDoc =
    "factor on each joint's part of a move, (dof,), >= 0; None: all 1.";
constexpr const char* kNormDoc = "how a move is measured.";
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
  return {
      keyword("near", &R::near,
              "configuration to stay near, (dof,) [rad or m], for a batch also (N, dof), one for "
              "each target; may lie outside the limits. The answer is the one with the smallest "
              "joint move of all that are found, whole turns considered; a redundant arm's is "
              "moved along its self-motion to where the move is smallest. Angles here, in `seeds` "
              "and in a posture that are too large for a double to tell poses apart to a tenth "
              "of the tolerances are refused: 1.5e8 rad for an arm of six joints and 1 m at the "
              "default tolerances, never less than 100 rad."),
      keyword("weights", &R::weights, kWeightsDoc),
      keyword("norm", &R::norm, kNormDoc),
      keyword("seeds", &R::seeds,
              "joint values to iterate from, (dof,) or (N, dof) [rad or m]; may lie outside the "
              "limits. They are ranked as the database's seeds, and tried before them: up to "
              "max_attempts, and as many of the database's on top."),
      keyword("database_seeds", &R::database_seeds,
              "whether other seeds follow the given ones: the database's, random ones, and those "
              "that a closed form gives."),
      keyword("scene", &R::scene,
              "what answers may not collide with; of a robot with the same chain. The search "
              "continues within its bounds while all collide."),
      keyword("exact", &R::exact, kExactDoc),
      keyword("filter", &R::filter, kFilterDoc),
      keyword("deadline", &R::deadline,
              "wall-clock time after which the search for a target ends [s]; checked between its "
              "stages."),
      keyword("task", &R::task,
              "what of the pose has to be reached; None: what the solver's options say."),
      keyword("objective", &R::objective,
              "what the answer is to be good at besides: an Objective, 'limits', "
              "'manipulability', or a function of joint values (dof,) that returns a cost. Comes "
              "before `near`. Of the answers found, the cheapest; a redundant arm's is moved along "
              "its self-motion to a local minimum."),
      keyword("closest", &R::closest, kClosestDoc),
      keyword("on_invalid_pose", &R::on_invalid_pose,
              "what a row does that is no pose (see check_pose): \"status\", "
              "Status.invalid_pose for it and NaN for its q; \"raise\", an error that names the "
              "first, and none is solved."),
  };
}

std::vector<Keyword> solve_all_keywords() {
  using O = SolveAllOptions;
  std::vector<Keyword> all = {
      keyword("max", &O::max, "solutions given at most."),
      keyword("min_distance", &O::min_distance,
              "solutions that differ by less in every joint are one [rad or m]."),
      keyword("whole_turns", &O::whole_turns,
              "whether periodic images inside the limits count as solutions of their own; "
              "otherwise each comes once, at the image nearest to `near` or to the middle of the "
              "limits."),
      keyword("order", &O::order,
              "what comes first; left alone where there is an objective, which decides it then."),
  };
  for (const Keyword& each : request_keywords()) all.push_back(each);
  return all;
}

std::vector<Keyword> path_keywords() {
  using O = PathOptions;
  return {
      keyword("start", &O::start,
              "where the arm is one time step before the first waypoint, (dof,) [rad or m]; "
              "None: the path may begin anywhere, and of its periodic images the one that "
              "begins nearest to the middle of the limits is taken."),
      keyword("dt", &O::dt,
              "time from one waypoint to the next [s], in which no joint moves farther than its "
              "velocity limit allows; 0: speeds are not limited."),
      keyword("weights", &O::weights, kWeightsDoc),
      keyword("norm", &O::norm, kNormDoc),
      keyword("scene", &O::scene,
              "what waypoints may not collide with; the moves between them are not looked at."),
      keyword("exact", &O::exact, kExactDoc),
      keyword("filter", &O::filter, kFilterDoc),
      keyword("candidates", &O::candidates, "candidates kept per waypoint at most."),
  };
}

SolveRequest read_request(const Solver& solver, const Given& given, const char* except) {
  auto request = given.read<SolveRequest>(solver.robot().dof(), except);
  if (request.near) warn_of_degrees(solver.robot(), {*request.near}, "near");
  warn_of_degrees(solver.robot(), request.seeds, "seeds");
  return request;
}

}  // namespace iksel::python
