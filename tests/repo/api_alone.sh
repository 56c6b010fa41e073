#!/bin/sh
# Each header of api/ compiles alone, as strict C11 and as C++17, by each compiler there is. usage: api_alone.sh ROOT
# SPDX-License-Identifier: MIT
set -eu
root=$1
failed=0
tried=0
warnings="-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -pedantic-errors"
try() { # COMPILER STANDARD LANGUAGE HEADER
    command -v "$1" >/dev/null 2>&1 || return 0
    tried=$((tried + 1))
    # shellcheck disable=SC2086 # a list of words
    printf '#include <portcullis/%s>\n#include <portcullis/%s>\nint there_is_something;\n' "$4" "$4" |
        "$1" -std="$2" -x "$3" $warnings -I"$root/api" -fsyntax-only - || { echo "$4: $1 -std=$2 refuses it"; failed=1; }
}
for header in "$root"/api/portcullis/*.h; do
    name=${header##*/}
    try gcc c11 c "$name"
    try clang-14 c11 c "$name"
    try g++ c++17 c++ "$name"
    try clang++-14 c++17 c++ "$name"
done
echo "$tried compilations"
[ "$tried" -gt 0 ] || failed=1
exit $failed
