#!/bin/sh
# Every real scene: none, brute and frustum miss no pixel and see the same truth. The long tier takes 100 views at
# 1280x720, the short one a few small ones. usage: real_scenes.sh PORTCULLIS
# SPDX-License-Identifier: MIT
portcullis=$1
scenes=${PORTCULLIS_SCENES:-}
. "$(dirname "$0")/counters.sh"
[ -d "$scenes" ] || skip "no folder of real scenes; set PORTCULLIS_SCENES"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
views=auto:8 size=320x180
if [ -n "${PORTCULLIS_LONG:-}" ]; then views=auto:100 size=1280x720; fi
for scene in "$scenes"/quake/*.map "$scenes"/librequake/*.map "$scenes"/city/*.obj "$scenes"/models/*.obj "$scenes"/boxes/*.boxes; do
  [ -f "$scene" ] || continue
  name=$(basename "$scene")
  "$portcullis" bench "$scene" --views "$views" --size "$size" --repeat 1 --culler none --culler brute --culler frustum \
    --culler 'frustum[isa=plain]' --json "$work/out.json" >"$work/table" 2>&1
  code=$?
  [ "$code" -ne 3 ] || skip "no OpenGL"
  is "$name: exit code" "$code" 0
  [ -f "$work/out.json" ] || { cat "$work/table"; continue; }
  is "$name: missed pixels" "$(same "$work/out.json" missed_pixels)" 0
  is "$name: missed items" "$(same "$work/out.json" missed_items)" 0
  is "$name: faults" "$(same "$work/out.json" faults)" 0
  is "$name: one polygons_visible" "$(same "$work/out.json" polygons_visible | wc -l)" 1
  is "$name: brute and frustum draw the same" "$(counter "$work/out.json" polygons_drawn | tail -n 3 | sort -u | wc -l)" 1
  visible=$(same "$work/out.json" polygons_visible)
  printf '%s %s %s %s visible, frustum draws %s\n' "$name" "$views" "$size" "$visible" "$(counter "$work/out.json" polygons_drawn | tail -n 1)"
  true_that "$name: something is seen" "${visible:-0} > 0"
  rm -f "$work/out.json"
  "$portcullis" bench "$scene" --views "$views" --size "$size" --repeat 1 --culler 'frustum[backface=1]' --json "$work/out.json" >"$work/table" 2>&1
  is "$name: exit code without backs" "$?" 0
  is "$name: missed pixels without backs" "$(same "$work/out.json" missed_pixels)" 0
  rm -f "$work/out.json"
done
finish
