#!/bin/sh
# Each command has a manual page, which tells each of its options, and in which no linter finds a fault.
# SPDX-License-Identifier: MIT
# usage: manual.sh PORTCULLIS MANUAL
set -eu
portcullis=$1
pages=$2/man1
[ -d "$pages" ] || { echo "skipped: no manual pages were made: no help2man; packaging/apt.txt lists it"; exit 77; }
plain=$(mktemp)
trap 'rm -f "$plain"' EXIT
failed=0
commands=$("$portcullis" --help | sed -n 's/^  \([a-z-]*\)  *[^ ].*/\1/p')
[ -n "$commands" ]
for command in $commands; do
    page=$pages/portcullis-$command.1
    [ -s "$page" ] || { echo "no page of $command"; failed=1; continue; }
    grep -q "^portcullis-$command .- " "$page" || { echo "$page has no line NAME"; failed=1; }
    sed 's/\\-/-/g' "$page" >"$plain"
    for option in $("$portcullis" "$command" --help | grep -o -e '^ .*' | grep -oE -e '(^|[ ,])--[a-z][a-z-]*' | tr -d ' ,' | sort -u); do
        grep -qF -e "$option" "$plain" || { echo "$page does not tell $option"; failed=1; }
    done
    grep -qF "portcullis\\-$(printf '%s' "$command" | sed 's/-/\\-/g')" "$pages/portcullis.1" || { echo "portcullis.1 does not tell $command"; failed=1; }
done
[ "$(find "$pages" -type f | wc -l)" = $(($(echo "$commands" | wc -w) + 1)) ] || { echo "other pages than those of commands"; failed=1; }
linted=0
if command -v mandoc >/dev/null 2>&1; then
    mandoc -Tlint -Wwarning "$pages"/*.1 || failed=1
    linted=1
fi
if command -v man >/dev/null 2>&1 && command -v groff >/dev/null 2>&1; then
    for page in "$pages"/*.1; do
        said=$(LC_ALL=C.UTF-8 MANROFFSEQ='' MANWIDTH=80 man --warnings -E UTF-8 -l -Tutf8 -Z "$page" 2>&1 >/dev/null) || failed=1
        [ -z "$said" ] || { printf '%s: %s\n' "$page" "$said"; failed=1; }
    done
    linted=1
fi
[ "$failed" = 0 ] || exit 1
[ "$linted" = 1 ] || { echo "skipped: no mandoc and no man to look at them with; packaging/apt.txt lists mandoc"; exit 77; }
echo "pages of $(echo "$commands" | wc -w) commands"
