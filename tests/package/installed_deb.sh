#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds C++ programs outside the checkout with the library that is installed: README's, by CMake and by
# pkg-config, and one that uses every noun.
#
# Usage: tests/package/installed_deb.sh
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cp -r "$root/tests/package" "$work"
cd "$work"
cmake -S package/find_package -B consumer -DCMAKE_BUILD_TYPE=Release
cmake --build consumer
consumer/consumer
"$root/tests/package/readme.sh" /usr
