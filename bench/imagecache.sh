#!/bin/sh
# What the image cache shows, errs by and costs, held to what Part 6 asks. A line a check, PASS or FAIL with its figure; ratios are of one run, in which all are
# timed in turns. Delft of 8 x 8 tiles and a forest-and-city of a million triangles, walks and drives of 1,000 views.
# usage: imagecache.sh PORTCULLIS SCENES [walk|drive|even|curve|cells|movers|quadtree|loses...] > bench/results/imagecache.txt
# environment, to take less while developing: FRAMES (1000), PICTURE (1280x720), REPEAT (3), CURVE_FRAMES (200), EYES (1000000),
#   STEP (1: all in one row; N: times of all views, error and misses of one run of 20 views of N), FRAME_MS (33.3), OUT (.: where curves go)
# on two cores at the defaults, about: walk and drive 80 minutes each, even 15, curve 120, cells 30, movers 15, quadtree 10, loses 10
# SPDX-License-Identifier: MIT
set -u
[ $# -ge 2 ] || { sed -n 's/^# usage: //p' "$0" >&2; exit 2; }
here=$(dirname "$0")
portcullis=$1 delft=$2/city/delft.obj
shift 2
[ $# -gt 0 ] || set -- walk drive even curve cells movers quadtree loses
for part in "$@"; do
  case $part in walk | drive | even | curve | cells | movers | quadtree | loses) ;; *) echo "$0: error: no part '$part'; see the usage" >&2; exit 2 ;; esac
done
frames=${FRAMES:-1000} picture=${PICTURE:-1280x720} repeat=${REPEAT:-3} curve_frames=${CURVE_FRAMES:-200} eyes=${EYES:-1000000} step=${STEP:-1}
frame_ms=${FRAME_MS:-33.3} out=${OUT:-.}
. "$here/../tests/bench/counters.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
case $delft in /*) ;; *) delft=$PWD/$delft ;; esac
[ -f "$delft" ] || skip "no $delft"
file=$work/results
scenes='delft8.json forest.obj'

figure() { counter "$file" "$2" | sed -n "$1p"; } # ROW COUNTER
ratio() { awk -v a="${1:-0}" -v b="${2:-0}" 'BEGIN { printf "%.4f", (a + 0 > 0 && b + 0 > 0 ? a / b : 0) }'; }
sum() { counter "$file" "$1" | awk '{ sum += $1 } END { print sum + 0 }'; } # COUNTER of all rows

scene_made() { # FILE of $work
  [ ! -f "$work/$1" ] || return 0
  case $1 in
  delft8.json)
    awk -v file="$delft" 'BEGIN {
      print "{\"portcullis\": 1, \"meshes\": ["
      for (row = 0; row < 8; row++)
        printf "  {\"file\": \"%s\", \"at\": [0, 0, %d], \"repeat\": {\"count\": 8, \"step\": [525, 0, 0]}}%s\n", file, row * 328, row < 7 ? "," : ""
      print "]}"
    }' >"$work/$1" ;;
  forest.obj) "$portcullis" generate forest --size 1000000 -o "$work/$1" || exit 1 ;;
  city.boxes) "$portcullis" generate city --size 20000 -o "$work/$1" || exit 1 ;;
  small.boxes) "$portcullis" generate city --size 1000 -o "$work/$1" || exit 1 ;;
  delft.obj) cp "$delft" "$work/$1" ;;
  moving_*) moving_made "${1#moving_}" >"$work/$1" ;;
  esac
}

# 1,500 boxes on loops of six seconds about the scene of that name.
moving_made() {
  base=${1%.json}
  half=1000
  [ "$base" = city.boxes ] || half=440
  scene_made "$base"
  awk -v base="$base" -v half=$half 'BEGIN {
    srand(3)
    print "{\"portcullis\": 1, \"include\": [{\"file\": \"" base "\"}], \"movers\": ["
    for (i = 0; i < 1500; i++) {
      x = (rand() * 2 - 1) * half; y = rand() * 12 + 0.1; z = (rand() * 2 - 1) * half; s = 0.8 + rand() * 3
      printf "%s{\"name\": \"m%d\", \"box\": {\"min\": [%.3f, %.3f, %.3f], \"max\": [%.3f, %.3f, %.3f]}, \"loop\": true,", i ? "," : "", i, x, y, z, x + s, y + s, z + s / 2
      printf " \"path\": [{\"time\": 0}, {\"time\": 3, \"at\": [%.3f, %.3f, %.3f]}, {\"time\": 6, \"at\": [0, 0, 0]}]}\n", rand() * 60 - 30, rand() * 4, rand() * 60 - 30
    }
    print "]}"
  }'
}

# run SCENE VIEWS words: options of the bench, --culler among them. A line a row of the table.
run() {
  scene=$1 views=$2
  shift 2
  scene_made "$scene"
  rm -f "$file"
  "$portcullis" bench "$work/$scene" --views "$views" --size "$picture" --json "$file" "$@" >"$work/table" 2>&1
  code=$?
  [ "$code" -ne 3 ] || skip "no OpenGL"
  [ -f "$file" ] || { cat "$work/table"; exit 1; }
  printf '# %s %s\n' "$scene" "${views##*/}"
  sed -n 's/^ *"run_name": ".*\/\([^/]*\)",*$/\1/p' "$file" >"$work/names"
  row=0
  while read -r chain; do
    row=$((row + 1))
    printf '  %-36s polygons %9.0f total ms %8.2f mean %8.2f p99 %8.2f refreshes %7.2f bytes %9s PSNR %s FLIP %s p99 %s cracks %s missed %s\n' "$chain" \
      "$(figure $row polygons_drawn)" "$(figure $row total_ms)" "$(figure $row total_ms_mean)" "$(figure $row total_ms_p99)" "$(figure $row refreshes)" \
      "$(figure $row picture_bytes)" "$(figure $row psnr | cut -c1-6)" "$(figure $row flip | cut -c1-7)" "$(figure $row flip_p99 | cut -c1-7)" \
      "$(figure $row crack_pixels)" "$(figure $row missed_pixels)"
  done <"$work/names"
  check "$scene ${views##*/}: exit code" "$code" == 0
  check "$scene ${views##*/}: faults" "$(sum faults)" == 0
}

held_errors() { # NAME ROW
  check "$1: missed pixels" "$(figure "$2" missed_pixels)" == 0
  check "$1: crack pixels" "$(figure "$2" crack_pixels)" == 0
  check "$1: mean FLIP" "$(figure "$2" flip)" '<=' 0.02
  check "$1: FLIP, 99th percentile" "$(figure "$2" flip_p99)" '<=' 0.05
  check "$1: PSNR" "$(figure "$2" psnr)" '>=' 35
}

held_times() { # NAME ROW: rows 1 and 2 are octree and octree+occlusion
  check "$1: total ms of octree, to its own" "$(ratio "$(figure 1 total_ms)" "$(figure "$2" total_ms)")" '>=' 10
  check "$1: total ms of octree+occlusion, to its own" "$(ratio "$(figure 2 total_ms)" "$(figure "$2" total_ms)")" '>=' 3
}

# Runs of 20 views, one of STEP: a view's error needs a history, not the whole path's.
some_of() { # SCENE VIEWS
  scene_made "$1"
  "$portcullis" generate views --scene "$work/$1" --views "$2" -o "$work/all.views" || exit 1
  awk -v step="$step" 'int((NR - 1) / 20) % step == 0' "$work/all.views" >"$work/some.views"
}

far() { # KIND of path
  for scene in $scenes; do
    name="$scene $1"
    if [ "$step" -eq 1 ]; then
      run "$scene" "auto:$1:$frames" --repeat "$repeat" --culler octree --culler octree+occlusion --culler imagecache --culler imagecache+occlusion
      for row in 3 4; do held_times "$name $(sed -n ${row}p "$work/names")" $row; done
    else
      run "$scene" "auto:$1:$frames" --repeat "$repeat" --no-truth --culler octree --culler octree+occlusion --culler imagecache --culler imagecache+occlusion
      for row in 3 4; do held_times "$name $(sed -n ${row}p "$work/names")" $row; done
      some_of "$scene" "auto:$1:$frames"
      run "$scene" "$work/some.views" --repeat 1 --culler octree --culler octree+occlusion --culler imagecache --culler imagecache+occlusion
    fi
    for row in 3 4; do held_errors "$name $(sed -n ${row}p "$work/names")" $row; done
  done
}
walk() { far walk; }
drive() { far drive; }

# Told that a frame may take FRAME_MS: with budget=bounded the error is kept, with steady the time.
even() {
  for scene in $scenes; do
    for kind in walk drive; do
      run "$scene" "auto:$kind:$frames" --repeat "$repeat" --no-truth --frame-ms "$frame_ms" --culler imagecache --culler 'imagecache[budget=steady]'
      for row in 1 2; do
        check "$scene $kind, $frame_ms ms a frame, $(sed -n ${row}p "$work/names"): total ms, p99 by p50" "$(figure $row total_ms_p99_to_p50)" '<=' 1.3
      done
    done
  done
}

# Both ways to show, with and without quadtree, at tolerances of 0.25 to 16 pixels: OUT/imagecache_SCENE_PATH.json and .svg
curve() {
  for scene in $scenes; do
    scene_made "$scene"
    for kind in walk drive; do
      to=$out/imagecache_${scene%.*}_$kind
      BENCH_OPTIONS="--size $picture --repeat 1 --no-truth" sh "$here/curve.sh" "$portcullis" "$to" "$work/$scene" "auto:$kind:$curve_frames"
      check "$scene $kind: exit code of the curve" $? == 0
      check "$scene $kind: points of the curve" "$(grep -c '"series"' "$to.json")" == 30
    done
  done
}

# Of random eyes, beside the 1998 report's forms: measure_grid stands beside portcullis in the build tree.
cells() {
  measure=$(dirname "$portcullis")/measure_grid
  [ -x "$measure" ] || { echo '# cells: SKIPPED: no measure_grid beside portcullis'; return; }
  "$measure" "$eyes" >"$work/grid" || exit 1
  sed 's/^/  /' "$work/grid"
  grep '^rings.*[0-9] *$' "$work/grid" | cut -c23- >"$work/exact"
  grep '^report' "$work/grid" | cut -c23- >"$work/report"
  check 'cells in view lost, of random eyes' "$(awk '$1 != "level" { sum += $3; rows++ } END { print rows ? sum : "null" }' "$work/exact")" == 0
  check 'order inversions' "$(awk '$1 != "level" { sum += $7; rows++ } END { print rows ? sum : "null" }' "$work/exact")" == 0
  check "the report's border: cells lost" "$(awk '{ sum += $3 } END { print sum + 0 }' "$work/report")" '>' 0
  check "the report's slope: order inversions" "$(awk '{ sum += $7 } END { print sum + 0 }' "$work/report")" '>' 0
}

movers() {
  for scene in moving_city.boxes.json moving_forest.obj.json; do
    for views in auto:roofs:100 auto:walk:200 auto:street:100; do
      run "$scene" "$views" --repeat 1 --culler imagecache
      seen=$(figure 1 mover_pixels) wrong=$(figure 1 mover_pixels_wrong) wrong_far=$(figure 1 mover_pixels_wrong_far)
      echo "# $scene $views: $seen pixels of movers, $wrong wrong, $wrong_far of these by more than a pixel"
      check "$scene $views: missed pixels" "$(figure 1 missed_pixels)" == 0
      [ "${seen:-0}" != 0 ] || { echo '# no mover is seen'; continue; }
      check "$scene $views: depth order of movers, wrong pixels of theirs" "$(awk "BEGIN { printf \"%.5f\", $wrong / $seen }")" '<=' 0.001
      check "$scene $views: wrong by more than a pixel explains" "$wrong_far" == 0
    done
  done
}

# Bytes of pictures with cells twice as wide, a level at a time: each level is one picture where the one before has four.
quadtree() {
  for scene in $scenes; do
    set --
    for level in 6 5 4 3; do set -- "$@" --culler "imagecache[level=$level,tree=off,hidden=shown]"; done
    run "$scene" auto:walk:200 --repeat 1 --no-truth "$@"
    for row in 2 3 4; do
      check "$scene: picture bytes of level $((7 - row)), to level $((8 - row))" "$(ratio "$(figure $row picture_bytes)" "$(figure $((row - 1)) picture_bytes)")" '<=' 0.55
      check "$scene: level $((7 - row)) has pictures" "$(figure $row picture_bytes)" '>' 0
    done
  done
}

# Small scenes, and views that have nothing in common: the culler hands the zone back to geometry.
loses() {
  for where in small.boxes:auto:walk:200 small.boxes:auto:200 delft.obj:auto:street:200 delft.obj:auto:200 forest.obj:auto:200 delft8.json:auto:200; do
    run "${where%%:*}" "${where#*:}" --repeat "$repeat" --no-truth --culler octree --culler imagecache
    check "${where%%:*} ${where#*:}: total ms of imagecache, to octree's" "$(ratio "$(figure 2 total_ms)" "$(figure 1 total_ms)")" '<=' 1.05
  done
}

printf '# %s, %s cores; load %s\n# %s views at %s, %s passes; errors of one run of 20 views of %s\n' "$(sed -n 's/^model name.*: //p' /proc/cpuinfo 2>/dev/null | head -n 1)" \
  "$(getconf _NPROCESSORS_ONLN)" "$(cut -d' ' -f1 /proc/loadavg 2>/dev/null)" "$frames" "$picture" "$repeat" "$step"
for part in "$@"; do $part; done
[ ! -f "$file" ] || printf '# commit %s\n' "$(sed -n 's/.*"commit": "\(.*\)".*/\1/p' "$file")"
finish
