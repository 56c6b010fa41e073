#!/bin/sh
# Does bench --against tell what is slower, and nothing else? Two runs of one build, and one with a culler that is a fifth slower, by turns.
# usage: against.sh PORTCULLIS SLOW_PLUGIN [TIMES] [OUT]    SLOW_PLUGIN: slow_plugins/frustum.culler.so of the build tree; TIMES: of each (default 10)
# SPDX-License-Identifier: MIT
set -eu
portcullis=$1 slow=$2 times=${3:-10} out=${4:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$portcullis" generate city --size 200000 -o "$work/city.boxes" >/dev/null
bench() {
  "$portcullis" bench "$work/city.boxes" --views auto:200 --repeat 100 --no-truth --culler brute --culler 'frustum[isa=plain]' --culler octree "$@" 2>&1
}
false_alarms=0 noticed=0 i=0
while [ "$i" -lt "$times" ]; do
  i=$((i + 1))
  bench --times --json "$work/old.json" >/dev/null
  code=0
  bench --against "$work/old.json" >"$work/same" || code=$?
  [ "$code" -eq 0 ] || false_alarms=$((false_alarms + 1))
  grep -E 'of then' "$work/same" | sed "s/^/run $i, one build: /"
  code=0
  bench --against "$work/old.json" --plugin "$slow" >"$work/slow" || code=$?
  if [ "$code" -eq 1 ] && grep -q '^frustum.*SLOWER' "$work/slow" && ! grep -q '^octree.*SLOWER' "$work/slow"; then noticed=$((noticed + 1)); fi
  grep -E 'of then' "$work/slow" | sed "s/^/run $i, frustum a fifth slower: /"
done >"$work/lines"
result="one build: $false_alarms of $times called a regression; frustum a fifth slower: $noticed of $times called one, and nothing else"
cat "$work/lines"
echo "$result"
[ -z "$out" ] || { cat "$work/lines"; echo "$result"; } >"$out"
[ "$false_alarms" -eq 0 ] && [ "$noticed" -eq "$times" ] && { echo PASS; exit 0; }
echo FAIL
exit 1
