#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds everything in build/release and runs all tests.
#
# Usage: scripts/test.sh [--quick]
#
#   --quick  300 random cases per C++ test, no pytest marked slow, no programs outside the tree
#
# IKSEL_TEST_CASES and IKSEL_TEST_SEED set the number of random cases and their seed.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

quick=false
for option in "$@"; do
  case $option in
    --quick) quick=true ;;
    -h | --help) usage && exit ;;
    *) unknown_option "$option" ;;
  esac
done

selection=()
if $quick; then
  export IKSEL_TEST_CASES=${IKSEL_TEST_CASES:-300}
  selection=(-m 'not slow')
fi

scripts/bootstrap.sh --dev
build_and_test dev

step pytest
"$python" -m pytest "${selection[@]}"

step "examples: C++ and Python print the same"
tests/package/compare_examples.sh build/release/cpp/examples "$python"

if ! $quick; then
  step "consumers of the installed package"
  tests/package/run.sh build/release
fi
