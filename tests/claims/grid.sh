#!/bin/sh
# 32x32 rooms with all doors open, and an open grid of 32x32 zones with no walls at all between them: no view takes 5 ms,
# merges are counted, no pixel is missed, by the flood and by a crosser that narrows.
# usage: grid.sh PORTCULLIS TEST_PLUGINS MEASURE_VIEWS
# SPDX-License-Identifier: MIT
portcullis=$1
. "$(dirname "$0")/common.sh"
export PORTCULLIS_PLUGIN_PATH="$2"
measure_views=$3
side=32
most_ms=5

# Zones of 4 m by 3 m, portals over the whole of each border, a floor, and a pillar or two in each; views from eyes anywhere.
open_grid() {
  awk -v side="$side" 'BEGIN {
    srand(5)
    print "{\"portcullis\": 1, \"zones\": ["
    for (i = 0; i < side * side; i++) {
      x = i % side * 4; z = int(i / side) * 4
      printf "{\"name\": \"z%d\", \"box\": [[%d, 0, %d], [%d, 3, %d]]}%s\n", i, x, z, x + 4, z + 4, i + 1 < side * side ? "," : "],"
    }
    print "\"portals\": ["
    for (i = 0; i < side * side; i++) {
      x = i % side * 4; z = int(i / side) * 4
      if (x + 4 < side * 4) { printf "%s{\"zones\": [\"z%d\", \"z%d\"], \"points\": [[%d, 0, %d], [%d, 0, %d], [%d, 3, %d], [%d, 3, %d]]}\n", n++ ? "," : "", i, i + 1, x + 4, z, x + 4, z + 4, x + 4, z + 4, x + 4, z }
      if (z + 4 < side * 4) { printf "%s{\"zones\": [\"z%d\", \"z%d\"], \"points\": [[%d, 0, %d], [%d, 0, %d], [%d, 3, %d], [%d, 3, %d]]}\n", n++ ? "," : "", i, i + side, x, z + 4, x + 4, z + 4, x + 4, z + 4, x, z + 4 }
    }
    print "], \"walls\": ["
    for (i = 0; i < side * side; i++) {
      x = i % side * 4; z = int(i / side) * 4
      printf "%s{\"points\": [[%d, 0, %d], [%d, 0, %d], [%d, 0, %d], [%d, 0, %d]]}\n", i ? "," : "", x, z, x, z + 4, x + 4, z + 4, x + 4, z
    }
    print "], \"boxes\": ["
    for (i = 0; i < side * side; i++) {
      x = i % side * 4 + int(rand() * 24) / 8; z = int(i / side) * 4 + int(rand() * 24) / 8
      printf "%s{\"min\": [%.3f, 0, %.3f], \"max\": [%.3f, %.3f, %.3f]}\n", i ? "," : "", x, z, x + 0.5, 0.5 + int(rand() * 16) / 8, z + 0.5
    }
    print "], \"paths\": ["
    for (p = 0; p < 2; p++) {
      printf "{\"name\": \"%s\", \"views\": [\n", p ? "tour" : "walk"
      for (v = 0; v < 500; v++) {
        a = rand() * 6.2831853
        x = p ? rand() * side * 4 : 0.5 + v * (side * 4 - 1) / 500; z = p ? rand() * side * 4 : x; if (p && v % 3 == 0) x = int(x / 4) * 4 # on a plane of portals
        if (!p) a = 0.7853982 + 0.5 * sin(v / 20)
        printf "{\"eye\": [%.4f, %.3f, %.4f], \"forward\": [%.6f, %.3f, %.6f]}%s\n", x, 0.2 + rand() * 2.6, z, cos(a), p ? rand() - 0.5 : 0, sin(a), v < 499 ? "," : "]}" (p ? "]}" : ",")
      }
    }
  }' >"$work/open$1.json"
}

value() { # LINES LINE NAME
  printf '%s\n' "$1" | sed -n "$2p" | sed "s/.* $3 \([^ ]*\).*/\1/"
}

judge() { # NAME STEP PICTURE
  for path in walk tour; do
    "$measure_views" "$work/$1.json" "$path" "$2" frustum frustum+portal >"$work/times" || { cat "$work/times"; is "$1 $path: times" 1 0; }
    cat "$work/times"
    lines=$(tail -n +2 "$work/times")
    for line in 1 2; do
      # A time is judged where nothing else runs; the short tier prints it.
      [ -z "${PORTCULLIS_LONG:-}" ] || true_that "$1 $path, strategy $line: the worst view in ms" "$(value "$lines" $line worst_ms) < $most_ms"
      is "$1 $path, strategy $line: faults" "$(value "$lines" $line faults)" 0
    done
    every "$3" "$work/$1.json" "$path"
    views=$work/$path.views
    [ "$3" -ne 1 ] || views=path:$path
    measure "$1 $path" "$work/$1.json" "$views" "$4" --culler frustum --culler frustum+portal
  done
}

generated rooms 1024
open_grid 32
if [ -n "${PORTCULLIS_LONG:-}" ]; then
  judge rooms1024 1 1 640x360
  judge open32 1 1 640x360
else
  judge rooms1024 1 25 160x90
  judge open32 10 50 160x90
fi
true_that 'in the open grid volumes merge, and it is counted' "$(value "$lines" 2 merges) > 0"
finish
