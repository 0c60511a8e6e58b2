// SPDX-License-Identifier: BSD-3-Clause
// One function per bound noun; module.cpp calls them in order. And what all files that bind use.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "array_fields.hpp"
#include "option_fields.hpp"
#include "py_result.hpp"

namespace iksel::python {

void bind_errors(py::module_& m);
void bind_link_tree(py::module_& m);
void bind_pose(py::module_& m);
void bind_mimic_curve(py::module_& m);
void bind_robot(py::module_& m);
/// Robot.from_dh.
void bind_dh(py::module_& m, py::class_<Robot>& robot);
/// The methods of Robot that compute poses and Jacobians.
void bind_kinematics(py::class_<Robot>& robot);
void bind_options(py::module_& m);
void bind_database(py::module_& m);
/// To come before the diagnosis, which names contacts.
void bind_scene(py::module_& m);
void bind_objective(py::module_& m);
void bind_diagnosis(py::module_& m);
void bind_result(py::module_& m);
void bind_solver(py::module_& m);
/// The methods of Solver that take a request's keywords.
void bind_requests(py::module_& m, py::class_<Solver>& solver);
void bind_path(py::module_& m, py::class_<Solver>& solver);
void bind_self_motion(py::module_& m, py::class_<Solver>& solver);
/// To come after the robot, diagnosis and solver, which they are made of.
void bind_evaluation(py::module_& m);
void bind_selector(py::module_& m);

}  // namespace iksel::python
