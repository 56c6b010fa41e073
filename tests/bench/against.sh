#!/bin/sh
# bench --against, --trace and --frames through the command line, with times that are written, not measured: a run beside itself is no regression, one beside times
# of half its length is; worse counters are told; files that are no earlier run are refused before anything is measured.
# usage: against.sh PORTCULLIS
# SPDX-License-Identifier: MIT
portcullis=$1
. "$(dirname "$0")/counters.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
"$portcullis" generate city --size 2000 -o "$work/city.boxes" >/dev/null || exit 1

bench() { # ARGUMENTS...: the exit code in $code, what it says in $work/log
  "$portcullis" bench "$work/city.boxes" --views auto:40 --repeat 3 --no-truth --culler none --culler frustum "$@" >"$work/log" 2>&1
  code=$?
}

says() { # NAME WORDS
  grep -q "$2" "$work/log" && passed=$((passed + 1)) && return
  failed=$((failed + 1))
  echo "FAILED $1: $(cat "$work/log")"
}

# scaled FILE BY: the times of its second strategy, frustum, multiplied
scaled() {
  awk -v by="$2" '/"run_name"/ { row++ } /"times": {/ { inside = 1 } inside && /^ *}/ { inside = 0 }
    inside && row == 2 && /^ *[0-9]+,?$/ { printf "%d%s\n", $1 * by, /,/ ? "," : ""; next } { print }' "$1"
}

bench --times --json "$work/old.json"
is 'measured' "$code" 0
is 'times of each view' "$(grep -c '"total_ns": \[' "$work/old.json")" 2
scaled "$work/old.json" 0.1 >"$work/faster_then.json"
bench --against "$work/faster_then.json"
is 'ten times slower than then: exit code' "$code" 1
says 'it is told' 'frustum: cull_ns .* of then, SLOWER by over 10%'
says 'the reference is told' 'none: its views take'
scaled "$work/old.json" 100 >"$work/slower_then.json"
bench --against "$work/slower_then.json"
is 'faster than then: exit code' "$code" 0
says 'that is told too' 'frustum: cull_ns .* of then, faster'
sed '/"polygons_drawn"/s/: [0-9.]*/: 1/' "$work/slower_then.json" >"$work/fewer_then.json"
bench --against "$work/fewer_then.json"
is 'more polygons than then: exit code' "$code" 1
says 'they are told' 'polygons_drawn .* then 1: WORSE'
sed 's/"cpu_model": ".*"/"cpu_model": "another"/' "$work/faster_then.json" >"$work/other_machine.json"
bench --against "$work/other_machine.json"
is 'another machine: exit code' "$code" 0
says 'times are not compared' 'another cpu_model: times are not compared'

bench --against "$work/old.json" --repeat 2
is 'other passes: exit code' "$code" 2
says 'they are named' 'its repeat differs'
bench --json "$work/timeless.json"
bench --against "$work/timeless.json" --json "$work/never.json"
is 'no times: exit code' "$code" 2
says 'what to do' 'measure it again with bench --times'
is 'nothing was measured' "$(ls "$work/never.json" 2>/dev/null)" ''
head -c 300 "$work/old.json" >"$work/half.json"
bench --against "$work/half.json"
is 'half a file: exit code' "$code" 2
bench --against "$work/city.boxes"
is 'no JSON: exit code' "$code" 2
bench --against "$work/old.json" --reference octopus
is 'no such reference: exit code' "$code" 2
bench --against "$work/old.json" --slower 0
is 'no percent: exit code' "$code" 2

bench --trace "$work/trace.json" --frames "$work/frames.csv"
is 'a trace: exit code' "$code" 0
is 'lines of frames' "$(wc -l <"$work/frames.csv" | tr -d ' ')" 81
is 'columns of frames' "$(awk -F , '{ print NF }' "$work/frames.csv" | sort -u)" 32
is 'frames of the trace' "$(grep -c '"name":"frame","ph":"X"' "$work/trace.json")" 80
is 'flows of the trace' "$(grep -c '"name":"flow","ph":"X"' "$work/trace.json")" 80
true_that 'steps of the trace' "$(grep -c '"name":"step","ph":"X"' "$work/trace.json") >= 80"
is 'strategies of the trace' "$(grep -c '"thread_name"' "$work/trace.json")" 2
is 'polygons of the trace' "$(grep -c '"name":"polygons drawn","ph":"C"' "$work/trace.json")" 80
if command -v python3 >/dev/null 2>&1; then
  is 'the trace is JSON, and spans lie in their frames' "$(python3 - "$work/trace.json" <<'P'
import json, sys
events = json.load(open(sys.argv[1]))["traceEvents"]
spans = [e for e in events if e["ph"] == "X"]
frames = [e for e in spans if e["name"] == "frame"]
def inside(e, f): return f["tid"] == e["tid"] and f["ts"] <= e["ts"] + 0.01 and e["ts"] + e["dur"] <= f["ts"] + f["dur"] + 0.01
print(all(e["name"] == "frame" or any(inside(e, f) for f in frames) for e in spans))
P
)" True
fi
finish
