#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Checks formatting, spelling, the order of the folders, types, names, licence lines and the stubs;
# changes nothing.
#
# Usage: scripts/lint.sh [--fast]
#
#   --fast  without clang-tidy, which takes minutes, and the stubs
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

fast=false
for option in "$@"; do
  case $option in
    --fast) fast=true ;;
    -h | --help) usage && exit ;;
    *) unknown_option "$option" ;;
  esac
done

# sources PATTERN...: files of the repository, also those not committed yet.
sources() {
  git ls-files --cached --others --exclude-standard -z -- "$@" |
    while IFS= read -r -d '' file; do
      if [[ -f $file ]]; then printf '%s\0' "$file"; fi
    done
}

failed=()
check() { # NAME COMMAND...
  local name=$1
  shift
  step "$name"
  if "$@"; then echo ok; else failed+=("$name"); fi
}

clang_format() {
  sources '*.cpp' '*.hpp' | xargs -0 -r clang-format --dry-run --Werror
}

# The checks walk through all of Eigen for every source, so the library is given to them as two
# sources that include the others. The lane kernels in it are the scalar ones: those of the other
# instruction sets, which have flags of their own and stay outside, are the same templates.
clang_tidy() {
  cmake --preset tidy >/dev/null
  if ! run-clang-tidy -quiet -p build/tidy -j "$CMAKE_BUILD_PARALLEL_LEVEL" \
    '/Unity/' >build/tidy/findings.log 2>&1; then
    # Without the command line that it prints for each file.
    grep -vE '^[^ ]*clang-tidy|warnings generated|^$' build/tidy/findings.log
    if grep -qE 'redefinition of|is ambiguous' build/tidy/findings.log; then
      echo "names in unnamed namespaces must differ between the sources of cpp/src (see scripts/lint.sh)"
    fi
    return 1
  fi
}

# Other people's robots and licences, and what the fuzzers found, have words of their own.
spelling() {
  sources . ':!cpp/robots/*.urdf' ':!packaging/licenses' ':!tests/fuzz/corpus' | xargs -0 "$venv/bin/codespell"
}

shell_check() {
  sources '*.sh' .ci/run | xargs -0 shellcheck
}

# Every file whose language has comments names its licence within its first three lines.
spdx_lines() {
  local file missing=0
  while IFS= read -r -d '' file; do
    if ! head -n 3 "$file" | grep -q 'SPDX-License-Identifier: BSD-3-Clause'; then
      echo "$file: no SPDX-License-Identifier: BSD-3-Clause in its first three lines"
      missing=1
    fi
  done < <(sources '*.cpp' '*.hpp' '*.in' '*.py' '*.pyi' '*.sh' '*.toml' '*.yml' '*.yaml' '*.cmake' \
    '*CMakeLists.txt' .ci/run .clang-format .clang-tidy .editorconfig .gitignore)
  return "$missing"
}

scripts/bootstrap.sh --dev --lint

check "SPDX lines" spdx_lines
check "spelling" spelling
check "folders" "$python" scripts/check_layers.py
check "ruff check" "$venv/bin/ruff" check
check "ruff format" "$venv/bin/ruff" format --check
check "mypy" "$venv/bin/mypy"
check "clang-format" clang_format
check "shellcheck" shell_check
if ! $fast; then
  check "stubs" env PYTHON="$python" scripts/generate_stubs.sh --check
  check "clang-tidy" clang_tidy
fi

if ((${#failed[@]} > 0)); then
  printf -v list '%s, ' "${failed[@]}"
  die "failed: ${list%, }"
fi
