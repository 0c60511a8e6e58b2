#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds everything in build/release and runs all tests.
#
# Usage: scripts/test.sh [--quick]
#
#   --quick  skip the tests marked slow and the packages built outside the tree
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

quick=false
for option in "$@"; do
  case $option in
    --quick) quick=true ;;
    -h | --help) usage && exit ;;
    *) unknown_option "$option" ;;
  esac
done

skip_ctest=() skip_pytest=()
if $quick; then
  skip_ctest=(--label-exclude slow)
  skip_pytest=(-m 'not slow')
fi

scripts/bootstrap.sh --dev
build_and_test dev "${skip_ctest[@]}"

step pytest
"$python" -m pytest "${skip_pytest[@]}"

step "examples: C++ and Python print the same"
tests/package/compare_examples.sh build/release/cpp/examples "$python"

if ! $quick; then
  step "consumers of the installed package"
  tests/package/run.sh build/release
fi
