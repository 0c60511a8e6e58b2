#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A frame to drag and turn in RViz; where it is goes to the topic `target`.

Parameters: ~frame, the link that poses are relative to; ~start, x y z [m].
"""

import rospy
from geometry_msgs.msg import PoseStamped
from interactive_markers.interactive_marker_server import InteractiveMarkerServer
from visualization_msgs.msg import (
    InteractiveMarker,
    InteractiveMarkerControl,
    InteractiveMarkerFeedback,
)

SIZE = 0.2  # [m]


def controls():
    """An arrow and a ring for each axis."""
    # Both are about the control's own x axis; quarter turns take it to the others.
    for turn in ("x", "z", "y"):
        for mode in (
            InteractiveMarkerControl.MOVE_AXIS,
            InteractiveMarkerControl.ROTATE_AXIS,
        ):
            control = InteractiveMarkerControl(interaction_mode=mode)
            control.orientation.w = 0.5**0.5
            setattr(control.orientation, turn, 0.5**0.5)
            yield control


def main():
    rospy.init_node("drag_target")
    topic = rospy.Publisher("target", PoseStamped, queue_size=1, latch=True)

    def follow(feedback):
        if feedback.event_type == InteractiveMarkerFeedback.POSE_UPDATE:
            topic.publish(PoseStamped(header=feedback.header, pose=feedback.pose))

    marker = InteractiveMarker(name="target", scale=SIZE)
    marker.header.frame_id = rospy.get_param("~frame")
    position = marker.pose.position
    position.x, position.y, position.z = rospy.get_param("~start", [0.3, 0.2, 0.3])
    marker.pose.orientation.w = 1
    marker.controls = list(controls())

    server = InteractiveMarkerServer("drag_target")
    server.insert(marker, follow)
    server.applyChanges()
    rospy.spin()


if __name__ == "__main__":
    main()
