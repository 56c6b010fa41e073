#!/bin/sh
# Stress: every culler holds to 1e7 m and far beyond, turned, jittered, doubled; what is too much is refused in words; a broken one is reported.
# usage: test_stress.sh PORTCULLIS TEST_PLUGINS TWO_ROOMS CELLAR
# SPDX-License-Identifier: MIT
portcullis=$1 plugins=$2 rooms=$3 cellar=$4
. "$(dirname "$0")/counters.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
stress() { # words: the exit code goes to $code
  "$portcullis" stress "$@" --json "$work/json" --svg "$work/svg" >"$work/table" 2>"$work/errors"
  code=$?
  [ "$code" -ne 3 ] || skip 'no OpenGL'
  [ "$code" -eq 0 ] || sed 's/^/# /' "$work/table"
}
row() { # FAMILY COLUMN: of all strategies, different values alone
  awk -v family="$1" -v column="$2" '$1 == family && NF > 5 { print $column }' "$work/table" | sort -u
}

families='--family move --family move-odd
  --family turn --family jitter --family near --family far --family narrow --family wide --family copies --family tiny --family eye'
"$portcullis" compile "$cellar" --portals auto -o "$work/cellar.pcs" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
# shellcheck disable=SC2086
stress "$work/cellar.pcs" --views auto:3 --size 160x90 $families --culler 'frustum[backface=1]+portal' --culler 'bsp[backface=1,cells=exact]+portal' \
  --culler 'octree+portal+occlusion[method=hiz]'
is 'rooms hold' "$code" 0
for family in move move-odd; do
  is "rooms: $family holds to 9e8 m" "$(row $family 3)" 9e+08
  is "rooms: $family reaches the same zones" "$(row $family 7)" -
done
is 'rooms: 2e9 m is refused' "$(grep -c '2e+09 refused: ' "$work/table")" 6
is 'pictures are the same, moved' "$(row move 5)" -
is 'the plot has a panel a family' "$(grep -c '<rect x=.*stroke="black"' "$work/svg")" 11
is 'and shows what was refused' "$(grep -c 'class="refused"' "$work/svg" | awk '{ print ($1 > 0) }')" 1
"${PYTHON:-python3}" -c 'import json, sys; json.load(open(sys.argv[1]))' "$work/json" 2>"$work/log" || is 'JSON reads back' "$(cat "$work/log")" ''

"$portcullis" generate city -n 300 -o "$work/city.boxes" >"$work/log" 2>&1 || exit 1
stress "$work/city.boxes" --views auto:3 --size 160x90 --family move --family turn --family shrink --family copies \
  --culler octree --culler 'octree+occlusion[method=hiz]'
is 'a city holds, turned too' "$code" 0
is 'a city: a ten-thousandth of its size' "$(row shrink 3)" 0.0001

stress "$work/city.boxes" --views auto:3 --size 160x90 --family eye --plugin "$plugins/testnothing.culler.so" --culler testnothing
is 'a broken culler' "$code" 1
stress "$rooms" --family nothing
is 'a family that is not there' "$code" 2
finish
