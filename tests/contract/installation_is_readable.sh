#!/bin/sh
# installation_is_readable.sh CMAKE BUILD: installs a build as someone who shares nothing (umask 077) would, and names
# what other users cannot read there.
set -eu
prefix=$(pwd)/installed
rm -rf "$prefix"
trap 'rm -rf "$prefix"' EXIT
umask 077
mkdir "$prefix"
chmod 755 "$prefix"
"$1" --install "$2" --prefix "$prefix/new/place" >/dev/null
test -x "$prefix/new/place/bin/roadfix"
unreadable=$(find "$prefix" ! -perm -o=r -o -type d ! -perm -o=x)
test -z "$unreadable" || { echo "$unreadable"; exit 1; }
