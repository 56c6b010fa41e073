#!/bin/sh
# The curve of time against error: a point for each value and baseline, in JSON and as a plot; a series without a place for the value
# is refused.
# usage: curve.sh PORTCULLIS CURVE_SCRIPT TWO_ROOMS TEST_PLUGINS
# SPDX-License-Identifier: MIT
portcullis=$1
script=$2
rooms=$3
PORTCULLIS_PLUGIN_PATH=$4
VALUES='16 256' BASELINES='none brute' BENCH_OPTIONS='--size 160x90 --repeat 1 --no-truth'
export PORTCULLIS_PLUGIN_PATH VALUES BASELINES BENCH_OPTIONS
. "$(dirname "$0")/counters.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

"$portcullis" bench "$rooms" --views path:walk --size 16x16 --repeat 1 --culler none >/dev/null 2>&1
[ "$?" -ne 3 ] || skip "no OpenGL"
sh "$script" "$portcullis" "$work/out" "$rooms" path:walk 'far & near:testpicture[pixels=@,distance=3]' 'a "near" one:testpicture[pixels=@,distance=0.5]'
is 'exit code' "$?" 0
is 'points: two baselines, and two series of two values' "$(grep -c '"series"' "$work/out.json")" 6
is 'values' "$(sed -n 's/.*"value": \([^,]*\),.*/\1/p' "$work/out.json" | tr '\n' ' ')" 'null null 16 256 16 256 '
is 'the first is what times are divided by' "$(grep '"chain": "none"' "$work/out.json" | grep -c '"total_ms_by_first": 1}')" 1
is 'baselines have no error' "$(grep '"value": null' "$work/out.json" | grep -c '"flip": 0,.*"crack_pixels": 0,.*"popping": 0,')" 2
is 'points with an error are plotted, beside one for each series that names it' "$(($(grep -c 'class="point"' "$work/out.svg") - 2))" "$(grep -v '"value": null' "$work/out.json" | grep '"series"' | grep -vc '"flip": 0,')"
true_that 'some are' "$(grep -c 'class="point"' "$work/out.svg") - 2 >= 2"
is 'labels are escaped' "$(grep -c '>far &amp; near<' "$work/out.svg") $(grep -c 'a \\"near\\" one' "$work/out.json")" '1 2'
is 'the plot is closed' "$(tail -n 1 "$work/out.svg")" '</svg>'
sh "$script" "$portcullis" "$work/bad" "$rooms" path:walk 'no place:testpicture' 2>/dev/null
is 'a series without @ is refused' "$?" 2
sh "$script" "$portcullis" 2>/dev/null
is 'too few words are refused' "$?" 2
[ ! -e "$work/bad.json" ]
is 'and leave nothing' "$?" 0
finish
