#!/bin/sh
# Outdoors: what each method of occlusion misses, draws too much and costs, held to what Part 5 asks. A line a check, PASS or FAIL
# with its figure. The long tier takes 100 views of each path at 1280x720 and cities of up to 100,000 boxes; the short tier a few views
# of the small scenes at 320x180, and judges what is missed alone. Figures are kept in bench/results/outdoor.txt.
# usage: outdoor.sh PORTCULLIS [SCENE...]; scenes: city terrain delft flagship maps cheap last
# SPDX-License-Identifier: MIT
portcullis=$1
shift
. "$(dirname "$0")/common.sh"
scenes=${PORTCULLIS_SCENES:-}
paths=$(dirname "$0")/../../bench/paths
few=8 size=320x180 cities=1000 tiles=256
[ -z "${PORTCULLIS_LONG:-}" ] || few=100 size=1280x720 cities='1000 10000 100000' tiles=1024
methods='wait twophase chc hiz' # held to 0 missed pixels on every scene; each joins by one word
[ $# -gt 0 ] || set -- city terrain delft flagship maps cheap last

# held NAME VALUE COMPARED LIMIT: a figure that the long tier alone judges.
held() { [ -z "${PORTCULLIS_LONG:-}" ] || check "$@"; }

figure() { counter "$file" "$2" | sed -n "$(printf '%s\n' $rows | grep -nxF "$1" | cut -d: -f1)p"; } # ROW COUNTER

ratio() { awk -v a="$1" -v b="$2" 'BEGIN { printf "%.3f", (b > 0 ? a / b : 0) }'; } # A B

# few_of NAME: the first views of a path that is kept, as many as the tier takes.
few_of() {
  head -n "$few" "$paths/$1.views" >"$work/$1.views"
  printf '%s' "$work/$1.views"
}

# run NAME SCENE VIEWS SELECT [METHOD...]: SELECT alone, then with each method over it. What is missed is checked.
run() {
  name=$1 scene=$2 views=$3 select=$4 rows=none file=$work/results
  shift 4
  [ $# -gt 0 ] || set -- $methods
  chains="--culler=$select"
  for method in "$@"; do
    chains="$chains --culler=$select+occlusion[method=$method]"
    rows="$rows $method"
  done
  rm -f "$file"
  "$portcullis" bench "$scene" --views "$views" --size "$size" --repeat "${repeat:-1}" --json "$file" $chains >"$work/table" 2>&1
  code=$?
  [ "$code" -ne 3 ] || skip "no OpenGL"
  [ -f "$file" ] || { cat "$work/table"; exit 1; }
  echo "# $name"
  for row in $rows; do
    printf '  %-9s items %8.1f floor %8.1f excess_items %6.2f polygons %9.1f tests %8.1f steps %7.1f stalls %6.0f cull us %8.1f gl ms %7.2f total ms %7.2f\n' "$row" \
      "$(figure "$row" items_drawn)" "$(figure "$row" floor)" "$(figure "$row" excess_items)" "$(figure "$row" polygons_drawn)" \
      "$(figure "$row" queries)" "$(figure "$row" steps)" "$(figure "$row" stalls)" \
      "$(ratio "$(figure "$row" cull_ns_mean)" 1000)" "$(figure "$row" gl_ms)" "$(figure "$row" total_ms)"
  done
  for row in $rows; do
    [ "$row" = last ] || check "$name $row: missed pixels" "$(figure "$row" missed_pixels)" == 0
    check "$name $row: faults" "$(figure "$row" faults)" == 0
  done
  check "$name: something is seen" "$(figure none polygons_visible)" '>' 0
}

excess() { held "$name $1: excess_items" "$(figure "$1" excess_items)" '<=' "$2"; }                                        # ROW LIMIT
over_floor() { held "$name $1: items over floor" "$(ratio "$(figure "$1" items_drawn)" "$(figure "$1" floor)")" '<=' "$2"; } # ROW LIMIT
costs() { held "$name $1: total ms, to none" "$(ratio "$(figure "$1" total_ms)" "$(figure none total_ms)")" '<=' "$2"; }     # ROW LIMIT

floors() { # of meshes
  over_floor wait 1.15
  over_floor twophase 1.35
  over_floor chc 1.35
}

city() {
  for boxes in $cities; do
    "$portcullis" generate city --size "$boxes" -o "$work/city.boxes" || exit 1
    run "city-$boxes street" "$work/city.boxes" "$(few_of city-street)" octree
    excess wait 1.3; excess chc 1.3
    run "city-$boxes aerial" "$work/city.boxes" "$(few_of city-roofs)" octree
    excess wait 1.3; excess chc 1.3
    run "city-$boxes smooth" "$work/city.boxes" "$(few_of city-smooth)" octree
    excess wait 1.3; excess chc 1.3; excess twophase 1.3
    run "city-$boxes auto:$few" "$work/city.boxes" "auto:$few" octree twophase
    excess twophase 2.5
    [ -f "$scenes/boxes/city.views" ] || continue
    for path in city city-aerial; do
      head -n "$few" "$scenes/boxes/$path.views" >"$work/there.views"
      run "city-$boxes boxes/$path.views" "$work/city.boxes" "$work/there.views" octree
      excess wait 1.3; excess chc 1.3
      [ $path != city ] || excess twophase 1.6
    done
  done
}

terrain() {
  "$portcullis" generate terrain --size $tiles -o "$work/terrain.obj" || exit 1
  for path in auto:$few auto:street:$few auto:roofs:$few; do
    run "terrain $path" "$work/terrain.obj" "$path" octree
    floors
  done
}

delft() {
  [ -f "$scenes/city/delft.obj" ] || { echo "# delft SKIPPED: set PORTCULLIS_SCENES"; return; }
  run "delft street" "$scenes/city/delft.obj" "$(few_of delft-street)" octree
  floors
  for row in $methods; do
    held "delft street $row: polygons of octree, to its own" "$(ratio "$(figure none polygons_drawn)" "$(figure "$row" polygons_drawn)")" '>=' 3
  done
  run "delft roofs" "$scenes/city/delft.obj" "$(few_of delft-roofs)" octree
  floors
}

flagship() {
  generated flagship ''
  for path in walk tour; do
    every 4 "$work/flagship.json" $path
    head -n "$few" "$work/$path.views" >"$work/few.views"
    run "flagship $path" "$work/flagship.json" "$work/few.views" octree
    floors
  done
  run "flagship auto:$few" "$work/flagship.json" "auto:$few" octree
  floors
}

maps() {
  [ -d "$scenes/quake" ] || { echo "# maps SKIPPED: set PORTCULLIS_SCENES"; return; }
  for map in quake/e1m1 librequake/lq_e3m4; do
    [ -n "${PORTCULLIS_LONG:-}" ] || [ $map = quake/e1m1 ] || continue
    "$portcullis" compile "$scenes/$map.map" --portals auto -o "$work/map.pcs" >"$work/compiled" 2>&1 || { cat "$work/compiled"; exit 1; }
    for path in auto:$few auto:walk:$few; do
      repeat=3 run "$(basename $map) $path" "$work/map.pcs" "$path" 'bsp[backface=1]+portal'
      costs twophase 1.1
    done
  done
}

# Nothing, or next to nothing, is hidden: from above, and between small boxes far apart.
cheap() {
  [ -n "${PORTCULLIS_LONG:-}" ] || return
  "$portcullis" generate terrain --size 1024 -o "$work/terrain.obj" || exit 1
  awk 'BEGIN { for (i = 0; i < 150; i++) printf "%f 220 %f 0.66 -0.717 %f 0 1 0 60 1.7777777777777777 0.1 4000\n", 300 + 2 * i, 400 + i, 0.2 + 0.2 * sin(i / 20) }' >"$work/above.views"
  repeat=5 run 'terrain from above' "$work/terrain.obj" "$work/above.views" octree twophase chc
  costs twophase 1.03; costs chc 1.03
  "$portcullis" generate swarm --size 10000 -o "$work/swarm.boxes" || exit 1
  repeat=5 run 'swarm auto:100' "$work/swarm.boxes" auto:100 octree twophase chc
  costs twophase 1.03; costs chc 1.03
  held "$name twophase: tests a frame" "$(figure twophase queries)" '<=' 20
}

last() { # believes stale answers: the path that turns says how wrong
  few=100
  "$portcullis" generate city --size 1000 -o "$work/city.boxes" || exit 1
  run "city-1000 turn" "$work/city.boxes" "$(few_of city-turn)" octree last twophase
  check "$name last: missed pixels" "$(figure last missed_pixels)" '>' 0
}

printf '# %s, %s cores; load %s\n' "$(sed -n 's/^model name.*: //p' /proc/cpuinfo 2>/dev/null | head -n 1)" "$(getconf _NPROCESSORS_ONLN)" \
  "$(cut -d' ' -f1 /proc/loadavg 2>/dev/null)"
for part in "$@"; do $part; done
[ -z "$file" ] || printf '# commit %s\n' "$(sed -n 's/.*"commit": "\(.*\)".*/\1/p' "$file")"
finish
