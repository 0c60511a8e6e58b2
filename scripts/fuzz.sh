#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Fuzzes what reads input that others made: URDF text, database files, pickles, and the command
# line's arguments. The first two are libFuzzer's under the address and undefined-behaviour
# sanitizers; the others run through Python by atheris.
#
# Usage: scripts/fuzz.sh [--seconds N] [--seed N] [--jobs N] [TARGET...]
#
#   --seconds N  for each target (default: 600)
#   --seed N     of the inputs (default: another each time)
#   --jobs N     targets at a time (default: $CMAKE_BUILD_PARALLEL_LEVEL, or one per core)
#   TARGET       urdf, database, pickle, cli (default: all)
#
# Starts from tests/fuzz/corpus; what is found on top is kept in build/fuzz/corpus. Fails on a
# finding, kept in build/fuzz/findings, and says how to repeat it.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

seconds=600 seed=0 jobs=$CMAKE_BUILD_PARALLEL_LEVEL targets=()
while (($#)); do
  case $1 in
    --seconds) seconds=${2:?} && shift 2 ;;
    --seed) seed=${2:?} && shift 2 ;;
    --jobs) jobs=${2:?} && shift 2 ;;
    -h | --help) usage && exit ;;
    urdf | database | pickle | cli) targets+=("$1") && shift ;;
    *) unknown_option "$1" ;;
  esac
done
if ((${#targets[@]} == 0)); then targets=(urdf database pickle cli); fi

# In one input at most [s]; a sound one takes milliseconds.
readonly hang=20
# urdfdom leaks on every file that it refuses, so that leaks are not looked for.
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1
export UBSAN_OPTIONS=print_stacktrace=1

native() { [[ $1 == urdf || $1 == database ]]; }

build_native() {
  # With flags of its own.
  unset CCACHE_STATSLOG
  scripts/bootstrap.sh --apt-only --fuzz
  step "build (fuzz)"
  cmake --preset fuzz >/dev/null
  cmake --build --preset fuzz
}

prepare_python() {
  scripts/bootstrap.sh --dev
  "$python" -c 'import atheris' 2>/dev/null || quietly "installing atheris" "$python" -m pip install 'atheris>=2.3'
}

# The command that runs a target, into the array `command`.
command_of() {
  if native "$1"; then
    command=("build/fuzz/tests/fuzz/fuzz_$1")
  else
    command=("$python" "tests/fuzz/fuzz_$1.py")
  fi
}

fuzz() {
  local target=$1 found=build/fuzz/findings/$1-
  mkdir -p build/fuzz/findings "build/fuzz/corpus/$target"
  rm -f "$found"*
  command_of "$target"
  # Arguments are chosen by few bytes.
  local longest=16384
  if [[ $target == cli ]]; then longest=256; fi
  local settings=("-max_total_time=$seconds" "-seed=$seed" "-timeout=$hang" -rss_limit_mb=4096
    "-max_len=$longest" -len_control=0 "-artifact_prefix=$found" -print_final_stats=1)
  if [[ -f tests/fuzz/$target.dict ]]; then settings+=("-dict=tests/fuzz/$target.dict"); fi
  if "${command[@]}" "${settings[@]}" "build/fuzz/corpus/$target" "tests/fuzz/corpus/$target" \
    >"build/fuzz/$target.log" 2>&1; then
    printf '%-9s %s executions, nothing found\n' "$target" \
      "$(sed -n 's/^stat::number_of_executed_units: *//p; s/^Done \([0-9]*\) runs.*/\1/p' "build/fuzz/$target.log" | head -n 1)"
    return
  fi
  tail -n 60 "build/fuzz/$target.log" >&2
  printf '\n%s: a finding; repeat it by: %s %s*\n' "$target" "${command[*]}" "$found" >&2
  touch build/fuzz/failed
}

for target in "${targets[@]}"; do
  if native "$target"; then
    build_native
    break
  fi
done
for target in "${targets[@]}"; do
  if ! native "$target"; then
    prepare_python
    break
  fi
done

step "fuzz ${targets[*]}, $seconds s each"
rm -f build/fuzz/failed
for target in "${targets[@]}"; do
  while (($(jobs -rp | wc -l) >= jobs)); do wait -n; done
  fuzz "$target" &
done
wait
if [[ -e build/fuzz/failed ]]; then die "findings, see above"; fi
