#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs the C++ tests under the address and undefined-behaviour sanitizers (build/asan), and those
# labelled `threads` under the thread sanitizer (build/tsan).
#
# Usage: scripts/sanitize.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

for option in "$@"; do
  case $option in
    -h | --help) usage && exit ;;
    *) unknown_option "$option" ;;
  esac
done

scripts/bootstrap.sh --apt-only --dev

# GCC's thread sanitizer gives up where addresses are randomised more than it knows of; leaving that
# out is not allowed in every container, and not needed in every kernel.
if setarch -R true 2>/dev/null && [[ -z ${IKSEL_FIXED_ADDRESSES-} ]]; then
  IKSEL_FIXED_ADDRESSES=1 exec setarch -R scripts/sanitize.sh
fi

build_and_test asan
build_and_test tsan
