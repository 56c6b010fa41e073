#!/bin/sh
# The long tier's proof that a scene file has the same bytes from every compiler: the command is built by gcc and clang, at
# -O0 and as fast as they can, and each build compiles every map and brush scene there is. usage: pcs_bytes.sh ROOT BUILD
# SPDX-License-Identifier: MIT
set -eu
root=$1
build=$2
[ "${PORTCULLIS_LONG:-0}" = 1 ] || { echo "skipped: builds four times; ./run test --long"; exit 77; }
command -v clang-14 >/dev/null 2>&1 || { echo "skipped: no clang-14; packaging/apt.txt lists it"; exit 77; }

build_one() { # NAME CC CXX FLAGS
    folder=$build/$1
    mkdir -p "$folder"
    cmake -S "$root" -B "$folder" -G Ninja -DCMAKE_C_COMPILER="$2" -DCMAKE_CXX_COMPILER="$3" -DCMAKE_BUILD_TYPE=None -DCMAKE_C_FLAGS="$4" \
        -DCMAKE_CXX_FLAGS="$4" -DPORTCULLIS_TESTS=OFF -DPORTCULLIS_WERROR=OFF >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
    cmake --build "$folder" --target portcullis plugin_frustum >"$folder/log" 2>&1 || { grep -v '^\[' "$folder/log" | tail -n 100; exit 1; }
}

build_one gcc-O0 gcc g++ -O0
build_one gcc-O3 gcc g++ '-O3 -DNDEBUG'
build_one clang-O0 clang-14 clang++-14 -O0
build_one clang-O3 clang-14 clang++-14 '-O3 -DNDEBUG'
sh "$(dirname "$0")/same_bytes.sh" "$root" "$build/work" all "$build/gcc-O0/bin/portcullis" "$build/gcc-O3/bin/portcullis" \
    "$build/clang-O0/bin/portcullis" "$build/clang-O3/bin/portcullis"
