#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Uses the library as others do: installs a build, and builds programs outside the tree with
# find_package and add_subdirectory, as a static and as a shared library.
#
# Usage: tests/package/run.sh [BUILD_FOLDER]    (default: build/release)
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=$(realpath "${1:-$root/build/release}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# Built with flags of their own on purpose; not to be counted among what is compiled once.
unset CCACHE_STATSLOG

# The checkout must not matter to what is installed.
cp -r "$root/tests/package" "$root/cpp/examples" "$work"
cd "$work"

run() { # COMMAND...: quiet unless it fails
  "$@" >log 2>&1 || {
    cat log >&2
    echo "failed: $*" >&2
    exit 1
  }
}

build_outside() { # SOURCE FOLDER CMAKE-ARGUMENT...
  local source=$1 folder=$2
  shift 2
  run cmake -S "$source" -B "$folder" "$@"
  run cmake --build "$folder" --parallel "${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}"
}

public_headers() { # PREFIX: each compiles alone, twice in a row, and shows only std and Eigen
  local headers=("$1"/include/iksel/*.hpp) header name foreign flags
  read -ra flags <<<"$(pkg-config --cflags eigen3)"
  for header in "${headers[@]}"; do
    name=$(basename "$header")
    printf '#include "iksel/%s"\n' "$name" "$name" >alone.cpp
    run "${CXX:-c++}" -std=c++17 -fsyntax-only -Wall -Wextra -Wpedantic -Werror \
      -I"$1/include" "${flags[@]/#-I/-isystem}" alone.cpp
  done
  foreign=$(grep -nHE '^[[:space:]]*#[[:space:]]*include' "${headers[@]}" |
    grep -vE '#include (<[a-z_]+>|<Eigen/[A-Za-z]+>|"iksel/[a-z_]+\.hpp")' || true)
  if [[ -n $foreign ]]; then
    printf 'public headers may include std, Eigen and iksel only:\n%s\n' "$foreign" >&2
    exit 1
  fi
  echo "${#headers[@]} public headers stand alone and show std and Eigen only"
}

installed() { # PREFIX KIND
  build_outside package/find_package "consumer-$2" -DCMAKE_PREFIX_PATH="$1" \
    -DCMAKE_BUILD_TYPE=Release
  "./consumer-$2/consumer"
  echo "find_package works with the $2 library"
}

other_programs() { # PREFIX: what does not depend on the kind of library
  # A program with other SIMD flags than the library: Eigen's types must not change their layout.
  if grep -qw avx2 /proc/cpuinfo; then
    build_outside package/find_package consumer-avx2 -DCMAKE_PREFIX_PATH="$1" \
      -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_STANDARD=20 -DCMAKE_CXX_FLAGS='-mavx2 -mfma'
    ./consumer-avx2/consumer
  fi
  build_outside examples examples-outside -DCMAKE_PREFIX_PATH="$1" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_CXX_FLAGS_RELEASE=-O1
  ./examples-outside/01_solve >/dev/null
  echo "the examples build outside the tree, and so does a program with other SIMD flags"
}

run cmake --install "$build" --prefix "$work/static"
public_headers "$work/static"
installed "$work/static" static
other_programs "$work/static"
"$root/tests/package/readme.sh" "$work/static"
"${PYTHON:-python3}" "$root/tests/package/docs.py" "$work/static"

# With Eigen's assertions on; the rest is left out to build faster, of two sources. Installed as Debian does,
# in a folder with the name of the machine.
build_outside package/add_subdirectory subdirectory -DIKSEL_SOURCE_DIR="$root" \
  -DIKSEL_INSTALL=ON -DBUILD_SHARED_LIBS=ON -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG= \
  -DIKSEL_SIMD_LEVELS= -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=38 \
  -DCMAKE_INSTALL_LIBDIR="lib/$("${CXX:-c++}" -print-multiarch)"
./subdirectory/consumer
echo "add_subdirectory works"
run cmake -S package/add_subdirectory -B untouched -DIKSEL_SOURCE_DIR="$root"

run cmake --install subdirectory --prefix "$work/shared"
installed "$work/shared" shared
"$root/tests/package/readme.sh" "$work/shared"

# What a program's own build is set to stays its own.
build_type=$(sed -n 's/^CMAKE_BUILD_TYPE:[A-Z]*=//p' untouched/CMakeCache.txt)
[[ -z $build_type ]] || { echo "add_subdirectory set CMAKE_BUILD_TYPE" >&2 && exit 1; }
