#!/bin/sh
# The scene of brushes that is shipped: refused as it is by one line, compiled, then measured without a missed pixel.
# usage: brushes_bench.sh PORTCULLIS PILLARS
# SPDX-License-Identifier: MIT
portcullis=$1
pillars=$2
. "$(dirname "$0")/../bench/counters.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

for command in info bench render; do
  views="--views path:walk"
  [ "$command" = info ] && views=
  [ "$command" = render ] && views="$views --view 0 -o $work/picture.png"
  # shellcheck disable=SC2086 # words
  "$portcullis" $command "$pillars" $views >"$work/out" 2>&1
  is "$command of brushes, exit code" $? 2
  is "$command of brushes, lines" "$(wc -l <"$work/out" | tr -d ' ')" 1
  is "$command of brushes says what to do" "$(grep -c 'portcullis compile .*pillars.json -o SCENE.pcs' "$work/out")" 1
done

"$portcullis" compile "$pillars" -o "$work/pillars.pcs" --json >"$work/report"
is "compile, exit code" $? 0
for fact in '"zones": 3' '"zones_sealed": 0' '"portals": 2' '"leak": 0' '"t_junctions_left": 0' '"open_edges": 0' '"degenerate_triangles": 0'; do
  is "compile, $fact" "$(grep -c "^ *$fact,\$" "$work/report")" 1
done

for views in path:walk auto:12; do
  "$portcullis" bench "$work/pillars.pcs" --views "$views" --size 640x360 --repeat 1 --culler frustum --culler frustum+flood --culler scene \
    --json "$work/json" >"$work/table" 2>&1
  code=$?
  [ "$code" -ne 3 ] || skip "no OpenGL"
  is "bench $views, exit code" "$code" 0
  is "bench $views, strategies" "$(counter "$work/json" missed_pixels | wc -l | tr -d ' ')" 3
  is "bench $views, missed pixels of all" "$(same "$work/json" missed_pixels)" 0
done
finish
