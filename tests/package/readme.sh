#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Follows the README's C++ section literally, outside the tree: its main.cpp by its CMakeLists.txt and
# by its line for pkg-config.
#
# Usage: tests/package/readme.sh PREFIX    (where the library is installed)
set -euo pipefail

prefix=$(realpath "$1")
readme=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/README.md
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

example() { # NAME: the code between its marks
  sed -n "/^<!-- $1 example -->\$/,/^<!-- end $1 example -->\$/p" "$readme" | grep -vE '^(<!--|```)'
}

example cpp >main.cpp
example cmake >CMakeLists.txt
grep -q main main.cpp
CMAKE_PREFIX_PATH=$prefix cmake -S . -B build >log 2>&1 || { cat log >&2 && exit 1; }
cmake --build build >log 2>&1 || { cat log >&2 && exit 1; }
./build/app | grep -q '^q \[rad\]'

# Debian's folder of libraries has the name of the machine in it.
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name iksel.pc)")
export PKG_CONFIG_PATH
example shell >build.sh
bash -e build.sh
LD_LIBRARY_PATH=$(dirname "$PKG_CONFIG_PATH") ./app | diff - <(./build/app)
echo "README's C++ example works by CMake and by pkg-config"
