#!/bin/sh
# A program outside the tree builds against the installed library by pkg-config, and finds the installed cullers.
# SPDX-License-Identifier: MIT
# usage: installed.sh CMAKE BUILD SOURCE
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset PORTCULLIS_PLUGIN_PATH DESTDIR
"$1" --install "$2" --prefix "$work/here" >/dev/null
mv "$work/here" "$work/there"
cp "$3/api/examples/minimal_host.c" "$work/host.c"
printf 'v 0 0 -5\nv 1 0 -5\nv 0 1 -5\nf 1 2 3\n' >"$work/scene.obj"
PKG_CONFIG_PATH=$work/there/lib/pkgconfig
export PKG_CONFIG_PATH
# shellcheck disable=SC2046 # flags are words
cc -std=c11 -Wall -Wextra -Wpedantic -Werror -o "$work/host" "$work/host.c" $(pkg-config --cflags --libs portcullis)
LD_LIBRARY_PATH=$work/there/lib "$work/host" "$work/scene.obj" >"$work/out"
grep -q '^ *all  *1 items in 1 runs' "$work/out" || { cat "$work/out"; exit 1; }
[ "$(wc -l <"$3/api/examples/minimal_host.c")" -le 60 ] || { echo 'minimal_host.c is over 60 lines'; exit 1; }
if LD_LIBRARY_PATH=$work/there/lib "$work/host" "$work/none.json" 2>"$work/err"; then exit 1; fi
grep -q 'none.json.*error' "$work/err"
for header in "$3"/api/portcullis/*.h; do
    test -f "$work/there/include/portcullis/$(basename "$header")" || { echo "$header is not installed"; exit 1; }
done
echo 'the installed library serves a program outside the tree'
