# SPDX-License-Identifier: BSD-3-Clause
"""Comments of the core's headers in words of Python."""

from __future__ import annotations

import re

# Where Python has to say more or less than C++.
TEXTS = {
    "Cause": "Why a solve gave no answer. Certain where Diagnosis.proven is true; "
    "else found by search and so likely.",
    "Kind": "What an Objective counts.",
    "Kind.none": "nothing",
    "Kind.custom": "the caller's function",
    "Iteration": "One scheme of numerical iteration (paper, Table II).",
    "Scale.small": "12,000 samples for 6 joints",
    "Scale.medium": "40,320 samples for 6 joints",
    "Scale.large": "151,200 samples for 6 joints",
    "GrowthStop.on": "always",
    "GrowthStop.off": "never",
    "BatchView": "Answers to many targets as arrays; row i belongs to target i. "
    "Indexing gives a Result, and by a slice or an array a BatchResult of its own. It "
    "is neither true nor false: ask success.all() or success.any().",
}
# What Python has to say besides.
MORE = {
    "AnswerCriteria.exact": "Called with candidates (n, dof), returns n truth values, "
    "which of them are free: an iksel.exact.ExactCollision.",
    "AnswerCriteria.filter": "Called with candidates (n, dof), each at the pose and "
    "inside the limits, returns n truth values.",
    "SolveRequest.closest": "True: a metre counts 1, a radian as the database weighs "
    "rotations; or six weights, of position [1/m] and rotation [1/rad] along the axes "
    "of the task.",
    "SolveRequest.near": "Of a batch one for all targets, or (N, dof), one for each.",
    "SolveRequest.objective": "An Objective, 'limits', 'manipulability', or a function "
    "of joint values (dof,) that returns a cost.",
    "SolveRequest.on_invalid_pose": "'status': Status.invalid_pose in its row, and NaN "
    "for its q; 'raise': an error that names the first, and none is solved.",
    "SolveRequest.seeds": "One may be (dof,).",
    "SolverOptions": "As in SolverOptions(strategy=Paper(iteration='dls')).",
    "DatabaseOptions": "Enums may be given by name, as in sampling='grid'.",
    "Paper": "Enums may be given by name, as in iteration='dls'. A field that the "
    "chosen scheme does not read has to be at its default.",
    "Result": "True if it is one.",
    "Solutions": "True if there are any. Indexing gives a Result.",
    "PathResult": "True if there are any for every waypoint.",
    "SelfMotion": "The arcs, the longest first; true if there are any. Indexing gives "
    "a SelfMotionArc.",
    "Diagnosis": "True if q_is_solution.",
    "LinkTree": "str() draws the tree.",
    "Objective.near_posture": "Both are (dof,).",
    "Obstacle.points": "None of other shapes.",
    "Result.q": "Read-only.",
    "UnknownNameError": "`available` has those it has.",
    "Task": "Immutable.",
    "Objective": "Immutable.",
    "UrdfError": "`available` is a tuple of all the names there were to choose from, "
    "where it is about a name.",
}
# Numbers, of which Python has none where C++ has -1.
INDICES = {
    "Diagnosis.unreachable_tip",
    "PathResult.first_unreachable",
    "PathResult.largest_step_joint",
    "PathResult.largest_step_waypoint",
    "Result.unreachable_tip",
    "TargetCriteria.in_frame_of",
}
WORDS = {
    r"\bfind_structure\b": "Robot.structure",
    "::": ".",
    r"Eq\. \(\d\)(?! of)": r"\g<0> of the paper",
    r"\bThrow(s?)\b": r"Raise\1",
    r"\bthrow(s?)\b": r"raise\1",
    r"\b[Ee]mpty(?=: | unless solved)": "None",
    r"\binfinity\b": "inf",
    r", 1 to kMax\w+|; kMax\w+ at most": "",
    r"\bkRigidTolerance\b": "RIGID_TOLERANCE",
}
# What Python has for a type: its shape is said behind the unit.
SHAPES = {
    "JointVector": "(dof,)",
    "std::optional<JointVector>": "(dof,)",
    "std::vector<JointVector>": "(n, dof)",
    "std::vector<double>": "(n,)",
    "Eigen::Vector3d": "(3,)",
    "std::shared_ptr<PointCloud>": "(n, 3)",
    "Pose": "(4, 4)",
    "StoredPose": "(4, 4)",
}


def words(comment: str) -> str:
    """The comment, in words of Python."""
    lines = re.sub(r"///<?", "", comment).splitlines()
    paragraphs = re.split(r"\n\s*\n", "\n".join(lines))
    text = "\n\n".join(" ".join(each.split()) for each in paragraphs).strip()
    for word, other in WORDS.items():
        text = re.sub(word, other, text)
    return text


def sentences(key: str, comment: str, type_: str) -> str:
    """The text of a class, a member or a function."""
    text = TEXTS.get(key) or words(comment)
    if shape := SHAPES.get(type_):
        # Behind the unit, if there is one.
        at = text.find("]") + 1 or re.search(r"(?=[.;:,]|$)", text).start()
        text = f"{text[:at]}, {shape}{text[at:]}"
    if key in INDICES:
        text = text.replace("-1", "None")
    text = re.sub(r"^[a-z]+(?![\w:,])", lambda found: found[0].capitalize(), text)
    text += "" if text.endswith(".") else "."
    return " ".join([text, MORE[key]] if key in MORE else [text])
