#!/bin/sh
# What time buys: total_ms against mean FLIP of an option's values, each series a curve, as OUT.json and OUT.svg; beside each series, in
# the same run, the baselines that draw everything.
# usage: curve.sh PORTCULLIS OUT SCENE VIEWS [LABEL:CHAIN...]    CHAIN holds an @ where the value goes
# environment: VALUES, BASELINES (chains that draw everything; the first is what times are divided by), BENCH_OPTIONS
# SPDX-License-Identifier: MIT
set -eu
[ $# -ge 4 ] || { sed -n 's/^# usage: //p' "$0" >&2; exit 2; }
portcullis=$1 out=$2 scene=$3 views=$4
shift 4
values=${VALUES-0.25 0.5 1 2 4 8 16}
baselines=${BASELINES-octree octree+occlusion}
[ $# -gt 0 ] || set -- 'quad, quadtree:imagecache[tolerance=@,show=quad,tree=on]' 'quad:imagecache[tolerance=@,show=quad,tree=off]' \
  'centre, quadtree:imagecache[tolerance=@,show=centre,tree=on]' 'centre:imagecache[tolerance=@,show=centre,tree=off]'
keys='total_ms total_ms_p95 total_ms_p99 flip flip_p99 psnr ssim crack_pixels missed_pixels picture_bytes refreshes polygons_drawn'
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# JSON of the bench: of each strategy, in order, its name after the path's, and the values of the keys, tabs between.
rows() {
  awk -v keys="$keys" '
    BEGIN { n = split(keys, wanted, " ") }
    /"run_name"/ { rows++; name[rows] = $0; sub(/^[^:]*: "/, "", name[rows]); sub(/",?$/, "", name[rows]); sub(/^[^\/]*\/[^\/]*\//, "", name[rows]) }
    rows { line = $0; gsub(/[", ]/, "", line); split(line, part, ":"); value[rows, part[1]] = part[2] }
    END { for (r = 1; r <= rows; r++) { row = name[r]; for (k = 1; k <= n; k++) row = row "\t" ((r, wanted[k]) in value ? value[r, wanted[k]] : "null"); print row } }' "$1"
}

: >"$work/points" # series, value, chain, the keys
number=0
for series in "$@"; do
  label=${series%%:*} pattern=${series#*:}
  number=$((number + 1))
  case $pattern in *@*) ;; *) echo "$0: '$series' has no @ where a value goes" >&2; exit 2 ;; esac
  set -f
  chains=''
  for chain in $baselines; do chains="$chains --culler $chain"; done
  for value in $values; do chains="$chains --culler $(printf %s "$pattern" | sed "s/@/$value/g")"; done
  # shellcheck disable=SC2086
  "$portcullis" bench "$scene" --views "$views" ${BENCH_OPTIONS-} $chains --pictures --json "$work/json" >"$work/log" || { cat "$work/log" >&2; exit 1; }
  rows "$work/json" >"$work/rows"
  at=0
  for chain in $baselines; do
    at=$((at + 1))
    printf '%s\t-\t%s\n' "$label" "$(sed -n "${at}p" "$work/rows")" >>"$work/points"
  done
  for value in $values; do
    at=$((at + 1))
    printf '%s\t%s\t%s\n' "$label" "$value" "$(sed -n "${at}p" "$work/rows")" >>"$work/points"
  done
  set +f
done

awk -F '\t' -v keys="$keys" -v scene="${scene##*/}" -v views="$views" '
  function text(s) { gsub(/[\\"]/, "\\\\&", s); return "\"" s "\"" }
  BEGIN { n = split(keys, key, " "); printf "{\n  \"scene\": %s,\n  \"views\": %s,\n  \"points\": [", text(scene), text(views) }
  {
    if ($1 != series) first = ""
    series = $1
    if (first == "") first = $4
    printf "%s\n    {\"series\": %s, \"value\": %s, \"chain\": %s", (NR == 1 ? "" : ","), text($1), ($2 == "-" ? "null" : $2), text($3)
    for (k = 1; k <= n; k++) printf ", \"%s\": %s", key[k], $(k + 3)
    printf ", \"total_ms_by_first\": %s}", (first + 0 == 0 ? "null" : sprintf("%.6g", $4 / first))
  }
  END { print "\n  ]\n}" }' "$work/points" >"$out.json"

awk -F '\t' -v title="${scene##*/}, $views: time against error" '
  function log10(v) { return log(v) / log(10) }
  function across(v) { return 80 + 580 * (log10(v) - x0) / (x1 - x0) }
  function up(v) { return 440 - 370 * (log10(v) - y0) / (y1 - y0) }
  function text(x, y, anchor, s) { gsub(/&/, "\\&amp;", s); gsub(/</, "\\&lt;", s); printf "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">%s</text>\n", x, y, anchor, s }
  function line(a, b, c, d, how) { printf "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" %s/>\n", a, b, c, d, how }
  function floor10(v) { e = log10(v); return e == int(e) ? e : e < 0 ? int(e) - 1 : int(e) }
  NR == FNR {
    if ($4 + 0 > 0) { least_ms = least_ms == "" || $4 + 0 < least_ms ? $4 + 0 : least_ms; most_ms = $4 + 0 > most_ms ? $4 + 0 : most_ms }
    if ($2 != "-" && $7 + 0 > 0) { least = least == "" || $7 + 0 < least ? $7 + 0 : least; most = $7 + 0 > most ? $7 + 0 : most }
    next
  }
  FNR == 1 {
    if (least == "") least = most = 0.001
    if (least_ms == "") least_ms = most_ms = 1
    x0 = floor10(least); x1 = floor10(most) + 1; y0 = log10(least_ms / 1.3); y1 = log10(most_ms * 1.3)
    split("#332288 #117733 #cc6677 #ddaa33 #88ccee #44aa99 #999933", colour, " ")
    print "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"940\" height=\"500\" font-family=\"sans-serif\" font-size=\"12\">"
    print "<rect width=\"940\" height=\"500\" fill=\"white\"/>"
    print "<g font-size=\"16\">"; text(20, 26, "start", title); print "</g>"
    line(80, 440, 660, 440, "stroke=\"black\""); line(80, 70, 80, 440, "stroke=\"black\"")
    for (e = x0; e <= x1; e++) { line(across(10 ^ e), 70, across(10 ^ e), 440, "stroke=\"#ddd\""); text(across(10 ^ e), 456, "middle", 10 ^ e) }
    for (e = floor10(least_ms / 10); e <= y1 + 1; e++) for (m = 1; m < 10; m += m == 1 ? 1 : m == 2 ? 3 : 5) {
      v = m * 10 ^ e
      if (log10(v) < y0 || log10(v) > y1) continue
      line(80, up(v), 660, up(v), "stroke=\"#ddd\""); text(74, up(v) + 4, "end", v)
    }
    text(370, 478, "middle", "mean FLIP over the path (0 is left out)")
    print "<text transform=\"translate(24 255) rotate(-90)\" text-anchor=\"middle\">total_ms, the median view</text>"
  }
  $1 != series { series = $1; count++; hue = colour[(count - 1) % 7 + 1]; before = ""; text(692, 80 + 18 * count, "start", $1); line(672, 76 + 18 * count, 688, 76 + 18 * count, "stroke=\"" hue "\" stroke-width=\"2\"") }
  $2 == "-" && $4 + 0 > 0 { line(80, up($4), 660, up($4), "stroke=\"" hue "\" stroke-dasharray=\"4 4\""); if (!told[$3]++) text(664, up($4) + 4, "start", $3) }
  $2 != "-" && $4 + 0 > 0 && $7 + 0 > 0 {
    if (before != "") line(x_before, y_before, across($7), up($4), "stroke=\"" hue "\"")
    before = 1; x_before = across($7); y_before = up($4)
    printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\"/>\n", x_before, y_before, hue
    text(x_before + 6, y_before - 6, "start", $2)
  }
  END { print "</svg>" }' "$work/points" "$work/points" >"$out.svg"
