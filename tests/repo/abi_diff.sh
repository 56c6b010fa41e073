#!/bin/sh
# abidiff's own opinion: a library with every type of today's culler.h differs from one with every type of the recorded header in
# nothing that breaks a plugin. usage: abi_diff.sh ROOT
# SPDX-License-Identifier: MIT
set -eu
root=$1
command -v abidiff >/dev/null 2>&1 || { echo "skipped: no abidiff; Debian's package abigail-tools has it"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
types=$(sed -n 's/^SIZE(\([a-z0-9_]*\),.*/\1/p' "$root/tests/abi/abi1_record.c")
[ -n "$types" ] || { echo "the record holds no types"; exit 1; }
{
    echo '#include <portcullis/culler.h>'
    for type in $types; do printf 'CULL_EXPORT %s *use_%s;\n' "$type" "$type"; done
} >"$work/types.c"
library() { # NAME HEADER
    mkdir -p "$work/$1/portcullis"
    cp "$2" "$work/$1/portcullis/culler.h"
    gcc -std=c11 -g -fPIC -shared -I"$work/$1" "$work/types.c" -o "$work/$1/types.so"
}
library recorded "$root/tests/abi/culler_abi1.h"
library today "$root/api/portcullis/culler.h"
sed 's/uint32_t point_count, reserved;/uint32_t point_count, reserved, more, one;/' "$root/api/portcullis/culler.h" >"$work/grown.h"
library grown "$work/grown.h"
abidiff --no-added-syms "$work/recorded/types.so" "$work/today/types.so" || { echo "abidiff calls this another ABI"; exit 1; }
if abidiff "$work/today/types.so" "$work/grown/types.so" >"$work/found"; then echo "abidiff does not find a struct that grew"; exit 1; fi
echo "abidiff: no change"
