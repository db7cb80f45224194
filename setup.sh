#!/usr/bin/env bash
# Sets a Debian 12 machine up, configures and builds; safe to run again.
#   ./setup.sh          installs what is missing and builds build/catoptric
#   ./setup.sh --test   the same, then builds and runs all tests; the last line counts them
set -euo pipefail
cd "$(dirname "$0")"

build_packages=(
  g++ cmake ninja-build ccache git ca-certificates
  libocct-data-exchange-dev libfontconfig-dev libeigen3-dev libtbb-dev libfmt-dev
  libceres-dev libpagmo-dev libnlopt-dev libembree-dev libcli11-dev libtomlplusplus-dev nlohmann-json3-dev libpng-dev
  librandom123-dev libnanoflann-dev libdxflib-dev libboost-dev libkainjow-mustache-dev
  gnuplot-nox libjs-three libopenmpi-dev openmpi-bin
)
test_packages=(
  catch2 freecad-python3 clang-format-14 chromium chromium-driver python3-selenium python3-gmsh python3-ezdxf admesh
  assimp-utils dpkg-dev file
)

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

# Units of many files: half the time for all, at the cost of some more after a change, for which there is preset dev.
options=(-DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=24)
[ $run_tests = yes ] || options+=(-DCATOPTRIC_TESTS=OFF -DCATOPTRIC_SANITIZED=OFF)
[ $run_tests = no ] ||
  options+=(-DCATOPTRIC_TESTS=ON -DCATOPTRIC_SANITIZED=ON -DCATOPTRIC_WARNINGS_AS_ERRORS=ON)
cmake --preset release "${options[@]}" >/dev/null
cmake --build build
echo "setup: built $(pwd)/build/catoptric"
[ $run_tests = yes ] || exit 0

log=build/test.log
status=0
ctest --test-dir build --output-on-failure -j "$(nproc)" 2>&1 | tee "$log" || status=1
total=$(sed -n 's/.*tests failed out of \([0-9]*\).*/\1/p' "$log" | tail -1)
failed=$(sed -n 's/.*, \([0-9]*\) tests failed out of .*/\1/p' "$log" | tail -1)
if [ -z "$total" ] || [ "$total" -eq 0 ]; then
  echo "setup: no test was run" >&2
  exit 1
fi
echo "$((total - failed)) passed, $failed failed"
exit $status
