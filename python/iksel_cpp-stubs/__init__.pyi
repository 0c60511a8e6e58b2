# SPDX-License-Identifier: BSD-3-Clause
"""
IKSel: inverse kinematics from precomputed seeds.

A pose is that of the TCP, or of the tip link if there is no tool, in the base frame: a (4, 4)
homogeneous matrix; lengths are metres, angles radians. A twist is [linear; angular] in base axes at
the TCP. The method is that of "IKSel: Selecting Good Seed Joint Values for Fast Numerical Inverse
Kinematics Iterations" (Yuan, Wan, Harada, 2025), called the paper below.
"""
from __future__ import annotations
import collections.abc
import enum
import numpy
import numpy.typing
import os
import typing
__all__: list[str] = ['AngleUnitWarning', 'ArcEnd', 'Axis', 'BatchResult', 'Cause', 'Contact', 'CoupledLimit', 'Database', 'DatabaseCorruptError', 'DatabaseError', 'DatabaseIoError', 'DatabaseMismatchError', 'DatabaseOptions', 'DhConvention', 'Diagnosis', 'Error', 'Evaluation', 'GrowthStop', 'InvalidArgumentError', 'Iteration', 'JointType', 'KeyScheme', 'Kinematics', 'Lanes', 'LinkTree', 'LinkTreeJoint', 'MimicCurve', 'MoveNorm', 'Objective', 'ObjectiveKind', 'Obstacle', 'Paper', 'PathResult', 'Proof', 'RIGID_TOLERANCE', 'Ranking', 'Reselection', 'Result', 'Robot', 'RobotSpheres', 'RotationDifference', 'RotationKey', 'Sampling', 'Scale', 'Scene', 'Selector', 'SelfMotion', 'SelfMotionArc', 'SelfMotionEnd', 'SignatureError', 'SolutionOrder', 'Solutions', 'Solver', 'SolverOptions', 'Status', 'Structure', 'StructureKind', 'Task', 'TaskFrame', 'Tracker', 'UnknownNameError', 'UrdfError', 'check_pose', 'evaluate', 'grid_counts', 'mend_xml', 'orthonormalized', 'pose_error', 'pose_matrices', 'rigid_deviation', 'simd_level', 'stage_times', 'time_kdl_fk_jacobian']
class AngleUnitWarning(UserWarning):
    """
    Angles that look like degrees were given where radians are meant.
    """
class Error(Exception):
    """
    Base of every exception of the library.
    """
class UrdfError(Error):
    """
    A URDF that cannot be read, parsed or turned into a chain. `available` is a tuple of all the names there were to choose from, where it is about a name.
    """
    available: tuple[str, ...]
class UnknownNameError(UrdfError):
    """
    A link or joint name that the URDF does not have. `available` has those it has.
    """
    available: tuple[str, ...]
class InvalidArgumentError(Error, ValueError):
    """
    An argument of the wrong size or value: a pose that is not rigid, a non-finite number, a q of the wrong length, an option out of range.
    """
class SignatureError(InvalidArgumentError, TypeError):
    """
    A call that does not fit: an unknown keyword, a missing argument, one of another class.
    """
class DatabaseError(Error):
    """
    A database that cannot be built, read, written or trusted.
    """
class DatabaseIoError(DatabaseError):
    """
    A database file that cannot be opened, read or written (no such file, full disk, no permission).
    """
class DatabaseCorruptError(DatabaseError):
    """
    A database file that is truncated, corrupted, or no database at all.
    """
class DatabaseMismatchError(DatabaseError):
    """
    An intact database that does not fit: other robot, other format version, other byte order.
    """
class LinkTreeJoint:
    """
    One joint of a URDF.
    """
    def __repr__(self) -> str:
        ...
    @property
    def child_link(self) -> str:
        """
        The link that it carries.
        """
    @property
    def name(self) -> str:
        """
        Its name.
        """
    @property
    def parent_link(self) -> str:
        """
        The link that it is on.
        """
    @property
    def type(self) -> str:
        """
        "revolute", "fixed", ...
        """
class LinkTree:
    """
    The tree of a URDF's links, depth first from the root. str() draws the tree.
    """
    @staticmethod
    def from_urdf(path_or_xml: str | bytes | os.PathLike[str], link: str | None = None) -> LinkTree:
        """
        Reads the tree of a URDF.

        Args:
            path_or_xml: a path, or the URDF itself: a str whose first character is '<', or bytes.
            link: a link of the tree that is meant, where the links hang in several.

        Raises:
            UrdfError: the file or the XML is no good, or there are several trees.
        """
    def __repr__(self) -> str:
        ...
    def __str__(self) -> str:
        ...
    @property
    def joints(self) -> list[LinkTreeJoint]:
        """
        Each leads to the next link.
        """
    @property
    def links(self) -> list[str]:
        """
        Names of all links, the root first.
        """
    @property
    def robot_name(self) -> str:
        """
        Name in the URDF.
        """
    @property
    def tips(self) -> list[tuple[str, int]]:
        """
        The links without children, each with the number of joints that move it.
        """
class MimicCurve:
    """
    A joint that follows another by a smooth curve, as a four-bar linkage or a cylinder beside a hinge makes it. It takes the place of the joint's mimic tag, which knows straight lines only.

    Between the points lies a cubic in each gap (Hermite's); the joint that is followed stays between the first point and the last.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    @staticmethod
    def sampled(joint: str, follows: str, lower: float, upper: float, function: collections.abc.Callable[[float], typing.SupportsFloat | typing.SupportsIndex], slope: collections.abc.Callable[[float], typing.SupportsFloat | typing.SupportsIndex]) -> MimicCurve:
        """
        The curve of a function, with so many points that it lies within 1e-10 of it.

        Args:
            joint: name of the joint that follows.
            follows: name of the joint that is followed; it follows none itself.
            lower: where the curve begins [rad or m].
            upper: where it ends [rad or m].
            function: value of `joint` at a value of the joint that is followed [rad or m].
            slope: the function's derivative.

        Raises:
            InvalidArgumentError: 8,192 gaps are not enough, as where slope is not function's derivative;
                or a function gives no finite number.
        """
    def __eq__(self, other: typing.Any) -> bool:
        ...
    def __init__(self, joint: str, follows: str, q: numpy.typing.ArrayLike, values: numpy.typing.ArrayLike, slopes: numpy.typing.ArrayLike | None = None) -> None:
        """
        Args:
            joint: name of the joint that follows.
            follows: name of the joint that is followed; it follows none itself.
            q: values of the joint that is followed [rad or m], (N,), each above the one before.
            values: value of `joint` at each [rad or m], (N,).
            slopes: derivative of `values` by q at each, (N,); None: those of the cubic spline through the
                points, whose second derivative has no steps.

        Raises:
            InvalidArgumentError: not names and arrays. What is wrong with the points, it says when a robot
                is loaded.
        """
    def __repr__(self) -> str:
        ...
    @property
    def follows(self) -> str:
        """
        Name of the joint that is followed; it follows none itself.
        """
    @property
    def joint(self) -> str:
        """
        Name of the joint that follows.
        """
    @property
    def q(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Values of the joint that is followed [rad or m], (n,), two or more, each above the one before.
        """
    @property
    def slopes(self) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        Derivative of `values` by q at each, (n,). None: those of the cubic spline through the points, whose second derivative has no steps.
        """
    @property
    def values(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Value of `joint` at each [rad or m], (n,).
        """
class JointType(enum.Enum):
    """
    How a degree of freedom moves.
    """
    continuous = 1
    prismatic = 2
    revolute = 0
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
class Kinematics(enum.Enum):
    """
    Which implementation computes forward kinematics and Jacobians; they agree to 1e-12.
    """
    kdl = 1
    kernel = 0
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
class StructureKind(enum.Enum):
    """
    How the solutions of a pose can be found.
    """
    closed_form = 0
    searched = 2
    swept = 1
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
class Structure:
    """
    What follows from how the axes of a chain lie.
    """
    def __repr__(self) -> str:
        ...
    @property
    def description(self) -> str:
        """
        Which axes, numbered from 1, are parallel or meet, or that none do that would help; a sentence without its full stop.
        """
    @property
    def kind(self) -> StructureKind:
        """
        How the solutions of a pose can be found.
        """
class CoupledLimit:
    """
    A limit that joints share, as a parallel linkage or a cable makes it: lower <= sum of coefficient * joint value <= upper.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, other: typing.Any) -> bool:
        ...
    def __init__(self, coefficients: collections.abc.Mapping[str, float], lower: float = ..., upper: float = ...) -> None:
        """
        Args:
            coefficients: by joint name; not 0. Joints between base and tip, mimic and locked ones too,
                but none that turns without limits.
            lower: least value of the sum [rad or m].
            upper: largest value of the sum [rad or m].

        Raises:
            InvalidArgumentError: not names and numbers. What is wrong with the limit of a robot, it says
                when that is loaded.
        """
    def __repr__(self) -> str:
        ...
    def __str__(self) -> str:
        ...
    @property
    def coefficients(self) -> dict[str, float]:
        """
        Coefficients by joint name; not 0. Joints between base and tip, mimic and locked ones too, but none that turns without limits.
        """
    @property
    def lower(self) -> float:
        """
        Least value of the sum [rad or m].
        """
    @property
    def upper(self) -> float:
        """
        Largest value [rad or m]; one of the two may be infinite.
        """
class Robot:
    """
    An immutable serial chain with its limits, or the chains from one base link to several tip links (RobotOptions.tip_links), joined: a joint that lies on several of them is one degree of freedom. Copies are cheap and share the data. Safe to use from many threads at once. What is about one tip raises InvalidArgumentError where there are several.
    """
    @staticmethod
    def from_dh(a: numpy.typing.ArrayLike, alpha: numpy.typing.ArrayLike, d: numpy.typing.ArrayLike, theta: numpy.typing.ArrayLike | None = None, *, convention: DhConvention | str = 'standard', types: collections.abc.Sequence[JointType | str] | None = None, lower: numpy.typing.ArrayLike | None = None, upper: numpy.typing.ArrayLike | None = None, velocity: numpy.typing.ArrayLike | None = None, names: collections.abc.Sequence[str] | None = None, base: numpy.typing.ArrayLike | typing.Any | None = None, tcp: numpy.typing.ArrayLike | typing.Any | None = None, name: str = 'dh') -> Robot:
        """
        Makes an arm of Denavit and Hartenberg's parameters, a column of the table each.

        The links are `base`, in whose frame poses are, and the table's frames `link0` to `linkN`, of which
        the last is the tip. Other links of the chain, locked joints and coupled limits: make another robot of
        `robot.urdf` by from_urdf.

        Args:
            a: lengths along x [m], (N,).
            alpha: turns about x [rad], (N,).
            d: offsets along z [m], (N,); the value of a prismatic joint is added.
            theta: turns about z [rad], (N,), to which the value of a joint that turns is added; None: 0.
            convention: "standard": Rz(theta) Tz(d) Tx(a) Rx(alpha), as of Denavit and Hartenberg,
                Siciliano, Spong; "modified": Rx(alpha) Tx(a) Rz(theta) Tz(d), as of Craig, where a and
                alpha are those of the link before.
            types: how each joint moves; None: all are revolute.
            lower: lower limits [rad or m], (N,), -inf for none; without limits, a revolute joint is
                continuous, and a prismatic one is refused.
            upper: upper limits [rad or m], (N,), inf for none.
            velocity: velocity limits [rad/s or m/s], (N,), inf for none.
            names: names of the joints; None: `joint1` to `jointN`.
            base: T_base_link0, (4, 4); None: the identity.
            tcp: T_linkN_tcp, (4, 4): the tool, whose pose is solved for; None: the identity.
            name: name of the robot.

        Raises:
            InvalidArgumentError: columns that are no numbers or not as long as a, a number that is not
                finite, a name that is there twice, one limit without the other, or a prismatic joint
                without limits.
            UrdfError: limits that leave a joint no range, or a length or joint value beyond 1e8.
        """
    @staticmethod
    def from_urdf(path_or_xml: str | bytes | os.PathLike[str], base_link: str | None = None, tip_link: str | None = None, tcp: numpy.typing.ArrayLike | typing.Any | None = None, locked_joints: collections.abc.Mapping[str, float] | None = None, soft_limits: bool = False, default_limits: numpy.typing.ArrayLike | None = None, coupled_limits: collections.abc.Sequence[CoupledLimit] = (), mimic_curves: collections.abc.Sequence[MimicCurve] = (), tip_links: collections.abc.Sequence[str] | None = None, tcps: numpy.typing.ArrayLike | typing.Any | None = None) -> Robot:
        """
        Reads the chain between two links of a URDF, or the chains to several tips.

        Args:
            path_or_xml: a path, or the URDF itself: a str whose first character is '<', or bytes.
            base_link: link the poses are relative to; None: the root link.
            tip_link: link whose pose is solved for; None: the one link without children.
            tcp: T_tip_tcp, (4, 4): tool centre point. Poses, FK and IK are then of the TCP.
            locked_joints: joints held at a value [rad or m]; they are no degrees of freedom.
            soft_limits: narrow the limits to the URDF's safety_controller where there is one.
            default_limits: (lower, upper) [rad or m] of revolute and prismatic joints whose limits the
                URDF leaves out or has as 0, 0; without, such a joint is an error.
            coupled_limits: limits of sums of joint values, beside those of each joint; at most 8.
            mimic_curves: how joints follow others where that is no straight line, one MimicCurve for each
                that does; in the place of their mimic tags.
            tip_links: in the place of tip_link, the links of a robot with several tips, 1 to 8: a torso and
                its two arms. A joint that lies on several of the chains is one degree of freedom.
            tcps: in the place of tcp, T_tip_tcp of each tip, (k, 4, 4); None: no tip has a tool.

        Raises:
            UrdfError: the file, the XML, a joint type or a limit is no good, or a length or joint value
                is beyond 1e8, where double precision ends. Where there was a choice of names, `available`
                has them all.
            UnknownNameError: no such link or joint.
            InvalidArgumentError: tcp is no rigid transform, or a number in the options is no good, or the
                coupled limits leave no configuration, or a curve is no good.
        """
    def __copy__(self) -> Robot:
        ...
    def __deepcopy__(self, memo: dict[int, object]) -> Robot:
        ...
    def __repr__(self) -> str:
        ...
    def _repr_html_(self) -> str:
        ...
    def chain(self, tip: int) -> Robot:
        """
        The chain to one tip by itself; tips count from 0. Raises InvalidArgumentError if there is no such tip.
        """
    def fk(self, q: numpy.typing.ArrayLike, kinematics: Kinematics | str = 'kernel') -> numpy.typing.NDArray[numpy.float64]:
        """
        Forward kinematics: T_base_tip, of the TCP if there is a tool.

        Args:
            q: joint values [rad or m], (dof,) or (N, dof).
            kinematics: what computes it.

        Returns:
            (4, 4), or (N, 4, 4) with the GIL released; of k tips (k, 4, 4), or (N, k, 4, 4).

        Raises:
            InvalidArgumentError: wrong shape or dtype, or a number that is not finite.
        """
    def inverse_jacobian(self, q: numpy.typing.ArrayLike, damping: float = 0.0) -> numpy.typing.NDArray[numpy.float64]:
        """
        Derivative of an answer q by its target, for differentiable use.

        dq = inverse_jacobian @ [linear; angular] for a small twist of the target in base axes at the TCP,
        of all dq the least: the damped pseudo-inverse J^T (J J^T + damping^2 I)^-1 (Nakamura and Hanafusa 1986).

        Args:
            q: joint values [rad or m], (dof,) or (N, dof).
            damping: bounds dq near singularities; 0: the pseudo-inverse.

        Returns:
            (dof, 6), or (N, dof, 6) with the GIL released.

        Raises:
            InvalidArgumentError: wrong shape or dtype, a number that is not finite, damping below 0.
        """
    def jacobian(self, q: numpy.typing.ArrayLike, kinematics: Kinematics | str = 'kernel') -> numpy.typing.NDArray[numpy.float64]:
        """
        Geometric Jacobian: rows [linear; angular] in base axes at the TCP.

        Args:
            q: joint values [rad or m], (dof,) or (N, dof).
            kinematics: what computes it.

        Returns:
            (6, dof), or (N, 6, dof) with the GIL released; of k tips 6 k rows, one below the other.

        Raises:
            InvalidArgumentError: wrong shape or dtype, or a number that is not finite.
        """
    def joints_of(self, tip: int) -> list[int]:
        """
        Where that chain's joints stand among all: its joint values are q[joints_of(tip)]. Raises as chain.
        """
    def link_poses(self, q: numpy.typing.ArrayLike, *, other_joints: collections.abc.Mapping[str, float] | None = None) -> numpy.typing.NDArray[numpy.float64]:
        """
        Poses of all links of the URDF in the base link's frame, in the order of link_names.

        Side branches move with the arm's joints, too, and with what mimics them at any depth. The TCP plays
        no part.

        Args:
            q: joint values [rad or m], (dof,) or (N, dof).
            other_joints: values of joints that q does not move [rad or m], by name. Those not given are
                where they are locked, or at 0; floating and planar joints are at their origin.

        Returns:
            (n_links, 4, 4), or (N, n_links, 4, 4) with the GIL released.

        Raises:
            InvalidArgumentError: wrong shape or dtype, a number that is not finite, or a joint in
                other_joints that q moves.
            UnknownNameError: a name in other_joints, or in a mimic tag, that is no joint's.
            UrdfError: a joint off the chain is no good: it mimics itself, or has no axis.
        """
    def random_configurations(self, n: int, seed: int | None = None) -> numpy.typing.NDArray[numpy.float64]:
        """
        n configurations uniform inside the limits (continuous joints in [-pi, pi)), (n, dof). The same seed gives the same numbers everywhere; None: other numbers in each call.
        """
    def with_tcp(self, tcp: numpy.typing.ArrayLike | typing.Any) -> Robot:
        """
        The same chain with another tool T_tip_tcp; databases built for one serve the other.
        """
    def within_limits(self, q: numpy.typing.ArrayLike) -> bool | typing.Any:
        """
        Whether q [rad or m], (dof,), lies inside the position limits; of (N, dof) values each, (N,).
        """
    @property
    def base_link(self) -> str:
        """
        Link the poses are relative to.
        """
    @property
    def chain_hash(self) -> int:
        """
        Hash over the structure and numbers of the chain up to the tip link: equal for chains that may share a database. The TCP and names are not part of it.
        """
    @property
    def coupled_limits(self) -> list[CoupledLimit]:
        """
        Limits of sums of joint values, beside those of each joint.
        """
    @property
    def default_limits(self) -> tuple[float, float] | None:
        """
        Lower and upper limit [rad or m] of revolute and prismatic joints whose limits the URDF leaves out or has as 0, 0; none: such a joint is an error. A mimic joint of that kind has no limits beside those of the joint that it follows.
        """
    @property
    def dof(self) -> int:
        """
        Degrees of freedom.
        """
    @property
    def joint_names(self) -> list[str]:
        """
        Names of the degrees of freedom, base to tip; of several tips those of the first chain, then those that only the second has, and so on.
        """
    @property
    def joint_types(self) -> list[JointType]:
        """
        How each degree of freedom moves, base to tip.
        """
    @property
    def link_names(self) -> list[str]:
        """
        Names of all links of the URDF, the chain's and others, depth first from the root.
        """
    @property
    def locked_joints(self) -> dict[str, float]:
        """
        Joints held at a value [rad or m], by name; they are no degrees of freedom.
        """
    @property
    def lower(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Position limits [rad or m], (dof,), both inside; -inf and inf for continuous joints.
        """
    @property
    def mimic_curves(self) -> list[MimicCurve]:
        """
        How joints follow others where that is no straight line, one for each that does; in the place of their mimic tags.
        """
    @property
    def name(self) -> str:
        """
        Name in the URDF.
        """
    @property
    def reach(self) -> float:
        """
        No pose whose origin lies farther than this from `reach_centre` can be reached [m].
        """
    @property
    def reach_centre(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        A point on the first joint's axis, in the base frame [m], (3,).
        """
    @property
    def shared_joints(self) -> list[int]:
        """
        Indices of the joints that move more than one tip, ascending.
        """
    @property
    def soft_limits(self) -> bool:
        """
        Whether the position limits are narrowed to the URDF's safety_controller where there is one.
        """
    @property
    def soft_lower(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Limits of the safety controller [rad or m], (dof,); the position limits where the URDF has none.
        """
    @property
    def soft_upper(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Limits of the safety controller [rad or m], (dof,); the position limits where the URDF has none.
        """
    @property
    def structure(self) -> Structure:
        """
        How the axes lie, and whether that gives all solutions of a pose in closed form.
        """
    @property
    def tcp(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        T_tip_tcp, (4, 4), the tool centre point in the tip link's frame.
        """
    @property
    def tcps(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        T_tip_tcp of each tip, (k, 4, 4).
        """
    @property
    def tip_link(self) -> str:
        """
        Link whose pose is solved for, of a robot with one tip.
        """
    @property
    def tip_links(self) -> list[str]:
        """
        Links whose poses are solved for.
        """
    @property
    def tips(self) -> int:
        """
        Number of tips.
        """
    @property
    def upper(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Position limits [rad or m], (dof,), both inside; -inf and inf for continuous joints.
        """
    @property
    def urdf(self) -> str:
        """
        The URDF text this robot was made of, as mend_xml gives it, without trees of links that the chain is not in.
        """
    @property
    def velocity_limit(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Velocity limits [rad/s or m/s], (dof,); inf where the URDF has none.
        """
class DhConvention(enum.Enum):
    """
    How a row of a table places the next frame; the joint moves about or along z.
    """
    modified = 1
    standard = 0
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
class Sampling(enum.Enum):
    """
    How the joint samples of a database are spread over the limits.
    """
    cvt = 1
    grid = 0
    kmeans = 4
    low_discrepancy = 2
    random = 3
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
class Scale(enum.Enum):
    """
    Size of a grid, and of other samplings whose `samples` is 0 (paper, Table "KDTree sizes").
    """
    large = 2
    medium = 1
    small = 0
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
class KeyScheme(enum.Enum):
    """
    What of a pose the database's key holds.
    """
    full = 0
    reduced = 1
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
class RotationKey(enum.Enum):
    """
    How the KD-tree's key writes the rotation of a pose (paper, footnote 1).
    """
    dual_quaternion = 4
    euler = 3
    matrix = 2
    quaternion = 1
    rotation_vector = 0
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
class Ranking(enum.Enum):
    """
    How the neighbours of a target are put in order.
    """
    joint_adjustment = 1
    nearest = 0
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
class RotationDifference(enum.Enum):
    """
    The rotation part of x_target - x_i in Eq. (4) of the paper.
    """
    geodesic = 1
    rotation_vector = 0
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
class Iteration(enum.Enum):
    """
    One scheme of numerical iteration (paper, Table II).
    """
    cwln = 3
    cwpi = 4
    dls = 0
    lm = 5
    pinv = 1
    pinv_rr = 2
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
class Reselection(enum.Enum):
    """
    Which seed follows a failed one.
    """
    farthest = 2
    next = 1
    none = 0
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
class GrowthStop(enum.Enum):
    """
    Whether an attempt is given up when both errors have grown.
    """
    by_scheme = 0
    off = 2
    on = 1
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
class TaskFrame(enum.Enum):
    """
    Axes that the tolerances of a task lie along.
    """
    base = 0
    tool = 1
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
class Axis(enum.Enum):
    """
    One axis of a frame.
    """
    x = 0
    y = 1
    z = 2
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
class Task:
    """
    What of a pose has to be reached: a box around the target for the deviation of the TCP, along the axes of `frame`. Zero width asks for the axis exactly, infinite width leaves it free.

    The deviation of a TCP at (R, p) from a target (R_t, p_t) has six parts. Position: p - p_t [m]. Rotation: that of E = R R_t^T [rad] (in tool axes E = R_t^T R), as the rotation vector of E where the three widths are equal, else as swing and twist, E = swing * twist about the axis whose width is unlike the other two's (of three, the wider odd one). So with a free spin the swing is the angle by which the tool's axis points elsewhere, whatever the spin. An answer lies at most SolverOptions.position_tolerance and .rotation_tolerance outside of the box, both as norms over their three axes, and inside it along axes wider than two tolerances. Immutable.
    """
    @staticmethod
    def box(position: collections.abc.Sequence[float], rotation: collections.abc.Sequence[float], frame: TaskFrame | str = 'tool') -> Task:
        """
        Symmetric tolerances about the target: half widths along x, y, z [m], where inf leaves an axis free, and about x, y, z [rad], where pi or more does. Raises InvalidArgumentError about one that is negative or not a number.
        """
    @staticmethod
    def free_spin(axis: Axis | str = 'z') -> Task:
        """
        The position and the direction of one of the tool's axes; any spin about it.
        """
    @staticmethod
    def planar(normal: Axis | str = 'z') -> Task:
        """
        The position in the plane through the base that `normal` is normal to, and the angle about `normal`; three axes are left free. For arms that move in a plane.
        """
    @staticmethod
    def pose() -> Task:
        """
        The whole pose, exactly.
        """
    @staticmethod
    def position_only() -> Task:
        """
        The position; any rotation.
        """
    @staticmethod
    def upright(axis: Axis | str = 'z') -> Task:
        """
        The position, and the rotation up to a turn about one of the base's axes: a glass stays upright.
        """
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, frame: TaskFrame | str = 'tool', position_lower: collections.abc.Sequence[float] = (0.0, 0.0, 0.0), position_upper: collections.abc.Sequence[float] = (0.0, 0.0, 0.0), rotation_lower: collections.abc.Sequence[float] = (0.0, 0.0, 0.0), rotation_upper: collections.abc.Sequence[float] = (0.0, 0.0, 0.0)) -> None:
        """
        Fields that are not given keep their default.

        Args:
            frame: Axes that the tolerances of a task lie along.
            position_lower: Bounds of the position's deviation along x, y, z [m]; infinite: none.
            position_upper: Bounds of the position's deviation along x, y, z [m]; infinite: none.
            rotation_lower: Bounds of the rotation's deviation about x, y, z [rad], in -pi .. pi, or both infinite: none.
            rotation_upper: Bounds of the rotation's deviation about x, y, z [rad], in -pi .. pi, or both infinite: none.

        Raises:
            SignatureError: a keyword that is no field.
            InvalidArgumentError: a value of the wrong type or out of range.
        """
    def __repr__(self) -> str:
        ...
    def replace(self, *, frame: TaskFrame | str = ..., position_lower: collections.abc.Sequence[float] = ..., position_upper: collections.abc.Sequence[float] = ..., rotation_lower: collections.abc.Sequence[float] = ..., rotation_upper: collections.abc.Sequence[float] = ...) -> Task:
        """
        A copy in which the given fields have another value.

        Args:
            frame: Axes that the tolerances of a task lie along.
            position_lower: Bounds of the position's deviation along x, y, z [m]; infinite: none.
            position_upper: Bounds of the position's deviation along x, y, z [m]; infinite: none.
            rotation_lower: Bounds of the rotation's deviation about x, y, z [rad], in -pi .. pi, or both infinite: none.
            rotation_upper: Bounds of the rotation's deviation about x, y, z [rad], in -pi .. pi, or both infinite: none.

        Raises:
            SignatureError: a keyword that is no field.
            InvalidArgumentError: a value of the wrong type or out of range.
        """
    def to_dict(self) -> dict[str, typing.Any]:
        """
        All fields by name as plain Python data, with the names of enums in their place.
        """
    @property
    def constrained_axes(self) -> int:
        """
        Number of axes that are not free, 0 to 6.
        """
    @property
    def frame(self) -> TaskFrame:
        """
        Axes that the tolerances of a task lie along.
        """
    @property
    def is_full_pose(self) -> bool:
        """
        Whether every tolerance is zero.
        """
    @property
    def position_lower(self) -> tuple[float, float, float]:
        """
        Bounds of the position's deviation along x, y, z [m]; infinite: none.
        """
    @property
    def position_upper(self) -> tuple[float, float, float]:
        """
        Bounds of the position's deviation along x, y, z [m]; infinite: none.
        """
    @property
    def rotation_lower(self) -> tuple[float, float, float]:
        """
        Bounds of the rotation's deviation about x, y, z [rad], in -pi .. pi, or both infinite: none.
        """
    @property
    def rotation_upper(self) -> tuple[float, float, float]:
        """
        Bounds of the rotation's deviation about x, y, z [rad], in -pi .. pi, or both infinite: none.
        """
class DatabaseOptions:
    """
    How a database is built. Enums may be given by name, as in sampling='grid'.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    @staticmethod
    def paper(year: int = 2025) -> DatabaseOptions:
        """
        The paper's: grid, medium, rotation vectors, unweighted. Of 2026: 2,048 samples by kmeans. Raises InvalidArgumentError on a year other than 2025 and 2026.
        """
    def __eq__(self, other: object) -> bool:
        ...
    def __init__(self, *, sampling: Sampling | str = 'low_discrepancy', scale: Scale | str = 'medium', samples: int = 2000, key_scheme: KeyScheme | str = 'reduced', rotation_key: RotationKey | str = 'rotation_vector', rotation_weight: float = 0.0, pinv_cutoff: float = 0.0001, cvt_updates: int = 1000000, kmeans_pool: int = 200000, kmeans_rounds: int = 20, seed: int = 0, threads: int = 0) -> None:
        """
        Fields that are not given keep their default.

        Args:
            sampling: How the samples are spread over the limits.
            scale: Counts of a grid; for the other samplings only if `samples` is 0.
            samples: Number of samples unless `sampling` is grid; 0 takes the grid's count at `scale`.
            key_scheme: What of a pose the key holds.
            rotation_key: How a full key writes a rotation.
            rotation_weight: Length that one unit of the key's rotation part counts as in the tree's distance [m]; 0: a quarter of the reach.
            pinv_cutoff: Singular values below this part of the largest are cut off in the pseudo-inverses.
            cvt_updates: Updates of MacQueen's method (cvt only).
            kmeans_pool: Random configurations whose centroids the samples are; only read by kmeans.
            kmeans_rounds: Rounds in which each of these goes to the nearest sample, and each sample to the mean of its own; only read by kmeans.
            seed: Seed of all samplings but grid.
            threads: Threads that work; 0: one per core. The result has the same bits for any number.

        Raises:
            SignatureError: a keyword that is no field.
            InvalidArgumentError: a value of the wrong type or out of range.
        """
    def __repr__(self) -> str:
        ...
    def replace(self, *, sampling: Sampling | str = ..., scale: Scale | str = ..., samples: int = ..., key_scheme: KeyScheme | str = ..., rotation_key: RotationKey | str = ..., rotation_weight: float = ..., pinv_cutoff: float = ..., cvt_updates: int = ..., kmeans_pool: int = ..., kmeans_rounds: int = ..., seed: int = ..., threads: int = ...) -> DatabaseOptions:
        """
        A copy in which the given fields have another value.

        Args:
            sampling: How the samples are spread over the limits.
            scale: Counts of a grid; for the other samplings only if `samples` is 0.
            samples: Number of samples unless `sampling` is grid; 0 takes the grid's count at `scale`.
            key_scheme: What of a pose the key holds.
            rotation_key: How a full key writes a rotation.
            rotation_weight: Length that one unit of the key's rotation part counts as in the tree's distance [m]; 0: a quarter of the reach.
            pinv_cutoff: Singular values below this part of the largest are cut off in the pseudo-inverses.
            cvt_updates: Updates of MacQueen's method (cvt only).
            kmeans_pool: Random configurations whose centroids the samples are; only read by kmeans.
            kmeans_rounds: Rounds in which each of these goes to the nearest sample, and each sample to the mean of its own; only read by kmeans.
            seed: Seed of all samplings but grid.
            threads: Threads that work; 0: one per core. The result has the same bits for any number.

        Raises:
            SignatureError: a keyword that is no field.
            InvalidArgumentError: a value of the wrong type or out of range.
        """
    def to_dict(self) -> dict[str, typing.Any]:
        """
        All fields by name as plain Python data, with the names of enums in their place.
        """
    def validate(self) -> None:
        """
        Raises InvalidArgumentError naming the first option out of range.
        """
    @property
    def cvt_updates(self) -> int:
        """
        Updates of MacQueen's method (cvt only).
        """
    @cvt_updates.setter
    def cvt_updates(self, value: int) -> None:
        ...
    @property
    def key_scheme(self) -> KeyScheme:
        """
        What of a pose the key holds.
        """
    @key_scheme.setter
    def key_scheme(self, value: KeyScheme | str) -> None:
        ...
    @property
    def kmeans_pool(self) -> int:
        """
        Random configurations whose centroids the samples are; only read by kmeans.
        """
    @kmeans_pool.setter
    def kmeans_pool(self, value: int) -> None:
        ...
    @property
    def kmeans_rounds(self) -> int:
        """
        Rounds in which each of these goes to the nearest sample, and each sample to the mean of its own; only read by kmeans.
        """
    @kmeans_rounds.setter
    def kmeans_rounds(self, value: int) -> None:
        ...
    @property
    def pinv_cutoff(self) -> float:
        """
        Singular values below this part of the largest are cut off in the pseudo-inverses.
        """
    @pinv_cutoff.setter
    def pinv_cutoff(self, value: float) -> None:
        ...
    @property
    def rotation_key(self) -> RotationKey:
        """
        How a full key writes a rotation.
        """
    @rotation_key.setter
    def rotation_key(self, value: RotationKey | str) -> None:
        ...
    @property
    def rotation_weight(self) -> float:
        """
        Length that one unit of the key's rotation part counts as in the tree's distance [m]; 0: a quarter of the reach.
        """
    @rotation_weight.setter
    def rotation_weight(self, value: float) -> None:
        ...
    @property
    def samples(self) -> int:
        """
        Number of samples unless `sampling` is grid; 0 takes the grid's count at `scale`.
        """
    @samples.setter
    def samples(self, value: int) -> None:
        ...
    @property
    def sampling(self) -> Sampling:
        """
        How the samples are spread over the limits.
        """
    @sampling.setter
    def sampling(self, value: Sampling | str) -> None:
        ...
    @property
    def scale(self) -> Scale:
        """
        Counts of a grid; for the other samplings only if `samples` is 0.
        """
    @scale.setter
    def scale(self, value: Scale | str) -> None:
        ...
    @property
    def seed(self) -> int:
        """
        Seed of all samplings but grid.
        """
    @seed.setter
    def seed(self, value: int) -> None:
        ...
    @property
    def threads(self) -> int:
        """
        Threads that work; 0: one per core. The result has the same bits for any number.
        """
    @threads.setter
    def threads(self, value: int) -> None:
        ...
class Lanes:
    """
    Seeds in SIMD lanes, many at once, by Levenberg-Marquardt with the limits inside the step: the recommended strategy. Where the chain has a closed form (Robot.structure), seeds come from that first. Over a database with a full key the same scheme takes one seed at a time.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, other: object) -> bool:
        ...
    def __init__(self, *, neighbours: int = 200, damping: float = 0.001) -> None:
        """
        Fields that are not given keep their default.

        Args:
            neighbours: Samples nearest to the target that are all tried, before the better half of the others and seeds at random.
            damping: Factor on |e|^2, which is added to the diagonal of J J^T [mixed units; lengths in metres, of arms that reach less than 0.35 m or more than 11 m in a power of 32 of them].

        Raises:
            SignatureError: a keyword that is no field.
            InvalidArgumentError: a value of the wrong type or out of range.
        """
    def __repr__(self) -> str:
        ...
    def replace(self, *, neighbours: int = ..., damping: float = ...) -> Lanes:
        """
        A copy in which the given fields have another value.

        Args:
            neighbours: Samples nearest to the target that are all tried, before the better half of the others and seeds at random.
            damping: Factor on |e|^2, which is added to the diagonal of J J^T [mixed units; lengths in metres, of arms that reach less than 0.35 m or more than 11 m in a power of 32 of them].

        Raises:
            SignatureError: a keyword that is no field.
            InvalidArgumentError: a value of the wrong type or out of range.
        """
    def to_dict(self) -> dict[str, typing.Any]:
        """
        All fields by name as plain Python data, with the names of enums in their place.
        """
    def validate(self) -> None:
        """
        Raises InvalidArgumentError naming the first option out of range.
        """
    @property
    def damping(self) -> float:
        """
        Factor on |e|^2, which is added to the diagonal of J J^T [mixed units; lengths in metres, of arms that reach less than 0.35 m or more than 11 m in a power of 32 of them].
        """
    @property
    def neighbours(self) -> int:
        """
        Samples nearest to the target that are all tried, before the better half of the others and seeds at random.
        """
class Paper:
    """
    The pipeline of the paper: query, rank, iterate, re-select, one seed at a time. The defaults are the paper's: k = 200, Eq. (5) of the paper, best 20, farthest first, DLS, KDL's kinematics. Enums may be given by name, as in iteration='dls'. A field that the chosen scheme does not read has to be at its default.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, other: object) -> bool:
        ...
    def __init__(self, *, neighbours: int = 200, neighbour_radius: float = 0.0, ranking: Ranking | str = 'joint_adjustment', rotation_difference: RotationDifference | str = 'rotation_vector', limit_aware: bool = False, candidates: int = 20, reselection: Reselection | str = 'farthest', iteration: Iteration | str = 'dls', damping: float = 0.0, pinv_cutoff: float = 0.0001, position_clamp: float = 0.1, rotation_clamp: float = 0.3141592653589793, growth_stop: GrowthStop | str = 'by_scheme', min_step: float = 1e-06, limits_stop: bool = False, null_space_gain: float = 0.0, limit_margin: float = 0.1, whole_turns: bool = False, kinematics: Kinematics | str = 'kdl') -> None:
        """
        Fields that are not given keep their default.

        Args:
            neighbours: Neighbours asked from the KD-tree (k).
            neighbour_radius: Samples whose key is farther than this from the target's are no seeds: the root of the threshold of Eq. (3) of the paper, in metres with rotations weighted by the database's rotation_weight. 0: no threshold.
            ranking: How the neighbours of a target are put in order.
            rotation_difference: The rotation part of x_target - x_i in Eq. (4) of the paper; read where seeds are ranked by Eq. (5) of the paper or limit-aware.
            limit_aware: Rank candidates whose predicted q + J^+ e leaves the limits behind all others.
            candidates: Best candidates kept after ranking; read unless re-selection is `none`.
            reselection: Which seed follows a failed one.
            iteration: One scheme of numerical iteration (paper, Table II).
            damping: dls: added to J J^T [mixed units]; 0: truncated least squares. lm: factor on |e|^2. Read by these two.
            pinv_cutoff: Singular values below this part of the largest are cut off (dls, pinv, pinv_rr, cwpi).
            position_clamp: The error fed to one step is shortened to at most this: position [m] and rotation [rad]. Read by all but lm.
            rotation_clamp: The error fed to one step is shortened to at most this: position [m] and rotation [rad]. Read by all but lm.
            growth_stop: Whether an attempt is given up when both errors have grown.
            min_step: An attempt ends, or that of pinv_rr restarts, when |sum of the step| is below this (dls, pinv, pinv_rr, cwpi) [rad or m].
            limits_stop: An attempt ends once it is within the tolerances, also outside the limits, instead of going on (dls, pinv, pinv_rr, cwpi; the others always do).
            null_space_gain: Part of the way to the middle of the limits that each step of a chain of more than six joints makes besides, as far as the pose lets it: in the Jacobian's null space (dls, pinv, pinv_rr).
            limit_margin: Part of a joint's range, at each end, in which cwln and cwpi hold it back.
            whole_turns: Bring joints with a range of more than 2 pi inside their limits by whole turns.
            kinematics: What computes FK and Jacobians of the iterations. The kernel agrees to 1e-12, and is faster.

        Raises:
            SignatureError: a keyword that is no field.
            InvalidArgumentError: a value of the wrong type or out of range.
        """
    def __repr__(self) -> str:
        ...
    def replace(self, *, neighbours: int = ..., neighbour_radius: float = ..., ranking: Ranking | str = ..., rotation_difference: RotationDifference | str = ..., limit_aware: bool = ..., candidates: int = ..., reselection: Reselection | str = ..., iteration: Iteration | str = ..., damping: float = ..., pinv_cutoff: float = ..., position_clamp: float = ..., rotation_clamp: float = ..., growth_stop: GrowthStop | str = ..., min_step: float = ..., limits_stop: bool = ..., null_space_gain: float = ..., limit_margin: float = ..., whole_turns: bool = ..., kinematics: Kinematics | str = ...) -> Paper:
        """
        A copy in which the given fields have another value.

        Args:
            neighbours: Neighbours asked from the KD-tree (k).
            neighbour_radius: Samples whose key is farther than this from the target's are no seeds: the root of the threshold of Eq. (3) of the paper, in metres with rotations weighted by the database's rotation_weight. 0: no threshold.
            ranking: How the neighbours of a target are put in order.
            rotation_difference: The rotation part of x_target - x_i in Eq. (4) of the paper; read where seeds are ranked by Eq. (5) of the paper or limit-aware.
            limit_aware: Rank candidates whose predicted q + J^+ e leaves the limits behind all others.
            candidates: Best candidates kept after ranking; read unless re-selection is `none`.
            reselection: Which seed follows a failed one.
            iteration: One scheme of numerical iteration (paper, Table II).
            damping: dls: added to J J^T [mixed units]; 0: truncated least squares. lm: factor on |e|^2. Read by these two.
            pinv_cutoff: Singular values below this part of the largest are cut off (dls, pinv, pinv_rr, cwpi).
            position_clamp: The error fed to one step is shortened to at most this: position [m] and rotation [rad]. Read by all but lm.
            rotation_clamp: The error fed to one step is shortened to at most this: position [m] and rotation [rad]. Read by all but lm.
            growth_stop: Whether an attempt is given up when both errors have grown.
            min_step: An attempt ends, or that of pinv_rr restarts, when |sum of the step| is below this (dls, pinv, pinv_rr, cwpi) [rad or m].
            limits_stop: An attempt ends once it is within the tolerances, also outside the limits, instead of going on (dls, pinv, pinv_rr, cwpi; the others always do).
            null_space_gain: Part of the way to the middle of the limits that each step of a chain of more than six joints makes besides, as far as the pose lets it: in the Jacobian's null space (dls, pinv, pinv_rr).
            limit_margin: Part of a joint's range, at each end, in which cwln and cwpi hold it back.
            whole_turns: Bring joints with a range of more than 2 pi inside their limits by whole turns.
            kinematics: What computes FK and Jacobians of the iterations. The kernel agrees to 1e-12, and is faster.

        Raises:
            SignatureError: a keyword that is no field.
            InvalidArgumentError: a value of the wrong type or out of range.
        """
    def to_dict(self) -> dict[str, typing.Any]:
        """
        All fields by name as plain Python data, with the names of enums in their place.
        """
    def validate(self) -> None:
        """
        Raises InvalidArgumentError naming the first option that is out of range, or that differs from its default though nothing reads it.
        """
    @property
    def candidates(self) -> int:
        """
        Best candidates kept after ranking; read unless re-selection is `none`.
        """
    @property
    def damping(self) -> float:
        """
        dls: added to J J^T [mixed units]; 0: truncated least squares. lm: factor on |e|^2. Read by these two.
        """
    @property
    def growth_stop(self) -> GrowthStop:
        """
        Whether an attempt is given up when both errors have grown.
        """
    @property
    def iteration(self) -> Iteration:
        """
        One scheme of numerical iteration (paper, Table II).
        """
    @property
    def kinematics(self) -> Kinematics:
        """
        What computes FK and Jacobians of the iterations. The kernel agrees to 1e-12, and is faster.
        """
    @property
    def limit_aware(self) -> bool:
        """
        Rank candidates whose predicted q + J^+ e leaves the limits behind all others.
        """
    @property
    def limit_margin(self) -> float:
        """
        Part of a joint's range, at each end, in which cwln and cwpi hold it back.
        """
    @property
    def limits_stop(self) -> bool:
        """
        An attempt ends once it is within the tolerances, also outside the limits, instead of going on (dls, pinv, pinv_rr, cwpi; the others always do).
        """
    @property
    def min_step(self) -> float:
        """
        An attempt ends, or that of pinv_rr restarts, when |sum of the step| is below this (dls, pinv, pinv_rr, cwpi) [rad or m].
        """
    @property
    def neighbour_radius(self) -> float:
        """
        Samples whose key is farther than this from the target's are no seeds: the root of the threshold of Eq. (3) of the paper, in metres with rotations weighted by the database's rotation_weight. 0: no threshold.
        """
    @property
    def neighbours(self) -> int:
        """
        Neighbours asked from the KD-tree (k).
        """
    @property
    def null_space_gain(self) -> float:
        """
        Part of the way to the middle of the limits that each step of a chain of more than six joints makes besides, as far as the pose lets it: in the Jacobian's null space (dls, pinv, pinv_rr).
        """
    @property
    def pinv_cutoff(self) -> float:
        """
        Singular values below this part of the largest are cut off (dls, pinv, pinv_rr, cwpi).
        """
    @property
    def position_clamp(self) -> float:
        """
        The error fed to one step is shortened to at most this: position [m] and rotation [rad]. Read by all but lm.
        """
    @property
    def ranking(self) -> Ranking:
        """
        How the neighbours of a target are put in order.
        """
    @property
    def reselection(self) -> Reselection:
        """
        Which seed follows a failed one.
        """
    @property
    def rotation_clamp(self) -> float:
        """
        The error fed to one step is shortened to at most this: position [m] and rotation [rad]. Read by all but lm.
        """
    @property
    def rotation_difference(self) -> RotationDifference:
        """
        The rotation part of x_target - x_i in Eq. (4) of the paper; read where seeds are ranked by Eq. (5) of the paper or limit-aware.
        """
    @property
    def whole_turns(self) -> bool:
        """
        Bring joints with a range of more than 2 pi inside their limits by whole turns.
        """
class SolverOptions:
    """
    All settings of a Solver. SolverOptions() is the recommended preset, SolverOptions.paper() the paper. What only one strategy reads is a field of that. As in SolverOptions(strategy=Paper(iteration='dls')).
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    @staticmethod
    def paper(year: int = 2025) -> SolverOptions:
        """
        The paper's setting: medium grid, the defaults of Paper, one re-selection, 1e-4 m and 1e-3 rad. Of 2026: its authors' newer one as https://github.com/wanweiwei07/one runs it at commit 96c863f1: 2,048 samples by kmeans, of the 200 nearest the 16 best by Eq. (5) of the paper in that order, 12 configurations each, without stops on growth and small steps, redundant joints towards the middle of their limits. Raises InvalidArgumentError on another year.
        """
    def __eq__(self, other: object) -> bool:
        ...
    def __init__(self, *, position_tolerance: float = 1e-06, rotation_tolerance: float = 1e-06, task: Task | collections.abc.Mapping[str, typing.Any] = ..., max_attempts: int = 1024, max_iterations: int = 20, seed: int = 0, database: DatabaseOptions | collections.abc.Mapping[str, typing.Any] = ..., strategy: Lanes | Paper | str | collections.abc.Mapping[str, typing.Any] = ...) -> None:
        """
        Fields that are not given keep their default.

        Args:
            position_tolerance: An answer's position is at most this far from the target's [m]. Below about 1e-15 of what the arm reaches a double cannot tell: poses may not be found then, which proves nothing.
            rotation_tolerance: An answer's rotation vector error is at most this long [rad].
            task: What of a pose has to be reached: all of it, or a box with free axes.
            max_attempts: Seeds tried at most: 1 + the number of re-selections (#ReA). Given seeds come on top.
            max_iterations: Steps per attempt at most.
            seed: Seed of random restarts.
            database: Database that a solver builds for itself when it is given none.
            strategy: How seeds are selected and iterated: Lanes or Paper.

        Raises:
            SignatureError: a keyword that is no field.
            InvalidArgumentError: a value of the wrong type or out of range.
        """
    def __repr__(self) -> str:
        ...
    def replace(self, *, position_tolerance: float = ..., rotation_tolerance: float = ..., task: Task | collections.abc.Mapping[str, typing.Any] = ..., max_attempts: int = ..., max_iterations: int = ..., seed: int = ..., database: DatabaseOptions | collections.abc.Mapping[str, typing.Any] = ..., strategy: Lanes | Paper | str | collections.abc.Mapping[str, typing.Any] = ...) -> SolverOptions:
        """
        A copy in which the given fields have another value.

        Args:
            position_tolerance: An answer's position is at most this far from the target's [m]. Below about 1e-15 of what the arm reaches a double cannot tell: poses may not be found then, which proves nothing.
            rotation_tolerance: An answer's rotation vector error is at most this long [rad].
            task: What of a pose has to be reached: all of it, or a box with free axes.
            max_attempts: Seeds tried at most: 1 + the number of re-selections (#ReA). Given seeds come on top.
            max_iterations: Steps per attempt at most.
            seed: Seed of random restarts.
            database: Database that a solver builds for itself when it is given none.
            strategy: How seeds are selected and iterated: Lanes or Paper.

        Raises:
            SignatureError: a keyword that is no field.
            InvalidArgumentError: a value of the wrong type or out of range.
        """
    def to_dict(self) -> dict[str, typing.Any]:
        """
        All fields by name as plain Python data, with the names of enums in their place.
        """
    def validate(self) -> None:
        """
        Raises InvalidArgumentError naming the first option out of range.
        """
    @property
    def database(self) -> DatabaseOptions:
        """
        Database that a solver builds for itself when it is given none.
        """
    @database.setter
    def database(self, value: DatabaseOptions | collections.abc.Mapping[str, typing.Any]) -> None:
        ...
    @property
    def max_attempts(self) -> int:
        """
        Seeds tried at most: 1 + the number of re-selections (#ReA). Given seeds come on top.
        """
    @max_attempts.setter
    def max_attempts(self, value: int) -> None:
        ...
    @property
    def max_iterations(self) -> int:
        """
        Steps per attempt at most.
        """
    @max_iterations.setter
    def max_iterations(self, value: int) -> None:
        ...
    @property
    def position_tolerance(self) -> float:
        """
        An answer's position is at most this far from the target's [m]. Below about 1e-15 of what the arm reaches a double cannot tell: poses may not be found then, which proves nothing.
        """
    @position_tolerance.setter
    def position_tolerance(self, value: float) -> None:
        ...
    @property
    def rotation_tolerance(self) -> float:
        """
        An answer's rotation vector error is at most this long [rad].
        """
    @rotation_tolerance.setter
    def rotation_tolerance(self, value: float) -> None:
        ...
    @property
    def seed(self) -> int:
        """
        Seed of random restarts.
        """
    @seed.setter
    def seed(self, value: int) -> None:
        ...
    @property
    def strategy(self) -> Lanes | Paper:
        """
        How seeds are selected and iterated: Lanes or Paper.
        """
    @strategy.setter
    def strategy(self, value: Lanes | Paper | str | collections.abc.Mapping[str, typing.Any]) -> None:
        ...
    @property
    def task(self) -> Task:
        """
        What of a pose has to be reached: all of it, or a box with free axes.
        """
    @task.setter
    def task(self, value: Task | collections.abc.Mapping[str, typing.Any]) -> None:
        ...
class Database:
    """
    An immutable set of samples (q_i, x_i, J_i^+); copies are cheap and share the data. Safe to use from many threads at once.
    """
    @staticmethod
    def build(robot: Robot, options: DatabaseOptions | collections.abc.Mapping[str, typing.Any] = ..., progress: collections.abc.Callable[[int, int], typing.Any] | None = None) -> Database:
        """
        Samples the joint limits and computes pose, Jacobian and pseudo-inverse.

        Args:
            robot: the chain; its TCP plays no part.
            options: how to sample.
            progress: called now and then with (samples done, samples in all). What it raises ends
                the build. The GIL is released between calls, and Ctrl-C works.

        Raises:
            InvalidArgumentError: an option out of range.
            DatabaseError: more samples than fit.
        """
    @staticmethod
    def from_bytes(content: bytes) -> Database:
        """
        The database that `to_bytes` wrote. Raises as `load`.
        """
    @staticmethod
    def load(path: str | os.PathLike[str], *, mmap: bool = False) -> Database:
        """
        Reads a file, after which it may be changed or removed.

        Args:
            path: what `save` wrote.
            mmap: leave the samples, most of a large file, in the file and map them read-only, so
                that processes that load one file share them. The file may then be replaced (`save`
                does so) or removed, but should not be written to: what is overwritten in place is
                not noticed, and makes seeds worse, never an answer wrong. Where a file is cut short,
                the call under way still ends, and the next one on the database or a solver of it
                raises DatabaseIoError; for this the first such load installs a handler of SIGBUS,
                which passes on what is not its own. At most 256 files are mapped at once.

        Raises:
            DatabaseIoError: the file cannot be read.
            DatabaseCorruptError: the file is damaged or no database.
            DatabaseMismatchError: another format version or byte order.
        """
    def __copy__(self) -> Database:
        ...
    def __deepcopy__(self, memo: dict[int, object]) -> Database:
        ...
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def nearest(self, pose: numpy.typing.ArrayLike | typing.Any, k: int) -> numpy.typing.NDArray[numpy.int64]:
        """
        Indices of the k samples whose keys are nearest to that of T_base_tip (of the tip link), nearest first; Eq. (2) of the paper.
        """
    def pose(self, i: int) -> numpy.typing.NDArray[numpy.float64]:
        """
        T_base_tip of sample i, (4, 4), of the tip link without the TCP.
        """
    def pseudo_inverse(self, i: int) -> numpy.typing.NDArray[numpy.float64]:
        """
        J^+ of sample i, as in Eq. (4) of the paper, (dof, 6).
        """
    def q(self, i: int) -> numpy.typing.NDArray[numpy.float64]:
        """
        Joint values of sample i [rad or m], (dof,).
        """
    def save(self, path: str | os.PathLike[str]) -> None:
        """
        Writes beside `path` and renames, so that a crash leaves the old file or the new one.

        Removes files named iksel-*.tmp in the same folder that saves which were killed have left.

        Raises:
            DatabaseIoError: the file cannot be written; an old one is untouched.
        """
    def to_bytes(self) -> bytes:
        """
        The content of a file, for pickling and sending.
        """
    @property
    def chain_hash(self) -> int:
        """
        Robot.chain_hash of the robot it belongs to.
        """
    @property
    def dof(self) -> int:
        """
        Degrees of freedom of its robot.
        """
    @property
    def key_dimension(self) -> int:
        """
        Dimension of the KD-tree's key.
        """
    @property
    def nbytes(self) -> int:
        """
        Bytes of all that it holds: samples, keys and pseudo-inverses, the trees over them, and the copies that are laid out for the lanes. Bytes of a mapped file are among them.
        """
    @property
    def options(self) -> DatabaseOptions:
        """
        Options it was built with (`threads` as given then).
        """
    @property
    def size(self) -> int:
        """
        Number of samples.
        """
class RobotSpheres:
    """
    Spheres that cover the links of a robot, and which links may not touch each other. Spheres that cover a link may refuse a configuration that is free, but never pass a contact.
    """
    def __init__(self, links: collections.abc.Mapping[str, numpy.typing.ArrayLike], pairs: collections.abc.Iterable[tuple[str, str]] | None = None) -> None:
        """
        Takes spheres as they are.

        Args:
            links: for each link that has a body its spheres, (N, 4), rows of centre in the link's frame and
                radius [m].
            pairs: pairs of links that are looked at for collisions with each other; None: no pair.

        Raises:
            InvalidArgumentError: a sphere that is not finite or whose radius is not above 0, a link
                without any, a pair of one link or of a link that is not in `links`.
        """
    def __repr__(self) -> str:
        ...
    @property
    def links(self) -> dict[str, numpy.typing.NDArray[numpy.float64]]:
        """
        For each link its spheres, (N, 4), rows of centre in the link's frame and radius [m].
        """
    @property
    def pairs(self) -> list[tuple[str, str]]:
        """
        Pairs of links that are looked at for collisions with each other.
        """
class Contact:
    """
    Two things that touch.
    """
    def __repr__(self) -> str:
        ...
    @property
    def depth(self) -> float:
        """
        How far they would have to part, margins included [m]; 0 or more.
        """
    @property
    def is_obstacle(self) -> bool:
        """
        Whether `other` is an obstacle.
        """
    @property
    def link(self) -> str:
        """
        A link of the robot or an attached object.
        """
    @property
    def other(self) -> str:
        """
        What it touches: an obstacle, a link or an attached object.
        """
class Obstacle:
    """
    A shape at a pose, as a Scene holds it.
    """
    def __repr__(self) -> str:
        ...
    @property
    def length(self) -> float:
        """
        capsule: of the segment; cylinder [m].
        """
    @property
    def margin(self) -> float:
        """
        The arm keeps this far away [m].
        """
    @property
    def points(self) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        In the obstacle's frame [m], (n, 3). None of other shapes.
        """
    @property
    def pose(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        T_base_obstacle, (4, 4).
        """
    @property
    def radius(self) -> float:
        """
        sphere, capsule, cylinder, points [m].
        """
    @property
    def shape(self) -> str:
        """
        What it is: sphere, box, capsule, cylinder, half_space or points.
        """
    @property
    def size(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        box: edges [m], (3,).
        """
class Scene:
    """
    A robot's body and what it may not touch. A value: copies share what neither of them changes, and one does not see what is done to another. Safe to use from many threads at once as long as none changes it.

    The arm is where its spheres are, so that what is free has no contact as long as they cover it. Links that no joint of the arm moves are not held against obstacles, which stand as still.
    """
    def __copy__(self) -> Scene:
        ...
    def __deepcopy__(self, memo: dict[int, object]) -> Scene:
        ...
    def __init__(self, robot: Robot, spheres: RobotSpheres, other_joints: collections.abc.Mapping[str, float] | None = None) -> None:
        """
        Begins with the robot alone.

        Args:
            robot: whose joint values are asked about; solvers of the same chain take the scene, whatever
                their tool.
            spheres: its body, which iksel.spheres makes from a URDF or reads from a sphere file.
            other_joints: values of joints that are not the arm's [rad or m], by name, as in
                Robot.link_poses.

        Raises:
            InvalidArgumentError: no spheres, or a base link that the arm's joints move.
            UnknownNameError: the URDF lacks a link of the spheres, or a joint.
        """
    def __repr__(self) -> str:
        ...
    def add_box(self, name: str, size: numpy.typing.ArrayLike, pose: numpy.typing.ArrayLike | typing.Any, margin: float = 0.0) -> None:
        """
        Adds a box centred at the origin of its frame.

        Args:
            name: its name, under which one that is there is replaced.
            size: edges along the axes of its frame, (3,) [m].
            pose: T_base_obstacle [m], as in Solver.solve; or a position (3,), unturned.
            margin: the arm keeps this far away [m].

        Raises:
            InvalidArgumentError: a number or shape that is no good, or a name that a link or an attached
                object has.
        """
    def add_capsule(self, name: str, radius: float, length: float, pose: numpy.typing.ArrayLike | typing.Any, margin: float = 0.0) -> None:
        """
        Adds all that is near a segment on the z axis of its frame, centred at the origin.

        Args:
            name: its name, under which one that is there is replaced.
            radius: how near, above 0 [m].
            length: of the segment, 0 or more [m].
            pose: T_base_obstacle [m], as in Solver.solve; or a position (3,), unturned.
            margin: the arm keeps this far away [m].

        Raises:
            InvalidArgumentError: a number or shape that is no good, or a name that a link or an attached
                object has.
        """
    def add_cylinder(self, name: str, radius: float, length: float, pose: numpy.typing.ArrayLike | typing.Any, margin: float = 0.0) -> None:
        """
        Adds a cylinder around the z axis of its frame, centred at the origin.

        Args:
            name: its name, under which one that is there is replaced.
            radius: above 0 [m].
            length: above 0 [m].
            pose: T_base_obstacle [m], as in Solver.solve; or a position (3,), unturned.
            margin: the arm keeps this far away [m].

        Raises:
            InvalidArgumentError: a number or shape that is no good, or a name that a link or an attached
                object has.
        """
    def add_half_space(self, name: str, pose: numpy.typing.ArrayLike | typing.Any, margin: float = 0.0) -> None:
        """
        Adds all that is below the plane z = 0 of its frame.

        Args:
            name: its name, under which one that is there is replaced.
            pose: T_base_obstacle [m], as in Solver.solve; or a position (3,), unturned.
            margin: the arm keeps this far away [m].

        Raises:
            InvalidArgumentError: a number or shape that is no good, or a name that a link or an attached
                object has.
        """
    def add_points(self, name: str, points: numpy.typing.ArrayLike, radius: float, pose: numpy.typing.ArrayLike | typing.Any | None = None, margin: float = 0.0) -> None:
        """
        Adds a ball around each point of a cloud.

        Args:
            name: its name, under which one that is there is replaced.
            points: in the cloud's frame, (N, 3) [m].
            radius: of the balls, 0 or more [m].
            pose: T_base_obstacle [m], as in Solver.solve; or a position (3,), unturned.
            margin: the arm keeps this far away [m].

        Raises:
            InvalidArgumentError: a number or shape that is no good, or a name that a link or an attached
                object has.
        """
    def add_sphere(self, name: str, radius: float, pose: numpy.typing.ArrayLike | typing.Any, margin: float = 0.0) -> None:
        """
        Adds a ball around the origin of its frame.

        Args:
            name: its name, under which one that is there is replaced.
            radius: above 0 [m].
            pose: T_base_obstacle [m], as in Solver.solve; or a position (3,), unturned.
            margin: the arm keeps this far away [m].

        Raises:
            InvalidArgumentError: a number or shape that is no good, or a name that a link or an attached
                object has.
        """
    def attach(self, name: str, link: str, spheres: numpy.typing.ArrayLike, may_touch: collections.abc.Iterable[str] | None = None) -> None:
        """
        Has a link carry an object from now on.

        Args:
            name: of the object, under which one that is there is replaced.
            link: that carries it.
            spheres: that cover it, (N, 4), rows of centre in the link's frame and radius [m].
            may_touch: links and other objects that it may touch; what does not move against it always may.

        Raises:
            UnknownNameError: the URDF lacks the link, or nothing has a name of `may_touch`.
            InvalidArgumentError: a sphere that is no good, or a name that a link or an obstacle has.
        """
    def contacts(self, q: numpy.typing.ArrayLike) -> list[Contact]:
        """
        What touches at q, (dof,) [rad or m], the deepest first: of each link and each thing that it touches, where they overlap most.
        """
    def is_free(self, q: numpy.typing.ArrayLike) -> bool | typing.Any:
        """
        Whether nothing touches at q [rad or m], (dof,); of (N, dof) values each, (N,).
        """
    def move(self, name: str, pose: numpy.typing.ArrayLike | typing.Any) -> None:
        """
        Puts an obstacle elsewhere.

        Args:
            name: of the obstacle.
            pose: T_base_obstacle [m], or a position (3,), unturned.

        Raises:
            UnknownNameError: no obstacle has that name.
            InvalidArgumentError: a pose that is none.
        """
    def remove(self, name: str) -> None:
        """
        Removes an obstacle or an attached object.

        Args:
            name: its name.

        Raises:
            UnknownNameError: nothing has that name.
        """
    @property
    def attached(self) -> dict[str, str]:
        """
        Names of the attached objects, and the links that carry them.
        """
    @property
    def attached_spheres(self) -> dict[str, numpy.typing.NDArray[numpy.float64]]:
        """
        Of each attached object its spheres, (N, 4), rows of centre in the link's frame and radius [m].
        """
    @property
    def may_touch(self) -> dict[str, list[str]]:
        """
        Of each attached object the links and other objects that it may touch.
        """
    @property
    def obstacles(self) -> dict[str, Obstacle]:
        """
        The obstacles by name.
        """
    @property
    def other_joints(self) -> dict[str, float]:
        """
        Values of joints that are not the arm's [rad or m], by name.
        """
    @property
    def robot(self) -> Robot:
        """
        The robot.
        """
    @property
    def spheres(self) -> RobotSpheres:
        """
        Its body.
        """
class ObjectiveKind(enum.Enum):
    """
    What an Objective counts.
    """
    custom = 4
    limits = 2
    manipulability = 3
    none = 0
    posture = 1
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
class Objective:
    """
    A cost of joint values, the smaller the better. Among all answers found the cheapest is taken; where the task leaves the arm free to move (more joints than fixed axes) the best are first moved along their self-motion to a local minimum of the cost. Immutable.
    """
    @staticmethod
    def custom(cost: collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], typing.Any], gradient: collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], typing.Any] | None = None) -> Objective:
        """
        The cost of joint values (dof,) inside the limits, a number, and its gradient (dof,); without one, central differences of the cost. A cost of +inf refuses the joint values; NaN, -inf, or a gradient that is not finite is an InvalidArgumentError.
        """
    @staticmethod
    def far_from_limits() -> Objective:
        """
        Far from the limits: sum 1/4 (1/x_i + 1/(1 - x_i)), x_i in 0 .. 1 the place between them, of joints and of coupled limits; joints without limits do not count (Zghal, Dubey and Euler 1990). Nearer to a limit than 1e-4 the sum goes on in a straight line.
        """
    @staticmethod
    def most_manipulable() -> Objective:
        """
        Far from singularities: -sqrt(det(J J^T)) (Yoshikawa 1985); of J^T J with fewer than 6 joints.
        """
    @staticmethod
    def near_posture(posture: numpy.typing.ArrayLike, weights: numpy.typing.ArrayLike | None = None) -> Objective:
        """
        Near joint values [rad or m], inside the limits or not: 1/2 sum (w_i (q_i - posture_i))^2, weights >= 0, or all 1. Both are (dof,).
        """
    @staticmethod
    def preferred(robot: Robot, values: collections.abc.Mapping[str, float], weights: collections.abc.Mapping[str, float] | None = None) -> Objective:
        """
        Some joints, as a rail or a turntable, at a value where that is possible, else as near to it as may be: near_posture with weights of these joints only. Values by joint [rad or m], and weights, > 0, of those that are to have another than 1. Between answers that are equally good the request's `near` decides, or else the middle of the limits. Raises UnknownNameError naming a joint that the robot does not have, InvalidArgumentError a number that is no good.
        """
    def __repr__(self) -> str:
        ...
    @property
    def kind(self) -> ObjectiveKind:
        """
        What it counts.
        """
class Status(enum.IntEnum):
    """
    Why a solve ended.
    """
    closest = 8
    in_collision = 9
    invalid_pose = 7
    not_converged = 1
    out_of_reach = 3
    out_of_time = 5
    outside_limits = 2
    rejected = 4
    solved = 0
    too_fast = 6
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
class Proof(enum.IntEnum):
    """
    What makes sure of what a result says: of one without an answer that there is none, of a set of solutions that there are no others.
    """
    answer = 6
    closed_form = 2
    intervals = 3
    none = 0
    reach = 1
    sweep = 4
    target = 5
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
@typing.type_check_only
class _Result:
    """
    Answer to one target, or to one of each tip. Everything in it is measured on the returned q, not predicted; errors are the largest of all tips. True if it is one.
    """
    def __repr__(self) -> str:
        ...
    def _repr_html_(self) -> str:
        ...
    @property
    def attempts(self) -> int:
        """
        Seeds tried; of several tips, values of the joints that they share among them.
        """
    @property
    def cost(self) -> float:
        """
        Cost of q by the request's objective; NaN unless solved with one.
        """
    @property
    def iterations(self) -> int:
        """
        Iteration steps over all attempts.
        """
    @property
    def move(self) -> float:
        """
        Length of the move from `near` to q, by the request's norm and weights; NaN without a q or a `near`.
        """
    @property
    def position_error(self) -> float:
        """
        |p_target - p(q)| [m], or what of it a task does not allow; NaN unless there is a q.
        """
    @property
    def proof(self) -> Proof:
        """
        `answer` of a success; of a failure, how certain it is that there is no answer.
        """
    @property
    def proven(self) -> bool:
        """
        Whether there is certainly no answer: `proof` is `reach`, `closed_form`, `intervals` or `target`.
        """
    @property
    def rotation_error(self) -> float:
        """
        |rotvec(R_target R(q)^T)| [rad], or what of it a task does not allow; NaN unless there is a q.
        """
    @property
    def status(self) -> Status:
        """
        Why the solve ended.
        """
    @property
    def unreachable_tip(self) -> int | None:
        """
        Of a failure with several tips: one whose target its chain cannot reach by itself, as far as a search can tell, and status and proof are that chain's; None: each can, or none was looked at.
        """
@typing.type_check_only
class _Solved(_Result):
    @property
    def q(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Joint values [rad or m], (dof,); None unless solved, so that no other q can be taken for an answer, or `closest`, which is given to those only who ask for it. Read-only.
        """
    @property
    def success(self) -> typing.Literal[True]:
        """
        Whether q reaches the target within both tolerances and lies inside the limits.
        """
    def __bool__(self) -> typing.Literal[True]:
        ...
@typing.type_check_only
class _Unsolved(_Result):
    @property
    def q(self) -> None:
        """
        Joint values [rad or m], (dof,); None unless solved, so that no other q can be taken for an answer, or `closest`, which is given to those only who ask for it. Read-only.
        """
    @property
    def success(self) -> typing.Literal[False]:
        """
        Whether q reaches the target within both tolerances and lies inside the limits.
        """
    def __bool__(self) -> typing.Literal[False]:
        ...
Result: typing.TypeAlias = _Solved | _Unsolved
class BatchResult:
    """
    Answers to many targets as arrays; row i belongs to target i. Indexing gives a Result, and by a slice or an array a BatchResult of its own. It is neither true nor false: ask success.all() or success.any().
    """
    def __bool__(self) -> typing.NoReturn:
        ...
    @typing.overload
    def __getitem__(self, i: int) -> Result:
        ...
    @typing.overload
    def __getitem__(self, i: slice | collections.abc.Sequence[int] | numpy.typing.NDArray[numpy.integer[typing.Any] | numpy.bool_]) -> BatchResult:
        ...
    def __iter__(self) -> collections.abc.Iterator[Result]:
        ...
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def _repr_html_(self) -> str:
        ...
    def statuses(self) -> list[Status]:
        """
        `status` as members of Status.
        """
    @property
    def attempts(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        Seeds tried, (n,).
        """
    @property
    def iterations(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        Iteration steps over all attempts, (n,).
        """
    @property
    def move(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Lengths of the moves from `near`, (n,); NaN where not solved or without one.
        """
    @property
    def position_error(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Distances to the targets [m], (n,); NaN where not solved.
        """
    @property
    def proof(self) -> numpy.typing.NDArray[numpy.uint8]:
        """
        Values of Proof, (n,); that of `answer` where solved.
        """
    @property
    def q(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Joint values [rad or m], (n, dof); NaN where not solved.
        """
    @property
    def rotation_error(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Lengths of the rotation vectors to the targets [rad], (n,); NaN where not solved.
        """
    @property
    def solved(self) -> int:
        """
        Number of targets solved.
        """
    @property
    def status(self) -> numpy.typing.NDArray[numpy.uint8]:
        """
        Values of Status, (n,).
        """
    @property
    def success(self) -> numpy.typing.NDArray[numpy.bool_]:
        """
        Whether each target is solved, (n,).
        """
    @property
    def unreachable_tip(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        Where not solved, with several tips: one whose target its chain cannot reach by itself, (n,); -1: each can, or none was looked at.
        """
class Cause(enum.Enum):
    """
    Why a solve gave no answer. Certain where Diagnosis.proven is true; else found by search and so likely.
    """
    budget = 7
    collision = 9
    joint_limits = 3
    no_branch = 4
    none = 0
    orientation = 2
    out_of_reach = 1
    out_of_time = 8
    rejected = 5
    shared_joints = 10
    singular = 6
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
class Diagnosis:
    """
    What Solver.diagnose found. Numbers that do not belong to the cause are NaN. True if q_is_solution.
    """
    def __bool__(self) -> bool:
        ...
    def __repr__(self) -> str:
        ...
    @property
    def attempts(self) -> int:
        """
        Seeds that were tried to find the cause; 0 where `proof` is `closed_form`: the branches say it.
        """
    @property
    def beyond_reach(self) -> float:
        """
        out_of_reach: distance from the nearest position that was reached [m]. no_branch: how much too long or too short the distance is that `joint`, an elbow, would have to bend for; NaN if it is no elbow.
        """
    @property
    def branch(self) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        joint_limits: that answer, which reaches the target outside the limits [rad or m], (dof,). None: another cause.
        """
    @property
    def cause(self) -> Cause:
        """
        Why there is no answer; `none` if there is one.
        """
    @property
    def contacts(self) -> list[Contact]:
        """
        collision: what touches at `q`, the answer that collides least, the deepest first; else empty.
        """
    @property
    def coupled_limit(self) -> int:
        """
        joint_limits: index of the coupled limit that lies farthest outside, if that is farther than any joint; `joint` is -1 then. -1 otherwise.
        """
    @property
    def joint(self) -> int:
        """
        joint_limits: index of the joint that lies farthest outside its limits in the answer that violates them least. no_branch: of the joint of which there is no angle. -1 otherwise.
        """
    @property
    def least_singular_value(self) -> float:
        """
        Least singular value of the Jacobian at `q` [mixed units]: small where it is close to a singularity.
        """
    @property
    def limit_violation(self) -> float:
        """
        joint_limits: by how much that joint, or the sum of the coupled limit, lies outside [rad or m].
        """
    @property
    def message(self) -> str:
        """
        What is wrong and what to do about it, in a sentence.
        """
    @property
    def position_error(self) -> float:
        """
        Errors of q outside of the task's box: position [m] and rotation [rad].
        """
    @property
    def proof(self) -> Proof:
        """
        As Result.proof of a solve with SolveRequest.prove: `answer` if there is one, else that there is none.
        """
    @property
    def proven(self) -> bool:
        """
        Whether there is certainly no answer: `proof` is `reach`, `closed_form`, `intervals` or `target`.
        """
    @property
    def q(self) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        Best effort inside the limits [rad or m], (dof,). NO SOLUTION unless q_is_solution, as where `cause` is none, singular, budget or out_of_time.
        """
    @property
    def q_is_solution(self) -> bool:
        """
        Whether q is an answer: within the tolerances, inside the limits, passed by the scene and the filter.
        """
    @property
    def refused(self) -> int:
        """
        rejected, collision: how many answers the filter or the scene refused.
        """
    @property
    def rotation_error(self) -> float:
        """
        Errors of q outside of the task's box: position [m] and rotation [rad].
        """
    @property
    def rotation_gap(self) -> float:
        """
        orientation: least rotation error that was reached with the position held [rad].
        """
    @property
    def unreachable_tip(self) -> int | None:
        """
        Of several tips: the first that cannot be reached by itself, whose chain the numbers are about, and q has that chain's joints; None: each can.
        """
class MoveNorm(enum.Enum):
    """
    How the length of a joint move is measured.
    """
    max = 1
    two = 0
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
class SolutionOrder(enum.Enum):
    """
    In which order solve_all gives its solutions where the request has no objective.
    """
    limit_distance = 1
    manipulability = 2
    move = 0
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
class Solver:
    """
    Solves inverse kinematics for one robot, with one tip or several. Immutable; copies share the data. Safe to use from many threads at once, and the same input gives the same bits from any of them. Solving allocates nothing on the heap as long as no more threads solve at once than the machine has cores.
    """
    def __copy__(self) -> Solver:
        ...
    def __deepcopy__(self, memo: dict[int, object]) -> Solver:
        ...
    def __init__(self, robot: Robot, options: SolverOptions | collections.abc.Mapping[str, typing.Any] | None = None, database: Database | None = None, *, nominal: Robot | None = None, max_calibration_deviation: collections.abc.Sequence[float] | None = None) -> None:
        """
        Uses a database, or builds one by `options.database` if it is given none.

        Args:
            robot: the chain to solve for.
            options: SolverOptions() if None.
            database: built for the same chain; its TCP may differ.
            nominal: for a calibrated arm, the chain that the database was built for, whose constants
                differ a little. Seeds come from it; iterations, tolerances and limits are the robot's.
            max_calibration_deviation: the largest deviation of the robot from `nominal`,
                (position [m], rotation [rad]); None: (0.05, 0.1).

        Raises:
            InvalidArgumentError: an option out of range.
            DatabaseMismatchError: the database belongs to another chain, or the deviation is too
                large.
        """
    def __repr__(self) -> str:
        ...
    def chain_solver(self, tip: int) -> Solver:
        """
        The solver of one tip's chain by itself; tips count from 0. Raises InvalidArgumentError if there is no such tip.
        """
    def diagnose(self, pose: numpy.typing.ArrayLike | typing.Any, *, scene: Scene | None = None, exact: collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], typing.Any] | None = None, filter: collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], typing.Any] | None = None, deadline: float | None = None, task: Task | collections.abc.Mapping[str, typing.Any] | None = None, tasks: collections.abc.Sequence[Task | collections.abc.Mapping[str, typing.Any]] | None = None, in_frame_of: collections.abc.Sequence[int | None] | None = None) -> Diagnosis:
        """
        Why solve() with the same arguments gives no answer, and the best that can be done.

        Spends much more than solving does, milliseconds to a second.

        Args:
            pose: T_base_tip [m], as in solve.
            scene: what answers may not collide with, as it is when the solve begins; of a robot with the
                same chains. The search continues within its bounds while all collide. The moves between
                waypoints of a path are not looked at.
            exact: a second opinion, which is asked about what collides in the scene by its spheres: what
                this keeps is free. Where nothing is free by spheres, it is asked about what a search finds
                within its bounds. Only with a scene. None: the spheres decide. Called with candidates (n,
                dof), returns n truth values, which of them are free: an iksel.exact.ExactCollision.
            filter: refuses candidates, of those that do not collide. The search continues within its bounds
                while all are refused. Of a batch it is asked about the first answers of up to 256 targets
                at once, of a path about one waypoint's. None: takes all. Called with candidates (n, dof),
                each at the pose and inside the limits, returns n truth values.
            deadline: wall-clock time after which no new stage of a target's search begins [s], above 0.
                What was found by then is judged. The one option under which the same input may give
                different answers.
            task: what of the pose has to be reached, of several tips of each; what is not given here is as
                the solver's options say.
            tasks: of several tips, one for each in the place of `task`. None: `task` holds for all.
            in_frame_of: of several tips, for each the number of the tip in whose frame, that of its TCP,
                its pose is given; None: in the base frame, as all are if this is empty. So two hands keep
                what they carry between them. No tip may follow itself by way of others.

        Returns:
            A Diagnosis; its cause is `none` if there is an answer.

        Raises:
            InvalidArgumentError: as solve.
        """
    def self_motion(self, pose: numpy.typing.ArrayLike | typing.Any, spacing: float = 0.1) -> SelfMotion:
        """
        All solutions of a redundant arm at once: the arcs of its self-motion inside the limits.

        Seven joints that turn, of which one can be swept (`Robot.structure`). Joints with a range of a
        whole turn or more end no arc. Each arc that a joint's limit ends is followed from there; a closed one,
        or one that coupled limits end, may be missed if it lies between two of 128 samples of the swept joint.

        Args:
            pose: T_base_tip [m], as in solve.
            spacing: farthest that a joint moves from one configuration of an arc to the next, 0.0001 to pi
                [rad].

        Returns:
            A SelfMotion; empty, with a status that says why, if there is no solution.

        Raises:
            InvalidArgumentError: a robot of another structure, a task with free axes, another strategy than
                Lanes, a spacing out of range; else as solve.
        """
    def solve(self, pose: numpy.typing.ArrayLike | typing.Any, *, near: numpy.typing.ArrayLike | None = None, weights: numpy.typing.ArrayLike | None = None, norm: MoveNorm | str = 'two', seeds: numpy.typing.ArrayLike | None = None, database_seeds: bool = True, scene: Scene | None = None, exact: collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], typing.Any] | None = None, filter: collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], typing.Any] | None = None, deadline: float | None = None, task: Task | collections.abc.Mapping[str, typing.Any] | None = None, objective: Objective | str | collections.abc.Callable[[numpy.ndarray], float] | None = None, closest: bool | numpy.typing.ArrayLike | None = None, prove: bool = False, tasks: collections.abc.Sequence[Task | collections.abc.Mapping[str, typing.Any]] | None = None, in_frame_of: collections.abc.Sequence[int | None] | None = None) -> Result:
        """
        Joint values that put the TCP (the tip link's frame, if there is no tool) at a pose, or the TCP of each tip at its own.

        Args:
            pose: T_base_tip [m]: (4, 4) or (3, 4); a pair (position, rotation) with a (3, 3) matrix or a
                scipy Rotation; an object with as_matrix(), .homogeneous or .A (scipy, Pinocchio,
                spatialmath); (3,) if the task leaves the rotation free. One that is rounded stands for the
                nearest rigid one (see check_pose), by which the errors are measured. Of several tips, (k,
                4, 4) or k of these.
            near: configuration to stay near [rad or m], (dof,), typically where the arm is. May lie outside
                the limits, as measured joint values do. The answer is then the one with the smallest move
                of all that are found within the bounds on work, whole turns considered; a redundant arm's
                is moved along its self-motion to a local minimum of the move. Angles here, in `seeds` and
                the objective's posture are refused where their rounding alone could move the TCP by a tenth
                of the tolerances: beyond 2^53 / 10 min(rotation_tolerance, position_tolerance / reach) /
                (number of joints that turn), 1.5e8 rad for an arm of six joints with 1 m of reach at the
                default tolerances; up to 100 rad always pass. Of a batch one for all targets, or (N, dof),
                one for each.
            weights: factor on each joint's part of a move, (dof,), >= 0, the largest from 1e-100 to 1e100
                (so that radians and metres can be compared); None: all 1.
            norm: how a move is measured.
            seeds: joint values of any origin to iterate from [rad or m], (n, dof), inside the limits or
                not. They are ranked and iterated as the database's own, and come before those; re-selection
                is among the best Paper.candidates of them, and SolverOptions.max_attempts bounds how many
                are tried, and how many of the database's after them. Ranking n takes time n log n, ends at
                the deadline, and up to 1,024 need no memory. One may be (dof,).
            database_seeds: whether other seeds follow the given ones: the database's, random ones, and
                those that a closed form gives (Robot.structure).
            scene: what answers may not collide with, as it is when the solve begins; of a robot with the
                same chains. The search continues within its bounds while all collide. The moves between
                waypoints of a path are not looked at.
            exact: a second opinion, which is asked about what collides in the scene by its spheres: what
                this keeps is free. Where nothing is free by spheres, it is asked about what a search finds
                within its bounds. Only with a scene. None: the spheres decide. Called with candidates (n,
                dof), returns n truth values, which of them are free: an iksel.exact.ExactCollision.
            filter: refuses candidates, of those that do not collide. The search continues within its bounds
                while all are refused. Of a batch it is asked about the first answers of up to 256 targets
                at once, of a path about one waypoint's. None: takes all. Called with candidates (n, dof),
                each at the pose and inside the limits, returns n truth values.
            deadline: wall-clock time after which no new stage of a target's search begins [s], above 0.
                What was found by then is judged. The one option under which the same input may give
                different answers.
            task: what of the pose has to be reached, of several tips of each; what is not given here is as
                the solver's options say.
            objective: what the answer is to be good at besides; comes before `near`, which then only
                measures the move, and chooses among periodic images that cost the same. An Objective,
                'limits', 'manipulability', or a function of joint values (dof,) that returns a cost.
            closest: of solve and solve_batch: what a target without an answer gets, with Status.closest, is
                the configuration inside the limits that is nearest to it by these weights; of equally near
                ones the nearest to `near`. It is the best of the local minima that a bounded search comes
                to, some 100 us on top of the search for an answer, whatever the deadline. The scene and the
                filter refuse it too; the objective has no say. None: it gets nothing. True: a metre counts
                1, a radian as the database weighs rotations; or six weights, of position [1/m] and rotation
                [1/rad] along the axes of the task.
            prove: whether a no is to be proven where that takes longer than to find it: by Proof.intervals
                instead of Proof.sweep, of six joints in some 20 us. Of seven, and by diagnose, it is proven
                anyway, where it can be.
            tasks: of several tips, one for each in the place of `task`. None: `task` holds for all.
            in_frame_of: of several tips, for each the number of the tip in whose frame, that of its TCP,
                its pose is given; None: in the base frame, as all are if this is empty. So two hands keep
                what they carry between them. No tip may follow itself by way of others.

        Returns:
            A Result. A pose that cannot be solved is no error but a status, and `proof` says how certain
            that is.

        Raises:
            InvalidArgumentError: wrong shape or dtype, a pose that is not rigid, a number that is not
                finite or out of range.
        """
    def solve_all(self, pose: numpy.typing.ArrayLike | typing.Any, max: int = 64, *, min_distance: float = 0.01, whole_turns: bool = False, order: SolutionOrder | str = 'move', near: numpy.typing.ArrayLike | None = None, weights: numpy.typing.ArrayLike | None = None, norm: MoveNorm | str = 'two', seeds: numpy.typing.ArrayLike | None = None, database_seeds: bool = True, scene: Scene | None = None, exact: collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], typing.Any] | None = None, filter: collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], typing.Any] | None = None, deadline: float | None = None, task: Task | collections.abc.Mapping[str, typing.Any] | None = None, objective: Objective | str | collections.abc.Callable[[numpy.ndarray], float] | None = None, prove: bool = False, tasks: collections.abc.Sequence[Task | collections.abc.Mapping[str, typing.Any]] | None = None, in_frame_of: collections.abc.Sequence[int | None] | None = None) -> Solutions:
        """
        Every distinct solution that is found: all branches (there certainly are no others where `proven` says so), or a spread for a redundant arm.

        Args:
            pose: T_base_tip [m], as in solve.
            max: solutions given at most.
            min_distance: solutions that differ by less than this in every joint are one [rad or m]; a
                redundant arm's, which come in families, are spread at least this far.
            whole_turns: whether periodic images inside the limits count as solutions of their own.
                Otherwise each is given once: at the image nearest to `near`, or else to the middle of the
                limits.
            order: what comes first. Left at `move` where the request has an objective: solutions then come
                in the order of that.
            near: configuration to stay near [rad or m], (dof,), typically where the arm is. May lie outside
                the limits, as measured joint values do. The answer is then the one with the smallest move
                of all that are found within the bounds on work, whole turns considered; a redundant arm's
                is moved along its self-motion to a local minimum of the move. Angles here, in `seeds` and
                the objective's posture are refused where their rounding alone could move the TCP by a tenth
                of the tolerances: beyond 2^53 / 10 min(rotation_tolerance, position_tolerance / reach) /
                (number of joints that turn), 1.5e8 rad for an arm of six joints with 1 m of reach at the
                default tolerances; up to 100 rad always pass. Of a batch one for all targets, or (N, dof),
                one for each.
            weights: factor on each joint's part of a move, (dof,), >= 0, the largest from 1e-100 to 1e100
                (so that radians and metres can be compared); None: all 1.
            norm: how a move is measured.
            seeds: joint values of any origin to iterate from [rad or m], (n, dof), inside the limits or
                not. They are ranked and iterated as the database's own, and come before those; re-selection
                is among the best Paper.candidates of them, and SolverOptions.max_attempts bounds how many
                are tried, and how many of the database's after them. Ranking n takes time n log n, ends at
                the deadline, and up to 1,024 need no memory. One may be (dof,).
            database_seeds: whether other seeds follow the given ones: the database's, random ones, and
                those that a closed form gives (Robot.structure).
            scene: what answers may not collide with, as it is when the solve begins; of a robot with the
                same chains. The search continues within its bounds while all collide. The moves between
                waypoints of a path are not looked at.
            exact: a second opinion, which is asked about what collides in the scene by its spheres: what
                this keeps is free. Where nothing is free by spheres, it is asked about what a search finds
                within its bounds. Only with a scene. None: the spheres decide. Called with candidates (n,
                dof), returns n truth values, which of them are free: an iksel.exact.ExactCollision.
            filter: refuses candidates, of those that do not collide. The search continues within its bounds
                while all are refused. Of a batch it is asked about the first answers of up to 256 targets
                at once, of a path about one waypoint's. None: takes all. Called with candidates (n, dof),
                each at the pose and inside the limits, returns n truth values.
            deadline: wall-clock time after which no new stage of a target's search begins [s], above 0.
                What was found by then is judged. The one option under which the same input may give
                different answers.
            task: what of the pose has to be reached, of several tips of each; what is not given here is as
                the solver's options say.
            objective: what the answer is to be good at besides; comes before `near`, which then only
                measures the move, and chooses among periodic images that cost the same. An Objective,
                'limits', 'manipulability', or a function of joint values (dof,) that returns a cost.
            prove: whether a no is to be proven where that takes longer than to find it: by Proof.intervals
                instead of Proof.sweep, of six joints in some 20 us. Of seven, and by diagnose, it is proven
                anyway, where it can be.
            tasks: of several tips, one for each in the place of `task`. None: `task` holds for all.
            in_frame_of: of several tips, for each the number of the tip in whose frame, that of its TCP,
                its pose is given; None: in the base frame, as all are if this is empty. So two hands keep
                what they carry between them. No tip may follow itself by way of others.

        Returns:
            Solutions; empty, with a status that says why, if there is none.

        Raises:
            InvalidArgumentError: as solve.
        """
    def solve_batch(self, poses: numpy.typing.ArrayLike | typing.Any, threads: int = 0, *, near: numpy.typing.ArrayLike | None = None, weights: numpy.typing.ArrayLike | None = None, norm: MoveNorm | str = 'two', seeds: numpy.typing.ArrayLike | None = None, database_seeds: bool = True, scene: Scene | None = None, exact: collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], typing.Any] | None = None, filter: collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], typing.Any] | None = None, deadline: float | None = None, task: Task | collections.abc.Mapping[str, typing.Any] | None = None, objective: Objective | str | collections.abc.Callable[[numpy.ndarray], float] | None = None, closest: bool | numpy.typing.ArrayLike | None = None, prove: bool = False, on_invalid_pose: typing.Literal['status', 'raise'] = 'status', tasks: collections.abc.Sequence[Task | collections.abc.Mapping[str, typing.Any]] | None = None, in_frame_of: collections.abc.Sequence[int | None] | None = None) -> BatchResult:
        """
        Solves many targets with the GIL released; row i belongs to target i.

        A row has the same bits whatever the number of threads and whatever else is in the batch. Its
        status is that of solve(), and so are its bits, but for seeds in SIMD lanes (the default preset): there a
        target has a lane to itself. Where all joints are solved in closed form, only `attempts` differs,
        which counts no branches after the first that is an answer; else the answer may be another of the
        target's solutions, within the same tolerances. The request holds for each target by itself.

        Args:
            poses: T_base_tip, (N, 4, 4) [m], or others as in solve. Doubles in C order are read in place.
            threads: threads that work; 0: one per core. The result has the same bits for any number.
            near: configuration to stay near [rad or m], (dof,), typically where the arm is. May lie outside
                the limits, as measured joint values do. The answer is then the one with the smallest move
                of all that are found within the bounds on work, whole turns considered; a redundant arm's
                is moved along its self-motion to a local minimum of the move. Angles here, in `seeds` and
                the objective's posture are refused where their rounding alone could move the TCP by a tenth
                of the tolerances: beyond 2^53 / 10 min(rotation_tolerance, position_tolerance / reach) /
                (number of joints that turn), 1.5e8 rad for an arm of six joints with 1 m of reach at the
                default tolerances; up to 100 rad always pass. Of a batch one for all targets, or (N, dof),
                one for each.
            weights: factor on each joint's part of a move, (dof,), >= 0, the largest from 1e-100 to 1e100
                (so that radians and metres can be compared); None: all 1.
            norm: how a move is measured.
            seeds: joint values of any origin to iterate from [rad or m], (n, dof), inside the limits or
                not. They are ranked and iterated as the database's own, and come before those; re-selection
                is among the best Paper.candidates of them, and SolverOptions.max_attempts bounds how many
                are tried, and how many of the database's after them. Ranking n takes time n log n, ends at
                the deadline, and up to 1,024 need no memory. One may be (dof,).
            database_seeds: whether other seeds follow the given ones: the database's, random ones, and
                those that a closed form gives (Robot.structure).
            scene: what answers may not collide with, as it is when the solve begins; of a robot with the
                same chains. The search continues within its bounds while all collide. The moves between
                waypoints of a path are not looked at.
            exact: a second opinion, which is asked about what collides in the scene by its spheres: what
                this keeps is free. Where nothing is free by spheres, it is asked about what a search finds
                within its bounds. Only with a scene. None: the spheres decide. Called with candidates (n,
                dof), returns n truth values, which of them are free: an iksel.exact.ExactCollision.
            filter: refuses candidates, of those that do not collide. The search continues within its bounds
                while all are refused. Of a batch it is asked about the first answers of up to 256 targets
                at once, of a path about one waypoint's. None: takes all. Called with candidates (n, dof),
                each at the pose and inside the limits, returns n truth values.
            deadline: wall-clock time after which no new stage of a target's search begins [s], above 0.
                What was found by then is judged. The one option under which the same input may give
                different answers.
            task: what of the pose has to be reached, of several tips of each; what is not given here is as
                the solver's options say.
            objective: what the answer is to be good at besides; comes before `near`, which then only
                measures the move, and chooses among periodic images that cost the same. An Objective,
                'limits', 'manipulability', or a function of joint values (dof,) that returns a cost.
            closest: of solve and solve_batch: what a target without an answer gets, with Status.closest, is
                the configuration inside the limits that is nearest to it by these weights; of equally near
                ones the nearest to `near`. It is the best of the local minima that a bounded search comes
                to, some 100 us on top of the search for an answer, whatever the deadline. The scene and the
                filter refuse it too; the objective has no say. None: it gets nothing. True: a metre counts
                1, a radian as the database weighs rotations; or six weights, of position [1/m] and rotation
                [1/rad] along the axes of the task.
            prove: whether a no is to be proven where that takes longer than to find it: by Proof.intervals
                instead of Proof.sweep, of six joints in some 20 us. Of seven, and by diagnose, it is proven
                anyway, where it can be.
            on_invalid_pose: what solve_batch does about a target that is no pose (check_pose); others
                always raise. 'status': Status.invalid_pose in its row, and NaN for its q; 'raise': an error
                that names the first, and none is solved.
            tasks: of several tips, one for each in the place of `task`. None: `task` holds for all.
            in_frame_of: of several tips, for each the number of the tip in whose frame, that of its TCP,
                its pose is given; None: in the base frame, as all are if this is empty. So two hands keep
                what they carry between them. No tip may follow itself by way of others.

        Raises:
            InvalidArgumentError: wrong shape or dtype, a bad argument, or with on_invalid_pose="raise"
                a bad pose.
        """
    def solve_path(self, poses: numpy.typing.ArrayLike | typing.Any, start: numpy.typing.ArrayLike | None = None, *, dt: float = 0.0, weights: numpy.typing.ArrayLike | None = None, norm: MoveNorm | str = 'two', scene: Scene | None = None, exact: collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], typing.Any] | None = None, filter: collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], typing.Any] | None = None, candidates: int = 64, task: Task | collections.abc.Mapping[str, typing.Any] | None = None, tasks: collections.abc.Sequence[Task | collections.abc.Mapping[str, typing.Any]] | None = None, in_frame_of: collections.abc.Sequence[int | None] | None = None) -> PathResult:
        """
        Joint values along a path of poses, by a choice among the solutions of all waypoints.

        Of all ways through the solutions that are found, the one with the least sum of joint moves.

        Args:
            poses: T_base_tip of each waypoint, (N, 4, 4) [m], or others as in solve; of several tips (N, k,
                4, 4).
            start: where the arm is one time step before the first waypoint [rad or m], (dof,); may lie
                outside the limits. None: the path may begin anywhere; of its periodic images, the one that
                begins nearest to the middle of the limits is taken.
            dt: time from one waypoint to the next [s]: no joint then moves farther than its velocity limit
                allows. 0: speeds are not limited.
            weights: factor on each joint's part of a move, (dof,), >= 0, the largest from 1e-100 to 1e100
                (so that radians and metres can be compared); None: all 1.
            norm: how a move is measured.
            scene: what answers may not collide with, as it is when the solve begins; of a robot with the
                same chains. The search continues within its bounds while all collide. The moves between
                waypoints of a path are not looked at.
            exact: a second opinion, which is asked about what collides in the scene by its spheres: what
                this keeps is free. Where nothing is free by spheres, it is asked about what a search finds
                within its bounds. Only with a scene. None: the spheres decide. Called with candidates (n,
                dof), returns n truth values, which of them are free: an iksel.exact.ExactCollision.
            filter: refuses candidates, of those that do not collide. The search continues within its bounds
                while all are refused. Of a batch it is asked about the first answers of up to 256 targets
                at once, of a path about one waypoint's. None: takes all. Called with candidates (n, dof),
                each at the pose and inside the limits, returns n truth values.
            candidates: candidates kept per waypoint at most.
            task: what of the pose has to be reached, of several tips of each; what is not given here is as
                the solver's options say.
            tasks: of several tips, one for each in the place of `task`. None: `task` holds for all.
            in_frame_of: of several tips, for each the number of the tip in whose frame, that of its TCP,
                its pose is given; None: in the base frame, as all are if this is empty. So two hands keep
                what they carry between them. No tip may follow itself by way of others.

        Raises:
            InvalidArgumentError: wrong shape or dtype, a pose that is not rigid, a number out of range.
        """
    def tracker(self, start: numpy.typing.ArrayLike, *, closest: bool | numpy.typing.ArrayLike | None = None, task: Task | collections.abc.Mapping[str, typing.Any] | None = None, tasks: collections.abc.Sequence[Task | collections.abc.Mapping[str, typing.Any]] | None = None, in_frame_of: collections.abc.Sequence[int | None] | None = None, objective: Objective | str | collections.abc.Callable[[numpy.ndarray], float] | None = None) -> Tracker:
        """
        Tracker(self, start, ...).
        """
    @property
    def calibration_deviation(self) -> tuple[float, float]:
        """
        The largest difference between the robot's tip link and `nominal`'s at the same joint values over 2000 configurations: (position [m], rotation [rad]).
        """
    @property
    def database(self) -> Database:
        """
        The database it selects seeds from. Of several tips each chain_solver has its own: raises InvalidArgumentError.
        """
    @property
    def nominal(self) -> Robot:
        """
        The chain that the database was built for: the robot itself, unless that is a calibrated one.
        """
    @property
    def options(self) -> SolverOptions:
        """
        Its options.
        """
    @property
    def robot(self) -> Robot:
        """
        The robot it solves for.
        """
    @property
    def task_hint(self) -> str:
        """
        For an arm with fewer joints than its task has axes, which hardly any target suits: tasks whose axes its joints can all move, in a sentence; else empty.
        """
    @property
    def work_bound(self) -> int:
        """
        Most iteration steps that one solve without given seeds can spend, over all its seeds: max_attempts * max_iterations. A step of a whole pack of lanes counts once in Result.iterations, so that solves in lanes stay below this by the number of lanes.
        """
class Solutions:
    """
    The distinct solutions for one target, best first. True if there are any. Indexing gives a Result.
    """
    def __bool__(self) -> bool:
        ...
    def __getitem__(self, i: int) -> Result:
        ...
    def __iter__(self) -> collections.abc.Iterator[Result]:
        ...
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def _repr_html_(self) -> str:
        ...
    @property
    def attempts(self) -> int:
        """
        Seeds tried.
        """
    @property
    def cost(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Costs by the objective, (n,); NaN without one.
        """
    @property
    def iterations(self) -> int:
        """
        Iteration steps over all attempts.
        """
    @property
    def move(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Lengths of the moves from `near`, (n,); NaN without one.
        """
    @property
    def position_error(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Distances to the target [m], (n,).
        """
    @property
    def proof(self) -> Proof:
        """
        Of an empty set, whether there is certainly no solution; of another, whether there are certainly no more (all of them were found in closed form), or `answer` if that is not known.
        """
    @property
    def proven(self) -> bool:
        """
        Whether these are certainly all: `proof` is `reach`, `closed_form`, `intervals` or `target`.
        """
    @property
    def q(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Joint values [rad or m], (n, dof).
        """
    @property
    def rotation_error(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Lengths of the rotation vectors to the target [rad], (n,).
        """
    @property
    def status(self) -> Status:
        """
        `solved` if there is at least one; else why there is none.
        """
    @property
    def success(self) -> bool:
        """
        Whether there is at least one.
        """
class PathResult:
    """
    Joint values along a path. True if there are any for every waypoint.
    """
    def __bool__(self) -> bool:
        ...
    def __repr__(self) -> str:
        ...
    @property
    def first_unreachable(self) -> int | None:
        """
        Index of the first waypoint that has no continuation; None if the path is solved.
        """
    @property
    def largest_step(self) -> float:
        """
        The farthest that a joint moves between two waypoints (or start and the first) [rad or m].
        """
    @property
    def largest_step_joint(self) -> int | None:
        """
        Index of the joint that does; None if there is no step.
        """
    @property
    def largest_step_waypoint(self) -> int | None:
        """
        Index of the waypoint where that step ends; None if there is no step.
        """
    @property
    def move(self) -> float:
        """
        Sum of the moves.
        """
    @property
    def q(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        One configuration per waypoint [rad or m], (n, dof); if there is none for one, of those before it.
        """
    @property
    def status(self) -> Status:
        """
        `solved` if there is a configuration for every waypoint. Else why there is none for waypoint `first_unreachable`: too_fast if it has solutions, but no joint path leads there in time.
        """
    @property
    def success(self) -> bool:
        """
        Whether there is a configuration for every waypoint.
        """
class Tracker:
    """
    Follows a stream of poses: each answer continues from the last, within the velocity limits. Not to be used from two threads at once; allocates nothing after construction.
    """
    def __init__(self, solver: Solver, start: numpy.typing.ArrayLike, *, closest: bool | numpy.typing.ArrayLike | None = None, task: Task | collections.abc.Mapping[str, typing.Any] | None = None, tasks: collections.abc.Sequence[Task | collections.abc.Mapping[str, typing.Any]] | None = None, in_frame_of: collections.abc.Sequence[int | None] | None = None, objective: Objective | str | collections.abc.Callable[[numpy.ndarray], float] | None = None) -> None:
        """
        Begins where the arm is.

        Args:
            solver: what solves.
            start: joint values, (dof,) [rad or m], as measured; outside the limits, the way back inside is
                part of the first moves.
            closest: True, or six weights as in Solver.solve: at poses that cannot be reached from where
                the arm is, it goes downhill to where it is nearest, with Status.closest, and comes back
                with the target on the side that it left from. The tool is at most three times as fast
                as the target, both measured by the weights; a target at rest counts as fast as it last
                was.
            task, tasks, in_frame_of: what of the poses has to be reached, and in the frame of which other
                tip they are, as in Solver.solve.
            objective: an Objective; an arm that its poses leave free moves to where it is least, as fast
                as the poses leave it, and in half a second if it went on as it begins.

        Raises:
            InvalidArgumentError: wrong shape or dtype, a number that is not finite, or tasks, frames or
                an objective that do not fit the robot.
        """
    def __repr__(self) -> str:
        ...
    def track(self, pose: numpy.typing.ArrayLike | typing.Any, dt: float, scene: Scene | None = None) -> Result:
        """
        Moves on towards a pose, by no more than each joint can in the time step.

        Args:
            pose: T_base_tip [m], as in Solver.solve; one for each tip, in the frame that was asked for.
            dt: time step [s].
            scene: the arm stays, with status `in_collision`, where it would collide at the end of its move;
                the way there is not looked at.

        Returns:
            A Result. Status `solved`: there. `too_fast`: the arm needs more time, and went as far on the
            straight way in joint space as it, or its tool, could. `closest`: not there, but as near as it gets from
            here. Any other: no continuation, and the arm stays.

        Raises:
            InvalidArgumentError: wrong shape or dtype, a pose that is not rigid, dt not above 0, or a
                scene of another chain.
        """
    @property
    def q(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Where the arm is now [rad or m], (dof,); once inside the limits, always inside.
        """
    @property
    def reached(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Where the arm was when it last reached its pose, or began; from the edge of the workspace it comes back on that side [rad or m], (dof,).
        """
class ArcEnd(enum.Enum):
    """
    What ends an arc of a self-motion.
    """
    closed = 2
    fold = 1
    limit = 0
    def __format__(self, arg0: str) -> str:
        ...
    def __str__(self) -> str:
        ...
class SelfMotionEnd:
    """
    One end of an arc.
    """
    def __repr__(self) -> str:
        ...
    @property
    def at_upper(self) -> bool:
        """
        Whether it is at the upper one of its limits.
        """
    @property
    def coupled_limit(self) -> int:
        """
        Index of the coupled limit that is reached, if it is not a joint's own; else -1.
        """
    @property
    def joint(self) -> int:
        """
        Index of the joint that is at its limit; -1 unless `limit`.
        """
    @property
    def kind(self) -> ArcEnd:
        """
        What ends the arc there.
        """
class SelfMotionArc:
    """
    A connected piece of the self-motion inside the limits.
    """
    def __iter__(self) -> collections.abc.Iterator[numpy.typing.NDArray[numpy.float64]]:
        ...
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    @property
    def begin(self) -> SelfMotionEnd:
        """
        What ends it before its first configuration.
        """
    @property
    def elbow(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        The elbow's angle at each, about the line from shoulder to wrist, 0 where the elbow lies in the plane of that line and the first axis, on the axis' side [rad], (n,); empty unless three axes meet in a shoulder and three in a wrist. NaN where shoulder and wrist lie on the first axis.
        """
    @property
    def end(self) -> SelfMotionEnd:
        """
        What ends it behind its last configuration.
        """
    @property
    def is_closed(self) -> bool:
        """
        Whether the last configuration leads on to the first.
        """
    @property
    def length(self) -> float:
        """
        Sum of the moves along it, each the root of the sum of squares [rad].
        """
    @property
    def q(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Configurations along it, its ends included [rad], (n, dof); each reaches the pose within the tolerances and lies inside the limits. A closed arc does not repeat the first. From one to the next no joint moves farther than asked, but where it has to turn round by a whole turn to stay inside its limits.
        """
class SelfMotion:
    """
    What Solver.self_motion found. The arcs, the longest first; true if there are any. Indexing gives a SelfMotionArc.
    """
    def __bool__(self) -> bool:
        ...
    def __getitem__(self, i: int) -> SelfMotionArc:
        ...
    def __iter__(self) -> collections.abc.Iterator[SelfMotionArc]:
        ...
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    @property
    def proof(self) -> Proof:
        """
        `answer` if there is an arc; else how certain it is that there is no solution.
        """
    @property
    def proven(self) -> bool:
        """
        Whether there is certainly no answer: `proof` is `reach`, `closed_form`, `intervals` or `target`.
        """
    @property
    def status(self) -> Status:
        """
        `solved` if there is an arc; else why there is none.
        """
    @property
    def success(self) -> bool:
        """
        Whether there is at least one arc.
        """
class Evaluation:
    """
    Outcome of `evaluate`. Times are per solve call, failures included [us].
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, other: object) -> bool:
        ...
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        All fields by name as plain Python data, with the names of enums in their place.
        """
    @property
    def false_success(self) -> int:
        """
        Results that say success and are none, by KDL's FK and the limits. Always to be 0.
        """
    @property
    def iterate_us(self) -> float:
        """
        Mean time of the iterations [us]; 0 unless asked for.
        """
    @property
    def kdl_fk_jac_us(self) -> float:
        """
        Mean time of one KDL forward kinematics plus one KDL Jacobian on the same robot [us].
        """
    @property
    def max_iterations(self) -> int:
        """
        Most iteration steps that a solve took; Solver.work_bound is the bound.
        """
    @property
    def max_us(self) -> float:
        """
        Longest time [us].
        """
    @property
    def mean_attempts(self) -> float:
        """
        Mean number of seeds tried.
        """
    @property
    def mean_iterations(self) -> float:
        """
        Mean number of iteration steps.
        """
    @property
    def mean_us(self) -> float:
        """
        Mean time per solve [us].
        """
    @property
    def median_us(self) -> float:
        """
        Median time [us].
        """
    @property
    def min_us(self) -> float:
        """
        Shortest time [us].
        """
    @property
    def p999_us(self) -> float:
        """
        99.9th percentile of the time [us].
        """
    @property
    def p99_us(self) -> float:
        """
        99th percentile of the time [us].
        """
    @property
    def query_us(self) -> float:
        """
        Mean time of the KD-tree query [us]; 0 unless asked for.
        """
    @property
    def rank_us(self) -> float:
        """
        Mean time of the ranking [us]; 0 unless asked for.
        """
    @property
    def ratio(self) -> float:
        """
        mean_us / kdl_fk_jac_us: how speed is compared between machines.
        """
    @property
    def reselect_us(self) -> float:
        """
        Mean time of the re-selections [us]; 0 unless asked for.
        """
    @property
    def seed(self) -> int:
        """
        Seed of the targets.
        """
    @property
    def solved(self) -> int:
        """
        Targets solved.
        """
    @property
    def std_us(self) -> float:
        """
        Standard deviation of the time [us].
        """
    @property
    def success_percent(self) -> float:
        """
        100 solved / targets.
        """
    @property
    def targets(self) -> int:
        """
        Targets tried.
        """
class Selector:
    """
    Selects seeds for one target after the other, as a solver with the strategy Paper does. Not to be used from two threads at once.
    """
    def __init__(self, database: Database, scheme: Paper | collections.abc.Mapping[str, typing.Any] = ...) -> None:
        """
        Takes a database with a full key, as DatabaseOptions.paper() describes it.

        Args:
            database: where the seeds come from.
            scheme: how they are selected; what it says of the iteration is not read.

        Raises:
            InvalidArgumentError: the scheme is out of range or limit-aware, or the database's key is
                reduced: of limits, and of the joints that such a key leaves out, a database alone says
                nothing.
        """
    def __repr__(self) -> str:
        ...
    def candidates(self, pose: numpy.typing.ArrayLike | typing.Any, count: int | None = None, ranking: Ranking | str | None = None) -> tuple[numpy.typing.NDArray[numpy.int64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        The samples nearest to a pose, the best first.

        Args:
            pose: T_base_tip [m] of the tip link, without the TCP; as in Solver.solve.
            count: how many are asked from the KD-tree; None: as many as the scheme says.
            ranking: how they are put in order; None: as the scheme says.

        Returns:
            (indices, distances, adjustments, q): the samples' indices in the database (k,); the distances
            of their keys from the pose's, Eq. (2) of the paper (k,); the norms of the joint adjustments
            J^+ (x_target - x_i), Eq. (5) (k,) [rad or m]; and their joint values (k, dof) [rad or m].

        Raises:
            InvalidArgumentError: a pose that is not rigid, a count of 0.
        """
    def next(self, failed: collections.abc.Sequence[int] = ()) -> int | None:
        """
        The sample to be tried after those that failed.

        Args:
            failed: indices of the samples that were tried, in that order.

        Returns:
            Its index in the database: if none has failed the first in the order, else the one that the
            scheme's re-selection takes among its `candidates` best, by default the one farthest from those
            that failed. None if there is none left.

        Raises:
            InvalidArgumentError: an index that is no candidate or comes twice, or there was no pose yet.
        """
    def rank(self, ranking: Ranking | str) -> tuple[numpy.typing.NDArray[numpy.int64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        The candidates of the last pose in another order, as `candidates` gives them.

        Raises:
            InvalidArgumentError: there was no pose yet.
        """
    @property
    def database(self) -> Database:
        """
        Where the seeds come from.
        """
    @property
    def scheme(self) -> Paper:
        """
        How they are selected.
        """
def _describe(value: typing.Any) -> str:
    """
    A value as messages show it.
    """
def check_pose(pose: numpy.typing.ArrayLike | typing.Any, name: str = 'pose') -> numpy.typing.NDArray[numpy.float64]:
    """
    The rigid transform that `pose` stands for: itself, bit for bit, if it is one to rounding (|R^T R - I| <= 1e-12), else the nearest, by polar decomposition. Raises InvalidArgumentError if it is not finite, its rotation is off by more than RIGID_TOLERANCE or mirrored, or its last row is not 0 0 0 1; `name` names the culprit in the message. Every pose that comes into the library goes through this.
    """
def evaluate(solver: Solver, targets: int, seed: int, stages: bool = False, progress: collections.abc.Callable[[int, int], typing.Any] | None = None, *, touched: int = 0) -> Evaluation:
    """
    The paper's experiment protocol: success and time over random reachable targets.

    Solves poses FK(q), q uniform inside the limits, one after another on this thread with the GIL
    released, timing each solve inside C++.

    Args:
        solver: what to evaluate.
        targets: number of targets.
        seed: seed of the targets.
        stages: take the time of each stage in a second pass.
        progress: called now and then with (targets done, targets in all). What it raises ends the
            evaluation. Ctrl-C works.
        touched: bytes of other memory that are touched before each timed solve, not counted; at most
            2**30. From some times the processor's caches on, a solve finds nothing in them, as in a
            control loop beside other work.
    """
def grid_counts(dof: int, scale: Scale | str) -> list[int]:
    """
    Points per joint of the paper's grid, base to tip.
    """
def mend_xml(data: bytes, link: str = '') -> str:
    """
    The text of an XML file (URDF, SRDF, MJCF) as every XML reader takes it, and Robot.urdf() gives it: UTF-8, with what people and exporters get wrong mended where it is clear what is meant.

    Out of UTF-16 and UTF-32 becomes UTF-8. A DOCTYPE, whose entities are not expanded, comments, processing instructions and a default namespace are left out; prefixes that nothing binds are bound; an & that begins no entity stands for itself. `quat_xyzw`, which a URDF may have from version 1.1 on, becomes `rpy`. Of a URDF whose links hang in several trees, the one of `link` is left; all, where no link is given.

    Raises UrdfError, which says the line, where it is not clear what is meant.
    """
def orthonormalized(pose: numpy.typing.ArrayLike | typing.Any) -> numpy.typing.NDArray[numpy.float64]:
    """
    The rigid transform nearest to `pose`, however far off its rotation is: scaled, sheared or rounded to two decimals. Raises InvalidArgumentError if it is not finite, singular or mirrored, or its last row is not 0 0 0 1.
    """
def pose_error(target: numpy.typing.ArrayLike | typing.Any, pose: numpy.typing.ArrayLike | typing.Any) -> numpy.typing.NDArray[numpy.float64]:
    """
    The rotation vector and position differences of two poses: [p_target - p; rotvec(R_target R^T)].
    """
def pose_matrices(pose: numpy.typing.ArrayLike | typing.Any, name: str = 'pose') -> typing.Any:
    """
    Poses in one of the forms that as_pose of iksel lists as matrices (..., 4, 4), not checked; what is none of them as it is.
    """
def rigid_deviation(pose: numpy.typing.ArrayLike | typing.Any) -> numpy.typing.NDArray[numpy.float64]:
    """
    Largest element of |R^T R - I|; infinite if `pose` is not finite, mirrored, or not 0 0 0 1 in its last row.
    """
def simd_level() -> str:
    """
    The instruction set whose lanes solve on this machine: avx512, avx2, sse2, neon or scalar. The environment variable IKSEL_SIMD forces one. Raises InvalidArgumentError if it is not to be had.
    """
def stage_times(solver: Solver, pose: numpy.typing.ArrayLike | typing.Any) -> dict[str, typing.Any]:
    """
    Where the time of one solve of a pose goes [us]: finding seeds or what is known of the solutions (query_us), ranking (rank_us), iterating (iterate_us) and choosing seeds again (reselect_us). Evaluation has the means of many.
    """
def time_kdl_fk_jacobian(robot: Robot) -> float:
    """
    Mean time of one KDL FK plus one KDL Jacobian over random configurations [us].
    """
RIGID_TOLERANCE: float = 0.001
__version__: str
