#!/bin/sh
# Who is to blame for a miss: walls are left out of the truth only where every zone that lists them rejects back faces, and
# a zone that promises nothing excuses no other, nor does one turn of a swap another.
# usage: blame.sh PORTCULLIS BACKS TEST_PLUGINS
# SPDX-License-Identifier: MIT
portcullis=$1
scene=$2
PORTCULLIS_PLUGIN_PATH=$3
export PORTCULLIS_PLUGIN_PATH
. "$(dirname "$0")/counters.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
json=$work/json

run() { # words: chains and options. The exit code goes to $code
  rm -f "$json"
  "$portcullis" bench "$scene" --views path:look --size 160x90 --repeat 1 --json "$json" "$@" >"$work/table" 2>&1
  code=$?
  [ "$code" -ne 3 ] || skip "no OpenGL"
}
blamed() { # NAME EXIT_CODE VIEWS_BLAMED
  is "$1: exit code" "$code" "$2"
  is "$1: promises broken" "$(counter "$json" broken_items | tail -n 1)" "$3"
  [ "$code" = "$2" ] || cat "$work/table"
}

run --culler frustum
blamed 'the scene is healthy' 0 0
is 'both walls are seen' "$(counter "$json" items_visible)" 2
run --culler 'frustum[backface=1]'
blamed 'backs rejected everywhere' 0 0
is 'the wall behind is left out' "$(counter "$json" items_visible)" 1
run --culler 'frustum[backface=1]' --zone far=testnothing
blamed 'backs rejected in another zone only' 1 4
true_that 'its pixels are missed' "$(counter "$json" missed_pixels) > 0"
is 'the row is marked' "$(counter "$json" front_walls_only)" 1
run --culler frustum --zone 'far=testnothing[backface=1]'
blamed 'backs rejected where the wall stands' 0 0
is 'and seen by the front alone' "$(counter "$json" items_visible)" 1

run --culler 'testnothing[promise=0]'
blamed 'nothing promised' 0 0
is 'all the same missed' "$(counter "$json" missed_items)" 8
run --culler 'testnothing[promise=0]' --zone far=testnothing
blamed 'the other zone had promised' 1 4
run --culler testnothing --zone 'far=testnothing[promise=0]'
blamed 'the one had promised' 1 4
run --culler 'testnothing[promise=0]' --culler testnothing --swap 2
blamed 'promises go with the turn' 1 4
is 'of those alone the second alone' "$(counter "$json" broken_items | tr '\n' ' ')" '0 8 4 '
run --ids --culler frustum
blamed 'ids are written' 0 0
finish
