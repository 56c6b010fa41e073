#!/bin/sh
# What a scene does not need is not there: no GL context and only the named library with --no-truth and a CPU-only chain;
# a culler that tests brings a context. Cullers that test and that show pictures lose nothing with the real renderer.
# usage: skipped_work.sh PORTCULLIS TEST_PLUGINS
# SPDX-License-Identifier: MIT
portcullis=$1
plugins=$2
. "$(dirname "$0")/counters.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
"$portcullis" generate demo -o "$work/demo.obj" || exit 1
"$portcullis" generate city --size 2000 -o "$work/city.boxes" || exit 1
json=$work/out.json

run() { # words: chains and options
  "$portcullis" bench "$work/city.boxes" --views auto:10 --size 320x180 --repeat 1 --json "$json" "$@" >"$work/table" 2>&1
  code=$?
  [ "$code" -ne 3 ] || skip "no OpenGL"
  [ "$code" -eq 0 ] || cat "$work/table"
}

run --no-truth --culler frustum
is 'no context for a CPU chain' "$(same "$json" gl_used)" 0
is 'only the named library' "$(same "$json" plugins_opened)" 1
is 'no truth, no misses' "$(same "$json" missed_pixels)" null
run --no-truth --culler brute
is 'no library for a built-in' "$(same "$json" plugins_opened)" 0
run --no-truth --culler frustum --ids
is 'ids need no context' "$(same "$json" gl_used)" 0
if command -v strace >/dev/null 2>&1; then
  strace -f -e trace=openat -o "$work/trace" "$portcullis" bench "$work/city.boxes" --views auto:10 --no-truth --culler frustum >/dev/null 2>&1
  is 'no GL driver is opened' "$(grep -c 'swrast_dri\|llvmpipe\|libLLVM' "$work/trace")" 0
fi

for plugin in testmore testpicture; do
  [ -f "$plugins/$plugin.culler.so" ] || { echo "FAILED no $plugin in $plugins"; failed=$((failed + 1)); continue; }
  PORTCULLIS_PLUGIN_PATH=$plugins run --no-truth --culler "$plugin"
  is "$plugin brings a context" "$(same "$json" gl_used)" 1
  PORTCULLIS_PLUGIN_PATH=$plugins run --culler "$plugin" --culler none
  is "$plugin misses nothing" "$(same "$json" missed_pixels)" 0
  is "$plugin does nothing wrong" "$(same "$json" faults)" 0
done
PORTCULLIS_PLUGIN_PATH=$plugins run --culler testmore --culler 'testmore[wait=1]' --query-latency 2
true_that 'testmore asks' "$(counter "$json" queries | head -n 1) > 0"
true_that 'testmore steps' "$(counter "$json" steps | head -n 1) > 1"
finish
