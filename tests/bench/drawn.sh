#!/bin/sh
# The bench sees what was truly drawn: with layouts that are not put in order after a swap it fails, otherwise it does not.
# usage: drawn.sh PORTCULLIS MUTANTS_FOLDER TWO_ROOMS TEST_PLUGINS
# SPDX-License-Identifier: MIT
portcullis=$1
mutants=$2
rooms=$3
PORTCULLIS_PLUGIN_PATH=$4
export PORTCULLIS_PLUGIN_PATH
. "$(dirname "$0")/counters.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

run() { # PROGRAM words: chains and options. The exit code goes to $code
  program=$1
  shift
  rm -f "$work/json"
  "$program" bench "$rooms" --views path:walk --size 320x180 --repeat 1 --json "$work/json" "$@" >"$work/table" 2>&1
  code=$?
  [ "$code" -ne 3 ] || skip "no OpenGL"
}

run "$portcullis" --culler frustum --culler testorder --culler testpicture --swap 5
is 'healthy: exit code' "$code" 0
is 'healthy: pixels drawn otherwise than said' "$(same "$work/json" picture_differs)" 0
is 'healthy: views compared' "$(counter "$work/json" pictures_compared | tr '\n' ' ')" '1 1 1 7 '
for mutant in reorder order movers runs; do
  [ -x "$mutants/portcullis_$mutant" ] || { is "mutant $mutant" 'not built' built; continue; }
  run "$mutants/portcullis_$mutant" --culler frustum --culler testorder --swap 5
  is "mutant $mutant: exit code" "$code" 1
  is "mutant $mutant: missed pixels, by what it says" "$(same "$work/json" missed_pixels)" 0
  true_that "mutant $mutant: pixels drawn otherwise than said" "$(counter "$work/json" picture_differs | tail -n 1) > 0"
  is "mutant $mutant: the table says so" "$(grep -c '^swap.*DRAWN WRONG' "$work/table")" 1
  is "mutant $mutant: a line says so" "$(grep -c 'error: swap/5: [0-9]* pixels of 7 views show something else' "$work/table")" 1
done
finish
