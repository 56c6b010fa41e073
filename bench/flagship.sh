#!/bin/sh
# The scene that mixes all strategies: what every assignment of chains to its zones draws, costs and errs by, held to what Part 6 asks. A line a
# check, PASS or FAIL with its figure. Assignments of one table are measured in one run, interleaved; ratios are of one table.
# usage: flagship.sh PORTCULLIS [table|mixed|rooms|open|memory...]
# environment: SIZE of the scene (1000 metres), PICTURE (1280x720), REPEAT (3), STEP (1: every view of the walk; N: runs of 20 views, one of N)
# SPDX-License-Identifier: MIT
set -u
[ $# -ge 1 ] || { sed -n 's/^# usage: //p' "$0" >&2; exit 2; }
portcullis=$1
shift
[ $# -gt 0 ] || set -- table mixed rooms open memory
size=${SIZE:-1000} picture=${PICTURE:-1280x720} repeat=${REPEAT:-3} step=${STEP:-1}
. "$(dirname "$0")/../tests/bench/counters.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
scene=$work/flagship.json views=$work/walk.views file=$work/results

# What the scene's file names; a room is told by the number behind its name.
open='imagecache+portal' street='octree+portal+occlusion[method=hiz]' rooms='bsp+portal'

figure() { counter "$file" "$2" | sed -n "$1p"; } # ROW COUNTER
ratio() { awk -v a="$1" -v b="$2" 'BEGIN { printf "%.3f", (b > 0 ? a / b : 0) }'; }

# run NAME BENCH-OPTION... -- ROW-NAME...: a table, and what must hold for each of its rows.
run() {
  name=$1
  shift
  options=''
  while [ "$1" != -- ]; do options="$options $1" && shift; done
  shift
  rm -f "$file"
  set -f
  # shellcheck disable=SC2086 # words
  "$portcullis" bench "$scene" --views "$views" --size "$picture" --repeat "$repeat" --json "$file" $options >"$work/table" 2>&1
  code=$?
  set +f
  [ "$code" -ne 3 ] || skip "no OpenGL"
  [ -f "$file" ] || { cat "$work/table"; exit 1; }
  printf '# %s\n  %-44s %9s %9s %9s %9s %9s %8s %7s %7s %7s\n' "$name" 'assignment' polygons visible 'cull us' 'total ms' 'p95' 'missed' FLIP 'p99' cracks
  row=0
  for label in "$@"; do
    row=$((row + 1))
    printf '  %-44s %9.0f %9.0f %9.1f %9.2f %9.2f %8s %7s %7s %7s\n' "$label" "$(figure $row polygons_drawn)" "$(figure $row polygons_visible)" \
      "$(ratio "$(figure $row cull_ns_mean)" 1000)" "$(figure $row total_ms)" "$(figure $row total_ms_p95)" "$(figure $row missed_pixels)" \
      "$(figure $row flip | cut -c1-6)" "$(figure $row flip_p99 | cut -c1-6)" "$(figure $row crack_pixels)"
  done
  check "$name: rows" "$(counter "$file" missed_pixels | wc -l)" == $row
  check "$name: exit code" "$code" == 0
  row=0
  for label in "$@"; do
    row=$((row + 1))
    check "$name, $label: missed pixels" "$(figure $row missed_pixels)" == 0
  done
  for counted in faults picture_differs; do
    check "$name: $counted of all rows" "$(counter "$file" $counted | awk '{ sum += $1 } END { print sum + 0 }')" == 0
  done
  check "$name: truths" "$(same "$file" polygons_visible | wc -l)" == 1
  check "$name: something is seen" "$(same "$file" polygons_visible | head -n 1)" '>' 0
}

# The mixed assignment of the scene's file against each strategy in all zones, and all of them swapped every 10 views.
table() {
  run 'mixed and uniform' --culler scene --culler frustum --culler bsp+portal --culler octree+occlusion --culler imagecache --swap 10 -- \
    'scene (mixed)' 'all frustum' 'all bsp+portal' 'all octree+occlusion' 'all imagecache' 'swapped every 10 views'
  row=1
  for uniform in frustum bsp+portal octree+occlusion imagecache; do
    row=$((row + 1))
    check "total ms of $uniform in all zones, to the mixed" "$(ratio "$(figure $row total_ms)" "$(figure 1 total_ms)")" '>=' 1.5
  done
  check 'zones swapped' "$(figure 6 swaps)" '>' 0
  check 'mixed: mean FLIP' "$(figure 1 flip)" '<=' 0.02
  check 'mixed: FLIP, 99th percentile' "$(figure 1 flip_p99)" '<=' 0.05
  check 'mixed: crack pixels' "$(figure 1 crack_pixels)" == 0
}

# Several mixed assignments beside the uniform ones, in one run; those that come nearest to the mixed ones are uniform too.
mixed() {
  run 'several mixed' --culler scene --culler "outside=$open;street=octree+portal+occlusion;$rooms" --culler "outside=$open;street=$rooms;$rooms" \
    --culler "outside=$open;street=frustum+portal;$rooms" --culler "outside=octree+occlusion;street=$street;$rooms" --culler frustum --culler bsp+portal \
    --culler octree+occlusion --culler imagecache --culler imagecache+portal -- \
    'scene (mixed)' 'street octree+portal+occlusion' "street $rooms" 'street frustum+portal' 'outside octree+occlusion' \
    'all frustum' 'all bsp+portal' 'all octree+occlusion' 'all imagecache' 'all imagecache+portal'
  best=$(for row in 1 2 3 4 5; do figure $row total_ms; done | sort -g | head -n 1)
  row=5
  for uniform in frustum bsp+portal octree+occlusion imagecache imagecache+portal; do
    row=$((row + 1))
    check "several mixed: total ms of $uniform in all zones, to the best mixed" "$(ratio "$(figure $row total_ms)" "$best")" '>=' 1.5
  done
}

# The same open and street, other chains in the rooms.
rooms() {
  run 'by rooms' --zone "outside=$open" --zone "street=$street" --culler "$rooms" --culler frustum --culler octree+occlusion --culler imagecache \
    --culler bsp+portal+occlusion -- "rooms $rooms" 'rooms frustum' 'rooms octree+occlusion' 'rooms imagecache' 'rooms bsp+portal+occlusion'
}

# The same rooms, other chains in the open and the street.
open() {
  run 'by the open' --zone "*_*=$rooms" --culler frustum --culler bsp+portal --culler octree+occlusion --culler octree+portal+occlusion --culler imagecache \
    --culler imagecache+portal --culler imagecache+occlusion -- 'open and street frustum' 'open and street bsp+portal' 'open and street octree+occlusion' \
    'open and street octree+portal+occlusion' 'open and street imagecache' 'open and street imagecache+portal' 'open and street imagecache+occlusion'
}

resident_kb() { sed -n 's/^VmRSS:[^0-9]*\([0-9]*\).*/\1/p' "/proc/$1/status" 2>/dev/null; }

# Three passes of swaps: what is resident in the last is what was resident in the second.
memory() {
  "$portcullis" bench "$scene" --views "$views" --size 320x180 --repeat 6 --no-truth --no-pictures --culler scene --culler frustum --culler bsp+portal \
    --culler octree+occlusion --culler imagecache --swap 10 >"$work/table" 2>&1 &
  pid=$!
  : >"$work/resident"
  while kill -0 "$pid" 2>/dev/null; do
    resident_kb "$pid" >>"$work/resident"
    sleep 0.2
  done
  wait "$pid"
  check 'memory: exit code' $? == 0
  set -- $(awk '{ kb[NR] = $1 } END { for (i = 1; i <= NR; i++) if (i > NR / 2 && i <= 3 * NR / 4) a = kb[i] > a ? kb[i] : a; else if (i > 3 * NR / 4) b = kb[i] > b ? kb[i] : b
    print a + 0, b + 0 }' "$work/resident")
  echo "# resident: at most $1 KB in the third quarter of the run, $2 KB in the last"
  check 'memory: growth' "$(ratio "$2" "$1")" '<=' 1.02
}

"$portcullis" generate flagship --size "$size" -o "$scene" || exit 1
"$portcullis" generate views --scene "$scene" --views path:walk -o "$work/all.views" || exit 1
awk -v step="$step" 'int((NR - 1) / 20) % step == 0' "$work/all.views" >"$views"
printf '# %s, %s cores; load %s\n# size %s, %s views at %s, %s passes\n' "$(sed -n 's/^model name.*: //p' /proc/cpuinfo 2>/dev/null | head -n 1)" \
  "$(getconf _NPROCESSORS_ONLN)" "$(cut -d' ' -f1 /proc/loadavg 2>/dev/null)" "$size" "$(wc -l <"$views")" "$picture" "$repeat"
"$portcullis" info "$scene" | sed -n 's/^\(zones\|portals\|items\|polygons\|triangles\) /# &/p'
for part in "$@"; do $part; done
[ ! -f "$file" ] || printf '# commit %s\n' "$(sed -n 's/.*"commit": "\(.*\)".*/\1/p' "$file")"
finish
