# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash
# What the scripts share: sourced by them, never run.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
venv=$(realpath -m "${IKSEL_VENV:-$root/.venv}")
# shellcheck disable=SC2034  # for the scripts that source this file
python=$venv/bin/python
export IKSEL_VENV=$venv
cd "$root"

: "${CMAKE_BUILD_PARALLEL_LEVEL:=$(nproc)}"
: "${CTEST_PARALLEL_LEVEL:=$CMAKE_BUILD_PARALLEL_LEVEL}"
export CMAKE_BUILD_PARALLEL_LEVEL CTEST_PARALLEL_LEVEL
# Whether warnings are errors, for the package and the tests alike.
export IKSEL_WARNINGS_AS_ERRORS=${IKSEL_WARNINGS_AS_ERRORS:-OFF}
# The package and the tests are made of the same sources: what one build has compiled, the next takes,
# if both are built by the same generator with the same flags.
use_build_tools() {
  if command -v ninja >/dev/null; then export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}; fi
  if ! command -v ccache >/dev/null; then return; fi
  export CMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER:-ccache}
  # Wherever the folder of the build is, and by one name of the compiler.
  export CCACHE_BASEDIR=${CCACHE_BASEDIR:-$root} CCACHE_NOHASHDIR=1 CXX=${CXX:-c++}
  # What is included the compiler says; to find out beforehand takes a tenth of the time.
  export CCACHE_DEPEND=1
}
use_build_tools

die() {
  printf '%s: %s\n' "$(basename "$0")" "$1" >&2
  exit "${2:-1}"
}

# The comment at the head of the running script is its help.
usage() {
  sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' "$0"
}

unknown_option() {
  usage >&2
  die "unknown option '$1'" 2
}

step() {
  printf '\n== %s\n' "$1"
}

# logged FILTER WHAT COMMAND...: the output goes to a file, and is shown whole only if the command fails;
# else what FILTER, a program for sed, prints of it.
logged() {
  local filter=$1 what=$2 log
  shift 2
  mkdir -p build
  log=build/$(basename "$0" .sh).log
  printf '%s ...\n' "$what"
  if ! "$@" 2>&1 </dev/null | tee "$log" | sed --unbuffered --quiet "$filter"; then
    cat "$log" >&2
    die "$what: failed; the output above is also in $log"
  fi
}

quietly() { logged '' "$@"; }

# Shows the steps of Ninja, [12/60], and the compiler's warnings.
with_progress() { logged 's/^ *\(\[[0-9]*\/[0-9]*\] .*\)/\1/p; / warning: /p' "$@"; }

# Configures, builds and tests a preset of CMakePresets.json.
build_and_test() {
  local preset=$1
  use_build_tools
  step "build ($preset)"
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset"
  step "ctest ($preset)"
  ctest --preset "$preset"
}
