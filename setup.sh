#!/usr/bin/env bash
# Sets a Debian 12 machine up, configures and builds; safe to run again.
#   ./setup.sh          installs what is missing and builds build/catoptric
#   ./setup.sh --test   the same, then builds and runs all tests, also under sanitizers; the last line counts them
set -euo pipefail
cd "$(dirname "$0")"

build_packages=(
  g++ cmake ninja-build ccache git ca-certificates
  libocct-data-exchange-dev libfontconfig-dev libeigen3-dev libtbb-dev libfmt-dev
  libceres-dev libpagmo-dev libnlopt-dev libembree-dev libcli11-dev libtomlplusplus-dev nlohmann-json3-dev
  librandom123-dev libboost-dev libkainjow-mustache-dev
  gnuplot-nox
)
test_packages=(catch2 freecad-python3 clang-format-14)

usage() {
  sed -n '2,4s/^# \{0,1\}//p' "$0"
  exit 2
}

run_tests=no
case "${1:-}" in
  "") ;;
  --test) run_tests=yes ;;
  *) usage ;;
esac

install_missing() {
  local missing=()
  for package in "$@"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  if ! command -v apt-get >/dev/null; then
    echo "setup: these Debian packages are missing: ${missing[*]}. Install their like by hand." >&2
    exit 1
  fi
  local root=()
  [ "$(id -u)" -eq 0 ] || root=(sudo)
  echo "setup: installing ${missing[*]}"
  "${root[@]}" apt-get update -q
  DEBIAN_FRONTEND=noninteractive "${root[@]}" apt-get install -y -q --no-install-recommends "${missing[@]}"
}

install_missing "${build_packages[@]}"
[ $run_tests = no ] || install_missing "${test_packages[@]}"

options=(-DCATOPTRIC_TESTS=OFF)
[ $run_tests = no ] || options=(-DCATOPTRIC_TESTS=ON -DCATOPTRIC_WARNINGS_AS_ERRORS=ON)
cmake --preset release "${options[@]}" >/dev/null
cmake --build build
echo "setup: built $(pwd)/build/catoptric"
[ $run_tests = yes ] || exit 0

passed=0
failed=0

# Runs the tests of a build folder and adds to the counts. A run that ends without a count is a failure of its own.
run_tests_of() {
  local log=$1/test.log total bad
  ctest --test-dir "$1" --output-on-failure -j "$(nproc)" 2>&1 | tee "$log" || true
  total=$(sed -n 's/.*tests failed out of \([0-9]*\).*/\1/p' "$log" | tail -1)
  bad=$(sed -n 's/.*, \([0-9]*\) tests failed out of .*/\1/p' "$log" | tail -1)
  if [ -z "$total" ] || [ "$total" -eq 0 ]; then
    echo "setup: no test was run in $1" >&2
    total=1 bad=1
  fi
  passed=$((passed + total - bad))
  failed=$((failed + bad))
}

run_tests_of build
# The whole suite again under asan and ubsan, with floating-point traps; sim and optim under tsan. Here each test
# program is one process and counts as one test (tests/README.md).
export CCACHE_SLOPPINESS=pch_defines,time_macros  # or ccache stores nothing that has a precompiled header
for preset in asan tsan; do
  cmake --preset $preset >/dev/null
  cmake --build --preset $preset
  run_tests_of build-$preset
done
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
