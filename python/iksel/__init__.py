# SPDX-License-Identifier: BSD-3-Clause
"""Fast numerical inverse kinematics by selecting good seeds.

    import iksel

    robot = iksel.load_robot("ur3")
    solver = iksel.Solver(robot)
    result = solver.solve(robot.fk([0.3, -1.2, 1.5, -0.4, 0.9, 0.0]))
    if result:
        print(result.q)

A pose is a 4x4 matrix T_base_tip; lengths are metres, angles radians.

To begin with:

    a robot              load_robot, robot_names, Robot
    a pose               pose_from_euler, pose_from_quaternion, as_pose
    an answer            Solver, Result, Status
    less than a pose     Task
    other settings       SolverOptions
    obstacles            Scene; the modules iksel.spheres, iksel.collision
    much at once         the module iksel.reach
    to look at it        the module iksel.view
    what goes wrong      Error
"""

from __future__ import annotations

try:
    import iksel_cpp as _core
except ImportError as _error:
    from iksel._base.missing import explain

    if isinstance(_error.__cause__, KeyboardInterrupt):
        raise _error.__cause__ from None
    raise ImportError(explain(str(_error)), name="iksel_cpp") from _error

from iksel_cpp import (
    AngleUnitWarning,
    ArcEnd,
    Axis,
    BatchResult,
    Cause,
    Contact,
    CoupledLimit,
    Database,
    DatabaseCorruptError,
    DatabaseError,
    DatabaseIoError,
    DatabaseMismatchError,
    DatabaseOptions,
    DhConvention,
    Diagnosis,
    Error,
    Evaluation,
    GrowthStop,
    InvalidArgumentError,
    Iteration,
    JointType,
    KeyScheme,
    Kinematics,
    Lanes,
    LinkTree,
    LinkTreeJoint,
    MimicCurve,
    MoveNorm,
    Objective,
    ObjectiveKind,
    Obstacle,
    Paper,
    PathResult,
    Proof,
    Ranking,
    Reselection,
    Result,
    Robot,
    RobotSpheres,
    RotationDifference,
    RotationKey,
    Sampling,
    Scale,
    Scene,
    Selector,
    SelfMotion,
    SelfMotionArc,
    SelfMotionEnd,
    SignatureError,
    SolutionOrder,
    Solutions,
    Solver,
    SolverOptions,
    Status,
    Structure,
    StructureKind,
    Task,
    TaskFrame,
    Tracker,
    UnknownNameError,
    UrdfError,
    evaluate,
    simd_level,
    stage_times,
    time_kdl_fk_jacobian,
)

from iksel._base.cmake import cmake_dir
from iksel.formats._attach import attach
from iksel.formats._manifest import RobotInfo
from iksel.pose import (
    as_pose,
    check_pose,
    euler_from_pose,
    is_rigid,
    orthonormalized,
    pose_error,
    pose_from_euler,
    pose_from_matrix,
    pose_from_quaternion,
    pose_from_rotation_vector,
    quaternion_from_pose,
    rotation_vector_from_pose,
)
from iksel.robots import load_robot, load_tree, robot_info, robot_names
from iksel.srdf import Srdf

__version__: str = _core.__version__

__all__ = [
    "AngleUnitWarning",
    "ArcEnd",
    "Axis",
    "BatchResult",
    "Cause",
    "Contact",
    "CoupledLimit",
    "Database",
    "DatabaseCorruptError",
    "DatabaseError",
    "DatabaseIoError",
    "DatabaseMismatchError",
    "DatabaseOptions",
    "DhConvention",
    "Diagnosis",
    "Error",
    "Evaluation",
    "GrowthStop",
    "InvalidArgumentError",
    "Iteration",
    "JointType",
    "KeyScheme",
    "Kinematics",
    "Lanes",
    "LinkTree",
    "LinkTreeJoint",
    "MimicCurve",
    "MoveNorm",
    "Objective",
    "ObjectiveKind",
    "Obstacle",
    "Paper",
    "PathResult",
    "Proof",
    "Ranking",
    "Reselection",
    "Result",
    "Robot",
    "RobotInfo",
    "RobotSpheres",
    "RotationDifference",
    "RotationKey",
    "Sampling",
    "Scale",
    "Scene",
    "Selector",
    "SelfMotion",
    "SelfMotionArc",
    "SelfMotionEnd",
    "SignatureError",
    "SolutionOrder",
    "Solutions",
    "Solver",
    "SolverOptions",
    "Srdf",
    "Status",
    "Structure",
    "StructureKind",
    "Task",
    "TaskFrame",
    "Tracker",
    "UnknownNameError",
    "UrdfError",
    "__version__",
    "as_pose",
    "attach",
    "check_pose",
    "cmake_dir",
    "euler_from_pose",
    "evaluate",
    "is_rigid",
    "load_robot",
    "load_tree",
    "orthonormalized",
    "pose_error",
    "pose_from_euler",
    "pose_from_matrix",
    "pose_from_quaternion",
    "pose_from_rotation_vector",
    "quaternion_from_pose",
    "robot_info",
    "robot_names",
    "rotation_vector_from_pose",
    "simd_level",
    "stage_times",
    "time_kdl_fk_jacobian",
]
