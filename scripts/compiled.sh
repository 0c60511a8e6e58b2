#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Says how many sources ccache had compiled and how many it knew, and fails if one was compiled twice.
#
# Usage: scripts/compiled.sh LOG    (where $CCACHE_STATSLOG had ccache write)
#
# A source is the same one in whatever folder of build it was made or compiled. What CMake compiles to know
# the compiler, an src.cxx of its own, does not count.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

case ${1-} in
  '' | -h | --help) usage && exit ;;
esac
[[ -r $1 ]] || die "no log of ccache: '$1'"

awk '
  /^# / {
    source = substr($0, 3)
    own = source !~ /\/cmake[^\/]*\/Modules\/|(^|\/)src\.cxx$/
    sub(/^.*build\/[^\/]*\//, "", source)
  }
  /^cache_miss$/ && own { compiled += 1; times[source] += 1 }
  /^(direct|preprocessed)_cache_hit$/ && own { known += 1 }
  END {
    printf "%d sources compiled, %d taken from ccache\n", compiled, known
    for (source in times) if (times[source] > 1) {
      printf "compiled %d times: %s\n", times[source], source
      twice = 1
    }
    exit twice
  }' "$1"
