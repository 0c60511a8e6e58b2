#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds the libraries that IKSel needs from their sources, for systems that have no packages of them:
# the images in which wheels for every Linux are built.
#
# Usage: scripts/dependencies.sh PREFIX [SOURCES]
#
#   PREFIX   where they are installed
#   SOURCES  a folder with their sources, by the names below, to take instead of git's
#
# Afterwards CMAKE_PREFIX_PATH=PREFIX, PKG_CONFIG_PATH=PREFIX/lib/pkgconfig:PREFIX/share/pkgconfig and
# LD_LIBRARY_PATH=PREFIX/lib find them. Needs git, CMake, pkg-config and a C++ compiler.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

case ${1-} in
  '' | -h | --help) usage && exit ;;
  -*) unknown_option "$1" ;;
esac

prefix=$(realpath -m "$1")
work=$root/build/dependencies
sources=${2-}
if [[ -n $sources ]]; then sources=$(realpath "$sources"); fi

fetch() { # NAME REPOSITORY TAG
  if [[ -n $sources ]]; then
    ln -sfn "$sources/$1" "$work/$1"
    return
  fi
  if [[ -d $work/$1 ]]; then return; fi
  quietly "fetching $1 $3" git clone --quiet --depth 1 --branch "$3" "$2" "$work/$1"
}

# The older ones ask for versions of CMake that the newest no longer plays.
install_by_cmake() { # FOLDER CMAKE-ARGUMENT...
  local name=$1
  shift
  quietly "configuring $name" cmake -S "$work/$name" -B "$work/build/$name" \
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_INSTALL_LIBDIR=lib \
    -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_POLICY_VERSION_MINIMUM=3.5 -DBUILD_TESTING=OFF "$@"
  quietly "building $name" cmake --build "$work/build/$name"
  quietly "installing $name" cmake --install "$work/build/$name"
}

mkdir -p "$work"
fetch eigen https://gitlab.com/libeigen/eigen.git 3.4.0
install_by_cmake eigen -DEIGEN_BUILD_DOC=OFF
fetch nanoflann https://github.com/jlblancoc/nanoflann.git v1.4.3
install_by_cmake nanoflann -DNANOFLANN_BUILD_EXAMPLES=OFF -DNANOFLANN_BUILD_TESTS=OFF
fetch xsimd https://github.com/xtensor-stack/xsimd.git 8.1.0
install_by_cmake xsimd
fetch xxHash https://github.com/Cyan4973/xxHash.git v0.8.1
install -D -m 644 "$work/xxHash/xxhash.h" "$prefix/include/xxhash.h"
fetch tinyxml2 https://github.com/leethomason/tinyxml2.git 9.0.0
install_by_cmake tinyxml2 -DBUILD_SHARED_LIBS=ON -Dtinyxml2_BUILD_TESTING=OFF
fetch console_bridge https://github.com/ros/console_bridge.git 1.0.2
install_by_cmake console_bridge
fetch urdfdom_headers https://github.com/ros/urdfdom_headers.git 1.1.0
install_by_cmake urdfdom_headers
fetch urdfdom https://github.com/ros/urdfdom.git 4.0.0
install_by_cmake urdfdom
fetch orocos_kdl https://github.com/orocos/orocos_kinematics_dynamics.git v1.5.1
install_by_cmake orocos_kdl/orocos_kdl -DENABLE_TESTS=OFF -DENABLE_EXAMPLES=OFF
