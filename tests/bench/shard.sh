#!/bin/sh
# A bench in shards, merged, has the counters of one process, for chains with and without history, with pictures and swaps, with and without truth; so it has when a
# shard is killed on the way and started again, and when Open MPI or Slurm says who is which. Parts that don't belong together are refused with a line.
# usage: shard.sh PORTCULLIS TWO_ROOMS
# SPDX-License-Identifier: MIT
portcullis=$1
rooms=$2
. "$(dirname "$0")/counters.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
unset SLURM_PROCID SLURM_NTASKS OMPI_COMM_WORLD_RANK OMPI_COMM_WORLD_SIZE PMI_RANK PMI_SIZE
"$portcullis" generate city --size 1000 -o "$work/city.boxes" >/dev/null || exit 1

# counted FILE: its JSON without what is time, the machine's, or a figure of an index (those count what each process walked)
counted() {
  awk '/"times": {|"figures": {/ { inside = 1 } !inside { print } inside && /^ *}/ { inside = 0 }' "$1" |
    grep -vE '_ns["_]|_ms|"date"|"load_avg"|^ *[0-9.]+,?$|_time"|"shards"'
}

same_counters() { # NAME FILE FILE
  counted "$2" >"$work/a"
  counted "$3" >"$work/b"
  is "$1: counters there are" "$(grep -c '"polygons_drawn"' "$work/a")" "$(grep -c '"polygons_drawn"' "$work/b")"
  if [ -s "$work/a" ] && cmp -s "$work/a" "$work/b"; then passed=$((passed + 1)); else
    failed=$((failed + 1))
    echo "FAILED $1: counters differ"
    diff "$work/a" "$work/b" | head -n 10
  fi
}

# whole NAME ARGUMENTS...: one process, to NAME.json
whole() {
  name=$1
  shift
  "$portcullis" bench "$@" --costs fixed --json "$work/$name.json" --frames "$work/$name.frames" >"$work/log" 2>&1
  code=$?
  [ "$code" -ne 3 ] || skip "no OpenGL"
  is "$name: exit code" "$code" 0
}

# sharded NAME N ARGUMENTS...: N shards one after the other, merged, beside NAME.json
sharded() {
  name=$1 count=$2
  shift 2
  for i in $(seq "$count"); do "$portcullis" bench "$@" --shard "$i/$count" --json "$work/out.json" >"$work/log" 2>&1 || cat "$work/log"; done
  is "$name: rows of a shard are not told" "$(ls "$work/out.json" 2>/dev/null)" ""
  is "$name: journals left" "$(find "$work" -name '*.journal')" ""
  "$portcullis" merge "$work"/out.json.*-of-"$count" --json "$work/merged.json" --frames "$work/merged.frames" >"$work/table" 2>&1
  is "$name of $count: merge" "$?" 0
  same_counters "$name of $count" "$work/$name.json" "$work/merged.json"
  is "$name of $count: views" "$(cut -d , -f 1-3,6- "$work/$name.frames" | sed 's/^"[^"]*"//' | cksum)" "$(cut -d , -f 1-3,6- "$work/merged.frames" | sed 's/^"[^"]*"//' | cksum)"
  rm -f "$work"/out.json.*
}

set -- "$work/city.boxes" --views auto:walk:21 --size 160x90 --repeat 2 --query-latency 2 --culler frustum --culler 'octree+occlusion[method=chc]' \
  --culler 'octree+occlusion[method=twophase]' --culler imagecache --swap 5
whole city "$@"
for count in 1 2 3 7; do sharded city "$count" "$@"; done
rm "$work"/*.json
set -- "$rooms" --views path:walk --size 96x54 --repeat 2 --culler 'frustum+portal' --culler 'octree+occlusion' --pictures
whole rooms "$@"
sharded rooms 3 "$@"
set -- "$work/city.boxes" --views auto:5 --repeat 1 --no-truth --culler frustum --culler octree
whole times "$@"
sharded times 7 "$@" # two shards have no view

# Killed on the way, at whatever place it is: it ends at last, and all is as it was.
set -- "$work/city.boxes" --views auto:walk:31 --size 320x180 --repeat 2 --culler frustum --culler 'octree+occlusion[method=chc]' --culler imagecache
whole killed "$@"
"$portcullis" bench "$@" --shard 1/2 --json "$work/out.json" >/dev/null 2>&1
kills=0
going=0
while [ ! -f "$work/out.json.2-of-2" ] && [ "$kills" -lt 60 ]; do
  kills=$((kills + 1))
  timeout -s KILL "0.$((kills / 10))$((kills % 10))5" "$portcullis" bench "$@" --shard 2/2 --json "$work/out.json" >"$work/log" 2>&1
  grep -q 'goes on; [1-9]' "$work/log" && going=$((going + 1))
done
[ -f "$work/out.json.2-of-2" ] || "$portcullis" bench "$@" --shard 2/2 --json "$work/out.json" >"$work/log" 2>&1
grep -q 'goes on; [1-9]' "$work/log" && going=$((going + 1))
true_that 'it went on from what it had' "$going > 0"
"$portcullis" merge "$work"/out.json.*-of-2 --json "$work/merged.json" >/dev/null 2>&1
same_counters "killed $kills times" "$work/killed.json" "$work/merged.json"

# Cut at each of some bytes, as by a full disk.
"$portcullis" bench "$@" --shard 2/2 --json "$work/cut.json" >/dev/null 2>&1
timeout -s KILL 0.6 "$portcullis" bench "$@" --shard 1/2 --json "$work/cut.json" >/dev/null 2>&1
if [ -f "$work/cut.json.1-of-2.journal" ]; then
  size=$(wc -c <"$work/cut.json.1-of-2.journal")
  head -c $((size - size / 3)) "$work/cut.json.1-of-2.journal" >"$work/short"
  mv "$work/short" "$work/cut.json.1-of-2.journal"
fi
"$portcullis" bench "$@" --shard 1/2 --json "$work/cut.json" >/dev/null 2>&1
"$portcullis" merge "$work"/cut.json.*-of-2 --json "$work/merged.json" >/dev/null 2>&1
same_counters 'a journal that was cut' "$work/killed.json" "$work/merged.json"

# What must not be merged.
refused() { # NAME WORDS FILES...
  name=$1 words=$2
  shift 2
  "$portcullis" merge "$@" --json "$work/never.json" >"$work/log" 2>&1
  is "$name: exit code" "$?" 2
  grep -q "$words" "$work/log" && [ ! -f "$work/never.json" ] && passed=$((passed + 1)) && return
  failed=$((failed + 1))
  echo "FAILED $name: $(cat "$work/log")"
}
one=$work/cut.json.1-of-2 two=$work/cut.json.2-of-2
refused 'a shard is missing' 'shard 2 of 2 is missing' "$one"
refused 'the first is missing' 'shard 1 of 2 is missing' "$two"
refused 'a shard stands twice' 'name each part once' "$one" "$one" "$two"
"$portcullis" bench "$work/city.boxes" --views auto:walk:31 --size 160x90 --repeat 2 --culler frustum --shard 2/2 --json "$work/other.json" >/dev/null 2>&1
refused 'another size' 'is of another bench' "$one" "$work/other.json.2-of-2"
head -c 4000 "$two" >"$work/short"
refused 'half a part' 'no whole part' "$one" "$work/short"
sed '1,2!s/a/b/' "$two" >"$work/bent"
refused 'a part with another byte' 'no whole part' "$one" "$work/bent"
refused 'no part at all' 'no whole part' "$rooms"
: >"$work/other.json.1-of-2.journal"
printf 'portcullis journal 1\nof another' >"$work/other.json.1-of-2.journal"
"$portcullis" bench "$work/city.boxes" --views auto:walk:31 --size 160x90 --repeat 2 --culler frustum --shard 1/2 --json "$work/other.json" >"$work/log" 2>&1
is 'a journal of another shard' "$?" 2
rm -f "$work"/other.json*

# Started by others.
set -- "$work/city.boxes" --views auto:6 --repeat 1 --no-truth --culler frustum --json "$work/started.json"
whole started "$work/city.boxes" --views auto:6 --repeat 1 --no-truth --culler frustum
cp "$work/started.json" "$work/alone.json"
SLURM_PROCID=0 SLURM_NTASKS=3 "$portcullis" bench "$@" >/dev/null 2>&1
OMPI_COMM_WORLD_RANK=1 OMPI_COMM_WORLD_SIZE=3 "$portcullis" bench "$@" >/dev/null 2>&1
PMI_RANK=2 PMI_SIZE=3 "$portcullis" bench "$@" >/dev/null 2>&1
"$portcullis" merge "$work"/started.json.*-of-3 --json "$work/merged.json" >/dev/null 2>&1
same_counters 'Slurm, Open MPI and PMI' "$work/alone.json" "$work/merged.json"
rm -f "$work"/started.json*
SLURM_PROCID=0 SLURM_NTASKS=3 "$portcullis" bench "$@" --shard none >/dev/null 2>&1
is 'none of them is asked' "$(ls "$work"/started.json*)" "$work/started.json"
rm -f "$work"/started.json*
if command -v mpirun >/dev/null 2>&1; then
  OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --oversubscribe -n 4 "$portcullis" bench "$@" >"$work/log" 2>&1
  is 'mpirun' "$?" 0
  "$portcullis" merge "$work"/started.json.*-of-4 --json "$work/merged.json" >/dev/null 2>&1
  same_counters 'mpirun -n 4' "$work/alone.json" "$work/merged.json"
else
  echo 'NOT RUN: mpirun is not installed (openmpi-bin); its environment was tried without it'
fi
finish
