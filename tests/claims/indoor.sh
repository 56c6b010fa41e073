#!/bin/sh
# Indoors on real maps, compiled with --portals auto: what each chain misses, draws too much and costs, held to what Part 4 asks. A line a
# check, PASS or FAIL with its figure. The long tier takes eight maps, 200 automatic views and 100 on portals and planes at 1280x720, and judges
# times; the short tier two maps and a few small views, without times and limits of excess. What is missed is looked for with all that moves
# in the scene, excess is of the scene without it: no culler here takes a door's leaf for a wall. Figures are kept in bench/results/indoor.txt.
# usage: indoor.sh PORTCULLIS [MAP...]
# SPDX-License-Identifier: MIT
portcullis=$1
shift
. "$(dirname "$0")/common.sh"
scenes=${PORTCULLIS_SCENES:-}
[ -d "$scenes" ] || skip "no folder of real scenes; set PORTCULLIS_SCENES"
maps="quake/dm4 librequake/lqdm12" size=320x180 views='auto:16 auto:edges:16' repeat=1
if [ -n "${PORTCULLIS_LONG:-}" ]; then
  maps="quake/dm4 quake/e1m1 quake/e1m4 quake/e3m5 librequake/lq_e0m8 librequake/lq_e3m4 librequake/lqdm12 librequake/lqdm7"
  size=1280x720 views='auto:200 auto:edges:100' repeat=3
fi
[ $# -eq 0 ] || maps=$*
timed=' dm4 e1m1 e3m5 '

# name: chain. What is judged against each other draws no backs, on any side.
chains='frustum: frustum[backface=1]
frustum+portal: frustum[backface=1]+portal
frustum+portal[octagon]: frustum[backface=1]+portal[clip=octagon]
frustum+portal[rect]: frustum[backface=1]+portal[clip=rect]
frustum+portal[planes]: frustum[backface=1]+portal[clip=planes]
frustum+portal[flood]: frustum[backface=1]+portal[clip=flood]
bsp: bsp[backface=1]
bsp+portal: bsp[backface=1]+portal
bsp[rect]+portal: bsp[backface=1,cells=rect]+portal
bsp[hull]+portal: bsp[backface=1,cells=hull]+portal
bsp[exact]+portal: bsp[backface=1,cells=exact]+portal'
has_bsp=1
"$portcullis" plugins 2>/dev/null | grep -q '^bsp' || has_bsp=0
[ "$has_bsp" = 1 ] || chains=$(printf '%s\n' "$chains" | grep -v '^bsp')
all_chains=$chains
few_chains=$(printf '%s\n' "$chains" | grep -v '\[.*: ') # what is asked of twice as many portals

choose_chains() { # 100|200
  chains=$all_chains
  [ "$1" = 100 ] || chains=$few_chains
  names=$(printf '%s\n' "$chains" | sed 's/: .*//')
}

figure() { # FILE CHAIN_NAME COUNTER: of the chains that the file's name tells
  case $1 in *-200-*) choose_chains 200 ;; *) choose_chains 100 ;; esac
  row=$(printf '%s\n' "$names" | grep -nxF "$2" | cut -d: -f1)
  [ -n "$row" ] || return 0
  [ "$3" != zones ] || row=$((row + 1)) # the file's own comes first
  counter "$1" "$3" | sed -n "${row}p"
}

micro() { # FILE CHAIN_NAME COUNTER in ns
  figure "$@" | awk '{ printf "%.2f", $1 / 1000 }'
}

# run SCENE VIEWS JSON words: all chains at once, so that they are timed in turns.
run() {
  scene=$1 path=$2 file=$3
  shift 3
  printf '%s\n' "$chains" | sed 's/.*: /--culler=/' >"$work/chains"
  while read -r chain; do set -- "$@" "$chain"; done <"$work/chains"
  "$portcullis" bench "$scene" --views "$path" --size "$size" --json "$file" "$@" >"$work/table" 2>&1
  code=$?
  [ "$code" -ne 3 ] || skip "no OpenGL"
  [ -f "$file" ] || { cat "$work/table"; exit 1; }
}

show() { # FILE: one line a chain
  printf '%s\n' "$names" | while read -r name; do
    printf '  %-24s drawn %7.1f visible %6.1f excess %6.3f hard %6.3f cull us %8.2f p99 %8.2f total ms %7.3f zones %5.2f merges %s missed %s %s\n' "$name" \
      "$(figure "$1" "$name" polygons_drawn)" "$(figure "$1" "$name" polygons_visible)" "$(figure "$1" "$name" excess)" \
      "$(figure "$1" "$name" hard_excess)" "$(micro "$1" "$name" cull_ns_mean)" "$(micro "$1" "$name" cull_ns_p99)" \
      "$(figure "$1" "$name" total_ms)" "$(figure "$1" "$name" zones)" "$(figure "$1" "$name" portal_merges)" \
      "$(figure "$1" "$name" missed_pixels)" "$(figure "$1" "$name" missed_items)"
  done
}

sound() { # NAME FILE
  printf '%s\n' "$names" >"$work/names"
  while read -r name; do
    check "$1 $name: missed pixels" "$(figure "$2" "$name" missed_pixels)" == 0
    check "$1 $name: missed items" "$(figure "$2" "$name" missed_items)" == 0
    check "$1 $name: faults" "$(figure "$2" "$name" faults)" == 0
    check "$1 $name: pixels of the picture that differ" "$(figure "$2" "$name" picture_differs)" == 0
  done <"$work/names"
  check "$1: something is seen" "$(figure "$2" frustum polygons_visible)" '>' 0
}

excess_at_most() { # NAME FILE CHAIN_NAME LIMIT: over all views, and over the hard ones
  check "$1 $3: excess" "$(figure "$2" "$3" excess)" '<=' "$4"
  hard=$(figure "$2" "$3" hard_excess)
  [ "$hard" = null ] || check "$1 $3: excess of hard views" "$hard" '<=' "$4"
}

ordered() { # NAME FILE FEWER COMPARED MORE [FILE_OF_FEWER]
  check "$1: excess of $3, and of $5" "$(figure "${6:-$2}" "$3" excess)" "$4" "$(figure "$2" "$5" excess)"
}

hold_limits() { # NAME FILE FILE_OF_200
  excess_at_most "$1" "$2" frustum+portal 1.75
  ordered "$1" "$2" frustum+portal '<' frustum
  check "$1: total ms of frustum+portal, and of frustum" "$(figure "$2" frustum+portal total_ms)" '<' "$(figure "$2" frustum total_ms)"
  [ "$has_bsp" = 1 ] || return
  excess_at_most "$1, 200 portals" "$3" bsp+portal 1.5
  check "$1, 200 portals: total ms of bsp+portal, and of frustum" "$(figure "$3" bsp+portal total_ms)" '<' "$(figure "$3" frustum total_ms)"
  ordered "$1, 200 portals" "$2" bsp+portal '<' frustum+portal "$3"
  for cells in rect hull; do
    excess_at_most "$1" "$2" "bsp[$cells]+portal" 1.15
    ordered "$1" "$3" "bsp[$cells]+portal" '<' bsp+portal "$2"
    ordered "$1" "$2" 'bsp[exact]+portal' '<=' "bsp[$cells]+portal"
  done
}

# What is exact is held to what 4 x 4 samples a pixel see: of single samples it draws what lies between them, too.
hold_exact() {
  [ "$has_bsp" = 1 ] || return
  chains='frustum: frustum[backface=1]
bsp[exact]+portal: bsp[backface=1,cells=exact]+portal'
  names=$(printf '%s\n' "$chains" | sed 's/: .*//')
  run "$work/$map-100.pcs" auto:200 "$work/$map-fine.json" --no-movers --samples 4 --repeat 1
  fine=$(counter "$work/$map-fine.json" excess | sed -n 2p)
  check "$map bsp[exact]+portal: excess, of 4 x 4 samples a pixel" "$fine" '<=' 1.02
  check "$map bsp[exact]+portal: missed samples" "$(counter "$work/$map-fine.json" missed_pixels | sed -n 2p)" == 0
}

# time_at_most NAME FILE CHAIN_NAME MEAN_US P99_US COLD: cold, what is drawn between two views has taken the caches
time_at_most() {
  check "$1 $3: us a view, mean" "$(micro "$2" "$3" cull_ns_mean)" '<=' "$(awk "BEGIN { print $4 * $6 }")"
  check "$1 $3: us a view, p99" "$(micro "$2" "$3" cull_ns_p99)" '<=' "$(awk "BEGIN { print $5 * $6 }")"
}

hold_times() { # NAME FILE FILE_OF_200 COLD
  time_at_most "$1" "$2" frustum+portal 8 60 "$4"
  [ "$has_bsp" = 1 ] || return
  time_at_most "$1, 200 portals" "$3" bsp+portal 12 100 "$4"
  time_at_most "$1" "$2" 'bsp[rect]+portal' 30 180 "$4"
  time_at_most "$1" "$2" 'bsp[hull]+portal' 30 180 "$4"
  time_at_most "$1" "$2" 'bsp[exact]+portal' 80 800 "$4"
}

map_run() { # MAP, as in the folder of scenes
  map=$(basename "$1")
  for most in 100 200; do
    "$portcullis" compile "$scenes/$1.map" --portals auto --max-portals $most -o "$work/$map-$most.pcs" >"$work/compiled" 2>&1 || { cat "$work/compiled"; exit 1; }
    portals=$("$portcullis" info "$work/$map-$most.pcs" | sed -n 's/^portals *//p')
    # Portals of doors come on top of --max-portals: told here, judged where the whole table is.
    if [ -n "${PORTCULLIS_LONG:-}" ]; then check "$map: portals with --max-portals $most" "$portals" '<=' "$most"; else echo "# $map: $portals portals with --max-portals $most"; fi
    choose_chains $most
    for path in $views; do
      file=$work/$map-$most-$path.json
      run "$work/$map-$most.pcs" "$path" "$file" --repeat 1
      printf '# %s, at most %s portals, %s at %s\n' "$map" "$most" "$path" "$size"
      show "$file"
      sound "$map $most $path" "$file"
    done
    [ -n "${PORTCULLIS_LONG:-}" ] || continue
    run "$work/$map-$most.pcs" auto:200 "$work/$map-$most-still.json" --no-movers --repeat $repeat
    printf '# %s, at most %s portals, auto:200 at %s, without what moves\n' "$map" "$most" "$size"
    show "$work/$map-$most-still.json"
    sound "$map $most without movers" "$work/$map-$most-still.json"
  done
  [ -n "${PORTCULLIS_LONG:-}" ] || return
  hold_limits "$map" "$work/$map-100-still.json" "$work/$map-200-still.json"
  hold_exact
  case $timed in *" $map "*) ;; *) return ;; esac
  hold_times "$map cold" "$work/$map-100-still.json" "$work/$map-200-still.json" 1.5
  for most in 100 200; do
    choose_chains $most
    run "$work/$map-$most.pcs" auto:200 "$work/$map-$most-warm.json" --no-movers --no-truth --repeat 9
  done
  hold_times "$map warm" "$work/$map-100-warm.json" "$work/$map-200-warm.json" 1
}

printf '# %s, %s cores; load %s\n' "$(sed -n 's/^model name.*: //p' /proc/cpuinfo 2>/dev/null | head -n 1)" "$(getconf _NPROCESSORS_ONLN)" \
  "$(cut -d' ' -f1 /proc/loadavg 2>/dev/null)"
for map in $maps; do map_run "$map"; done
check 'the culler bsp is there' "$has_bsp" == 1
[ -z "$file" ] || printf '# commit %s\n' "$(sed -n 's/.*"commit": "\(.*\)".*/\1/p' "$file")"
finish
