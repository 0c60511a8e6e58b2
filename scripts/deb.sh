#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds the Debian packages of the C++ library, with their source package, into dist.
#
# Usage: scripts/deb.sh
#
# From the files that git knows. What it needs: apt-get install dpkg-dev git, and
# apt-get build-dep ./packaging
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

case ${1-} in
  '') ;;
  -h | --help) usage && exit ;;
  *) unknown_option "$1" ;;
esac

work=$root/build/deb
source=$work/iksel
rm -rf "$work"
mkdir -p "$source" dist
git ls-files --cached --others --exclude-standard -z |
  xargs -0 tar -c --ignore-failed-read | tar -x -C "$source"
mv "$source/packaging/debian" "$source/debian"
# Without packages of debugging symbols, 22 MB.
export DEB_BUILD_OPTIONS="${DEB_BUILD_OPTIONS-} noautodbgsym"
(cd "$source" && quietly "building the Debian packages" dpkg-buildpackage -us -uc)
mv "$work"/*.deb "$work"/iksel_*.dsc "$work"/iksel_*.tar.* dist/
ls -sh dist/*.deb
