#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Solves 3,000 reachable poses of every chain in URDF, xacro and MJCF files of 14 packages of PyPI.
#
# Usage: scripts/chain_files.sh
#
# The packages of tests/python/chain_packages.txt, 450 MB, are downloaded to build/chain_files, or
# $IKSEL_CHAIN_FILES, unless they are there; they are read, not installed. What is found, what is
# lost and with which proof, and each refusal, is in report.txt there. $IKSEL_TEST_SEED sets the
# seed, $IKSEL_TEST_CASES the number of poses.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

case ${1:-} in
  '') ;;
  -h | --help) usage && exit ;;
  *) unknown_option "$1" ;;
esac

export IKSEL_CHAIN_FILES=${IKSEL_CHAIN_FILES:-$root/build/chain_files}
mkdir -p "$IKSEL_CHAIN_FILES"

scripts/bootstrap.sh --dev
# The same files on every machine: those of one platform, whatever this one is.
quietly "downloading the packages with robots' files" "$python" -m pip download --no-deps \
  --python-version 3.11 --platform manylinux_2_28_x86_64 --platform manylinux2014_x86_64 \
  --dest "$IKSEL_CHAIN_FILES" --requirement tests/python/chain_packages.txt

step "pytest"
IKSEL_TEST_CASES=${IKSEL_TEST_CASES:-3000} "$python" -m pytest -m urdf_files \
  tests/python/test_chain_files.py
grep -v '^ ' "$IKSEL_CHAIN_FILES/report.txt"
echo "each chain that loses, and each refusal: $IKSEL_CHAIN_FILES/report.txt"
