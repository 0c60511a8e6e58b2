#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Writes python/iksel_cpp-stubs/__init__.pyi from the installed iksel_cpp.
#   --check   compare instead of writing; exit status 1 and a diff if they differ
# PYTHON names the interpreter to use (python3).
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
stubs=$root/python/iksel_cpp-stubs/__init__.pyi
python=${PYTHON:-python3}
check=false
case "${1:-}" in
  "") ;;
  --check) check=true ;;
  *)
    echo "usage: $(basename "$0") [--check]" >&2
    exit 2
    ;;
esac

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# From an empty folder, so that the installed module is the one described.
cd "$work"
if ! "$python" -m pybind11_stubgen iksel_cpp --exit-code --output-dir out >log 2>&1; then
  cat log >&2
  exit 1
fi
"$python" "$root/scripts/tidy_stubs.py" <out/iksel_cpp.pyi >tidy.pyi

if $check; then
  if ! diff -u "$stubs" tidy.pyi; then
    echo "the stubs do not fit the installed iksel_cpp: run scripts/generate_stubs.sh" >&2
    exit 1
  fi
else
  mkdir -p "$(dirname "$stubs")"
  cp tidy.pyi "$stubs"
fi
