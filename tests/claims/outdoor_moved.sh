#!/bin/sh
# A city and a terrain a million metres from the origin, a thousandth to a thousand times as large, looked at with near and far planes
# 0.01 and 1e6, 1 and infinity, and fields of view of 1 to 170 degrees: nothing missed under octree, alone and with occlusion.
# A thousand times as large is a model of the city at 1:100: a zone holds 32,768 m.
# usage: outdoor_moved.sh PORTCULLIS TEST_PLUGINS
# SPDX-License-Identifier: MIT
portcullis=$1
. "$(dirname "$0")/common.sh"
export PORTCULLIS_PLUGIN_PATH="$2"
boxes=2000 cells=1024 count=8 size=320x180
[ -z "${PORTCULLIS_LONG:-}" ] || { boxes=10000 cells=4096 count=100 size=640x360; }
cullers='--culler octree[kind=oct] --culler octree[kind=quad] --culler octree+occlusion --culler octree+occlusion[method=wait] --culler octree+occlusion[method=chc] --culler octree+occlusion[method=hiz]'

"$portcullis" generate city --size "$boxes" -o "$work/city.boxes" || exit 1
"$portcullis" generate terrain --size "$cells" -o "$work/terrain.obj" || exit 1

looks() { # HEIGHT SCALE OFFSET FOV NEAR FAR: eyes along a street of the city, turned a little more each
  awk -v n="$count" -v height="$1" -v scale="$2" -v off="$3" -v fov="$4" -v near="$5" -v far="$6" 'BEGIN {
    for (i = 0; i < n; i++) {
      z = -150 + 300 * i / n; turn = 2.39996 * i; down = i % 3 == 2 ? -0.3 : -0.02
      printf "%.9f %.9f %.9f %.9f %.9f %.9f 0 1 0 %s 1.7777777777777777 %s %s\n", 0 * scale + off, (i % 4 == 3 ? 20 * height : height) * scale, z * scale - off,
        sin(turn), down, cos(turn), fov, near, far
    }
  }'
}

scaled() { # SCALE: the city's boxes
  awk -v s="$1" 'NR == 1 { print; next } { printf "%.9g %.9g %.9g %.9g %.9g %.9g\n", $1 * s, $2 * s, $3 * s, $4 * s, $5 * s, $6 * s }' "$work/city.boxes"
}

moved() { # FILE OFFSET: as a scene there
  printf '{"portcullis": 1, "include": [{"file": "%s", "at": [%s, 0, -%s]}]}\n' "$1" "$2" "$2"
}

look() { # NAME SCENE words of looks
  name=$1 scene=$2
  shift 2
  looks "$@" >"$work/looks.views"
  # shellcheck disable=SC2086
  measure "$name" "$work/$scene" "$work/looks.views" "$size" $cullers
}

for fov in 1 60 170; do
  look "city, $fov degrees, 0.01 to 1e6" city.boxes 1.7 1 0 "$fov" 0.01 1000000
  look "city, $fov degrees, 1 to infinity" city.boxes 1.7 1 0 "$fov" 1 inf
done
for scale in 0.001 0.01 10; do # 0.01: the model; 10: it a thousand times as large
  scaled "$scale" >"$work/scaled.boxes"
  near=$(awk -v s="$scale" 'BEGIN { print 0.1 * s }')
  look "city at $scale" scaled.boxes 1.7 "$scale" 0 60 "$near" inf
done
moved city.boxes 1000000 >"$work/far.json"
for fov in 1 60 170; do look "city at 1e6 m, $fov degrees" far.json 1.7 1 1000000 "$fov" 0.01 1000000; done
moved terrain.obj 1000000 >"$work/far.json"
look "terrain at 1e6 m" far.json 400 1 1000000 60 1 inf
look "terrain" terrain.obj 400 1 0 170 0.01 1000000
finish
