#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs IKSel into .venv if need be, and solves inverse kinematics for one pose of a UR3.
#
# Usage: scripts/demo.sh [ROBOT [OPTION...]]
#
# The arguments go to `iksel solve`, e.g. scripts/demo.sh panda --pose ...
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

case ${1-} in
  -h | --help) usage && exit ;;
esac

scripts/bootstrap.sh
if (($# == 0)); then
  # 0.3 m in front of the base and 0.2 m above it, the tool pointing down.
  set -- ur3 --pose 0.3 0.1 0.2 0 1 0 0
fi
printf '$ iksel solve %s\n' "$*"
exec "$venv/bin/iksel" solve "$@"
