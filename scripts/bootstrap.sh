#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs what IKSel needs, and IKSel itself into a virtual environment.
#
# Usage: scripts/bootstrap.sh [--dev] [--lint] [--fuzz] [--bench] [--ros] [--docs] [--browser] [--apt-only]
#
#   --dev       also what tests, benchmarks and the extra [dev] need
#   --lint      also clang-format, clang-tidy and shellcheck
#   --fuzz      also clang with libFuzzer
#   --bench     also NLopt for the C++ baselines, and from PyPI the solvers to compare with, robots
#               with bodies for scenes and JAX for the learned seeds
#   --ros       also Debian's ROS 1, for the node in ros/ros1
#   --docs      also what the documentation is made with
#   --browser   also Debian's Chromium and playwright, which drive the view in the tests
#   --apt-only  only the system's packages, no virtual environment
#
# System packages come from apt; those that are there already are left alone. The virtual environment
# is .venv, or $IKSEL_VENV; it is made with python3, or $IKSEL_PYTHON. Nothing is reinstalled while
# the sources are unchanged.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

apt_only=false bench=false browser=false dev=false docs=false fuzz=false lint=false ros=false
for option in "$@"; do
  case $option in
    --apt-only) apt_only=true ;;
    --bench) bench=true ;;
    --browser) browser=true ;;
    --dev) dev=true ;;
    --docs) docs=true ;;
    --fuzz) fuzz=true ;;
    --lint) lint=true ;;
    --ros) ros=true ;;
    -h | --help) usage && exit ;;
    *) unknown_option "$option" ;;
  esac
done

base_python=${IKSEL_PYTHON:-python3}

want_command() { # COMMAND PACKAGE
  command -v "$1" >/dev/null || missing+=("$2")
}

want_library() { # PKG-CONFIG-NAME PACKAGE
  pkg-config --exists "$1" 2>/dev/null || missing+=("$2")
}

want_package() { # PACKAGE...
  local package
  for package in "$@"; do
    [[ $(dpkg-query --show --showformat '${db:Status-Status}' "$package" 2>/dev/null) == installed ]] ||
      missing+=("$package")
  done
}

has_libfuzzer() {
  echo 'extern "C" int LLVMFuzzerTestOneInput(const char*, unsigned long) { return 0; }' |
    clang++ -fsanitize=fuzzer,address -x c++ -o /dev/null - 2>/dev/null
}

# Puts the packages of what is not there into the array `missing`.
find_missing() {
  missing=()
  want_command g++ g++
  want_command cmake cmake
  want_command make make
  want_command ninja ninja-build
  want_command ccache ccache
  want_command pkg-config pkg-config
  want_library eigen3 libeigen3-dev
  want_library libxxhash libxxhash-dev
  want_library nanoflann libnanoflann-dev
  want_library orocos-kdl liborocos-kdl-dev
  want_library urdfdom liburdfdom-dev
  want_library xsimd libxsimd-dev
  if ! $apt_only; then find_missing_python; fi
  if $dev; then
    want_library benchmark libbenchmark-dev
    want_library gtest libgtest-dev
  fi
  if $browser; then want_command chromium chromium; fi
  if $bench; then want_library nlopt libnlopt-cxx-dev; fi
  if $ros; then
    want_package catkin libgeometry-msgs-dev libroscpp-dev librostest-dev libsensor-msgs-dev \
      libvisualization-msgs-dev python3-geometry-msgs python3-interactive-markers python3-numpy \
      python3-rospy python3-rostest python3-sensor-msgs python3-visualization-msgs \
      ros-geometry-msgs ros-message-generation ros-sensor-msgs ros-std-msgs
  fi
  if $docs; then want_command doxygen doxygen; fi
  if $fuzz && ! has_libfuzzer; then missing+=(clang libclang-rt-14-dev); fi
  if $lint; then
    want_command clang-format clang-format
    want_command clang-tidy clang-tidy
    want_command git git
    want_command shellcheck shellcheck
  fi
}

find_missing_python() {
  if ! command -v "$base_python" >/dev/null; then
    missing+=(python3 python3-dev python3-venv)
    return
  fi
  "$base_python" -c 'import ensurepip, venv' 2>/dev/null || missing+=(python3-venv)
  "$base_python" - <<'PYTHON' || missing+=(python3-dev)
import pathlib, sys, sysconfig
sys.exit(not (pathlib.Path(sysconfig.get_path("include")) / "Python.h").exists())
PYTHON
}

install_missing() {
  find_missing
  if ((${#missing[@]} == 0)); then return; fi
  local list="${missing[*]}" as_root=()
  if ! command -v apt-get >/dev/null; then
    die "apt is not available; install the equivalents of these Debian packages and run again: $list"
  fi
  if ((EUID != 0)); then
    command -v sudo >/dev/null || die "run this as root and start again: apt-get install $list"
    as_root=(sudo)
    sudo -v || die "no rights to install packages; have installed: $list"
  fi
  as_root+=(env DEBIAN_FRONTEND=noninteractive apt-get)
  quietly "updating the package lists" "${as_root[@]}" update
  quietly "installing $list" "${as_root[@]}" install -y --no-install-recommends "${missing[@]}"
  find_missing
  if ((${#missing[@]} > 0)); then
    die "installed, but not found on the search paths: ${missing[*]}"
  fi
}

# A hash over what the installed package is made of.
source_hash() {
  local inputs=(CMakeLists.txt pyproject.toml README.md LICENSE cpp python)
  find "${inputs[@]}" -type f ! -path '*/examples/*' ! -path '*/__pycache__/*' -print0 |
    LC_ALL=C sort -z | xargs -0 sha256sum | sha256sum | cut -d ' ' -f 1
}

# from_pyproject ITEMS: what a Python expression over pyproject.toml's contents gives, a line each.
from_pyproject() {
  "$python" - "$1" <<'PYTHON'
import sys
from pip._vendor import tomli  # Python 3.10 has no parser of its own
with open("pyproject.toml", "rb") as file:
    project = tomli.load(file)
print(*eval(f"[*({sys.argv[1]})]", {"project": project}), sep="\n")
PYTHON
}

install_project() {
  if ! "$python" -m pip --version >/dev/null 2>&1; then
    quietly "making the virtual environment $venv" "$base_python" -m venv --clear "$venv"
  fi
  local stamp=$venv/iksel.stamp target=. state build_system
  if $dev; then target='.[dev]'; fi
  # As the tests build it, so that ccache knows it. In variables: the options that say the same are not
  # known to every pip.
  export SKBUILD_BUILD_DIR=build/python
  export SKBUILD_CMAKE_DEFINE="BUILD_SHARED_LIBS=OFF;IKSEL_WARNINGS_AS_ERRORS=$IKSEL_WARNINGS_AS_ERRORS"
  state="$(source_hash) $("$python" -V)"
  # Once the extra is there, it stays there.
  if [[ -f $stamp ]] && { [[ $(<"$stamp") == "$state $target" ]] ||
    [[ $(<"$stamp") == "$state .[dev]" ]]; }; then
    return
  fi
  if [[ -f $stamp ]] && grep -qF '.[dev]' "$stamp"; then target='.[dev]'; fi
  rm -f "$stamp"
  # Python compiles what it imports; that would be all of numpy.
  export PIP_NO_COMPILE=1
  # Once, where it stays: pip's own environment for builds has another path each time.
  mapfile -t build_system < <(from_pyproject 'project["build-system"]["requires"]')
  quietly "installing ${build_system[*]}" "$python" -m pip install "${build_system[@]}"
  with_progress "installing iksel into $venv" \
    "$python" -m pip install --verbose --no-build-isolation "$target"
  printf '%s\n' "$state $target" >"$stamp"
}

# What the extras of pyproject.toml whose names begin so name; iksel itself is not built again.
install_extras() { # PREFIX
  local packages
  mapfile -t packages < <(from_pyproject \
    "item for extra, items in project['project']['optional-dependencies'].items()
       if extra.startswith('$1') for item in items")
  quietly "installing ${packages[*]}" "$python" -m pip install "${packages[@]}"
}

install_missing
use_build_tools
if ! $apt_only; then
  install_project
  if $bench; then install_extras bench; fi
  if $browser; then install_extras browser; fi
  if $docs; then install_extras docs; fi
fi
