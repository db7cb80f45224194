#!/usr/bin/env bash
# A disk that fills while a search runs, and one that is too small from the beginning, on a RAM disk of its own.
#   tests/cli/full_disk.sh [PROGRAM]      needs a kernel that lets users mount (unshare -rm)
set -euo pipefail
cd "$(dirname "$0")/../.."
program=$(realpath "${1:-build/catoptric}")
scene=$PWD/data/paper/start_a.toml
export program scene
exec unshare -rm bash -c '
set -u
fail() { echo "FAILED: $1"; exit 1; }
disk=$(mktemp -d)
trap "umount \"$disk\"; rmdir \"$disk\"" EXIT
mount -t tmpfs -o size=20M none "$disk"
search=("$program" design "$scene" --quiet --set model.rung=photons --set model.photons=400000)
"${search[@]}" --out "$disk/a" & running=$!
while [ ! -e "$disk/a/checkpoint.json" ]; do sleep 0.02; done
dd if=/dev/zero of="$disk/filled" bs=1M 2>/dev/null
wait $running
[ $? -eq 6 ] || fail "a disk that fills must end with 6"
[ "$(ls -A "$disk/a")" = checkpoint.json ] || fail "something but the checkpoint was left"
grep -q "\"answers\":\[\[.*\]\]}$" "$disk/a/checkpoint.json" || fail "the checkpoint is not whole"
rm "$disk/filled"
"${search[@]}" --out "$disk/a" --resume || fail "the search does not go on"
"${search[@]}" --out "$disk/b" || fail "the search from the beginning"
cmp "$disk/a/reflector.step" "$disk/b/reflector.step" || fail "resumed, it is another mirror"
mount -t tmpfs -o size=2M none "$disk"
"${search[@]}" --out "$disk/a"
[ $? -eq 6 ] || fail "a disk without room must be found before the search"
umount "$disk"
echo "a disk that fills, and one without room: passed"
'
