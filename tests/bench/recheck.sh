#!/bin/sh
# The committed long results still hold: one of their scenes, chosen by the commit's hash, is measured again in full.
# usage: recheck.sh PORTCULLIS RESULTS ROOT
# SPDX-License-Identifier: MIT
portcullis=$1
results=$2
root=$3
scenes=${PORTCULLIS_SCENES:-}
. "$(dirname "$0")/counters.sh"
[ -d "$scenes" ] || skip "no folder of real scenes; set PORTCULLIS_SCENES"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
count=$(grep -c ' visible, frustum draws ' "$results")
hash=$(git -C "$root" rev-parse HEAD 2>/dev/null | cut -c1-6)
[ "$count" -gt 0 ] || skip "no results in $results"
pick=$((0x${hash:-0} % count + 1))
line=$(grep ' visible, frustum draws ' "$results" | sed -n "${pick}p")
# shellcheck disable=SC2086 # words of the line
set -- $line
echo "again: $line"
scene=$(find "$scenes" -name "$1" | head -n 1)
[ -f "$scene" ] || skip "no $1 in PORTCULLIS_SCENES"
"$portcullis" bench "$scene" --views "$2" --size "$3" --repeat 1 --culler frustum --json "$work/out.json" >/dev/null 2>&1
code=$?
[ "$code" -ne 3 ] || skip "no OpenGL"
is 'exit code' "$code" 0
is 'missed pixels' "$(same "$work/out.json" missed_pixels)" 0
# Another driver may round a corner of a pixel otherwise; what is culled may not differ at all.
true_that 'polygons visible' "$(same "$work/out.json" polygons_visible) / $4 > 0.999 && $(same "$work/out.json" polygons_visible) / $4 < 1.001"
is 'polygons drawn' "$(same "$work/out.json" polygons_drawn)" "$8"
finish
