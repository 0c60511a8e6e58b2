#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Asks the node as its users do, and checks each answer by kinematics of its own."""

import math
import time
import unittest
import xml.etree.ElementTree as ET

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from iksel_ros.srv import SolveIK, SolveIKRequest
from sensor_msgs.msg import JointState
from visualization_msgs.msg import InteractiveMarkerFeedback, MarkerArray

SEED = 1
TOLERANCE = 1e-6  # [m] and [rad]


def rotation(axis, angle):
    """Rotation matrix by Rodrigues' formula."""
    x, y, z = axis / np.linalg.norm(axis)
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * K + (1 - math.cos(angle)) * K @ K


def numbers(element, name, default):
    text = default if element is None else element.get(name, default)
    return np.array([float(word) for word in text.split()])


class Arm:
    """The revolute chain of a URDF between two links, read from its XML."""

    def __init__(self, urdf, base, tip):
        joints = ET.fromstring(urdf).findall("joint")
        above = {joint.find("child").get("link"): joint for joint in joints}
        self.chain = []
        while tip != base:
            self.chain.insert(0, above[tip])
            tip = above[tip].find("parent").get("link")
        moving = [joint for joint in self.chain if joint.get("type") != "fixed"]
        assert all(joint.get("type") == "revolute" for joint in moving)
        self.names = [joint.get("name") for joint in moving]
        limits = [joint.find("limit") for joint in moving]
        self.lower = np.array([float(limit.get("lower")) for limit in limits])
        self.upper = np.array([float(limit.get("upper")) for limit in limits])

    def fk(self, q):
        values = iter(q)
        T = np.eye(4)
        for joint in self.chain:
            origin = joint.find("origin")
            roll, pitch, yaw = numbers(origin, "rpy", "0 0 0")
            step = np.eye(4)
            step[:3, 3] = numbers(origin, "xyz", "0 0 0")
            step[:3, :3] = (
                rotation(np.array([0, 0, 1]), yaw)
                @ rotation(np.array([0, 1, 0]), pitch)
                @ rotation(np.array([1, 0, 0]), roll)
            )
            if joint.get("type") != "fixed":
                axis = numbers(joint.find("axis"), "xyz", "1 0 0")
                step[:3, :3] = step[:3, :3] @ rotation(axis, next(values))
            T = T @ step
        return T

    def random(self, rng):
        return rng.uniform(self.lower, self.upper)


def quaternion(R):
    """(x, y, z, w): the column of largest norm of the matrix 4 q q^T."""
    xx, yy, zz = np.diag(R)
    M = np.array(
        [
            [1 + xx - yy - zz, R[0, 1] + R[1, 0], R[0, 2] + R[2, 0], R[2, 1] - R[1, 2]],
            [R[0, 1] + R[1, 0], 1 - xx + yy - zz, R[1, 2] + R[2, 1], R[0, 2] - R[2, 0]],
            [R[0, 2] + R[2, 0], R[1, 2] + R[2, 1], 1 - xx - yy + zz, R[1, 0] - R[0, 1]],
            [R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1], 1 + xx + yy + zz],
        ]
    )
    column = M[:, np.argmax(np.diag(M))]
    return column / np.linalg.norm(column)


def message(T, frame):
    pose = PoseStamped()
    pose.header.frame_id = frame
    point, turn = pose.pose.position, pose.pose.orientation
    point.x, point.y, point.z = T[:3, 3]
    turn.x, turn.y, turn.z, turn.w = quaternion(T[:3, :3])
    return pose


def errors(target, T):
    """Distance [m] and angle [rad] between two poses."""
    R = target[:3, :3] @ T[:3, :3].T
    sine = 0.5 * np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    angle = math.atan2(np.linalg.norm(sine), (np.trace(R) - 1) / 2)
    return np.linalg.norm(target[:3, 3] - T[:3, 3]), angle


def show_times(name, seconds):
    median, p99 = 1e6 * np.quantile(seconds, [0.5, 0.99])
    print(f"{name}: median {median:.0f} us, 99 % {p99:.0f} us")


class Listener:
    """What arrives at a topic."""

    def __init__(self, topic, kind):
        self.messages = []
        self._subscriber = rospy.Subscriber(topic, kind, self.messages.append)

    def answer_to(self, send, fits):
        """The message that fits.

        Sends again until one does: the node may not know yet that somebody listens.
        """
        for _ in range(40):
            send()
            again = time.monotonic() + 0.5
            while time.monotonic() < again:
                for message in list(self.messages):
                    if fits(message):
                        return message
                time.sleep(0.001)
        raise AssertionError(f"{self._subscriber.name}: nothing that fits arrives")


def wait_for(condition, what, seconds=20):
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, f"{what}: not within {seconds} s"
        time.sleep(0.002)


class TestSolveIk(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_solve_ik")
        rospy.wait_for_service("iksel/solve_ik", timeout=30)
        cls.service = rospy.ServiceProxy("iksel/solve_ik", SolveIK, persistent=True)
        cls.base = rospy.get_param("iksel/base_link")
        tip = rospy.get_param("iksel/tip_link")
        cls.arm = Arm(rospy.get_param("robot_description"), cls.base, tip)

    def setUp(self):
        self.rng = np.random.default_rng(SEED)

    def ask(self, T, **more):
        return self.service(SolveIKRequest(pose=message(T, self.base), **more))

    def state(self, q):
        """Joint values in another order than the arm's."""
        return JointState(name=self.arm.names[::-1], position=list(q[::-1]))

    def check(self, T, joints):
        """The answer's joint values, which reach T inside the limits."""
        assert joints.name == self.arm.names
        q = np.array(joints.position)
        assert (self.arm.lower <= q).all()
        assert (q <= self.arm.upper).all()
        position_error, rotation_error = errors(T, self.arm.fk(q))
        assert position_error <= TOLERANCE, position_error
        assert rotation_error <= TOLERANCE, rotation_error
        return q

    def far_away(self):
        T = self.arm.fk(self.arm.random(self.rng))
        T[:3, 3] += [50, 0, 0]
        return T

    def test_1000_calls(self):
        count = 1000
        calls, solves = [], []
        for i in range(count):
            T = self.arm.fk(self.arm.random(self.rng))
            begin = time.monotonic()
            answer = self.ask(T)
            calls.append(time.monotonic() - begin)
            assert answer.success, f"seed {SEED}, pose {i}: {answer.reason}"
            assert answer.status == "solved"
            assert answer.position_error <= TOLERANCE
            assert answer.rotation_error <= TOLERANCE
            self.check(T, answer.joints)
            solves.append(1e-6 * answer.microseconds)
        print(f"\n{len(calls)} calls, all answers within {TOLERANCE} m and rad")
        show_times("call", calls)
        show_times("of which solving", solves)

    def test_no_answer_has_a_reason(self):
        for _ in range(20):
            answer = self.ask(self.far_away())
            assert not answer.success
            assert answer.status == "out_of_reach"
            assert "reach" in answer.reason
            assert not answer.joints.position
            assert math.isnan(answer.position_error)

    def test_nearest(self):
        for _ in range(50):
            q = self.arm.random(self.rng)
            T = self.arm.fk(q)
            answer = self.check(T, self.ask(T, near=self.state(q)).joints)
            assert np.abs(answer - q).max() < 1e-3

    def test_nearest_to_the_joint_states(self):
        publisher = rospy.Publisher("joint_states", JointState, queue_size=1)
        q = self.arm.random(self.rng)
        T = self.arm.fk(q)

        def arrived():
            publisher.publish(self.state(q))
            answer = self.ask(T, near_current=True)
            return answer.success and np.allclose(answer.joints.position, q, atol=1e-3)

        wait_for(arrived, "near_current")
        publisher.unregister()

    def test_tasks(self):
        T = self.arm.fk(self.arm.random(self.rng))
        place = self.ask(T, task="position_only", near=self.state(0 * self.arm.lower))
        reached = self.arm.fk(place.joints.position)
        assert np.linalg.norm(T[:3, 3] - reached[:3, 3]) <= TOLERANCE
        assert errors(T, reached)[1] > 0.01
        spun = self.ask(T, task="free_spin", near=self.state(0 * self.arm.lower))
        reached = self.arm.fk(spun.joints.position)
        assert np.linalg.norm(np.cross(T[:3, 2], reached[:3, 2])) <= TOLERANCE
        assert errors(T, reached)[1] > 0.01

    def test_requests_that_make_no_sense(self):
        T = self.arm.fk(self.arm.random(self.rng))
        other_frame = SolveIKRequest(pose=message(T, "camera"))
        no_rotation = SolveIKRequest(pose=message(T, self.base))
        no_rotation.pose.pose.orientation.w = math.nan
        unknown = JointState(name=["wing"], position=[0])
        short = JointState(name=self.arm.names, position=[0])
        for request, words in [
            (other_frame, ["'camera'", self.base]),
            (no_rotation, ["quaternion"]),
            (SolveIKRequest(), ["quaternion", "length 0"]),
            (SolveIKRequest(pose=message(T, ""), near=unknown), [self.arm.names[0]]),
            (SolveIKRequest(pose=message(T, ""), near=short), ["names", "1 positions"]),
            (SolveIKRequest(pose=message(T, ""), task="dance"), ["dance", "upright"]),
        ]:
            answer = self.service(request)
            assert not answer.success
            assert answer.status == "invalid_request"
            for word in words:
                assert word in answer.reason, answer.reason

    def test_markers(self):
        markers = Listener("iksel/markers", MarkerArray)
        T = self.arm.fk(self.arm.random(self.rng))
        for target in (T, self.far_away()):
            answer = self.ask(target)
            pose = message(target, self.base).pose
            found = markers.answer_to(
                lambda target=target: self.ask(target),
                lambda array, pose=pose: array.markers[0].pose == pose,
            )
            shown = {marker.ns: marker for marker in found.markers}
            assert set(shown) == {"target", "arm", "reason"}
            assert {marker.header.frame_id for marker in shown.values()} == {self.base}
            color = shown["arm"].color
            assert (color.g > color.r) == answer.success
            assert shown["reason"].text == (answer.reason or "solved")
            points = [[p.x, p.y, p.z] for p in shown["arm"].points]
            gap = np.linalg.norm(np.array(points) - target[:3, 3], axis=1).min()
            assert (gap <= TOLERANCE) == answer.success

    def test_dragging(self):
        """As RViz does it: the target moves on a line, and the arm does not jump."""
        answers = Listener("iksel/answer", JointState)
        drag = rospy.Publisher(
            "drag_target/feedback", InteractiveMarkerFeedback, queue_size=1
        )
        start = self.arm.fk(0.5 * np.array([0.6, -2.4, 2.8, -1.2, 2.4, 0.4]))
        before = None
        for i in range(30):
            T = start.copy()
            T[1, 3] += 0.005 * i
            pose = message(T, self.base)
            feedback = InteractiveMarkerFeedback(
                header=pose.header,
                client_id="test",
                marker_name="target",
                event_type=InteractiveMarkerFeedback.POSE_UPDATE,
                pose=pose.pose,
            )
            answer = answers.answer_to(
                lambda feedback=feedback: drag.publish(feedback),
                lambda state, T=T: max(errors(T, self.arm.fk(state.position))) < 1e-4,
            )
            q = self.check(T, answer)
            assert before is None or np.abs(q - before).max() < 0.1
            before = q


if __name__ == "__main__":
    rostest.rosrun("iksel_ros", "solve_ik", TestSolveIk)
