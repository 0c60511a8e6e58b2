// SPDX-License-Identifier: BSD-3-Clause
// The C++ enums as Python enums: one table of names per enum, from which the Python class, the
// parsing of names and the error messages follow.
#pragma once

#include <pybind11/native_enum.h>
#include <pybind11/pybind11.h>

#include <string>
#include <type_traits>

#include "iksel/dh.hpp"
#include "iksel/diagnosis.hpp"
#include "iksel/options.hpp"
#include "iksel/request.hpp"
#include "iksel/result.hpp"
#include "iksel/robot.hpp"
#include "iksel/self_motion.hpp"
#include "iksel/structure.hpp"

namespace iksel::python {

namespace py = pybind11;

template <class E>
struct EnumValue {
  const char* name;
  E value;
  const char* doc;
};

/// Specialised for every bound enum: kName, kDoc, kValues.
template <class E>
struct EnumTable;

template <>
struct EnumTable<Kinematics> {
  static constexpr const char* kName = "Kinematics";
  static constexpr const char* kDoc =
      "Which implementation computes forward kinematics and Jacobians; they agree to 1e-12.";
  static constexpr EnumValue<Kinematics> kValues[] = {
      {"kernel", Kinematics::kernel, "the library's flattened chain"},
      {"kdl", Kinematics::kdl, "Orocos KDL, the reference"},
  };
};

template <>
struct EnumTable<JointType> {
  static constexpr const char* kName = "JointType";
  static constexpr const char* kDoc = "How a degree of freedom moves.";
  static constexpr EnumValue<JointType> kValues[] = {
      {"revolute", JointType::revolute, "turns between limits [rad]"},
      {"continuous", JointType::continuous, "turns without limits [rad]"},
      {"prismatic", JointType::prismatic, "slides between limits [m]"},
  };
};

template <>
struct EnumTable<DhConvention> {
  static constexpr const char* kName = "DhConvention";
  static constexpr const char* kDoc =
      "How a row of Denavit and Hartenberg's parameters places the next frame.";
  static constexpr EnumValue<DhConvention> kValues[] = {
      {"standard", DhConvention::standard,
       "Rz(theta) Tz(d) Tx(a) Rx(alpha): Denavit and Hartenberg, Siciliano, Spong"},
      {"modified", DhConvention::modified,
       "Rx(alpha) Tx(a) Rz(theta) Tz(d): Craig; a and alpha of the link before"},
  };
};

template <>
struct EnumTable<StructureKind> {
  static constexpr const char* kName = "StructureKind";
  static constexpr const char* kDoc = "How the solutions of a pose can be found.";
  static constexpr EnumValue<StructureKind> kValues[] = {
      {"closed_form", StructureKind::closed_form,
       "all of them in closed form: that there is none is proven"},
      {"swept", StructureKind::swept,
       "by equations for each value of one joint, which is swept over its range"},
      {"searched", StructureKind::searched, "by search only"},
  };
};

template <>
struct EnumTable<ArcEnd> {
  static constexpr const char* kName = "ArcEnd";
  static constexpr const char* kDoc = "What ends an arc of a self-motion.";
  static constexpr EnumValue<ArcEnd> kValues[] = {
      {"limit", ArcEnd::limit, "a joint is at its limit"},
      {"fold", ArcEnd::fold, "branches merge in a singularity, from which no way on was found"},
      {"closed", ArcEnd::closed, "nothing does: the last configuration leads on to the first"},
  };
};

template <>
struct EnumTable<Sampling> {
  static constexpr const char* kName = "Sampling";
  static constexpr const char* kDoc =
      "How the joint samples of a database are spread over the limits.";
  static constexpr EnumValue<Sampling> kValues[] = {
      {"grid", Sampling::grid, "Cartesian product of interior points (the paper)"},
      {"cvt", Sampling::cvt, "centroidal Voronoi tessellation, MacQueen updates"},
      {"low_discrepancy", Sampling::low_discrepancy, "additive recurrence R_d"},
      {"random", Sampling::random, "uniform, seeded"},
  };
};

template <>
struct EnumTable<Scale> {
  static constexpr const char* kName = "Scale";
  static constexpr const char* kDoc =
      "Size of a grid, and of other samplings whose `samples` is 0 (paper, database sizes).";
  static constexpr EnumValue<Scale> kValues[] = {
      {"small", Scale::small, "12,000 samples for 6 joints"},
      {"medium", Scale::medium, "40,320 samples for 6 joints"},
      {"large", Scale::large, "151,200 samples for 6 joints"},
  };
};

template <>
struct EnumTable<KeyScheme> {
  static constexpr const char* kName = "KeyScheme";
  static constexpr const char* kDoc = "What of a pose the database's key holds.";
  static constexpr EnumValue<KeyScheme> kValues[] = {
      {"full", KeyScheme::full, "position and rotation (the paper)"},
      {"reduced", KeyScheme::reduced,
       "what the first and last joint cannot change, so that they need no samples"},
  };
};

template <>
struct EnumTable<RotationKey> {
  static constexpr const char* kName = "RotationKey";
  static constexpr const char* kDoc =
      "How the KD-tree's key writes the rotation of a pose (paper, footnote 1).";
  static constexpr EnumValue<RotationKey> kValues[] = {
      {"rotation_vector", RotationKey::rotation_vector, "3 numbers [rad]"},
      {"quaternion", RotationKey::quaternion, "4 numbers (w, x, y, z), w >= 0"},
      {"matrix", RotationKey::matrix, "9 numbers"},
      {"euler", RotationKey::euler, "3 numbers, roll-pitch-yaw [rad]"},
      {"dual_quaternion", RotationKey::dual_quaternion,
       "8 numbers for the whole pose, position included: the real part r (w, x, y, z), w >= 0, "
       "of a unit dual quaternion, and its dual part, half the product of the position and r "
       "[m]"},
  };
};

template <>
struct EnumTable<Ranking> {
  static constexpr const char* kName = "Ranking";
  static constexpr const char* kDoc = "How the neighbours of a target are put in order.";
  static constexpr EnumValue<Ranking> kValues[] = {
      {"nearest", Ranking::nearest, "distance of the keys, Eq. (2) of the paper"},
      {"joint_adjustment", Ranking::joint_adjustment,
       "norm of J^+ (x_target - x_i), Eq. (5) of the paper"},
  };
};

template <>
struct EnumTable<RotationDifference> {
  static constexpr const char* kName = "RotationDifference";
  static constexpr const char* kDoc =
      "The rotation part of x_target - x_i in Eq. (4) of the paper.";
  static constexpr EnumValue<RotationDifference> kValues[] = {
      {"rotation_vector", RotationDifference::rotation_vector, "w_target - w_i, as in the paper"},
      {"geodesic", RotationDifference::geodesic,
       "rotvec(R_target R_i^T), the same error that iterations reduce"},
  };
};

template <>
struct EnumTable<Iteration> {
  static constexpr const char* kName = "Iteration";
  static constexpr const char* kDoc = "One scheme of numerical iteration (paper, Table II).";
  static constexpr EnumValue<Iteration> kValues[] = {
      {"dls", Iteration::dls, "damped least squares; truncated least squares if `damping` is 0"},
      {"pinv", Iteration::pinv, "truncated pseudo-inverse"},
      {"pinv_rr", Iteration::pinv_rr,
       "as pinv; restarts at random on a limit violation or local minimum"},
      {"cwln", Iteration::cwln, "clamping weighted least-norm (Huang et al. 2016)"},
      {"cwpi", Iteration::cwpi, "as cwln with the truncated pseudo-inverse"},
      {"lm", Iteration::lm, "Levenberg-Marquardt with the limits inside the step"},
  };
};

template <>
struct EnumTable<Reselection> {
  static constexpr const char* kName = "Reselection";
  static constexpr const char* kDoc = "Which seed follows a failed one.";
  static constexpr EnumValue<Reselection> kValues[] = {
      {"none", Reselection::none, "give up after the first"},
      {"next", Reselection::next, "the next in the ranking"},
      {"farthest", Reselection::farthest,
       "the candidate farthest in joint space from the failed ones (the paper)"},
  };
};

template <>
struct EnumTable<GrowthStop> {
  static constexpr const char* kName = "GrowthStop";
  static constexpr const char* kDoc = "Whether an attempt is given up when both errors have grown.";
  static constexpr EnumValue<GrowthStop> kValues[] = {
      {"by_scheme", GrowthStop::by_scheme,
       "yes for dls, pinv and pinv_rr; no for cwln and cwpi, as the paper's text says (its "
       "reference implementation gives cwpi up, too), and for lm"},
      {"on", GrowthStop::on, "always"},
      {"off", GrowthStop::off, "never"},
  };
};

template <>
struct EnumTable<Status> {
  static constexpr const char* kName = "Status";
  static constexpr const char* kDoc = "Why a solve ended.";
  static constexpr EnumValue<Status> kValues[] = {
      {"solved", Status::solved,
       "q reaches the target within both tolerances and lies inside the limits"},
      {"not_converged", Status::not_converged,
       "no attempt reached the tolerances within the allowed work; Result.proof may say that none "
       "can"},
      {"outside_limits", Status::outside_limits,
       "attempts reached the target, but only with joints outside their limits"},
      {"out_of_reach", Status::out_of_reach,
       "the target's position is farther away than the arm is long; nothing was tried"},
      {"rejected", Status::rejected,
       "attempts reached the target inside the limits, but the filter refused each"},
      {"out_of_time", Status::out_of_time, "the deadline passed before an answer was found"},
      {"too_fast", Status::too_fast,
       "answers exist, but joints would have to move faster than their velocity limits"},
      {"invalid_pose", Status::invalid_pose,
       "the target is no pose; in batches only, for a single pose it is an error"},
      {"closest", Status::closest,
       "no answer, but q is nearest to one: for those who ask for `closest`"},
      {"in_collision", Status::in_collision,
       "attempts reached the target inside the limits, but each collides in the scene"},
  };
};

template <>
struct EnumTable<Proof> {
  static constexpr const char* kName = "Proof";
  static constexpr const char* kDoc =
      "What makes sure of what a result says: of one without an answer that there is none, of a "
      "set of solutions that there are no others.";
  static constexpr EnumValue<Proof> kValues[] = {
      {"none", Proof::none, "nothing does: no answer was found by a search"},
      {"reach", Proof::reach, "the target lies farther away than the links are long together"},
      {"closed_form", Proof::closed_form,
       "all branches are known (Robot.structure), and no other lies inside the limits; of seven "
       "joints, all ends of curves of solutions, and there are none inside"},
      {"sweep", Proof::sweep,
       "not proven: a joint was swept over its range (Robot.structure), and no branch came inside "
       "the limits at its values or beside them"},
      {"target", Proof::target,
       "what the target itself places touches something in the scene: the tip, with what is fixed "
       "to it, whatever the arm does"},
      {"answer", Proof::answer,
       "of what was found: it is measured on the joint values themselves. Of a set nothing is said "
       "about others"},
  };
};

template <>
struct EnumTable<MoveNorm> {
  static constexpr const char* kName = "MoveNorm";
  static constexpr const char* kDoc = "How the length of a joint move is measured.";
  static constexpr EnumValue<MoveNorm> kValues[] = {
      {"two", MoveNorm::two, "root of the sum of squares"},
      {"max", MoveNorm::max, "the largest joint's"},
  };
};

/// No Python enum, where `raise` could not be written.
template <>
struct EnumTable<OnInvalidPose> {
  static constexpr EnumValue<OnInvalidPose> kValues[] = {
      {"status", OnInvalidPose::status, "Status::invalid_pose in its row"},
      {"raise", OnInvalidPose::raise, "an error that names the first"},
  };
};

template <>
struct EnumTable<SolutionOrder> {
  static constexpr const char* kName = "SolutionOrder";
  static constexpr const char* kDoc = "In which order solve_all gives its solutions.";
  static constexpr EnumValue<SolutionOrder> kValues[] = {
      {"move", SolutionOrder::move,
       "the smallest move first: from `near`, or else from the middle of the limits"},
      {"limit_distance", SolutionOrder::limit_distance,
       "the largest distance from the limits first, relative to each joint's range"},
      {"manipulability", SolutionOrder::manipulability, "the largest sqrt(det(J J^T)) first"},
  };
};

template <>
struct EnumTable<TaskFrame> {
  static constexpr const char* kName = "TaskFrame";
  static constexpr const char* kDoc = "Axes that the tolerances of a task lie along.";
  static constexpr EnumValue<TaskFrame> kValues[] = {
      {"base", TaskFrame::base, "the base's"},
      {"tool", TaskFrame::tool, "the target pose's own: those the tool has when it is there"},
  };
};

template <>
struct EnumTable<Axis> {
  static constexpr const char* kName = "Axis";
  static constexpr const char* kDoc = "One axis of a frame.";
  static constexpr EnumValue<Axis> kValues[] = {
      {"x", Axis::x, "x"}, {"y", Axis::y, "y"}, {"z", Axis::z, "z"}};
};

template <>
struct EnumTable<Cause> {
  static constexpr const char* kName = "Cause";
  static constexpr const char* kDoc =
      "Why a solve gave no answer. Certain where Diagnosis.proven is true; else found by search "
      "and "
      "so likely.";
  static constexpr EnumValue<Cause> kValues[] = {
      {"none", Cause::none, "there is an answer"},
      {"out_of_reach", Cause::out_of_reach, "the position lies beyond what the arm reaches"},
      {"orientation", Cause::orientation,
       "the position can be reached, but not with this rotation"},
      {"joint_limits", Cause::joint_limits,
       "answers exist, but all with joints outside their limits"},
      {"no_branch", Cause::no_branch,
       "no joint values reach the pose, whatever the limits: known in closed form"},
      {"rejected", Cause::rejected, "answers exist, but the filter refuses each"},
      {"singular", Cause::singular,
       "more work finds an answer, where the arm is close to a singularity"},
      {"budget", Cause::budget,
       "more work finds an answer: the bounds on attempts or iterations are too low"},
      {"out_of_time", Cause::out_of_time, "more time finds an answer: the deadline is too short"},
      {"collision", Cause::collision, "answers exist, but each collides in the scene"},
      {"shared_joints", Cause::shared_joints,
       "each of several tips can be reached by itself, but not all at once"},
  };
};

template <>
struct EnumTable<Objective::Kind> {
  static constexpr const char* kName = "ObjectiveKind";
  static constexpr const char* kDoc = "What an Objective counts.";
  static constexpr EnumValue<Objective::Kind> kValues[] = {
      {"none", Objective::Kind::none, "nothing"},
      {"posture", Objective::Kind::posture, "1/2 sum (w_i (q_i - posture_i))^2"},
      {"limits", Objective::Kind::limits,
       "sum 1/4 (1/x_i + 1/(1 - x_i)), x_i in 0 .. 1 the place between the limits"},
      {"manipulability", Objective::Kind::manipulability, "-sqrt(det(J J^T))"},
      {"custom", Objective::Kind::custom, "the caller's function"},
  };
};

/// All names of an enum, for messages: "grid, cvt, random".
template <class E>
std::string enum_names() {
  std::string names;
  for (const auto& entry : EnumTable<E>::kValues) {
    names += (names.empty() ? "" : ", ") + std::string(entry.name);
  }
  return names;
}

/// Name of a value; "?" if it is none of the enum's.
template <class E>
const char* enum_name(E value) {
  for (const auto& entry : EnumTable<E>::kValues) {
    if (entry.value == value) return entry.name;
  }
  return "?";
}

/// Without this, str() gives "Status.solved", or a number, by the version of Python.
inline void show_names(const py::object& cls) {
  cls.attr("__str__") =
      py::cpp_function([](const py::object& self) { return py::str(self.attr("name")); },
                       py::name("__str__"), py::is_method(cls));
  cls.attr("__format__") = py::cpp_function(
      [](const py::object& self, const py::str& spec) {
        return py::str(self.attr("name").attr("__format__")(spec));
      },
      py::name("__format__"), py::is_method(cls));
}

/// The Python enum.
template <class E>
py::handle& enum_class() {
  static py::handle cls;
  return cls;
}

/// Makes the Python enum; to come before any function that takes or returns it.
template <class E>
void bind_enum(py::module_& m) {
  // Statuses and proofs stand as numbers in batch results, and compare with them.
  constexpr bool kIsColumn = std::is_same_v<E, Status> || std::is_same_v<E, Proof>;
  constexpr const char* kBase = kIsColumn ? "enum.IntEnum" : "enum.Enum";
  py::native_enum<E> binding(m, EnumTable<E>::kName, kBase, EnumTable<E>::kDoc);
  for (const auto& entry : EnumTable<E>::kValues) binding.value(entry.name, entry.value, entry.doc);
  binding.finalize();
  enum_class<E>() = py::object(m.attr(EnumTable<E>::kName)).release();
  show_names(py::reinterpret_borrow<py::object>(enum_class<E>()));
}

}  // namespace iksel::python
