#!/bin/sh
# Pictures beside full geometry: nothing differs where everything is drawn; what a picture of few pixels shows, from where it no
# longer fits, is told by every metric, in table, JSON, CSV and images, as the same numbers each time.
# usage: pictures.sh PORTCULLIS TWO_ROOMS TEST_PLUGINS
# SPDX-License-Identifier: MIT
portcullis=$1
rooms=$2
PORTCULLIS_PLUGIN_PATH=$3
export PORTCULLIS_PLUGIN_PATH
. "$(dirname "$0")/counters.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
coarse='testpicture[pixels=32,distance=3]' fine='testpicture[pixels=512,distance=0.2]'

run() { # NAME words: options. The results go to $json, the exit code to $code
  json=$work/$1.json
  shift
  "$portcullis" bench "$rooms" --size 320x180 --repeat 1 --json "$json" "$@" >"$work/table" 2>&1
  code=$?
  [ "$code" -ne 3 ] || skip "no OpenGL"
  [ "$code" -eq 0 ] || cat "$work/table"
}
row() { counter "$json" "$1" | sed -n "$2p"; } # COUNTER NUMBER

run plain --views path:walk --culler frustum
is 'none shows pictures: nothing is compared' "$(row flip 1) $(row psnr 1) $(row crack_pixels 1)" 'null null null'
is 'and the table has no columns of it' "$(grep -c FLIP "$work/table")" 0
true_that 'percentiles of total_ms stand in order' "$(row total_ms 1) <= $(row total_ms_p95 1) && $(row total_ms_p95 1) <= $(row total_ms_p99 1)"
true_that 'and their mean is theirs' "$(row total_ms_mean 1) > 0 && $(row total_ms_mean 1) <= 1.000001 * $(row total_ms_p99 1)"

run all --views path:walk --culler frustum --culler none --culler "$fine" --culler "$coarse" --pictures --csv "$work/all.csv" --images "$work/images"
is 'exit code' "$code" 0
is 'compared in every view' "$(same "$json" pictures_measured)" 60
for i in 1 2; do
  is "row $i draws everything: no difference" "$(row flip $i) $(row flip_p99 $i) $(row crack_pixels $i)" '0 0 0'
  is "row $i: PSNR stands at its most" "$(row psnr $i)" 100
  is "row $i: nothing pops" "$(row popping $i) $(row popping_p99 $i)" '0 0'
  is "row $i: SSIM" "$(row ssim $i)" 1
  is "row $i: no pictures, no refreshes" "$(row picture_bytes $i) $(row refreshes $i)" '0 0'
done
true_that 'movers are seen' "$(row mover_pixels 1) > 1000"
is 'before and behind the right things' "$(row mover_pixels_wrong 1) $(row mover_pixels_wrong 2)" '0 0'
true_that 'some of what is wrong is so by more than a pixel, of what is right none' "$(row mover_pixels_wrong_far 3) <= $(row mover_pixels_wrong 3) && $(row mover_pixels_wrong_far 2) == 0"
true_that 'behind a picture with few depths seldom wrongly' "$(row mover_pixels_wrong 3) < 0.01 * $(row mover_pixels 3)"
is 'every view but the first follows another' "$(same "$json" popping_views)" 59
true_that 'a coarse picture pops when it is taken anew' "$(row popping 4) > $(row popping 3) && $(row popping_max 4) >= $(row popping_p99 4) && $(row popping_p99 4) >= $(row popping 4)"
true_that 'the 99th percentile stands beside the median' "$(row total_ms_p99_to_p50 1) >= 1"
true_that 'a coarse picture shows' "$(row flip 4) > 0.0005 && $(row flip 4) < 0.5"
true_that 'more than a fine one' "$(row flip 4) > $(row flip 3) && $(row psnr 4) < $(row psnr 3) && $(row ssim 4) < $(row ssim 3)"
true_that 'the worst views are worse than the mean' "$(row flip_p99 4) >= $(row flip 4) && $(row flip_max 4) >= $(row flip_p99 4)"
true_that 'its cracks are seen' "$(row crack_pixels 4) > 0 && $(row crack_inner 4) <= $(row crack_pixels 4)"
true_that 'its pictures are captured' "$(row refreshes 4) > 0 && $(row refreshes 4) < 1"
true_that 'and take memory' "$(row picture_bytes 4) >= 32 * 32 * 2 && $(row picture_bytes 3) > $(row picture_bytes 4)"
is 'the table has columns of it' "$(grep -c 'PSNR *SSIM *FLIP *p99 *cracks' "$work/table")" 1
is 'CSV: a line each, and their names' "$(wc -l <"$work/all.csv" | tr -d ' ')" 5
is 'CSV: as many fields in each; names hold one comma' "$(awk -F, 'NR > 1 { n = NF; gsub(/\[[^]]*\]/, ""); print split($0, part, ",") }' "$work/all.csv" | sort -u)" \
  "$(head -n 1 "$work/all.csv" | awk -F, '{ print NF }')"
is 'CSV: the same value' "$(awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "flip") at = i } NR == 2 { print $at }' "$work/all.csv")" "$(row flip 1)"
view=$(row flip_view 4)
for kind in truth shown flip; do
  [ -s "$work/images/testpicture_pixels_32_distance_3_-$kind-$view.png" ]
  is "the worst view's picture: $kind" $? 0
done
is 'none where nothing differs' "$(ls "$work/images" | grep -c 'frustum-flip')" 0
cp "$json" "$work/first.json"
run again --views path:walk --culler "$fine" --culler "$coarse" --culler frustum
for name in psnr ssim flip flip_p99 popping popping_p99 crack_pixels picture_bytes refreshes; do
  is "the same $name again, unasked, without the others" "$(counter "$json" $name | sed -n 1,2p | tr "\n" " ")" "$(counter "$work/first.json" $name | sed -n 3,4p | tr "\n" " ")"
done
is 'who shows no pictures is not compared unasked' "$(row flip 3)" null

run nothing --views path:walk --culler 'testnothing[promise=0]' --culler none --pictures
true_that 'who draws nothing but movers leaves cracks nearly everywhere' "$(row crack_pixels 1) > 0.5 * 60 * 320 * 180 && $(row crack_inner 1) > 0"
true_that 'and no likeness' "$(row flip 1) > 0.2 && $(row psnr 1) < 20 && $(row ssim 1) < 0.9"
is 'beside it everything is there' "$(row crack_pixels 2) $(row flip 2)" '0 0'
run never --views path:walk --culler "$coarse" --no-pictures
is 'unless told not to' "$(row flip 1)" null
run fast --views path:walk --culler "$coarse" --no-truth
is 'nor without truth' "$(row flip 1)" null
run fast --views path:walk --culler "$coarse" --no-truth --pictures
true_that 'but when asked' "$(row flip 1) > 0"

run long --views auto:walk:200 --culler frustum --pictures --size 64x36
is 'a long walk warms up' "$(sed -n 's/.*"warmup_views": \([0-9]*\).*/\1/p' "$json")" 60
is 'in views compared' "$(row pictures_measured 1)" 140
is 'not in views' "$(row views 1)" 200
run told --views path:walk --culler "$fine" --frame-ms 12.5 --no-truth
is "a frame's time stands in the context" "$(sed -n 's/.*"frame_ms": \([0-9.]*\).*/\1/p' "$json")" 12.5
for wrong in -1 1e9 ten 5x ''; do
  "$portcullis" bench "$rooms" --views path:walk --culler none --frame-ms="$wrong" >"$work/table" 2>&1
  is "--frame-ms='$wrong' is refused" "$? $(grep -c 'takes 0 to 100000 milliseconds' "$work/table")" '2 1'
done
run tiny --views path:walk --culler "$coarse" --pictures --size 10x10
is 'a picture smaller than a window has no SSIM' "$(row ssim 1)" null
"$portcullis" bench "$rooms" --views path:walk --culler none --json - --csv - >/dev/null 2>"$work/table"
is 'two results to stdout are refused' "$?" 2
"$portcullis" bench "$rooms" --views path:walk --culler none --no-truth --csv - 2>/dev/null | head -n 1 | grep -q '^name,run_name,'
is 'CSV to stdout' "$?" 0
finish
