# Shared by the scripts that show what Part 2 claims: scenes, views of a path, runs of the bench.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/../bench/counters.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
json=$work/results

# generated KIND SIZE: $work/KIND.json or $work/KINDSIZE.json, made once. SIZE may be ''.
generated() {
  [ -f "$work/$1$2.json" ] || "$portcullis" generate "$1" ${2:+--size "$2"} -o "$work/$1$2.json" || exit 1
}

# every STEP SCENE PATH: every STEP-th view of a path, as $work/PATH.views; the generators write one a line.
every() {
  awk -v step="$1" -v name="$3" '
    $0 ~ "^{\"name\": \"" name "\", \"views\": " { on = 1; next }
    on && /^{"eye"/ {
      if (n++ % step == 0) { gsub(/"[a-z]+"/, ""); gsub(/[^-0-9.e]/, " "); print $1, $2, $3, $4, $5, $6, "0 1 0 60 1.7777777777777777 0.0625 1000" }
      next
    }
    on { exit }' "$2" >"$work/$3.views"
}

# measure NAME SCENE VIEWS SIZE words: chains and options. Nothing may be missed, and nothing be at fault.
measure() {
  name=$1 scene=$2 views=$3 size=$4
  shift 4
  rm -f "$json"
  "$portcullis" bench "$scene" --views "$views" --size "$size" --repeat 1 --json "$json" "$@" >"$work/table" 2>&1
  code=$?
  [ "$code" -ne 3 ] || skip "no OpenGL"
  printf '# %s\n' "$name"
  cat "$work/table"
  is "$name: exit code" "$code" 0
  is "$name: missed pixels" "$(same "$json" missed_pixels)" 0
  is "$name: missed items" "$(same "$json" missed_items)" 0
  is "$name: faults" "$(same "$json" faults)" 0
  is "$name: one truth" "$(same "$json" polygons_visible | wc -l)" 1
  true_that "$name: something is seen" "$(same "$json" polygons_visible | head -n 1) > 0"
}
