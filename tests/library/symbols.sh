#!/bin/sh
# The library exports what its header declares, and nothing else.
# SPDX-License-Identifier: MIT
# usage: symbols.sh LIBRARY HEADER
set -eu
LC_ALL=C
export LC_ALL
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
nm -D --defined-only "$1" | awk '{print $3}' | sed 's/@.*//' | sort -u >"$work/exported"
sed -n 's/^CULL_API .*[ *]\(cull_[a-z_]*\)(.*/\1/p' "$2" | sort -u >"$work/declared"
[ -s "$work/declared" ] || { echo "no declaration found in $2"; exit 1; }
diff "$work/declared" "$work/exported"
echo "$(wc -l <"$work/declared") functions, exported as declared"
