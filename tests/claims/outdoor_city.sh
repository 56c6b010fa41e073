#!/bin/sh
# Time follows the boxes that are seen, not the boxes there are: cities of 1,000 to 1,000,000, looked at to distances of 30 m to 10 km. A smaller city is
# the middle of a larger one, so views to 100 m see the same boxes in all: their time's exponent of the boxes there are must be near 0 (a
# tree's depth grows with the logarithm). In the largest city the exponent of the boxes seen: what is seen whole costs nothing but its edge. With
# a file name given, a plot as SVG.
# usage: outdoor_city.sh PORTCULLIS TEST_PLUGINS MEASURE_OCTREE [PLOT.svg]
# SPDX-License-Identifier: MIT
portcullis=$1
. "$(dirname "$0")/common.sh"
measure_octree=$3
what=boxes third=runs times=8
. "$(dirname "$0")/follow.sh"
plot=${4:-}
sizes='1000 10000 100000' passes=3
[ -z "${PORTCULLIS_LONG:-}" ] || sizes='1000 3162 10000 31623 100000 316228 1000000' passes=9
most_there=0.2 # a thousand times the boxes: 4 times the time where the same are seen
least_seen=0.1 # below, it would follow nothing
most_seen=0.8

# From places near the middle of the smallest city, turned a little more each, to all distances.
awk 'BEGIN {
  split("30 60 100 200 400 1000 2000 4000 10000", far, " ")
  for (i = 0; i < 24; i++) {
    turn = 2.39996 * i
    for (k = 1; k <= 9; k++)
      printf "%.3f %.1f %.3f %.9f %.3f %.9f 0 1 0 60 1.7777777777777777 0.1 %s\n", 60 * (i % 3 - 1), i % 4 == 3 ? 60 : 1.7, 7.5 * (i % 12 - 6), sin(turn),
        i % 4 == 3 ? -0.3 : -0.02, cos(turn), far[k]
  }
}' >"$work/looks.views"

views="$work/views"
: >"$views"
for size in $sizes; do
  "$portcullis" generate city --size "$size" -o "$work/city.boxes" || exit 1
  "$measure_octree" --each "$work/city.boxes" "$work/looks.views" "$passes" octree:auto,2,0,auto >>"$views" || exit 1
done
echo '# city, octree'
show "$views"
set -- $(awk '(NR - 1) % 9 < 3' "$views" >"$work/near"; fit "$(judged "$work/near")")
there=$1
# One size: what stands for it is any two numbers, as the fit needs to tell them apart.
set -- $(awk -v all="${sizes##* }" '$1 == all && $2 >= 64 { print 1 + NR % 2, $2, $3, $4, $5 }' "$views" >"$work/largest"; fit "$(judged "$work/largest")")
seen=$2
told="$measured grows as the boxes there are to the power $there where the same boxes are seen, and in the largest city as the boxes seen to the power $seen"
echo "  $told"
true_that "exponent of the boxes there are" "$there < $most_there"
true_that "exponent of the boxes seen" "$seen > $least_seen && $seen < $most_seen"
[ -z "$plot" ] || draw "$views" "Generated cities, octree" "" "$told"
finish
