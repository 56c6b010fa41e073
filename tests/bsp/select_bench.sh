#!/bin/sh
# Real maps compiled to rooms: bsp misses no pixel of the truth, draws no more than frustum, whatever its options; nor do its cells; and the
# bench tells of its tree. usage: select_bench.sh PORTCULLIS COUNTERS
# SPDX-License-Identifier: MIT
portcullis=$1
scenes=${PORTCULLIS_SCENES:-}
. "$2"
[ -d "$scenes" ] || skip "no folder of real scenes; set PORTCULLIS_SCENES"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
views=auto:10
if [ -n "${PORTCULLIS_LONG:-}" ]; then views=auto:100; fi
for name in quake/e1m1 librequake/lq_e0m8; do
  [ -f "$scenes/$name.map" ] || skip "no $name.map"
  "$portcullis" compile "$scenes/$name.map" --portals auto -o "$work/map.pcs" >"$work/table" 2>&1
  is "$name: compiled" "$?" 0
  "$portcullis" bench "$work/map.pcs" --views "$views" --size 640x360 --repeat 1 --json "$work/out.json" \
    --culler 'frustum[backface=1]' --culler 'bsp[backface=1]' --culler 'bsp[backface=1,split=node,choose=first]' \
    --culler 'frustum[backface=1]+portal' --culler 'bsp[backface=1]+portal' --culler 'bsp[backface=1,split=1,choose=sah]+portal' >"$work/table" 2>&1
  code=$?
  [ "$code" -ne 3 ] || skip "no OpenGL"
  is "$name: exit code" "$code" 0
  [ -f "$work/out.json" ] || { cat "$work/table"; continue; }
  is "$name: missed pixels" "$(same "$work/out.json" missed_pixels)" 0
  is "$name: faults" "$(same "$work/out.json" faults)" 0
  set -- $(counter "$work/out.json" polygons_drawn)
  printf '%s: frustum %s, bsp %s, frustum+portal %s, bsp+portal %s\n' "$name" "$1" "$2" "$4" "$5"
  true_that "$name: bsp draws less than frustum" "$2 < $1"
  is "$name: the tree does not matter" "$3 $6" "$2 $5"
  true_that "$name: bsp+portal draws less than frustum+portal" "$5 < $4"
  is "$name: figures of each tree" "$(grep -c '"bsp.nodes": [1-9]' "$work/out.json")" 4
  is "$name: and in the table" "$(grep -c 'built in .* bsp.nodes [1-9].* bsp.depth [1-9].* bsp.splits ' "$work/table")" 4
  rm -f "$work/out.json"
done

# MAP PORTALS VIEWS: no pixel is missed by cells, be backs drawn or not
cells_miss_nothing()
{
  [ -f "$scenes/$1.map" ] || skip "no $1.map"
  if [ -n "${PORTCULLIS_LONG:-}" ]; then set -- "$1" "$2" auto:100; fi
  "$portcullis" compile "$scenes/$1.map" --portals "$2" -o "$work/map.pcs" >"$work/table" 2>&1
  "$portcullis" bench "$work/map.pcs" --views "$3" --size 640x360 --repeat 1 --json "$work/out.json" --culler 'bsp[backface=1,cells=exact]+portal' \
    --culler 'bsp[backface=1,cells=rect]+portal' --culler 'bsp[cells=exact]+portal' --culler 'bsp[cells=rect]+portal' >"$work/table" 2>&1
  is "$1, portals $2, cells: exit code" "$?" 0
  is "$1, portals $2, cells: missed pixels" "$(same "$work/out.json" missed_pixels)" 0
  rm -f "$work/out.json"
}
cells_miss_nothing quake/e1m4 auto auto:20    # view 9: a portal's hull over a shelf of its own zone
cells_miss_nothing quake/e1m1 none auto:10    # view 0: a face buried between brushes that touch
cells_miss_nothing librequake/lqdm12 auto auto:10
finish
