#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds what a release has, wheels, sdist and Debian packages, and uses each in a bare Debian 12 of its
# own, as somebody who installs it does.
#
# Usage: scripts/packages.sh [--built] [PYTHON...]
#
#   --built  takes what is in dist rather than building it
#   PYTHON   see scripts/wheels.sh; Debian's own, 3.11, must be among them
#
# Needs root, as scripts/fresh_debian.sh does; not in .ci/run, which has no time for it.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

built=false
case ${1-} in
  --built) built=true && shift ;;
  -h | --help) usage && exit ;;
  -*) unknown_option "$1" ;;
esac

apt='export DEBIAN_FRONTEND=noninteractive; apt-get -q update && apt-get -qy --no-install-recommends'

if ! $built; then
  rm -rf dist
  scripts/wheels.sh "$@"
  scripts/fresh_debian.sh --bring dist \
    "$apt install dpkg-dev git && apt-get -qy --no-install-recommends build-dep ./packaging" \
    "git config --global --add safe.directory '*' && scripts/deb.sh"
fi

step "what is in the wheels"
build/wheels/tools/bin/python -m pytest -q -c tests/package/pytest.ini tests/package/test_wheels.py

scripts/fresh_debian.sh --carry dist \
  "$apt install python3-venv" \
  "tests/package/installed_wheel.sh" \
  "$apt install cmake g++ libeigen3-dev make" \
  "tests/package/installed_wheel.sh --cpp"
scripts/fresh_debian.sh --carry dist \
  "$apt install ./dist/*.deb" \
  "$apt install cmake g++ make pkg-config" \
  "tests/package/installed_deb.sh"
