#!/bin/sh
# Two rooms with a door, movers on paths: chains mixed by zone, swapped while the path runs, doors open and shut; nothing
# is missed, and what a view reaches differs as it must.
# usage: zones.sh PORTCULLIS TWO_ROOMS TEST_PLUGINS
# SPDX-License-Identifier: MIT
portcullis=$1
rooms=$2
plugins=$3
. "$(dirname "$0")/counters.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

run() { # NAME words: chains and options. The results go to $json, the exit code to $code
  json=$work/$1.json
  shift
  "$portcullis" bench "$rooms" --views path:walk --size 320x180 --repeat 2 --json "$json" "$@" >"$work/table" 2>&1
  code=$?
  [ "$code" -ne 3 ] || skip "no OpenGL"
  [ "$code" -eq 0 ] || cat "$work/table"
}

run open --culler scene --culler none --culler frustum --culler brute --swap 7 --zone 'nothing-like-it*=none'
is 'a pattern that fits no zone' "$code" 2
run open --culler scene --culler none --culler frustum --culler brute --swap 7
is 'mixed chains, exit code' "$code" 0
is 'missed pixels' "$(same "$json" missed_pixels)" 0
is 'missed items' "$(same "$json" missed_items)" 0
is 'faults' "$(same "$json" faults)" 0
is 'one truth' "$(same "$json" polygons_visible | wc -l)" 1
is 'rows, the swapped one too' "$(counter "$json" missed_pixels | wc -l)" 5
is 'its name' "$(grep -c '"name": "two_rooms/walk/swap/7"' "$json")" 1
is 'zones of the scene' "$(counter "$json" zones | head -n 1)" 2
is 'portals of the scene' "$(counter "$json" portals)" 1
true_that 'swaps happened' "$(counter "$json" swaps | tail -n 1) >= 20"
is 'and only there' "$(counter "$json" swaps | head -n 4 | sort -u)" 0
true_that 'a swap takes time' "$(counter "$json" swap_ms | tail -n 1) > 0"
true_that 'some views reach both rooms, some one' "$(counter "$json" zones | sed -n 2p) > 1 && $(counter "$json" zones | sed -n 2p) < 2"
true_that 'portals are tried' "$(counter "$json" crossings | head -n 1) > 0"
true_that 'movers are seen' "$(counter "$json" movers_visible | head -n 1) > 0"
true_that 'movers are drawn' "$(counter "$json" movers_drawn | head -n 1) >= $(counter "$json" movers_visible | head -n 1)"
true_that 'what a mover costs' "$(counter "$json" mover_update_ns | head -n 1) > 0"
is 'an index for each zone' "$(same "$json" indices_built)" 2
true_that 'none draws more than frustum' "$(counter "$json" polygons_drawn | sed -n 2p) > $(counter "$json" polygons_drawn | sed -n 3p)"
is 'brute and frustum draw the same' "$(counter "$json" polygons_drawn | sed -n 3,4p | sort -u | wc -l)" 1
is 'the scene names brute and nothing: the same again' "$(counter "$json" polygons_drawn | sed -n '1p;3p' | sort -u | wc -l)" 1
is 'columns of zones' "$(grep -c 'zones  volumes' "$work/table")" 1
open_visible=$(same "$json" polygons_visible) open_zones=$(counter "$json" zones | sed -n 4p)

run shut --culler frustum --culler none --doors shut
is 'doors shut, exit code' "$code" 0
is 'doors shut, missed pixels' "$(same "$json" missed_pixels)" 0
is 'doors shut, every view reaches the rooms its eye is in' "$(awk "BEGIN { print $(counter "$json" zones | sed -n 2p) < $open_zones }")" 1
true_that 'doors shut, less is seen' "$(same "$json" polygons_visible) < $open_visible"

run zone --culler frustum --zone 'hall=none'
is 'a zone named' "$(same "$json" missed_pixels)" 0
is 'in the name too' "$(grep -c '"name": "two_rooms/walk/frustum,hall=none"' "$json")" 1
hall=$(counter "$json" polygons_drawn)
run zone --culler frustum --zone '*all=none'
is 'a pattern' "$(counter "$json" polygons_drawn)" "$hall"
run zone --culler brute --zone '*=none' --zone 'kitchen=frustum'
is 'a name goes before a pattern' "$(counter "$json" polygons_drawn)" "$hall"
run zone --culler brute --zone 'kitchen=frustum' --zone '*=none'
is 'in either order' "$(counter "$json" polygons_drawn)" "$hall"
run named --culler 'hall=none;frustum' --culler '*all=none;frustum' --culler '*=brute;hall=none;scene' --culler frustum --culler 'kitchen=scene;none' --culler scene --culler none
is 'cullers that name zones' "$(same "$json" missed_pixels)" 0
is 'by name, by pattern, the name before the pattern' "$(counter "$json" polygons_drawn | sed -n 1,3p | sort -u)" "$hall"
true_that 'less in the other' "$(counter "$json" polygons_drawn | sed -n 4p) < $hall"
true_that 'some of the zones as the scene says' "$(counter "$json" polygons_drawn | sed -n 5p) < $(counter "$json" polygons_drawn | sed -n 7p)"
is 'their names as typed' "$(grep -c '"name": "two_rooms/walk/hall=none;frustum"' "$json")" 1
run named --culler 'hall=none;frustum' --zone 'hall=frustum' --culler frustum
is '--zone goes before what a culler names' "$(counter "$json" polygons_drawn | sort -u | wc -l)" 1
run zone --no-truth --culler frustum --zone '*=none'
is 'a library that no zone names is not opened' "$(counter "$json" plugins_opened)" 0
is 'nor a context' "$(counter "$json" gl_used)" 0

run backs --culler 'frustum[backface=1]' --culler frustum --zone 'kitchen=brute'
is 'walls from behind in one zone' "$(same "$json" missed_pixels)" 0
is 'are said' "$(counter "$json" front_walls_only | tr '\n' ' ')" '1 0 '

# Cullers that test boxes, show pictures, lay the zone out backwards, narrow volumes: one after the other in each zone.
if [ -f "$plugins/testmore.culler.so" ]; then
  for latency in 0 2; do
    PORTCULLIS_PLUGIN_PATH=$plugins run renderer --culler frustum --culler testmore --culler 'testmore[wait=1]' --culler testpicture \
      --culler testorder --culler frustum+portal --swap 5 --query-latency $latency
    is "latency $latency: exit code" "$code" 0
    is "latency $latency: missed pixels" "$(same "$json" missed_pixels)" 0
    is "latency $latency: missed items" "$(same "$json" missed_items)" 0
    is "latency $latency: faults" "$(same "$json" faults)" 0
    true_that "latency $latency: tests were asked" "$(counter "$json" queries | sed -n 2p) > 0"
    true_that "latency $latency: by the swapped one too" "$(counter "$json" queries | tail -n 1) > 0"
    true_that "latency $latency: a crosser narrows" "$(counter "$json" polygons_drawn | sed -n 6p) <= $(counter "$json" polygons_drawn | head -n 1)"
  done
else
  echo "FAILED no testmore in $plugins"
  failed=$((failed + 1))
fi

# The bench tells a graph that is wrong: without its portal the doorway is looked through all the same.
grep -v '"name": "doorway"' "$rooms" >"$work/walled.json"
"$portcullis" bench "$work/walled.json" --views path:walk --size 320x180 --repeat 1 --culler none --json "$work/walled" >"$work/table" 2>&1
is 'a missing portal, exit code' "$?" 1
true_that 'a missing portal, missed pixels' "$(same "$work/walled" missed_pixels) > 0"

# Rectangles: a crosser makes them small. What is seen stays, what stands beside a portal is cut.
PORTCULLIS_PLUGIN_PATH=$plugins
export PORTCULLIS_PLUGIN_PATH
picture() { # SCENE VIEW words
  scene=$1 view=$2
  shift 2
  "$portcullis" render "$scene" --views path:walk --view "$view" --culler frustum+portal --size 320x180 -o "$@"
}
for view in 0 20 37 59; do
  picture "$rooms" "$view" "$work/whole.png"
  picture "$rooms" "$view" "$work/cut.png" --scissor
  is "view $view: cut to rectangles, the same picture" "$(cmp "$work/whole.png" "$work/cut.png" 2>&1)" ''
done
sed '/"name": "doorway"/s/, 5\]/, 4]/g' "$rooms" >"$work/half.json" # a portal of half the doorway
picture "$work/half.json" 0 "$work/whole.png"
picture "$work/half.json" 0 "$work/cut.png" --scissor
is 'what stands beside a portal is cut' "$(cmp -s "$work/whole.png" "$work/cut.png"; echo $?)" 1
missed() { # SCENE words: what the error picture of view 0 says is missed
  scene=$1
  shift
  "$portcullis" render "$scene" --views path:walk --view 0 --mode error --culler frustum+portal --size 320x180 -o "$work/error.png" "$@" 2>&1 |
    sed -n 's/^.* \([0-9]*\) missed pixels$/\1/p'
}
is 'rectangles cut nothing that is seen' "$(missed "$rooms" --scissor)" 0
true_that 'what is cut away is missed too' "$(missed "$work/half.json" --scissor) > $(missed "$work/half.json")"
"$portcullis" render "$rooms" --views path:walk --view 20 --mode error --size 320x180 --culler frustum -o "$work/error.png" >"$work/error" 2>&1
is 'nothing missed in the error picture' "$(grep -c '^.*0 missed pixels$' "$work/error")" 1
finish
