#!/bin/sh
# delft moved by (85000, 0, 446000) m: the same pictures in 99.99% of pixels, 570 objects. usage: far_city.sh PORTCULLIS COMPARE
# SPDX-License-Identifier: MIT
portcullis=$1
compare=$2
city=${PORTCULLIS_SCENES:-}/city/delft.obj
. "$(dirname "$0")/counters.sh"
[ -f "$city" ] || skip "no city/delft.obj in PORTCULLIS_SCENES"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
# The sums are exact: three decimals in, three out.
awk '$1 == "v" { printf "v %.3f %s %.3f\n", $2 + 85000, $3, $4 + 446000; next } { print }' "$city" >"$work/far.obj"
is 'objects' "$("$portcullis" info "$work/far.obj" --json | sed -n 's/.*"objects": \([0-9]*\).*/\1/p')" 570
is 'objects at home' "$("$portcullis" info "$city" --json | sed -n 's/.*"objects": \([0-9]*\).*/\1/p')" 570
"$compare" "$city" "$work/far.obj" 85000 0 446000
code=$?
[ "$code" -ne 77 ] || skip "no OpenGL"
is 'id pictures' "$code" 0
finish
