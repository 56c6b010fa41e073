#!/bin/sh
# Chains that are chosen miss nothing where they were measured, are written where the scene keeps them, and stand nowhere that one broken could.
# usage: test_auto.sh PORTCULLIS TEST_PLUGINS
# SPDX-License-Identifier: MIT
portcullis=$1 plugins=$2
. "$(dirname "$0")/counters.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
choose() { # words: the exit code goes to $code
  "$portcullis" auto "$@" --size 160x90 --repeat 1 --budget 20 >out 2>errors
  code=$?
  [ "$code" -ne 3 ] || skip 'no OpenGL'
}
benches() { # NAME SCENE VIEWS: what was written misses nothing
  "$portcullis" bench "$2" --views "$3" --size 160x90 --repeat 1 --culler scene --json json >table 2>&1
  is "$1: bench" "$?" 0
  is "$1: missed pixels" "$(counter json missed_pixels)" 0
}

"$portcullis" generate rooms --size 4 -o rooms.json >log 2>&1 || { cat log; exit 1; }
choose rooms.json --views auto:4 --zones 2 -o chosen.json
is 'rooms' "$code" 0
benches 'rooms' chosen.json auto:4
is 'rooms: a chain at every zone' "$(grep -c '"chain"' chosen.json)" "$("$portcullis" info rooms.json --json | sed -n 's/.*"zones": \([0-9]*\).*/\1/p')"
is 'rooms: it says why' "$(grep -c '^zone .* why$' out)" 1
choose rooms.json --views auto:4 --zones 1 --candidate octree -o chosen.pcs
is 'rooms, one candidate' "$code" 0
is 'no other is exact' "$(grep -c 'no other is exact' out)" 3
benches 'rooms, as a scene file' chosen.pcs auto:4

"$portcullis" generate city -n 300 -o city.boxes >log 2>&1 || exit 1
choose city.boxes --views auto:4 -o city.json
is 'a city' "$code" 0
is 'a city has one zone' "$(grep -c '"chain"' city.json)" 1
benches 'a city' city.json auto:4

choose city.boxes --views auto:4 --plugin "$plugins/testnothing.culler.so" --candidate testnothing --candidate none -o city.json
is 'a broken candidate' "$code" 0
is 'it is told' "$(grep -c '^testnothing .* not taken: misses what is seen' out)" 1
is 'and not chosen' "$(sed -n 's/.*"chain": "\(.*\)".*/\1/p' city.json)" none
choose city.boxes --views auto:4 --plugin "$plugins/testnothing.culler.so" --candidate testnothing -o nothing.json
is 'none is left' "$code" 2
is 'and nothing is written' "$(ls nothing.json 2>/dev/null)" ''

mkdir elsewhere
printf '{"portcullis": 1, "include": [{"file": "rooms.json", "name": "r"}]}' >outer.json
choose outer.json --views auto:4 -o outer_chosen.json
is 'zones of an include' "$code" 2
choose chosen.pcs --views auto:4 -o chosen2.json
is 'a scene file to JSON' "$code" 2
choose outer.json --views auto:4 -o elsewhere/out.json
is 'files by their place' "$code" 2
choose city.boxes --views auto:4 -o elsewhere/city.json --candidate frustum
benches 'geometry from elsewhere' elsewhere/city.json auto:4
finish
