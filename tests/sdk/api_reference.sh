#!/bin/sh
# Doxygen reads api/ without a warning, and the filter in front of it changes no code. usage: api_reference.sh ROOT
# SPDX-License-Identifier: MIT
set -eu
command -v doxygen >/dev/null 2>&1 || { echo "skipped: no doxygen; packaging/apt.txt lists it"; exit 77; }
cd "$1"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
code_of() { cc -fpreprocessed -dD -E -P "$1" 2>/dev/null | tr -d ' \n'; } # without comments
for header in api/portcullis/*.h; do
    awk -f packaging/doxygen_filter.awk "$header" >"$work/shown.h"
    [ "$(wc -l <"$header")" = "$(wc -l <"$work/shown.h")" ] || { echo "$header: the filter moves lines"; exit 1; }
    [ "$(code_of "$header")" = "$(code_of "$work/shown.h")" ] || { echo "$header: the filter changes code"; exit 1; }
done
{ cat packaging/doxygen.conf; echo "OUTPUT_DIRECTORY = $work"; echo 'WARN_AS_ERROR = FAIL_ON_WARNINGS'; } | doxygen - >"$work/said" 2>&1 ||
    { cat "$work/said"; exit 1; }
[ ! -s "$work/said" ] || { cat "$work/said"; exit 1; }
# what the headers say is there: of a struct, of a member, of a function
find_in() { grep -qF "$2" "$work/html/$1" || { echo "$1 has no '$2'"; exit 1; }; }
find_in structcull__run.html 'Consecutive items in the zone'
find_in structcull__visit.html 'filter: runs of the culler before'
find_in structcull__plugin.html 'Items of the zone whose box touches a volume'
find_in scene_8h.html 'loads the cullers that it names'
# and a mistake is found
mkdir "$work/api"
cp api/portcullis/runs.h "$work/api/runs.h"
printf '%s\n' '/// See \nosuchcommand here.' 'typedef int cull_wrong;' >>"$work/api/runs.h"
grep -v -e '^FILTER' -e '^INPUT' packaging/doxygen.conf >"$work/wrong.conf"
printf '%s\n' "INPUT = $work/api" "OUTPUT_DIRECTORY = $work/two" 'WARN_AS_ERROR = FAIL_ON_WARNINGS' >>"$work/wrong.conf"
if doxygen "$work/wrong.conf" >/dev/null 2>&1; then
    echo 'a wrong comment is not found'
    exit 1
fi
echo "$(find "$work/html" -name '*.html' | wc -l) pages"
