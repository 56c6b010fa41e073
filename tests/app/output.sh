#!/bin/sh
# What the commands write: a failed write is no success, JSON is UTF-8 whatever files are called, ratios by nothing have
# no value, and movers' polygons stand apart.
# SPDX-License-Identifier: MIT
# usage: output.sh PORTCULLIS PLUGINS
portcullis=$1
plugins=$2
. "$(dirname "$0")/check.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' > good.obj
bad=$(printf 'd\377.obj')
cp good.obj "$bad"
good=$(printf 'd\303\251\342\202\254.obj')
cp good.obj "$good"
printf '9 9 9 0 0 1 0 1 0 60 1 0.1 100\n' > away.views
printf '0.3 0.3 3 0 0 -1 0 1 0 60 1 0.1 100\n' > at.views

run() { "$portcullis" "$@" 2>/dev/null </dev/null; }
to_full() { "$portcullis" "$@" 2>&1 >/dev/full </dev/null; }
if [ -w /dev/full ]; then
  for command in 'info good.obj' 'info good.obj --json' plugins 'plugins --json' --help --version 'bench good.obj --views at.views --no-truth' \
                 'bench good.obj --views at.views --no-truth --json -'; do
    # shellcheck disable=SC2086
    expect "no room for $command" 2 'error: cannot write to stdout' to_full $command
  done
else
  printf 'SKIPPED writes that fail: no /dev/full here\n' >&2
fi

bench_of() { run bench "$1" --views "$2" --culler brute --size 64x64 --repeat 1 --json - "${3:---no-truth}"; }
holds 'a name that is no UTF-8, in info' run info "$bad" --json
expect 'a name that is no UTF-8, in bench' 0 '"name": "d\?/at/brute"' bench_of "$bad" at.views
expect 'a name that is UTF-8, in bench' 0 "\"scene\": \"${good%.obj}\"" bench_of "$good" at.views
cp "$bad" "$(printf 'path\300\200.obj')"
expect 'an overlong byte pair' 0 '"scene": "path\?\?"' bench_of "$(printf 'path\300\200.obj')" at.views
cp good.obj "$(printf 'half\355\240\200.obj')"
expect 'half of a surrogate pair' 0 '"scene": "half\?\?\?"' bench_of "$(printf 'half\355\240\200.obj')" at.views
refused=$(printf 'no\377.culler.so')
printf 'no library\n' > "$refused"
expect 'a library whose name is no UTF-8' 0 '"path": "./no\?.culler.so"' run plugins --json --plugin "$refused"
odd=$(printf 'odd\377')
mkdir "$odd"
cp "$plugins/frustum.culler.so" "$odd" 2>/dev/null
in_odd_folder() { PORTCULLIS_PLUGIN_PATH="$work/$odd" run plugins --json; }
expect 'a culler in a folder that is no UTF-8' 0 'odd\?/frustum.culler.so"' in_odd_folder

"$portcullis" bench good.obj --views away.views --culler brute --size 64x64 --repeat 1 --json away.json > away.txt 2>&1
code=$?
if [ "$code" -eq 3 ]; then
  printf 'SKIPPED what needs truth: no OpenGL 4.5 on this machine\n' >&2
else
  holds 'nothing in view is no failure' test "$code" -eq 0
  holds 'excess of nothing is null' grep -q '"excess": null' away.json
  holds 'excess_items of nothing is null' grep -q '"excess_items": null' away.json
  holds 'nothing visible is 0, not null' grep -q '"polygons_visible": 0' away.json
  holds 'the table has its truth columns all the same' grep -Eq '^strategy .* visible +excess +missed px +items' away.txt
  holds 'and - for the excess' grep -Eq '^brute .* - +0 +0 *$' away.txt
  expect 'excess of something' 0 '"excess": 1,' run bench good.obj --views at.views --culler brute --size 64x64 --repeat 1 --json -
fi
holds 'no truth columns without truth' sh -c '! "$1" bench good.obj --views at.views --no-truth 2>/dev/null | grep -q excess' sh "$portcullis"
expect 'all walls' 0 '"front_walls_only": 0' bench_of good.obj at.views
"$portcullis" bench good.obj --views at.views --culler 'frustum[backface=1]' --culler frustum --no-truth --json front.json > front.txt 2>&1
holds 'walls that face the eye only' grep -q '"front_walls_only": 1' front.json
holds 'so does the table say' grep -Eq '^frustum\[backface=1\] .* front walls$' front.txt
holds 'and of the other not' grep -Eq '^frustum  .*[0-9] +$' front.txt

cube() { # a 64-unit cube, in Quake's units
  printf '{\n( 0 0 0 ) ( 0 1 0 ) ( 0 0 1 ) w 0 0 0 1 1\n( 64 0 0 ) ( 64 0 1 ) ( 64 1 0 ) w 0 0 0 1 1\n( 0 0 0 ) ( 0 0 1 ) ( 1 0 0 ) w 0 0 0 1 1\n'
  printf '( 0 64 0 ) ( 1 64 0 ) ( 0 64 1 ) w 0 0 0 1 1\n( 0 0 0 ) ( 1 0 0 ) ( 0 1 0 ) w 0 0 0 1 1\n( 0 0 64 ) ( 0 1 64 ) ( 1 0 64 ) w 0 0 0 1 1\n}\n'
}
{ printf '{\n"classname" "worldspawn"\n'; cube; printf '}\n{\n"classname" "func_door"\n'; cube; printf '}\n'; } > door.map
number() { sed -n "s/^ *\"$1\": \([0-9]*\),*$/\1/p" door.json; }
if run info door.map --json > door.json; then
  holds 'a mover' test "$(number movers)" -eq 1
  holds 'six polygons stand still' test "$(number polygons)" -eq 6
  holds 'twelve triangles stand still' test "$(number triangles)" -eq 12
  holds 'six polygons move' test "$(number mover_polygons)" -eq 6
  holds 'twelve triangles move' test "$(number mover_triangles)" -eq 12
else
  expect 'a map with a door' 0 movers "$portcullis" info door.map --json
fi
finish
