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

rm -rf "$out"
mkdir -p "$out"

# A museum in one zone.
"$portcullis" generate demo -o "$out/demo.obj"
measure table.txt bench.json "$out/demo.obj" "$out/demo.views" --culler none --culler brute --culler frustum --images "$out"
"$portcullis" render "$out/demo.obj" --views "$out/demo.views" --view 98 --culler frustum -o "$out/demo.png"

# The flagship: a street of houses, each room a zone; `scene` is the chains that its file names.
"$portcullis" generate flagship -o "$out/flagship.json"
measure flagship_table.txt flagship_bench.json "$out/flagship.json" path:walk --size 320x180 --culler none --culler frustum --culler scene
for view in 60 312 600; do # the street, the cellar, over the roofs
    "$portcullis" render "$out/flagship.json" --views path:walk --view "$view" --culler scene -o "$out/flagship_$view.png"
done

say "written to $(pwd)/$out:"
(cd "$out" && find . -type f | sort | sed 's|^\./|  |') >&2
