#!/bin/sh
# Scenes that only a warning is given for lose nothing: zones that overlap, items and movers outside all zones, a zone without
# anything in it on the way. Random views inside, outside and on the borders.
# usage: lost.sh PORTCULLIS TEST_PLUGINS
# SPDX-License-Identifier: MIT
portcullis=$1
. "$(dirname "$0")/common.sh"
export PORTCULLIS_PLUGIN_PATH="$2"
count=60
[ -z "${PORTCULLIS_LONG:-}" ] || count=1000

# Eyes all over a box, every fourth on a plane that borders lie in.
awk -v count="$count" 'BEGIN {
  srand(11)
  for (i = 0; i < count; i++) {
    if (i % 5 < 4) { x = rand() * 14; y = rand() * 3; z = rand() * 6 } else { x = -2 + rand() * 24; y = -1 + rand() * 6; z = -2 + rand() * 10 }
    a = rand() * 6.2831853
    if (i % 4 == 0) x = int(x)
    if (i % 8 == 0) x = 5.5
    print x, y, z, cos(a), rand() - 0.5, sin(a), "0 1 0 75 1.7777777777777777 0.0625 1000"
  }
}' >"$work/random.views"

furniture='{"min": [1, 0, 1], "max": [2, 1, 2]}, {"min": [5.25, 0, 4], "max": [5.75, 1, 4.5]}, {"min": [7, 0, 1], "max": [8, 2, 2]}, {"min": [4.5, 0, 2], "max": [6.5, 0.5, 2.5]}'
ball='{"name": "cart", "box": {"min": [4, 0, 4.75], "max": [5, 1, 5.5]}, "path": [{"time": 0}, {"time": 4, "at": [9, 0, 0]}, {"time": 9, "at": [-6, 1, 0]}], "loop": true}'

# Two zones that share a metre, a portal in the middle of it.
cat >"$work/overlap.json" <<EOF
{"portcullis": 1, "boxes": [{"min": [0, 0, 0], "max": [11, 3, 6], "side": "in"}, $furniture], "movers": [$ball],
"zones": [{"name": "a", "box": [[0, 0, 0], [6, 3, 6]]}, {"name": "b", "box": [[5, 0, 0], [11, 3, 6]]}],
"portals": [{"zones": ["a", "b"], "points": [[5.5, 0, 0], [5.5, 0, 6], [5.5, 3, 6], [5.5, 3, 0]]}]}
EOF
# Open at the end, with boxes beyond it that no zone has, one half in a zone, a mover that drives out, one that hovers outside.
cat >"$work/stray.json" <<EOF
{"portcullis": 1, "boxes": [{"min": [0, 0, 0], "max": [11, 3, 6], "side": "in", "omit": ["+x", "+y"]}, $furniture, {"min": [14, 0, 2], "max": [15, 2, 4]},
{"min": [10.5, 0, 4], "max": [12, 1, 5]}, {"min": [3, 5, 2], "max": [4, 6, 4]}],
"movers": [$ball, {"name": "kite", "box": {"min": [18, 2, 2], "max": [19, 3, 3]}, "path": [{"time": 0}, {"time": 3, "at": [0, 2, 2]}]}],
"zones": [{"name": "a", "box": [[0, 0, 0], [5.5, 3, 6]]}, {"name": "b", "box": [[5.5, 0, 0], [11, 3, 6]]}],
"portals": [{"zones": ["a", "b"], "points": [[5.5, 0, 0], [5.5, 0, 6], [5.5, 3, 6], [5.5, 3, 0]]}]}
EOF
# Between two rooms a zone with neither walls nor anything else in it; at times the cart.
cat >"$work/empty.json" <<EOF
{"portcullis": 1, "boxes": [{"min": [0, 0, 0], "max": [5.5, 3, 6], "side": "in", "omit": ["+x"]}, {"min": [8, 0, 0], "max": [14, 3, 6], "side": "in", "omit": ["-x"]},
{"min": [1, 0, 1], "max": [2, 1, 2]}, {"min": [10, 0, 3], "max": [11, 2, 4]}], "movers": [$ball],
"zones": [{"name": "a", "box": [[0, 0, 0], [5.5, 3, 6]]}, {"name": "gap", "box": [[5.5, 0, 0], [8, 3, 6]]}, {"name": "b", "box": [[8, 0, 0], [14, 3, 6]]}],
"portals": [{"zones": ["a", "gap"], "points": [[5.5, 0, 0], [5.5, 0, 6], [5.5, 3, 6], [5.5, 3, 0]]},
{"zones": ["gap", "b"], "points": [[8, 0, 0], [8, 0, 6], [8, 3, 6], [8, 3, 0]]}]}
EOF
# The same where all lies in a zone that is everywhere, and the gap overlaps both rooms.
cat >"$work/nested.json" <<EOF
{"portcullis": 1, "boxes": [{"min": [0, 0, 0], "max": [5.5, 3, 6], "side": "in", "omit": ["+x"]}, {"min": [8, 0, 0], "max": [14, 3, 6], "side": "in", "omit": ["-x"]},
{"min": [1, 0, 1], "max": [2, 1, 2]}, {"min": [10, 0, 3], "max": [11, 2, 4]}, {"min": [16, 0, 2], "max": [17, 2, 4]}, {"min": [6.25, 0, -2], "max": [7, 1, -1]}], "movers": [$ball],
"zones": [{"name": "open"}, {"name": "a", "box": [[0, 0, 0], [5.5, 3, 6]], "in": "open"}, {"name": "b", "box": [[7.5, 0, 0], [14, 3, 6]], "in": "open"},
{"name": "c", "box": [[8, 0, 0], [14, 3, 6]], "in": "open"}],
"portals": [{"zones": ["a", "open"], "points": [[5.5, 0, 0], [5.5, 0, 6], [5.5, 3, 6], [5.5, 3, 0]]},
{"zones": ["open", "c"], "points": [[8, 0, 0], [8, 0, 6], [8, 3, 6], [8, 3, 0]]}, {"zones": ["open", "b"], "points": [[7.5, 0, 0], [7.5, 0, 6], [7.5, 3, 6], [7.5, 3, 0]]}]}
EOF

for kind in overlap stray empty nested; do
  measure "$kind" "$work/$kind.json" "$work/random.views" 320x180 --culler none --culler frustum --culler frustum+portal --culler brute --swap 10
  warned=$(grep -c 'warning' "$work/table")
  case $kind in
    overlap | nested) true_that "$kind: a warning" "$warned > 0" ;;
  esac
  is "$kind: brute draws what frustum does" "$(counter "$json" polygons_drawn | sed -n '2p;4p' | sort -u | wc -l)" 1
  true_that "$kind: movers are seen" "$(counter "$json" movers_visible | head -n 1) > 0"
done
finish
