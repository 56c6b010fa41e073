#!/bin/sh
# Two rooms 1 km, 100 km and 10,000 km from the origin, and the flagship there: the same zones and sets, pictures equal in
# 99.99% of pixels, nothing missed. usage: zones_far.sh PORTCULLIS COMPARE TWO_ROOMS
# SPDX-License-Identifier: MIT
portcullis=$1
compare=$2
rooms=$3
. "$(dirname "$0")/counters.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cp "$rooms" "$work/rooms.json"

measure() { # FILE PATH words: chains
  json=$work/$(basename "$1" .json).results
  file=$1 views=path:$2
  shift 2
  "$portcullis" bench "$file" --views "$views" --size 320x180 --repeat 1 --json "$json" "$@" >"$work/table" 2>&1
  code=$?
  [ "$code" -ne 3 ] || skip "no OpenGL"
  [ "$code" -eq 0 ] || cat "$work/table"
}

all() { # what must be the same wherever the scene lies, on one line
  for name in zones volumes crossings items_drawn polygons_drawn movers_drawn; do counter "$json" "$name"; done | tr '\n' ' '
}

move() { # SCENE PATH METRES words: chains
  scene=$1 path=$2 metres=$3
  shift 3
  far=$work/far$metres.json
  printf '{"portcullis": 1, "include": [{"file": "%s", "at": [%s, 0, -%s]}]}\n' "$scene" "$metres" "$metres" >"$far"
  measure "$far" "$path" "$@"
  is "$scene, $metres m: exit code" "$code" 0
  is "$scene, $metres m: missed pixels" "$(same "$json" missed_pixels)" 0
  is "$scene, $metres m: faults" "$(same "$json" faults)" 0
  is "$scene, $metres m: the same zones, volumes and sets" "$(all)" "$home"
  "$compare" "$work/$scene" "$far" "$metres" 0 "-$metres" "path:$path" >"$work/table"
  is "$scene, $metres m: id pictures" "$?" 0
  cat "$work/table"
}

measure "$work/rooms.json" walk --culler frustum --culler none --swap 10
is 'rooms.json at home: exit code' "$code" 0
home=$(all)
true_that 'at home something is drawn' "$(counter "$json" items_drawn | head -n 1) > 0"
for metres in 1000 100000 10000000; do move rooms.json walk "$metres" --culler frustum --culler none --swap 10; done

"$portcullis" generate flagship -o "$work/flagship.json" || exit 1
measure "$work/flagship.json" tour --culler frustum --no-truth
is 'flagship.json at home: exit code' "$code" 0
home=$(all)
move flagship.json tour 10000000 --culler frustum
finish
