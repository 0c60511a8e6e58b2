#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Uses a wheel of dist as somebody does who has nothing but Python: solves, runs README's Python example and
# the tests. In a folder outside the checkout; meant for a system without a compiler and without the
# libraries that IKSel is built with.
#
# Usage: tests/package/installed_wheel.sh [--cpp]
#
#   --cpp  afterwards, where there are a compiler, CMake and Eigen: C++ programs that find the library in the
#          wheel
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=${IKSEL_INSTALLED:-/var/tmp/iksel-installed}
python=$work/venv/bin/python
tag=$(python3 -c 'import sys; print("cp%d%d" % sys.version_info[:2])')

solve() {
  local found
  found=$(type -P c++ cc g++ gcc clang++ || true)
  found+=$(find /usr -name 'liborocos-kdl*' -o -name 'liburdfdom*')
  if [[ -n $found ]]; then
    printf 'no bare system, there are:\n%s\n' "$found" >&2
    exit 1
  fi
  rm -rf "$work"
  mkdir -p "$work"
  cd "$work"
  SECONDS=0
  python3 -m venv venv
  venv/bin/pip --quiet install "$root/dist/iksel"-*-"$tag"-*.whl
  "$python" -c '
import iksel
robot = iksel.load_robot("ur3")
print(iksel.Solver(robot).solve(robot.fk([0.3, -1.2, 1.5, -0.4, 0.9, 0.0])))'
  echo "from nothing to the first answer: $SECONDS s"
  ((SECONDS <= 30))
}

python_example() {
  sed -n '/^<!-- python example -->$/,/^<!-- end python example -->$/p' "$root/README.md" |
    grep -vE '^(<!--|```)' >example.py
  "$python" example.py | grep -A 1 '^q \[rad\]'
  venv/bin/iksel solve ur3 --pose 0.3 0.1 0.2 0 1 0 0 >/dev/null
  echo "README's Python example and the command line work"
}

# But for those of the benchmarks and of the order of the sources' folders.
tests() {
  venv/bin/pip --quiet install pytest hypothesis matplotlib
  mkdir copy
  cd copy
  (cd "$root" && tar -c pyproject.toml tests/data tests/python cpp/robots) | tar -x
  "$python" -m pytest -q -o pythonpath= --ignore-glob='*/test_bench*.py' \
    --ignore=tests/python/test_layers.py
}

cpp() {
  rm -rf "$work/cpp"
  mkdir -p "$work/cpp"
  cd "$work/cpp"
  cp -r "$root/tests/package" "$root/cpp/examples" .
  local folder found
  found=$("$python" -c 'import iksel; print(iksel.cmake_dir())')
  for folder in package/find_package examples; do
    cmake -S "$folder" -B "build/$folder" -DCMAKE_PREFIX_PATH="$found" -DCMAKE_BUILD_TYPE=Release
    cmake --build "build/$folder" --parallel "$(nproc)"
  done
  build/package/find_package/consumer
  "$root/tests/package/compare_examples.sh" build/examples "$python"
}

case ${1-} in
  '')
    solve
    python_example
    tests
    ;;
  --cpp) cpp ;;
  *) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' "$0" && exit 2 ;;
esac
