#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds the documentation into build/docs/html, and checks its links.
#
# Usage: scripts/docs.sh [--external]
#
#   --external  also ask for every page outside, which needs the network
#
# Warnings are errors, and so is a notebook that fails. Without --external the links between the pages,
# their anchors, pictures and files are checked.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

external=false
for option in "$@"; do
  case $option in
    --external) external=true ;;
    -h | --help) usage && exit ;;
    *) unknown_option "$option" ;;
  esac
done

scripts/bootstrap.sh --docs

mkdir -p build/docs/doxygen
quietly "reading the C++ headers" doxygen docs/Doxyfile

sphinx=("$python" -m sphinx -W --keep-going -n -j "$CMAKE_BUILD_PARALLEL_LEVEL")
quietly "running the notebooks, making the pages" "${sphinx[@]}" -b html docs build/docs/html

step "links"
"$python" scripts/check_links.py build/docs/html
if $external; then "${sphinx[@]}" -b linkcheck docs build/docs/linkcheck; fi
echo "build/docs/html/index.html"
