#!/bin/sh
# Several builds of the command write the same scene files, byte for byte. usage: same_bytes.sh ROOT WORK all|few PORTCULLIS...
# SPDX-License-Identifier: MIT
set -eu
root=$1
work=$2
which=$3
shift 3
for portcullis; do
    [ -x "$portcullis" ] || { echo "skipped: no $portcullis; the test that builds it has not run"; exit 77; }
done
mkdir -p "$work"
scenes=${PORTCULLIS_SCENES:-$root/../shared/scenes}
[ -d "$scenes" ] || echo "SKIPPED: real maps; PORTCULLIS_SCENES names no folder"
compared=0
failed=0

compare() { # SCENE OPTIONS...
    scene=$1
    number=0
    shift
    for portcullis in $builds; do
        number=$((number + 1))
        "$portcullis" compile "$scene" -o "$work/$number.pcs" "$@" >"$work/words" 2>&1 || { echo "FAILED $portcullis: $scene $*"; cat "$work/words"; exit 1; }
        if [ "$number" -eq 1 ]; then continue; fi
        if cmp "$work/1.pcs" "$work/$number.pcs"; then compared=$((compared + 1)); else
            printf 'FAILED %s %s: %s writes other bytes\n' "$scene" "$*" "$portcullis"
            failed=1
        fi
    done
}

builds=$*
case $which in
few) set -- "$scenes/quake/dm4.map" "$scenes/librequake/lqdm7.map" "$root"/scenes/*.json ;;
*) set -- "$scenes"/*/*.map "$root"/scenes/*.json ;;
esac
for each; do
    case $each in
    *.json) grep -q '"brushes"' "$each" || continue ;;
    esac
    [ -f "$each" ] || continue
    compare "$each"
    [ "$which" = few ] || compare "$each" --portals none
    [ "$which" = few ] || compare "$each" --portals authored --grid 64 --bake frustum
done
rm -f "$work"/*.pcs
[ "$compared" -gt 0 ] || { echo "FAILED: no scene was compiled"; exit 1; }
printf '%s files compared\n' "$compared"
exit "$failed"
