#!/bin/sh
# Time follows the rooms that are seen, not the rooms there are: mazes of 10 to 10,000 rooms, doors open. Over all views the least squares fit of
# log time = a + seen * log(rooms seen) + there * log(rooms there are); the exponent `there` must be near 0. With a file name given, a plot as SVG.
# usage: indoor_maze.sh PORTCULLIS TEST_PLUGINS MEASURE_ROOMS [PLOT.svg]
# SPDX-License-Identifier: MIT
portcullis=$1
. "$(dirname "$0")/common.sh"
measure_rooms=$3
plot=${4:-}
sizes='10 100 1000' step=10
[ -z "${PORTCULLIS_LONG:-}" ] || sizes='10 32 100 316 1000 3162 10000' step=2
most_there=0.15  # 10,000 rooms for 10: 2.8 times the time where as many are seen
least_seen=0.3   # below, it would follow nothing
most_seen=1.2

fit() { # FILE: "there seen views"
  awk '$2 > 0 && $5 > 0 {
    n++; x = log($2); z = log($1); y = log($5)
    sx += x; sz += z; sy += y; xx += x * x; zz += z * z; xz += x * z; xy += x * y; zy += z * y
  }
  END {
    xx -= sx * sx / n; zz -= sz * sz / n; xz -= sx * sz / n; xy -= sx * sy / n; zy -= sz * sy / n
    d = xx * zz - xz * xz
    printf "%.3f %.3f %d\n", (zy * xx - xy * xz) / d, (xy * zz - zy * xz) / d, n
  }' "$1"
}

show() { # FILE: a line a size: means, and of views that see 1, 2, 3-4, 5-8, ... rooms the mean time
  awk '{
    n[$1]++; seen[$1] += $2; crossed[$1] += $3; ns[$1] += $5
    b = 0; for (k = 1; k < $2; k *= 2) b++
    binned[$1, b] += $5; counted[$1, b]++; if (b > most) most = b
  }
  END {
    printf "  %6s %6s %9s %9s %8s  mean us of views that see", "rooms", "views", "seen", "crossings", "mean us"
    for (b = 0; b <= most; b++) printf " %7s", b == 0 ? "1" : "<=" 2 ^ b
    printf "\n"
    for (s = 1; s < 100000; s++) if (s in n) {
      printf "  %6d %6d %9.2f %9.2f %8.2f %26s", s, n[s], seen[s] / n[s], crossed[s] / n[s], ns[s] / n[s] / 1000, ""
      for (b = 0; b <= most; b++) if ((s, b) in counted) printf " %7.2f", binned[s, b] / counted[s, b] / 1000; else printf " %7s", "-"
      printf "\n"
    }
  }' "$1"
}

draw() { # FILE NAME: time by rooms seen, both logarithmic, a colour a size
  awk -v name="$2" 'BEGIN {
    split("#332288 #88ccee #44aa99 #117733 #999933 #ddcc77 #cc6677", colour, " ")
    print "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"720\" height=\"480\" font-family=\"sans-serif\" font-size=\"12\">"
    print "<rect width=\"720\" height=\"480\" fill=\"white\"/>"
    printf "<text x=\"360\" y=\"20\" text-anchor=\"middle\">%s: microseconds a view by rooms seen</text>\n", name
    for (k = 0; k <= 4; k++) printf "<text x=\"%d\" y=\"465\" text-anchor=\"middle\">%d</text><line x1=\"%d\" y1=\"40\" x2=\"%d\" y2=\"450\" stroke=\"#ddd\"/>\n", 60 + k * 140, 2 ^ k, 60 + k * 140, 60 + k * 140
    for (k = -2; k <= 6; k++) printf "<text x=\"50\" y=\"%d\" text-anchor=\"end\">%s</text><line x1=\"60\" y1=\"%d\" x2=\"620\" y2=\"%d\" stroke=\"#ddd\"/>\n", 354 - k * 50, 2 ^ k, 350 - k * 50, 350 - k * 50
  }
  $2 > 0 {
    if (!($1 in number)) { number[$1] = ++sizes; printf "<text x=\"640\" y=\"%d\" fill=\"%s\">%d rooms</text>\n", 40 + 18 * sizes, colour[(sizes - 1) % 7 + 1], $1 }
    place = sprintf("cx=\"%.0f\" cy=\"%.0f\"", 60 + 140 * log($2) / log(2) + number[$1] * 3, 350 - 50 * log($5 / 1000) / log(2))
    if ($5 >= 250 && !((place, $1) in drawn)) printf "<circle %s r=\"1.5\" fill=\"%s\"/>\n", place, colour[(number[$1] - 1) % 7 + 1]
    drawn[place, $1] = 1
  }
  END { print "</svg>" }' "$1" >"$plot"
}

for chain in frustum+portal bsp+portal; do
  [ "$chain" = frustum+portal ] || "$portcullis" plugins | grep -q '^bsp' || continue
  : >"$work/views"
  for size in $sizes; do
    generated maze "$size"
    "$measure_rooms" "$work/maze$size.json" $step "$chain" >>"$work/views" || exit 1
  done
  printf '# maze, doors open, %s\n' "$chain"
  show "$work/views"
  set -- $(fit "$work/views")
  printf '  time grows with rooms seen to the power %s, with rooms there are to the power %s; %s views\n' "$2" "$1" "$3"
  true_that "$chain: exponent of the rooms there are" "$1 < $most_there"
  true_that "$chain: exponent of the rooms seen" "$2 > $least_seen && $2 < $most_seen"
  [ -z "$plot" ] || [ "$chain" != frustum+portal ] || draw "$work/views" "maze, $chain"
done
finish
