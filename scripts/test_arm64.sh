#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Cross-builds for 64-bit Arm in build/arm64, and runs the tests of the lanes and the solver there
# under qemu: that the NEON kernels build and are right, not how fast they are.
#
# Usage: scripts/test_arm64.sh
#
# IKSEL_TEST_CASES sets the number of random cases, 60 if it is not set. Needs rights to install
# g++-aarch64-linux-gnu and qemu-user-static; the Arm libraries are only unpacked.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

for option in "$@"; do
  case $option in
    -h | --help) usage && exit ;;
    *) unknown_option "$option" ;;
  esac
done

work=$root/build/arm64
mkdir -p "$work"/{debs,lists/partial,cache/archives/partial,root}
arm_apt=(-o APT::Architecture=arm64 -o APT::Architectures=arm64
  -o "Dir::State::Lists=$work/lists" -o "Dir::Cache=$work/cache")

install_emulator() {
  if command -v aarch64-linux-gnu-g++ qemu-aarch64-static >/dev/null; then return; fi
  quietly "installing the cross compiler and qemu" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y --no-install-recommends g++-aarch64-linux-gnu qemu-user-static
}

# Unpacks the libraries that IKSel is built with, and what they are linked to, for arm64.
unpack_libraries() {
  if [[ -f $work/unpacked ]]; then return; fi
  quietly "updating the package lists for arm64" apt-get "${arm_apt[@]}" update
  local wanted=(libeigen3-dev libgtest-dev libnanoflann-dev liborocos-kdl-dev liburdfdom-dev
    libxsimd-dev libxxhash-dev)
  mapfile -t wanted < <(apt-cache "${arm_apt[@]}" depends --recurse --no-suggests --no-recommends \
    --no-conflicts --no-breaks --no-replaces --no-enhances "${wanted[@]}" |
    grep -E '^lib(eigen|gtest|gmock|nanoflann|orocos|urdfdom|console-bridge|tinyxml|xsimd|xxhash)' |
    cut -d : -f 1 | sort -u)
  quietly "fetching ${wanted[*]}" env -C "$work/debs" apt-get "${arm_apt[@]}" download "${wanted[@]}"
  local package
  for package in "$work"/debs/*.deb; do dpkg -x "$package" "$work/root"; done
  touch "$work/unpacked"
}

install_emulator
unpack_libraries
step "build (arm64)"
cmake -S . -B "$work/build" -DCMAKE_BUILD_TYPE=Release -DIKSEL_BUILD_TESTS=ON \
  -DIKSEL_TEST_FILES='lanes;solver' -DCMAKE_TOOLCHAIN_FILE="$root/scripts/arm64.cmake" >/dev/null
cmake --build "$work/build" --target iksel_tests
step "ctest (arm64)"
IKSEL_TEST_CASES=${IKSEL_TEST_CASES:-60} ctest --test-dir "$work/build" --output-on-failure
