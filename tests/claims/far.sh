#!/bin/sh
# The flagship, rooms and a maze 1 km, 100 km and 10,000 km from the origin: the same zones, pictures equal in 99.99% of
# pixels, nothing missed, no pixel of a closed scene that shows nothing.
# usage: far.sh PORTCULLIS TEST_PLUGINS COMPARE_FAR
# SPDX-License-Identifier: MIT
portcullis=$1
. "$(dirname "$0")/common.sh"
export PORTCULLIS_PLUGIN_PATH="$2"
compare_far=$3

move() { # KIND SIZE open|closed STEP STEP_OF_TRUTH
  generated "$1" "$2"
  near=$1$2.json
  for metres in 1000 100000 10000000; do
    far=$work/far.json
    printf '{"portcullis": 1, "include": [{"file": "%s", "at": [%s, 0, -%s]}]}\n' "$near" "$metres" "$metres" >"$far"
    printf '# %s at %s m: ' "$near" "$metres"
    "$compare_far" "$work/$near" "$far" "$metres" 0 "-$metres" "$4" "$3"
    code=$?
    [ "$code" -ne 77 ] || skip "no OpenGL"
    is "$near, $metres m: zones, pictures, cracks" "$code" 0
    every "$5" "$work/$near" walk
    awk -v by="$metres" '{ $1 = sprintf("%.6f", $1 + by); $3 = sprintf("%.6f", $3 - by); print }' "$work/walk.views" >"$work/far.views"
    measure "$near, $metres m" "$far" "$work/far.views" 320x180 --culler scene --culler frustum+portal --culler none --swap 10
  done
}

if [ -n "${PORTCULLIS_LONG:-}" ]; then
  move flagship '' open 1 4
  move rooms 64 closed 1 4
  move maze 100 closed 1 4
else
  move flagship '' open 65 90
  move rooms 64 closed 50 60
  move maze 100 closed 50 60
fi
finish
