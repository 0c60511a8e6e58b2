#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs commands beside each other, each with its share of the processors.
#
# Usage: scripts/beside.sh COMMAND...    (each a line for bash)
#
# Tests take all processors, as much of them runs when the other commands have ended.
# What a command prints is shown when it ends. Fails as soon as one fails, and ends the others.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

case ${1-} in
  '' | -h | --help) usage && exit ;;
esac

share=$(($(nproc) / $#))
export CMAKE_BUILD_PARALLEL_LEVEL=$((share > 0 ? share : 1))
CTEST_PARALLEL_LEVEL=$(nproc)
export CTEST_PARALLEL_LEVEL

mkdir -p build/beside
declare -A commands=() logs=()
# Each in a process group of its own, which ends as a whole.
set -m
for command in "$@"; do
  log=build/beside/${#logs[@]}.log
  bash -c "$command" >"$log" 2>&1 </dev/null &
  commands[$!]=$command logs[$!]=$log
done
end_others() {
  local pid
  for pid in "${!commands[@]}"; do kill -- "-$pid" 2>/dev/null || true; done
}
trap end_others EXIT

while ((${#commands[@]} > 0)); do
  status=0
  wait -n -p ended "${!commands[@]}" || status=$?
  step "${commands[$ended]}: $SECONDS s, exit status $status"
  cat "${logs[$ended]}"
  ((status == 0)) || die "failed: ${commands[$ended]}"
  unset "commands[$ended]"
done
