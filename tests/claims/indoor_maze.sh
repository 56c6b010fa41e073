#!/bin/sh
# Time follows the rooms that are seen, not the rooms there are: mazes of 10 to 10,000 rooms, doors open. Over all views the least squares fit of
# log time = a + seen * log(rooms seen) + there * log(rooms there are); the exponent `there` must be near 0. With a file name given, a plot as SVG.
# usage: indoor_maze.sh PORTCULLIS TEST_PLUGINS MEASURE_ROOMS [PLOT.svg]
# SPDX-License-Identifier: MIT
portcullis=$1
. "$(dirname "$0")/common.sh"
measure_rooms=$3
what=rooms third=crossings times=2
. "$(dirname "$0")/follow.sh"
plot=${4:-}
told='' fits=''
sizes='10 100 1000' step=10
[ -z "${PORTCULLIS_LONG:-}" ] || sizes='10 32 100 316 1000 3162 10000' step=2
most_there=0.15  # 10,000 rooms for 10: 2.8 times the time where as many are seen
least_seen=0.3   # below, it would follow nothing
most_seen=1.2

for chain in frustum+portal bsp+portal; do
  [ "$chain" = frustum+portal ] || "$portcullis" plugins | grep -q '^bsp' || continue
  views="$work/views.$chain"
  : >"$views"
  for size in $sizes; do
    generated maze "$size"
    "$measure_rooms" "$work/maze$size.json" $step "$chain" >>"$views" || exit 1
  done
  printf '# maze, doors open, %s\n' "$chain"
  show "$views"
  set -- $(fit "$(judged "$views")")
  printf '  %s grows with rooms seen to the power %s, with rooms there are to the power %s; %s views\n' "$measured" "$2" "$1" "$3"
  true_that "$chain: exponent of the rooms there are" "$1 < $most_there"
  true_that "$chain: exponent of the rooms seen" "$2 > $least_seen && $2 < $most_seen"
  told="$told${told:+;}$chain: $measured grows as the rooms seen to the power $2, as the rooms there are to the power $1"
  [ "$chain" != frustum+portal ] || fits="$*"
done
[ -z "$plot" ] || draw "$work/views.frustum+portal" "Generated mazes, doors open, frustum+portal" "$fits" "$told"
finish
