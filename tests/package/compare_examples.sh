#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs the examples of both languages and compares what they print, byte for byte.
#
# Usage: tests/package/compare_examples.sh FOLDER_OF_THE_CPP_EXAMPLES [PYTHON]
set -euo pipefail

binaries=$(cd "$1" && pwd)
python=$(realpath -s "$(command -v "${2:-python3}")")
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

compared=0
for script in "$root"/python/examples/*.py; do
  name=$(basename "$script" .py)
  # Progress goes to stderr; it is shown only if the example fails.
  "$binaries/$name" >"$name.cpp.out" 2>err || { cat err >&2 && exit 1; }
  "$python" "$script" >"$name.py.out" 2>err || { cat err >&2 && exit 1; }
  diff -u "$name.cpp.out" "$name.py.out"
  [[ -s $name.cpp.out ]]
  compared=$((compared + 1))
done
[[ $compared == $(find "$root/cpp/examples" -name '*.cpp' | wc -l) ]] ||
  { echo "examples without a twin in the other language" >&2 && exit 1; }
echo "$compared examples print the same in C++ and Python"
