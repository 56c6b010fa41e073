#!/bin/sh
# What automatic rooms are worth: on e1m1 at most 0.6 of what the frustum draws is drawn through portals; and on every map little is drawn that
# is not seen, with no more portals than the default. PORTCULLIS_LONG: all maps, the views of the claims; else two maps in small pictures.
# usage: rooms_bench.sh PORTCULLIS
# SPDX-License-Identifier: MIT
portcullis=$1
. "$(dirname "$0")/../bench/counters.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
scenes=${PORTCULLIS_SCENES:-}
[ -f "$scenes/quake/e1m1.map" ] || skip "no maps in PORTCULLIS_SCENES"
json=$work/results
views=100 size=640x360 maps='quake/dm4 quake/e1m1'
[ -z "${PORTCULLIS_LONG:-}" ] || views=200 size=1280x720 maps='quake/dm4 quake/e1m1 quake/e1m4 quake/e3m5 librequake/lqdm12 librequake/lq_e0m8 librequake/lqdm7 librequake/lq_e3m4'

# run SCENE words: chains and options
run() {
  scene=$1
  shift
  rm -f "$json"
  "$portcullis" bench "$scene" --views "auto:$views" --repeat 1 --json "$json" "$@" >"$work/table" 2>&1
  [ $? -ne 3 ] || skip "no OpenGL"
}

for portals in none auto; do
  "$portcullis" compile "$scenes/quake/e1m1.map" --portals $portals -o "$work/$portals.pcs" >"$work/table" 2>&1 || exit 1
done
run "$work/none.pcs" --no-truth --culler 'frustum[backface=1]'
plain=$(counter "$json" polygons_drawn)
run "$work/auto.pcs" --no-truth --culler 'frustum[backface=1]+portal'
parted=$(counter "$json" polygons_drawn)
printf 'e1m1: %s polygons a view without portals, %s through them\n' "$plain" "$parted"
true_that 'e1m1: what is drawn through portals, to what is drawn without' "$parted <= 0.6 * $plain"

for map in $maps; do
  "$portcullis" compile "$scenes/$map.map" --portals auto -o "$work/rooms.pcs" >"$work/table" 2>&1 || exit 1
  portals=$(awk '$1 == "portals" { print $2 }' "$work/table")
  true_that "$map: portals, those of doors too" "$portals <= 100"
  run "$work/rooms.pcs" --size $size --culler 'frustum[backface=1]' --culler 'frustum[backface=1]+portal'
  # lq_e3m4 is three times the size of the others: 100 portals are too few for it, and this is what they reach.
  most=1.75
  [ "$map" != librequake/lq_e3m4 ] || most=2.5
  excess=$(counter "$json" excess | tail -n 1)
  printf '%s: excess %s\n' "$map" "$excess"
  true_that "$map: excess" "$excess <= $most"
  true_that "$map: less than the frustum's" "$excess < $(counter "$json" excess | head -n 1)"
done
finish
