// SPDX-License-Identifier: BSD-3-Clause
// One function per bound noun; module.cpp calls them in order.
#pragma once

#include <pybind11/pybind11.h>

namespace iksel {
class Robot;
class Solver;
}  // namespace iksel

namespace iksel::python {

void bind_errors(pybind11::module_& m);
void bind_link_tree(pybind11::module_& m);
void bind_pose(pybind11::module_& m);
/// To come before the robot, one of whose properties it is.
void bind_structure(pybind11::module_& m);
void bind_coupled_limit(pybind11::module_& m);
void bind_mimic_curve(pybind11::module_& m);
void bind_robot(pybind11::module_& m);
/// Robot.from_dh.
void bind_dh(pybind11::module_& m, pybind11::class_<Robot>& robot);
/// The methods of Robot that compute poses and Jacobians.
void bind_kinematics(pybind11::class_<Robot>& robot);
/// To come before the options, one of which is a task.
void bind_task(pybind11::module_& m);
void bind_options(pybind11::module_& m);
void bind_database(pybind11::module_& m);
/// To come before the diagnosis, which names contacts.
void bind_scene(pybind11::module_& m);
void bind_objective(pybind11::module_& m);
void bind_diagnosis(pybind11::module_& m);
void bind_result(pybind11::module_& m);
void bind_solver(pybind11::module_& m);
/// The methods of Solver that take a request's keywords.
void bind_requests(pybind11::module_& m, pybind11::class_<Solver>& solver);
void bind_path(pybind11::module_& m, pybind11::class_<Solver>& solver);
void bind_self_motion(pybind11::module_& m, pybind11::class_<Solver>& solver);
/// To come after the robot, diagnosis and solver, which they are made of.
void bind_evaluation(pybind11::module_& m);
void bind_selector(pybind11::module_& m);

}  // namespace iksel::python
