#!/bin/sh
# Bad input for a tree of walls: 10,000 polygons in one place, corners in one line, slivers, zones without polygons, portals of no area:
# a clear line that names the place, or drawn and nothing lost.
# usage: indoor_bad.sh PORTCULLIS TEST_PLUGINS
# SPDX-License-Identifier: MIT
portcullis=$1
. "$(dirname "$0")/common.sh"
export PORTCULLIS_PLUGIN_PATH="$2"

bench_all() { # NAME FILE
  measure "$1" "$2" path:look 160x90 --culler 'frustum[backface=1]+portal' --culler 'bsp[backface=1]+portal' --culler 'bsp[backface=1,split=1]+portal' \
    --culler 'bsp[backface=1,split=node]+portal' --culler 'bsp[backface=1,choose=sah]+portal' --culler 'bsp[backface=1,choose=first]+portal' \
    --culler 'bsp[backface=1,cells=rect]+portal' --culler 'bsp[backface=1,cells=hull]+portal' --culler 'bsp[backface=1,cells=exact]+portal'
}

refused() { # NAME FILE WORDS_OF_THE_MESSAGE
  "$portcullis" bench "$2" --views path:look --size 160x90 --repeat 1 --culler bsp+portal >"$work/out" 2>"$work/errors"
  is "$1: exit code" $? 2
  cat "$work/errors"
  is "$1: one line" "$(wc -l <"$work/errors")" 1
  true_that "$1: says '$3'" "$(grep -c "$3" "$work/errors") > 0"
}

# Two rooms and what is wrong with them. $1: walls, $2: more portals, $3: more zones
scene() {
  cat <<END
{"portcullis": 1,
 "boxes": [{"min": [0, 0, 0], "max": [4, 3, 4], "side": "in", "omit": ["+x"]}, {"min": [4, 0, 0], "max": [8, 3, 4], "side": "in", "omit": ["-x"]}],
 "walls": [{"points": [[1, 1, 1], [2, 1, 1], [2, 2, 1], [1, 2, 1]]}$1],
 "zones": [{"name": "left", "box": [[0, 0, 0], [4, 3, 4]]}, {"name": "right", "box": [[4, 0, 0], [8, 3, 4]]}$3],
 "portals": [{"zones": ["left", "right"], "points": [[4, 0, 0], [4, 0, 4], [4, 3, 4], [4, 3, 0]]}$2],
 "paths": [{"name": "look", "views": [{"eye": [0.5, 1.5, 3.5], "forward": [1, 0, -0.5]}, {"eye": [7.5, 1.2, 2], "forward": [-1, 0, 0]}, {"eye": [4, 1.5, 2], "forward": [-1, 0, -0.3]},
   {"eye": [3.5, 1.5, 1], "forward": [-1, 0, 0]}]}]}
END
}

walls() { awk -v n="$1" -v shape="$2" 'BEGIN { for (i = 0; i < n; i++) printf ", {\"points\": [%s]}\n", shape }'; }

scene "$(walls 10000 '[6, 1, 1], [6, 1, 2], [6, 2, 2], [6, 2, 1]')" >"$work/coincident.json"
bench_all 'ten thousand polygons in one place' "$work/coincident.json"
scene "$(walls 2000 '[6, 1, 1], [6, 1, 2], [6, 2, 2], [6, 2, 1]')$(walls 2000 '[6, 1, 1], [6, 2, 1], [6, 2, 2], [6, 1, 2]')" >"$work/backs.json"
bench_all 'polygons back to back' "$work/backs.json"
scene "$(awk 'BEGIN { for (i = 0; i < 300; i++) { a = i * 0.0209; printf ", {\"points\": [[6, 0.5, 2], [%.6f, 0.5, %.6f], [%.6f, 2.5, %.6f], [6, 2.5, 2]]}\n", 6 + cos(a), 2 + sin(a), 6 + cos(a), 2 + sin(a) } }')" >"$work/fan.json"
bench_all 'three hundred walls about one line' "$work/fan.json"
scene "$(awk 'BEGIN { for (i = 0; i < 200; i++) printf ", {\"points\": [[5, 1, %.7f], [7, 1, %.7f], [7, 1.5, %.7f]]}\n", 1 + i * 1e-6, 1 + i * 1e-6, 1 + i * 1e-6 }')" >"$work/close.json"
bench_all 'planes a micrometre apart' "$work/close.json"
scene ', {"points": [[5, 1, 1], [7, 1, 1], [7, 1.0001, 1]]}, {"points": [[5, 2, 1], [6, 2.0001, 1], [7, 2, 1]]}' >"$work/slivers.json"
bench_all 'slivers' "$work/slivers.json"
scene '' '' ', {"name": "empty", "box": [[8, 0, 0], [12, 3, 4]]}' >"$work/empty.json"
bench_all 'a zone without polygons' "$work/empty.json"
scene ', {"points": [[5, 1, 1], [6, 1, 1], [7, 1, 1]]}' >"$work/line.json"
refused 'three points in one line' "$work/line.json" '/walls/1'
scene '' ', {"zones": ["left", "right"], "points": [[4, 1, 1], [4, 1, 2], [4, 1, 3]]}' >"$work/portal.json"
refused 'a portal without area' "$work/portal.json" '/portals/1'
scene '' ', {"zones": ["left", "right"], "points": [[4, 1, 1], [4, 1.0000001, 1], [4, 1, 1.0000001]]}' >"$work/small.json"
refused 'a portal smaller than the precision' "$work/small.json" 'portal'
finish
