#!/bin/sh
# Makes the Debian packages and looks into them. With a third word the program's package is installed on a bare Debian 12
# in a folder of its own (package debootstrap, root, some minutes) and designs a mirror there.
# Usage: debian_package.sh BUILD_FOLDER [bare]
set -eu
build=$(cd "$1" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
components=program
[ -z "${2:-}" ] || components='program;development'
(cd "$build" && cpack -G DEB -B "$work" -D CPACK_COMPONENTS_ALL="$components") >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
package=$(echo "$work"/catoptric_*.deb)
dpkg-deb --field "$package" Package Version Depends
for library in libocct-data-exchange libembree libnlopt libpng libfmt libtbb; do
  dpkg-deb --field "$package" Depends | grep -q "$library" || { echo "does not depend on $library"; exit 1; }
done
dpkg-deb --contents "$package" >"$work/contents"
for file in usr/bin/catoptric usr/share/man/man1/catoptric.1 usr/share/catoptric/paper/start_a.toml; do
  grep -q "$file" "$work/contents" || { echo "lacks $file"; exit 1; }
done
! grep -q '\.a$' "$work/contents" || { echo "holds libraries"; exit 1; }
[ -n "${2:-}" ] || exit 0

root=$work/root
debootstrap --variant=minbase bookworm "$root" >"$work/log" 2>&1 || { tail -20 "$work/log"; exit 1; }
cp "$package" "$work"/libcatoptric-dev_*.deb "$root/tmp"
chroot "$root" sh -c 'apt-get install -y -q --no-install-recommends /tmp/catoptric_*.deb' >"$work/log" 2>&1 || { tail -20 "$work/log"; exit 1; }
chroot "$root" sh -c 'cd /tmp && catoptric design /usr/share/catoptric/paper/start_a.toml --out a && ls -l a && catoptric --version'
chroot "$root" sh -c 'apt-get install -y -q --no-install-recommends g++ cmake make /tmp/libcatoptric-dev_*.deb' >"$work/log" 2>&1 || { tail -20 "$work/log"; exit 1; }
chroot "$root" sh -c 'cd /tmp && cmake -S /usr/share/doc/catoptric/example -B example >/dev/null && cmake --build example && example/mirror'
echo "installed and run on a bare Debian $(cat "$root/etc/debian_version")"
