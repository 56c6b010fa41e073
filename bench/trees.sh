#!/bin/sh
# The trees of the culler bsp by choose= and split=: nodes, depth, splits, how long they take to build and to walk, over maps as one zone and
# with automatic rooms; and how building grows over generated mazes, each as one zone of walls.
# usage: trees.sh PORTCULLIS SCENES [VIEWS] [REPEATS] [BUILDS]    SCENES: quake/, librequake/
# SPDX-License-Identifier: MIT
set -eu
portcullis=$1 scenes=$2 views=${3:-100} repeats=${4:-9} builds=${5:-5}
maps="quake/dm4 quake/e1m1 quake/e3m5 librequake/lq_e3m4"
ways="balance sah first"
rooms="20 60 200 620 1720" # of mazes: 946 to 98,466 polygons
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# JSON of the bench on stdin: of each strategy, in order, the values of the named keys on a line; - where it has none.
values() {
    awk -v keys="$*" '
    BEGIN { n = split(keys, wanted, " ") }
    /"run_name"/ { rows++ }
    rows { line = $0; gsub(/[",]/, "", line); split(line, part, /: */); gsub(/ /, "", part[1]); value[rows, part[1]] = part[2] }
    END { for (r = 1; r <= rows; r++) { row = ""; for (k = 1; k <= n; k++) row = row " " ((r, wanted[k]) in value ? value[r, wanted[k]] : "-"); print row } }'
}

bench() { # SCENE VIEWS OUTPUT ARGUMENTS...
    scene=$1 path=$2 output=$3
    shift 3
    "$portcullis" bench "$scene" --no-truth --no-movers --views "auto:$path" --json="$output" "$@" > "$work/log" 2> "$work/errors" || { cat "$work/errors" >&2; exit 1; }
}

# SCENE CULLERS...: a line each to $work/built: median and least milliseconds of $builds builds, which take turns
build_times() {
    scene=$1
    shift
    rm -f "$work"/ms.*
    i=0
    while [ "$i" -lt "$builds" ]; do
        bench "$scene" 1 "$work/json" --repeat 1 "$@"
        values build_ms < "$work/json" > "$work/ms.$i"
        i=$((i + 1))
    done
    paste -d ' ' "$work"/ms.* | awk '{
        n = split($0, t, " ")
        for (i = 2; i <= n; i++) for (k = i; k > 1 && t[k] + 0 < t[k - 1] + 0; k--) { swap = t[k]; t[k] = t[k - 1]; t[k - 1] = swap }
        print t[int((n + 1) / 2)], t[1]
    }' > "$work/built"
}

# NAME SCENE KEYS LABELS CULLERS...: KEYS of the bench behind its labels, then build and cull times; LABELS a file of one line each
table() {
    name=$1 scene=$2 keys=$3 labels=$4
    shift 4
    build_times "$scene" "$@"
    bench "$scene" "$views" "$work/json" --repeat "$repeats" "$@"
    # shellcheck disable=SC2086
    values $keys cull_ns_mean cull_ns_p99 < "$work/json" > "$work/values"
    paste -d ' ' "$labels" "$work/values" "$work/built" | awk -v name="$name" '
        { m = NF - 3; line = sprintf("%-8s %-5s %-8s", name, $1, $2); for (k = 3; k < m; k++) line = line sprintf(" %8s", $k ~ /\./ ? sprintf("%.1f", $k) : $k) }
        $2 == "balance" { build = $(m + 2); cull = $m }
        { printf "%s %9.2f %8.2f %8.2f %8.2f %8.2f\n", line, $(m + 2), $(m + 2) / build, $m / 1e3, $(m + 1) / 1e3, $m / cull }'
}

# A maze's mesh as walls of one zone
walls_of() {
    awk '
    $1 == "v" { point[++points] = $2 ", " $3 ", " $4 }
    $1 == "f" {
        row = ""
        for (i = 2; i <= NF; i++) { split($i, part, "/"); row = row (i > 2 ? ", [" : "[") point[part[1]] "]" }
        printf "%s{\"points\": [%s]}", walls++ ? ",\n" : "{\"portcullis\": 1, \"walls\": [\n", row
    }
    END { print "\n]}" }' "$1"
}

: > "$work/split_labels"
set --
for split in 0 1 node; do
    for way in $ways; do
        echo "$split $way" >> "$work/split_labels"
        set -- "$@" --culler "bsp[backface=1,split=$split,choose=$way]"
    done
done
echo "## Maps as one zone (--portals none): bsp[backface=1,split=,choose=]"
echo "map      split choose   polygons    nodes    depth   splits listings    drawn  build_ms /balance  cull_us   p99_us /balance"
for map in $maps; do
    [ -f "$scenes/$map.map" ] || { echo "skipped: $scenes/$map.map is not there" >&2; exit 77; }
    "$portcullis" compile "$scenes/$map.map" --portals none -o "$work/${map##*/}.pcs" > "$work/log"
    table "${map##*/}" "$work/${map##*/}.pcs" "polygons_total bsp.nodes bsp.depth bsp.splits bsp.listings polygons_drawn" "$work/split_labels" "$@"
done

: > "$work/room_labels"
set --
for cells in off hull; do
    for way in $ways; do
        echo "$cells $way" >> "$work/room_labels"
        set -- "$@" --culler "bsp[backface=1,cells=$cells,choose=$way]+portal"
    done
done
echo
echo "## Maps with rooms (--portals auto): bsp[backface=1,cells=,choose=]+portal"
echo "map      cells choose   polygons    nodes    depth   splits    cells    drawn  build_ms /balance  cull_us   p99_us /balance"
for map in $maps; do
    "$portcullis" compile "$scenes/$map.map" --portals auto -o "$work/auto.pcs" > "$work/log"
    table "${map##*/}" "$work/auto.pcs" "polygons_total bsp.nodes bsp.depth bsp.splits bsp.cells polygons_drawn" "$work/room_labels" "$@"
done

set --
for way in $ways; do set -- "$@" --culler "bsp[backface=1,choose=$way]"; done
echo
echo "## Mazes as one zone: growth of building, split=0"
echo "rooms    choose   polygons    nodes    depth   splits  build_ms  least_ms  ns/(n*log2(n))"
: > "$work/growth"
for size in $rooms; do
    "$portcullis" generate maze --size "$size" -o "$work/maze.json" > "$work/log"
    walls_of "$work/maze.obj" > "$work/walls.json"
    build_times "$work/walls.json" "$@"
    values polygons_total bsp.nodes bsp.depth bsp.splits < "$work/json" > "$work/values"
    echo "$ways" | tr ' ' '\n' | paste -d ' ' - "$work/values" "$work/built" | awk -v size="$size" '{ $1 = size " " $1; print }' >> "$work/growth"
done
awk '
{
    printf "%-8s %-8s %8d %8d %8d %8d %9.2f %9.2f %9.1f\n", $1, $2, $3, $4, $5, $6, $7, $8, $8 * 1e6 / ($3 * log($3) / log(2))
    if (!($2 in n)) order[++ways] = $2
    n[$2]++; x = log($3); y = log($8); z = log($3 * log($3))
    sx[$2] += x; sy[$2] += y; sxx[$2] += x * x; sxy[$2] += x * y
    rn++; rx += x; ry += z; rxx += x * x; rxy += x * z
}
END {
    printf "fitted exponent of the least build time by polygons:"
    for (i = 1; i <= ways; i++) { w = order[i]; printf " %s %.3f,", w, (n[w] * sxy[w] - sx[w] * sy[w]) / (n[w] * sxx[w] - sx[w] * sx[w]) }
    printf " n log n itself %.3f\n", (rn * rxy - rx * ry) / (rn * rxx - rx * rx)
}' "$work/growth"
