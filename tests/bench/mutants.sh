#!/bin/sh
# Every mutant is reported by the bench: exit code 1 and missed pixels; the healthy plugin on the same views is not.
# SPDX-License-Identifier: MIT
# usage: mutants.sh PORTCULLIS MUTANTS_FOLDER
portcullis=$1
mutants=$2
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
passed=0
failed=0
"$portcullis" generate demo -o "$work/demo.obj" || exit 1

measure() { # words: options before the chain
  "$portcullis" bench "$work/demo.obj" --views "$work/demo.views" --size 640x360 --repeat 1 --culler frustum --json "$work/out.json" "$@" >"$work/table" 2>&1
}

judge() { # NAME WANTED_CODE GOT_CODE
  missed=$(sed -n 's/.*"missed_pixels": \([0-9]*\).*/\1/p' "$work/out.json" 2>/dev/null)
  printf '%s: %s missed pixels, exit code %s\n' "$1" "$missed" "$3"
  if [ "$3" = 3 ]; then
    echo "SKIPPED: no OpenGL"
    exit 77
  fi
  if [ "$3" = "$2" ] && { [ "$2" = 0 ] || [ "${missed:-0}" -gt 0 ]; }; then passed=$((passed + 1)); else
    failed=$((failed + 1))
    cat "$work/table"
  fi
  rm -f "$work/out.json"
}

measure
judge healthy 0 $?
for folder in "$mutants"/*; do
  measure --plugin "$folder/frustum.culler.so"
  judge "$(basename "$folder")" 1 $?
done
printf '%s passed, %s failed\n' "$passed" "$failed"
[ "$failed" -eq 0 ] && [ "$passed" -eq 6 ]
