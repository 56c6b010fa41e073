#!/bin/sh
# A plugin exports one symbol, cull_entry, and it is data. usage: plugin_symbols.sh LIBRARY...
# SPDX-License-Identifier: MIT
set -eu
failed=0
[ $# -gt 0 ] || { echo "no plugin named"; exit 1; }
for library in "$@"; do
    exported=$(nm -D --defined-only "$library" | awk '{ print $NF, $(NF - 1) }')
    case $exported in
    "cull_entry R" | "cull_entry D" | "cull_entry B") echo "$library: cull_entry" ;;
    *) echo "$library exports other than the one constant cull_entry:"; printf '%s\n' "$exported"; failed=1 ;;
    esac
done
exit $failed
