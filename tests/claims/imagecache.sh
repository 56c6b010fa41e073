#!/bin/sh
# What Part 6 claims of pictures, by counts: behind occlusion what is hidden is neither taken nor shown, and no pixel is missed; movers stand before and behind
# pictures as they do in geometry; memory stays under its cap. In a city with movers.
# SPDX-License-Identifier: MIT
# usage: imagecache.sh PORTCULLIS
portcullis=$1
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
failed=0
frames=24
[ -z "$PORTCULLIS_LONG" ] || frames=150

"$portcullis" generate city -n 20000 -o "$work/city.boxes" || exit 1
awk 'BEGIN {
  srand(3)
  print "{\"portcullis\": 1, \"include\": [{\"file\": \"city.boxes\"}], \"movers\": ["
  for (i = 0; i < 1500; i++) {
    x = rand() * 2000 - 1000; y = rand() * 12 + 0.1; z = rand() * 2000 - 1000; s = 0.8 + rand() * 3
    printf "%s{\"name\": \"m%d\", \"box\": {\"min\": [%.3f, %.3f, %.3f], \"max\": [%.3f, %.3f, %.3f]}, \"loop\": true, \"path\": [{\"time\": 0}, ", i ? "," : "", i, x, y, z, x + s, y + s, z + s / 2
    printf "{\"time\": 3, \"at\": [%.3f, %.3f, %.3f]}, {\"time\": 6, \"at\": [0, 0, 0]}]}\n", rand() * 60 - 30, rand() * 4, rand() * 60 - 30
  }
  print "]}"
}' >"$work/scene.json"

# measure VIEWS CHAIN...: rows of the table below in $work/rows, one a chain: chain, missed pixels, refreshes, picture bytes, mover pixels, wrong ones.
measure() {
  views=$1
  shift
  for chain; do set -- "$@" --culler "$chain"; shift; done
  "$portcullis" bench "$work/scene.json" --views "$views" --size 640x360 --repeat 1 --csv "$work/out.csv" "$@" >"$work/table" 2>&1
  code=$?
  [ "$code" -ne 3 ] || { echo "SKIPPED: no OpenGL"; exit 77; }
  [ "$code" -eq 0 ] || { cat "$work/table"; failed=$((failed + 1)); }
  awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) column[$i] = i; next }
    { n = $column["name"]; gsub(/"/, "", n); sub(/.*\//, "", n)
      print n, $column["missed_pixels"], $column["refreshes"], $column["picture_bytes"], $column["mover_pixels"], $column["mover_pixels_wrong"] }' "$work/out.csv" >"$work/rows"
  cat "$work/rows"
}

# claim WORDS AWK: over the rows, where `bad` has to stay 0 and `rows` are counted.
claim() {
  if awk "BEGIN { bad = 0 } { rows++ } $2 END { exit rows == 0 || bad }" "$work/rows"; then echo "holds: $1"; else
    echo "FAILED: $1"
    failed=$((failed + 1))
  fi
}

measure auto:street:$frames 'imagecache[hidden=shown]' imagecache+occlusion 'imagecache+occlusion[method=hiz]' 'imagecache+occlusion[method=chc]' 'imagecache+occlusion[method=wait]'
claim "no pixel is missed" '{ bad += $2 > 0 }'
claim "occlusion leaves out two thirds of the captures and more" 'NR == 1 { all = $3 } NR > 1 { bad += $3 > all / 3 }'

measure auto:roofs:$frames imagecache imagecache+occlusion 'imagecache[memory_mib=1]' 'imagecache[memory_mib=1]+occlusion'
claim "no pixel is missed over the roofs" '{ bad += $2 > 0 }'
claim "movers stand as in geometry in 99.9% of their pixels, which are many" '{ bad += $5 < 10000 || $6 > 0.001 * $5 }'
claim "pictures never take more than their cap" 'NR > 2 { bad += $4 > 1048576 || $4 == 0 }'
[ "$failed" -eq 0 ]
