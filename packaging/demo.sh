#!/bin/sh
# The demo behind `./run demo`: the project's two scenes measured and drawn. Run from the root of the tree.
# SPDX-License-Identifier: MIT
# usage: demo.sh PORTCULLIS OUT
set -eu
portcullis=$1
out=$2

say() { printf 'run: %s\n' "$*" >&2; }

# measure TABLE JSON SCENE VIEWS OPTION...
measure() {
    table=$1 json=$2 scene=$3 views=$4
    shift 4
    status=0
    "$portcullis" bench "$scene" --views "$views" "$@" --json "$out/$json" >"$out/$table" || status=$?
    cat "$out/$table"
    [ "$status" = 0 ] || { say "error: the bench ended with $status; its lines are above"; exit "$status"; }
}

# views_of_zones SCENE VIEWS NAMES: a view a zone. The generator writes a zone and an eye of the tour a line: in each room, of the eyes that the tour has
# there, the one farthest from its middle, looking to the middle.
views_of_zones() {
    awk -v views="$2" -v names="$3" '
        function look(name, x, y, z, dx, dy, dz) {
            printf "%s %s %s %s %s %s 0 1 0 75 1.7777777777777777 0.0625 1000\n", x, y, z, dx, dy, dz >views
            print name >names
        }
        /^{"name": .*"box": \[/ {
            name = $0; sub(/^{"name": "/, "", name); sub(/".*/, "", name)
            line = $0; sub(/.*"box": /, "", line); sub(/"in".*/, "", line); gsub(/[^-0-9.e]+/, " ", line); split(line, b, " ")
            if (name == "street") next
            n++; zone[n] = name; best[n] = -1
            for (k = 1; k <= 6; k++) box[n, k] = b[k] + 0
        }
        /^{"name": "tour"/ { tour = 1; next }
        tour && /^{"eye"/ {
            gsub(/"[a-z]+"/, ""); gsub(/[^-0-9.e]+/, " "); split($0, e, " ")
            for (i = 1; i <= n; i++) {
                if (e[1] < box[i, 1] || e[1] > box[i, 4] || e[2] < box[i, 2] || e[2] > box[i, 5] || e[3] < box[i, 3] || e[3] > box[i, 6]) continue
                dx = (box[i, 1] + box[i, 4]) / 2 - e[1]; dz = (box[i, 3] + box[i, 6]) / 2 - e[3]; far = dx * dx + dz * dz
                if (far > best[i]) { best[i] = far; for (k = 1; k <= 3; k++) eye[i, k] = e[k]; to[i, 1] = dx; to[i, 2] = dz }
            }
        }
        END {
            look("outside", -100, 12, 24, 1, -0.1, -0.15)
            look("street", -34, 1.7, 1, 1, 0.02, -0.05)
            for (i = 1; i <= n; i++)
                if (best[i] > 0.01) look(zone[i], eye[i, 1], eye[i, 2], eye[i, 3], to[i, 1], -0.15 * sqrt(best[i]), to[i, 2])
                else look(zone[i], (box[i, 1] + box[i, 4]) / 2, box[i, 2] + 1.7, (box[i, 3] + box[i, 6]) / 2, 1, 0, 0)
        }' "$1"
}

rm -rf "$out"
mkdir -p "$out/zones"

# A museum in one zone.
"$portcullis" generate demo -o "$out/demo.obj"
measure table.txt bench.json "$out/demo.obj" "$out/demo.views" --culler none --culler brute --culler frustum --images "$out"
"$portcullis" render "$out/demo.obj" --views "$out/demo.views" --view 98 --culler frustum -o "$out/demo.png"

# The flagship: hills and woods, a street of houses, each room a zone. `scene` is the chains that its file names, the other rows have one for all
# zones; in the last one each zone goes through all of them.
"$portcullis" generate flagship --size 600 -o "$out/flagship.json"
"$portcullis" generate views --scene "$out/flagship.json" --views path:walk -o "$out/flagship.views"
awk 'int((NR - 1) / 10) % 12 == 0' "$out/flagship.views" >"$out/flagship_parts.views"
measure flagship_table.txt flagship_bench.json "$out/flagship.json" "$out/flagship_parts.views" --size 640x360 --repeat 1 --culler scene --culler frustum \
    --culler bsp+portal --culler octree+occlusion --culler imagecache --swap 10
for view in 60 312 600; do # from the walk
    "$portcullis" render "$out/flagship.json" --views path:walk --view "$view" --culler scene -o "$out/flagship_$view.png"
done
views_of_zones "$out/flagship.json" "$out/zones.views" "$out/zones.txt"
view=0
while read -r zone; do
    "$portcullis" render "$out/flagship.json" --views "$out/zones.views" --view "$view" --size 480x270 --culler scene -o "$out/zones/$zone.png"
    view=$((view + 1))
done <"$out/zones.txt"

say "written to $(pwd)/$out:"
(cd "$out" && find . -type f | sort | sed 's|^\./|  |') >&2
