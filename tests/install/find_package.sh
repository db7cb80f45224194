#!/bin/sh
# Installs the built project to an empty folder, builds the worked example against it as a stranger would, and holds its
# light to the closed form. Usage: find_package.sh BUILD_FOLDER
set -eu
build=$(cd "$1" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/usr" >"$work/log" || { cat "$work/log"; exit 1; }
cmake -S "$work/usr/share/doc/catoptric/example" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/usr" >"$work/log" 2>&1 ||
  { cat "$work/log"; exit 1; }
cmake --build "$work/build" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
"$work/build/mirror" | tee "$work/light"
# Paper eqs. 12 and 13 at the five samples; kernel and photon noise take at most 3 % of the reflected half.
awk '{ gsub(",", ""); square = 2500 * (NR - 0.5) / 5
       direct = 125000 / (2500 + square) ^ 1.5; reflected = 1 / (1 + square / 10000) ^ 2
       if ($2 < direct - 1e-4 || $2 > direct + 1e-4 || $4 < 0.97 * reflected || $4 > 1.03 * reflected) wrong = 1 }
     END { exit wrong || NR != 5 }' "$work/light"

# What a person installs, where people's programs look for it.
for file in bin/catoptric share/man/man1/catoptric.1 share/man/man5/catoptric-scene.5 share/catoptric/paper/start_a.toml \
  share/bash-completion/completions/catoptric share/doc/catoptric/copyright; do
  [ -s "$work/usr/$file" ] || { echo "missing: $file"; exit 1; }
done
"$work/usr/bin/catoptric" explain "$work/usr/share/catoptric/paper/start_a.toml" | grep -q "ray tubes\|tubes"
