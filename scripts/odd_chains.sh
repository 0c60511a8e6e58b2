#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Judges answers of every kind of request on random odd chains (tests/cpp/test_odd_chains.cpp), a
# million by default, in one process per core. A million take about a quarter of an hour on two cores.
#
# Usage: scripts/odd_chains.sh [--cases N] [--jobs N] [--seed N]
#
# Fails on a false answer, a crash or a hang, and says which chain it was.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

cases=1000000 jobs=$(nproc) seed=1
while (($#)); do
  case $1 in
    --cases) cases=${2:?} && shift 2 ;;
    --jobs) jobs=${2:?} && shift 2 ;;
    --seed) seed=${2:?} && shift 2 ;;
    -h | --help) usage && exit ;;
    *) unknown_option "$1" ;;
  esac
done

scripts/bootstrap.sh --apt-only --dev
step "build (dev)"
cmake --preset dev >/dev/null
cmake --build --preset dev --target iksel_tests

step "$cases cases in $jobs processes, seed $seed"
# Each process has seeds of its own: that many chains none of them makes.
each=$(((cases + jobs - 1) / jobs)) apart=1000000000
log=build/odd_chains
mkdir -p "$log"
running=()
for ((i = 0; i < jobs; i++)); do
  IKSEL_TEST_CASES=$each IKSEL_TEST_SEED=$((seed + i * apart)) \
    build/release/tests/iksel_tests --gtest_filter='OddChains.*' >"$log/$i.log" 2>&1 &
  running+=($!)
done
trap 'kill "${running[@]}" 2>/dev/null || true' EXIT

failed=0
for ((i = 0; i < jobs; i++)); do
  if wait "${running[i]}"; then
    grep -h '^odd chains:' "$log/$i.log"
  else
    failed=1
    tail -n 60 "$log/$i.log" >&2
  fi
done
trap - EXIT
((failed == 0)) || die "findings; IKSEL_TEST_SEED=... IKSEL_TEST_CASES=100 build/release/tests/iksel_tests --gtest_filter=OddChains.* repeats a chain"
