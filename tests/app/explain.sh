#!/bin/sh
# portcullis explain: what it says of items and movers in two rooms, its exit codes, and that it agrees with the truth.
# usage: explain.sh PORTCULLIS TWO_ROOMS
# SPDX-License-Identifier: MIT
portcullis=$1
rooms=$2
. "$(dirname "$0")/check.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

explain() { "$portcullis" explain "$rooms" --views path:walk "$@"; }

# The last wall is the lintel of the doorway: in both rooms. The eye of view 0 stands in the hall and looks at it.
items=$("$portcullis" info "$rooms" --json | sed -n 's/^ *"items": \([0-9]*\),*$/\1/p')
lintel=$((items - 1)) leaf=$items cart=$((items + 1)) lamp=$((items + 2)) beyond=$((items + 3))

expect 'an item in sight' 0 "^item $lintel .* is drawn in zone 'hall'" explain --item "$lintel"
expect 'why: where the eye is' 0 "eye in 'hall'" explain --item "$lintel"
expect 'its other zone, by which portal' 0 "portal 'doorway' \(door 'door' open\) -> 'kitchen'" explain --item "$lintel"
expect 'drawn once' 0 "zone 'hall' has drawn it already" explain --item "$lintel"
expect 'what dropped an item behind the eye' 0 "culler 'brute' dropped it" explain --item 0
expect 'by how much' 0 'its box lies [0-9.]+ m outside plane' explain --item 0
expect 'another culler' 0 "'frustum'.* dropped it" explain --item 0 --zone 'h*=frustum'
expect 'a culler of all zones' 0 "culler 'none' kept it" explain --item 0 --culler none
expect 'beyond a door' 0 'is drawn in zone .kitchen' explain --item 27
expect 'beyond a door that is shut' 0 "portal 'doorway' from 'hall' is shut by door 'door'" explain --item 27 --doors shut
expect 'a mover behind the items' 0 "^mover 0 'leaf' is drawn" explain --item "$leaf"
expect 'a mover elsewhere at another time' 0 "^mover 1 'cart' is drawn" explain --item "$cart" --view 55
expect 'the last mover' 0 "^mover 2 'lamp' " explain --item "$lamp"

expect 'no such item' 2 "error: --item $beyond: .*counted from 0" explain --item "$beyond"
expect 'no such view' 2 'error: --view 60: .*counted from 0' explain --item 0 --view 60
expect 'no number' 2 'number' explain --item -1
expect 'no item named' 2 'needed' explain
expect 'no such path' 2 'error: ' "$portcullis" explain "$rooms" --views path:nowhere --item 0
expect 'no such scene' 2 'error: ' "$portcullis" explain "$work/nowhere.json" --views path:walk --item 0
expect 'no such culler' 2 "no culler 'nothing'" explain --item 0 --culler nothing
expect 'no such zone' 2 'the zones of this scene are: hall, kitchen' explain --item 0 --zone 'attic=none'
expect 'help' 0 'Usage: portcullis explain' "$portcullis" explain --help

explain --item 0 --truth --size 320x180 > "$work/truth" 2>&1
if [ $? -eq 3 ]; then
  printf 'SKIPPED what needs truth: no OpenGL 4.5 on this machine\n' >&2
else
  expect 'truth of what is behind the eye' 0 '^truth: owns no pixel of 320x180$' cat "$work/truth"
  expect 'truth of what is in sight' 0 '^truth: owns [0-9]+ pixels of 320x180, by 1 polygon$' explain --item "$lintel" --truth --size 320x180
  expect 'truth of a mover where its path has it' 0 '^truth: owns [0-9]+ pixels of ' explain --item "$cart" --view 55 --truth --size 320x180
  for item in $(awk "BEGIN { for (i = 0; i < $beyond; i += 7) print i }"); do
    holds "item $item: not missed" sh -c '! "$1" explain "$2" --views path:walk --view 20 --item "$3" --truth --size 320x180 | grep missed' sh \
      "$portcullis" "$rooms" "$item"
  done
fi
finish
