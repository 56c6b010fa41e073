#!/bin/sh
# What each clip= of the culler portal saves and costs, over maps with automatic rooms; and plain frustum on the same maps as one zone.
# usage: clips.sh PORTCULLIS SCENES [VIEWS] [REPEATS]    SCENES: quake/, librequake/
# SPDX-License-Identifier: MIT
set -eu
portcullis=$1 scenes=$2 views=${3:-200} repeats=${4:-9}
maps="librequake/lqdm12 quake/dm4 quake/e1m1 librequake/lqdm7 quake/e1m4 librequake/lq_e0m8 quake/e3m5 librequake/lq_e3m4"
clips="exact octagon rect planes flood"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# JSON of the bench on stdin: of each strategy, in order, the values of the named keys on a line.
values() {
    awk -v keys="$*" '
    BEGIN { n = split(keys, wanted, " ") }
    /"run_name"/ { rows++ }
    rows { line = $0; gsub(/[",]/, "", line); split(line, part, /: */); gsub(/ /, "", part[1]); value[rows, part[1]] = part[2] }
    END { for (r = 1; r <= rows; r++) { row = ""; for (k = 1; k <= n; k++) row = row " " value[r, wanted[k]]; print row } }'
}

bench() { # SCENE OUTPUT ARGUMENTS...: 1 only says that something was missed, which the table shows
    scene=$1 output=$2
    shift 2
    "$portcullis" bench "$scene" --views "auto:$views" --size 1280x720 --json="$output" "$@" > "$work/log" 2> "$work/errors" || [ $? -eq 1 ] || { cat "$work/errors" >&2; exit 1; }
}

set --
for clip in $clips; do set -- "$@" --culler "frustum[backface=1]+portal[clip=$clip]"; done
echo "map       portals clip      drawn  excess  hard  missed   volumes  mean_us  p99_us  time/exact  total_ms  total/one_zone"
for map in $maps; do
    [ -f "$scenes/$map.map" ] || { echo "skipped: $scenes/$map.map is not there" >&2; exit 77; }
    name=${map##*/}
    "$portcullis" compile "$scenes/$map.map" --portals auto -o "$work/rooms.pcs" > "$work/log"
    "$portcullis" compile "$scenes/$map.map" --portals none -o "$work/one.pcs" > "$work/log"
    bench "$work/rooms.pcs" "$work/warm" --no-truth --repeat "$repeats" "$@"
    bench "$work/rooms.pcs" "$work/drawn" --repeat 3 "$@"
    bench "$work/one.pcs" "$work/one" --repeat 3 --culler 'frustum[backface=1]'
    portals=$(sed -n '/"context"/,/}/s/^ *"portals": *\([0-9]*\),*$/\1/p' "$work/warm")
    one=$(values total_ms < "$work/one")
    echo "$clips" | tr ' ' '\n' > "$work/names"
    values polygons_drawn excess hard_excess missed_pixels volumes total_ms < "$work/drawn" > "$work/a"
    values cull_ns_mean cull_ns_p99 < "$work/warm" > "$work/b"
    paste -d ' ' "$work/names" "$work/a" "$work/b" | awk -v name="$name" -v portals="$portals" -v one="$one" '
        NR == 1 { exact = $8 }
        { printf "%-10s %5d %-8s %6.1f %7.3f %6.3f %6d %8.2f %8.2f %7.2f %10.2f %9.2f %11.3f\n", name, portals, $1, $2, $3, $4, $5, $6, $8 / 1e3, $9 / 1e3, $8 / exact, $7, $7 / one }'
done
