# SPDX-License-Identifier: BSD-3-Clause
"""The node, for a robot in a URDF file."""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def node(context):
    def value(name):
        return LaunchConfiguration(name).perform(context)

    parameters = {
        "robot_description": Path(value("urdf")).read_text(encoding="utf-8"),
        "base_link": value("base_link"),
        "tip_link": value("tip_link"),
    }
    return [
        Node(
            package="iksel_ros",
            executable="ik_node",
            name="iksel",
            output="screen",
            parameters=[parameters],
        )
    ]


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("urdf"),
            # Empty: the root link, and the one link without children.
            DeclareLaunchArgument("base_link", default_value=""),
            DeclareLaunchArgument("tip_link", default_value=""),
            OpaqueFunction(function=node),
        ]
    )
