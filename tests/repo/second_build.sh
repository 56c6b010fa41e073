#!/bin/sh
# Builds everything once more by a preset, warnings being errors, and runs the tests of that build but those that carry
# the label `tree` or LABEL. usage: second_build.sh ROOT BUILD PRESET LABEL [NEEDED_COMMAND]
# SPDX-License-Identifier: MIT
set -eu
root=$1
build=$2
preset=$3
label=$4
if [ $# -gt 4 ] && ! command -v "$5" >/dev/null 2>&1; then
    echo "skipped: no $5 here; packaging/apt.txt lists it"
    exit 77
fi
mkdir -p "$build"
log=$build/second_build.log
cd "$root"
cmake --preset "$preset" -B "$build" -DPORTCULLIS_WERROR=ON -DPORTCULLIS_MUTANTS=OFF >"$log" 2>&1 || { cat "$log"; exit 1; }
cmake --build "$build" >"$log" 2>&1 || { grep -v '^\[' "$log" | tail -n 200; exit 1; }
if grep -i 'warning:' "$log"; then exit 1; fi
export ASAN_OPTIONS="detect_stack_use_after_return=1"
export UBSAN_OPTIONS="print_stacktrace=1:halt_on_error=1"
export LSAN_OPTIONS="suppressions=$root/packaging/lsan.supp:print_suppressions=0"
unset PORTCULLIS_LONG # the short tier, also in a long run
# The driver's cache of shaders has a thread that may start as the process ends; LeakSanitizer then dies looking at it ("Tracer caught signal").
export MESA_SHADER_CACHE_DISABLE=true
ctest --test-dir "$build" -LE "^(tree|$label)\$" -j 2 --output-on-failure --no-tests=error
