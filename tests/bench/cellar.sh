#!/bin/sh
# The own cellar, eleven zones: portal culling off and on in one view, as a picture pair with the counts in it; on draws at most half
# of the polygons, nothing is missed, and the two pictures show the same.
# usage: cellar.sh PORTCULLIS CELLAR_JSON
# SPDX-License-Identifier: MIT
portcullis=$1
. "$(dirname "$0")/counters.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
off='frustum[backface=1]'
on='frustum[backface=1]+portal'

"$portcullis" compile "$2" --portals authored -o "$work/cellar.pcs" --json >"$work/compiled"
is 'compiles' $? 0
is 'zones' "$(counter "$work/compiled" zones)" 11

"$portcullis" bench "$work/cellar.pcs" --views path:views --size 320x240 --repeat 1 --culler "$off" --culler "$on" --json "$work/json" >"$work/table" 2>&1
code=$?
[ "$code" -ne 3 ] || skip 'no OpenGL'
is 'nothing is missed' "$code" 0
cat "$work/table"

"$portcullis" render "$work/cellar.pcs" --views path:views --view 1 --culler "$off" --culler "$on" --counts --size 320x240 -o "$work/pair.png" 2>"$work/counts"
is 'the picture pair' $? 0
cat "$work/counts"
polygons() { sed -n "s/.*$1: \([0-9]*\) polygons of.*/\1/p" "$work/counts"; }
many=$(polygons 'frustum\[backface=1\]')
few=$(polygons 'frustum\[backface=1\]+portal')
true_that 'with portals at most half of the polygons' "$few > 0 && 2 * $few <= $many"
for one in "$off" "$on"; do
  "$portcullis" render "$work/cellar.pcs" --views path:views --view 1 --culler "$one" --size 320x240 -o "$work/$(printf %s "$one" | wc -c).png" || is 'a picture of one' 1 0
done
cmp "$work"/[0-9]*.png
is 'both show the same' $? 0
finish
