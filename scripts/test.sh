#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds everything in build/release and runs all tests.
#
# Usage: scripts/test.sh [--quick] [--only cpp|python]
#
#   --quick  300 random cases per C++ test, no pytest marked slow, no programs outside the tree
#   --only   those in C++ and the programs, or those in Python: CI runs both beside each other
#
# IKSEL_TEST_CASES and IKSEL_TEST_SEED set the number of random cases and their seed.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

quick=false only=
while (($# > 0)); do
  case $1 in
    --quick) quick=true ;;
    --only) only=${2:?cpp or python} && shift ;;
    -h | --help) usage && exit ;;
    *) unknown_option "$1" ;;
  esac
  shift
done
case $only in
  '' | cpp | python) ;;
  *) unknown_option "--only $only" ;;
esac

selection=()
if $quick; then
  export IKSEL_TEST_CASES=${IKSEL_TEST_CASES:-300}
  selection=(-m 'not slow')
fi

scripts/bootstrap.sh --dev

if [[ $only != python ]]; then
  build_and_test dev

  step "examples: C++ and Python print the same"
  tests/package/compare_examples.sh build/release/cpp/examples "$python"

  if ! $quick; then
    step "consumers of the installed package"
    tests/package/run.sh build/release
  fi
fi

if [[ $only != cpp ]]; then
  step pytest
  "$python" -m pytest "${selection[@]}"
fi
