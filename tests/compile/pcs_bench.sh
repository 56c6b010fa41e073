#!/bin/sh
# A scene file measures as its source does: the bench's counters, zones, pictures' worth, all but the times.
# usage: pcs_bench.sh PORTCULLIS PCS_MAKE TWO_ROOMS
# SPDX-License-Identifier: MIT
portcullis=$1
make=$2
rooms=$3
. "$(dirname "$0")/../bench/counters.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
scenes=${PORTCULLIS_SCENES:-none}

measured() { # SCENE OUT VIEWS: what the bench says of it, without times
  "$portcullis" bench "$1" --views "$3" --size 320x180 --repeat 1 --culler frustum --culler scene --json "$work/json" >"$work/table" 2>&1
  code=$?
  [ "$code" -ne 3 ] || skip "no OpenGL"
  [ "$code" -eq 0 ] || cat "$work/table"
  grep -vE '"(date|real_time|cpu_time|[a-z_]*_(ns|ms)[a-z0-9_]*)"|^ *[0-9.]+,?$' "$work/json" >"$2"
}

both() { # SCENE VIEWS
  name=$(basename "$1")
  "$make" "$1" "$work/${name%.*}.pcs" || failed=$((failed + 1))
  measured "$1" "$work/source" "$2"
  is "$name, exit code" "$code" 0
  measured "$work/${name%.*}.pcs" "$work/compiled" "$2"
  is "$name compiled, exit code" "$code" 0
  true_that "$name has counters" "$(wc -l <"$work/source") > 60"
  is "$name, both alike" "$(diff "$work/source" "$work/compiled")" ""
  "$portcullis" info "$1" | grep -v '^bytes ' >"$work/source"
  for doors in open shut; do # its doors stay as they are in the file
    "$portcullis" info "$work/${name%.*}.pcs" --doors "$doors" | grep -v '^bytes ' >"$work/compiled"
    is "info $name, --doors $doors" "$(diff "$work/source" "$work/compiled")" ""
  done
}

both "$rooms" path:walk
if [ -d "$scenes" ]; then
  both "$scenes/quake/dm4.map" auto:8
  both "$scenes/librequake/lqdm12.map" auto:walk:8
  both "$scenes/models/cow.obj" auto:4
else
  echo "SKIPPED: real scenes; PORTCULLIS_SCENES names no folder"
fi
finish
