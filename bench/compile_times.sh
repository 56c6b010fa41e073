#!/bin/sh
# CPU time, memory and growth of the scene compiler over maps, beside the goals and what published compilers were measured at.
# usage: compile_times.sh PORTCULLIS TILE_MAP SCENES [RUNS]    TILE_MAP: the program of tests/compile; SCENES: quake/, librequake/
# SPDX-License-Identifier: MIT
set -eu
portcullis=$1 tile_map=$2 scenes=$3 runs=${4:-5}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

brushes_of() { # braces within braces
    awk '$1 == "{" { if (++depth == 2) n++ } $1 == "}" { depth-- } END { print n + 0 }' "$1"
}

field() { # NAME FILE, of a flat JSON object
    sed -n "s/^ *\"$1\": *\([0-9.e+-]*\),*\$/\1/p" "$2"
}

measure() { # NAME MAP, a line: name brushes median_ms least_ms peak_mb zones leak
    : > "$work/times"
    i=0
    while [ "$i" -lt "$runs" ]; do
        "$portcullis" compile "$2" -o "$work/out.pcs" --json > "$work/json" 2> "$work/errors" || { cat "$work/errors" >&2; exit 1; }
        field cpu_ms "$work/json" >> "$work/times"
        i=$((i + 1))
    done
    sort -g "$work/times" | awk -v name="$1" -v brushes="$(brushes_of "$2")" -v peak="$(field peak_bytes "$work/json")" \
        -v zones="$(field zones "$work/json")" -v leak="$(field leak "$work/json")" \
        '{ t[NR] = $1 } END { print name, brushes, t[int((NR + 1) / 2)], t[1], peak / 1e6, zones, leak }'
}

for map in librequake/lqdm12 quake/dm4 quake/e1m1 librequake/lqdm7 quake/e1m4 librequake/lq_e0m8 quake/e3m5 librequake/lq_e3m4; do
    [ -f "$scenes/$map.map" ] || { echo "skipped: $scenes/$map.map is not there" >&2; exit 77; }
    measure "${map##*/}" "$scenes/$map.map" >> "$work/rows"
done
"$tile_map" "$scenes/librequake/lq_e3m4.map" 4 "$work/tiled.map"
measure 16xlq_e3m4 "$work/tiled.map" >> "$work/rows"

awk -v runs="$runs" '
BEGIN {
    split("dm4 0.12 0.06 0.30 0.179 e1m1 0.45 0.23 0.59 0.357 e3m5 0.6 0.31 1.19 -", p, " ")
    for (i = 1; i <= 15; i += 5) beside[p[i]] = sprintf("%8s %8s %8s %8s", p[i + 1], p[i + 2], p[i + 3], p[i + 4])
    printf "CPU seconds of all stages, one thread, of %d runs; beside them the goal, the stretch (a published compiler, hull 0), its\n", runs
    print "successor, and a union of the brushes alone by a mesh library, as published measurements had them on another machine"
    printf "%-12s %8s %8s %8s %8s %6s %5s %8s %8s %8s %8s\n", "map", "brushes", "median", "least", "peak MB", "zones", "leak", "goal", "stretch", "newer", "union"
}
function add(s, x, y) { n[s]++; sx[s] += x; sy[s] += y; sxx[s] += x * x; sxy[s] += x * y }
function slope(s) { return (n[s] * sxy[s] - sx[s] * sy[s]) / (n[s] * sxx[s] - sx[s] * sx[s]) }
{
    printf "%-12s %8d %8.4f %8.4f %8.1f %6d %5d %s\n", $1, $2, $3 / 1000, $4 / 1000, $5, $6, $7, beside[$1]
    add("median", log($2), log($3))
    add("least", log($2), log($4))
    if ($1 ~ /lq_e3m4/) { add("tiling", log($2), log($3)); add("tiling least", log($2), log($4)) }
}
END {
    printf "fitted exponent of CPU against brushes, least squares of the logarithms: median %.3f, least %.3f (goal 1.25 at most)\n", slope("median"), slope("least")
    printf "from one copy to 16: median %.3f, least %.3f\n", slope("tiling"), slope("tiling least")
}' "$work/rows"
