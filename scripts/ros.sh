#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds the ROS 1 node in build/ros with Debian's ROS, and asks it 1,000 times.
#
# Usage: scripts/ros.sh
#
# It is built against an installed IKSel, as a catkin workspace would. build/ros/devel/setup.bash makes it
# known to rosrun and roslaunch.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

case ${1-} in
  '') ;;
  -h | --help) usage && exit ;;
  *) unknown_option "$1" ;;
esac

scripts/bootstrap.sh --apt-only --ros

prefix=$root/build/ros/iksel

# As the tests build it, and in a folder as deep as theirs, so that ccache knows it.
quietly "configuring the library" cmake -S . -B build/ros -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_INSTALL_PREFIX="$prefix" -DIKSEL_WARNINGS_AS_ERRORS="$IKSEL_WARNINGS_AS_ERRORS"
quietly "building the library" cmake --build build/ros --target install

# Debian's Python has Debian's modules; another may come first in the path.
quietly "configuring the node" cmake -S ros/ros1/iksel_ros -B build/ros/node \
  -DCMAKE_PREFIX_PATH="$prefix" -DCATKIN_DEVEL_PREFIX="$root/build/ros/devel" \
  -DPYTHON_EXECUTABLE=/usr/bin/python3
quietly "building the node" cmake --build build/ros/node

step "rostest"
# With --text it would say success whatever the tests say; so what they print stands in its results.
results=$root/build/ros/results
rm -rf "$results"
build/ros/devel/env.sh rostest --results-base-dir "$results" iksel_ros solve_ik.test \
  urdf:="$prefix/share/iksel/robots/ur5e.urdf" base_link:=base_link tip_link:=tool0 ||
  { find "$results" -name '*.xml' -exec cat {} + && die "rostest failed"; }
grep --recursive --no-filename --extended-regexp '^[0-9]+ calls|: median' "$results"
