#!/bin/sh
# What time buys: total_ms against mean FLIP of an option's values, each series a curve, as OUT.json and OUT.svg, all measured in one run; in the same
# run the baselines that draw everything.
# usage: curve.sh PORTCULLIS OUT SCENE VIEWS [LABEL:CHAIN...]    CHAIN holds an @ where the value goes
# environment: VALUES, BASELINES (chains that draw everything; the first is what times are divided by), BENCH_OPTIONS
# SPDX-License-Identifier: MIT
set -eu
[ $# -ge 4 ] || { sed -n 's/^# usage: //p' "$0" >&2; exit 2; }
portcullis=$1 out=$2 scene=$3 views=$4
shift 4
values=${VALUES-0.25 0.5 1 2 4 8 16}
baselines=${BASELINES-octree octree+occlusion}
[ $# -gt 0 ] || set -- 'quad, quadtree:imagecache[tolerance=@,show=quad,tree=on]' 'quad, cells alone:imagecache[tolerance=@,show=quad,tree=off]' \
  'centre, quadtree:imagecache[tolerance=@,show=centre,tree=on]' 'centre, cells alone:imagecache[tolerance=@,show=centre,tree=off]'
keys='total_ms total_ms_p95 total_ms_p99 flip flip_p99 psnr ssim crack_pixels missed_pixels picture_bytes refreshes polygons_drawn popping popping_p99 total_ms_p99_to_p50'
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

: >"$work/heads" # of each strategy, in order: series and value
chains=''
set -f
for chain in $baselines; do
  chains="$chains --culler $chain"
  printf -- '-\t-\n' >>"$work/heads"
done
for series in "$@"; do
  label=${series%%:*} pattern=${series#*:}
  case $pattern in *@*) ;; *) echo "$0: '$series' has no @ where a value goes" >&2; exit 2 ;; esac
  for value in $values; do
    chains="$chains --culler $(printf %s "$pattern" | sed "s/@/$value/g")"
    printf '%s\t%s\n' "$label" "$value" >>"$work/heads"
  done
done
# shellcheck disable=SC2086
"$portcullis" bench "$scene" --views "$views" ${BENCH_OPTIONS-} $chains --pictures --json "$work/json" >"$work/log" || { cat "$work/log" >&2; exit 1; }
set +f
rows "$work/json" >"$work/rows"
paste "$work/heads" "$work/rows" >"$work/points" # series, value, chain, the keys

awk -F '\t' -v keys="$keys" -v scene="${scene##*/}" -v views="${views##*/}" -v options="${BENCH_OPTIONS-}" '
  function text(s) { gsub(/[\\"]/, "\\\\&", s); return "\"" s "\"" }
  BEGIN { n = split(keys, key, " "); printf "{\n  \"scene\": %s,\n  \"views\": %s,\n  \"options\": %s,\n  \"points\": [", text(scene), text(views), text(options) }
  {
    if (NR == 1) first = $4
    printf "%s\n    {\"series\": %s, \"value\": %s, \"chain\": %s", (NR == 1 ? "" : ","), ($1 == "-" ? "null" : text($1)), ($2 == "-" ? "null" : $2), text($3)
    for (k = 1; k <= n; k++) printf ", \"%s\": %s", key[k], $(k + 3)
    printf ", \"total_ms_by_first\": %s}", (first + 0 == 0 ? "null" : sprintf("%.6g", $4 / first))
  }
  END { print "\n  ]\n}" }' "$work/points" >"$out.json"

# Read twice: the extent first. Both axes by powers of ten, with lines at 1, 2 and 5; at 1 alone where there are over two powers.
awk -F '\t' -v title="${scene##*/}, ${views##*/}: time against error" '
  function log10(v) { return log(v) / log(10) }
  function floor_of(v) { return v == int(v) || v > 0 ? int(v) : int(v) - 1 }
  function across(v) { return 80 + 600 * (log10(v) - x0) / (x1 - x0) }
  function up(v) { return 460 - 400 * (log10(v) - y0) / (y1 - y0) }
  function text(x, y, how, s) { gsub(/&/, "\\&amp;", s); gsub(/</, "\\&lt;", s); printf "<text x=\"%.1f\" y=\"%.1f\" %s>%s</text>\n", x, y, how, s }
  function line(a, b, c, d, how) { printf "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" %s/>\n", a, b, c, d, how }
  function mark(x, y) {
    if (count % 2) printf "<circle class=\"point\" cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\"/>\n", x, y, hue
    else printf "<rect class=\"point\" x=\"%.1f\" y=\"%.1f\" width=\"7\" height=\"7\" fill=\"white\" stroke=\"%s\" stroke-width=\"2\"/>\n", x - 3.5, y - 3.5, hue
  }
  NR == FNR {
    if ($4 + 0 > 0) { least_ms = least_ms == "" || $4 + 0 < least_ms ? $4 + 0 : least_ms; most_ms = $4 + 0 > most_ms ? $4 + 0 : most_ms }
    if ($2 != "-" && $7 + 0 > 0) { least = least == "" || $7 + 0 < least ? $7 + 0 : least; most = $7 + 0 > most ? $7 + 0 : most }
    next
  }
  FNR == 1 {
    if (least == "") least = most = 0.001
    if (least_ms == "") least_ms = most_ms = 1
    x0 = log10(least / 1.5); x1 = log10(most * 1.5); y0 = log10(least_ms / 1.3); y1 = log10(most_ms * 1.3)
    split("#332288 #332288 #cc6677 #cc6677 #117733 #117733 #aa7700 #aa7700", colour, " ")
    print "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"900\" height=\"520\" font-family=\"sans-serif\" font-size=\"12\">"
    print "<rect width=\"900\" height=\"520\" fill=\"white\"/>"
    text(80, 32, "font-size=\"16\"", title)
    for (e = floor_of(x0); e <= x1; e++) for (m = 1; m < 10; m += x1 - x0 > 2 ? 9 : m == 1 ? 1 : m == 2 ? 3 : 5) {
      v = m * 10 ^ e
      if (log10(v) < x0 || log10(v) > x1) continue
      line(across(v), 60, across(v), 460, "stroke=\"#ddd\""); text(across(v), 476, "text-anchor=\"middle\"", v)
    }
    for (e = floor_of(y0); e <= y1; e++) for (m = 1; m < 10; m += y1 - y0 > 2 ? 9 : m == 1 ? 1 : m == 2 ? 3 : 5) {
      v = m * 10 ^ e
      if (log10(v) < y0 || log10(v) > y1) continue
      line(80, up(v), 680, up(v), "stroke=\"#ddd\""); text(74, up(v) + 4, "text-anchor=\"end\"", v)
    }
    print "<rect x=\"80\" y=\"60\" width=\"600\" height=\"400\" fill=\"none\" stroke=\"black\"/>"
    text(380, 500, "text-anchor=\"middle\"", "mean FLIP over the path (0 is left out)")
    print "<text transform=\"translate(24 260) rotate(-90)\" text-anchor=\"middle\">total_ms, the median view</text>"
  }
  $1 == "-" && $4 + 0 > 0 { line(80, up($4), 680, up($4), "stroke=\"black\" stroke-dasharray=\"6 4\""); text(88, up($4) - 5, "", $3 ": " sprintf("%.3g", $4) " ms") }
  $1 != "-" && $1 != series {
    series = $1; count++; hue = colour[(count - 1) % 8 + 1]; before = ""
    key_y = 56 + 22 * count
    line(690, key_y - 4, 714, key_y - 4, "stroke=\"" hue "\" stroke-width=\"1.5\""); mark(702, key_y - 4); text(722, key_y, "", $1)
  }
  $1 != "-" && $4 + 0 > 0 && $7 + 0 > 0 {
    if (before != "") line(x_before, y_before, across($7), up($4), "stroke=\"" hue "\" stroke-width=\"1.5\"")
    before = 1; x_before = across($7); y_before = up($4)
    mark(x_before, y_before)
    text(x_before + (count % 2 ? 7 : -7), y_before + (count % 2 ? -5 : 13), "font-size=\"10\" fill=\"" hue "\" text-anchor=\"" (count % 2 ? "start" : "end") "\"", $2)
  }
  END { print "</svg>" }' "$work/points" "$work/points" >"$out.svg"
