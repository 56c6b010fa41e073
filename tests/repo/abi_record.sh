#!/bin/sh
# The plugin ABI stands as it is recorded in tests/abi: every size, place and value, by each compiler there is, and no
# declaration of the recorded header is gone or changed; comments may, and new declarations may come. usage: abi_record.sh ROOT
# SPDX-License-Identifier: MIT
set -eu
root=$1
record=$root/tests/abi/abi1_record.c
frozen=$root/tests/abi/culler_abi1.h
today=$root/api/portcullis/culler.h
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
tried=0
advice="the ABI differs from the recorded one: a new ability takes an extension (CONTRIBUTING.md, The plugin ABI); while CULL_ABI is 0: tests/abi/freeze.py ."

holds() { # COMPILER STANDARD LANGUAGE API
    "$1" -std="$2" -x "$3" -I"$4" -fsyntax-only -Wall -Wextra -Wpedantic -Werror "$record" 2>"$work/errors"
}
try() { # COMPILER STANDARD LANGUAGE
    command -v "$1" >/dev/null 2>&1 || return 0
    tried=$((tried + 1))
    holds "$1" "$2" "$3" "$root/api" || { cat "$work/errors"; echo "$1 -std=$2: $advice"; failed=1; }
}
try gcc c11 c
try clang-14 c11 c
try g++ c++17 c++
try clang++-14 c++17 c++
[ "$tried" -gt 0 ] || { echo "no compiler"; exit 1; }

# Declarations alone: no comments, one space between words, a line for each of the preprocessor's and for each ; { or }. The number itself
# is left out.
declarations() {
    gcc -fpreprocessed -dD -E -P -x c "$1" 2>/dev/null | grep -v '^ *# *define CULL_ABI \|^#ifndef CULL_ABI$' |
        awk '/^#/ { print; next } { gsub(/[;{}]/, "&\n"); printf "%s ", $0 }' | awk '{ gsub(/[ \t]+/, " "); sub(/^ /, ""); sub(/ $/, "") } length' |
        grep -v '^#if\|^#endif\|^#else\|^#elif'
}
declarations "$frozen" >"$work/frozen"
declarations "$today" >"$work/today"
[ "$(wc -l <"$work/frozen")" -gt 200 ] || { echo "the recorded header has no declarations"; failed=1; }
if diff "$work/frozen" "$work/today" | grep '^<' >"$work/gone"; then
    echo "gone or changed since the record:"
    cat "$work/gone"
    echo "$advice"
    failed=1
fi

# The record finds what it is for: a field more, two that change places, a wider enumerator, another value.
mutate() { # NAME SED
    mkdir -p "$work/$1/portcullis"
    sed "$2" "$today" >"$work/$1/portcullis/culler.h"
    if cmp -s "$today" "$work/$1/portcullis/culler.h"; then echo "$1 changes nothing"; failed=1; fi
    if holds gcc c11 c "$work/$1"; then echo "$1 is not found"; failed=1; fi
}
mutate field_more 's/uint32_t point_count, reserved;/uint32_t point_count, reserved, more;/'
mutate fields_swapped 's/uint32_t run_count, slot;/uint32_t slot, run_count;/'
mutate field_wider 's/^    float near_distance;/    double near_distance;/'
mutate slots_swapped 's/(\*close)(cull_query \*)/(*shut)(cull_query *)/'
mutate value_changed 's/CULL_WAIT = 2,/CULL_WAIT = 3,/'
mutate limit_changed 's/CULL_MAX_PLANES 32u/CULL_MAX_PLANES 64u/'
echo "$tried compilers, $(grep -c '^AT(' "$record") fields"
exit "$failed"
