#!/bin/sh
# The long tier's fuzzing: every libFuzzer target, built by clang with AddressSanitizer, UBSan and coverage of the whole
# host, for PORTCULLIS_FUZZ_SECONDS each (120). usage: fuzz_long.sh ROOT BUILD
# SPDX-License-Identifier: MIT
set -eu
root=$1
build=$2
seconds=${PORTCULLIS_FUZZ_SECONDS:-120}
[ "${PORTCULLIS_LONG:-0}" = 1 ] || { echo "skipped: takes minutes; ./run test --long"; exit 77; }
command -v clang-14 >/dev/null 2>&1 || { echo "skipped: no clang-14; packaging/apt.txt lists it"; exit 77; }
mkdir -p "$build"
cd "$root"
cmake --preset clang-asan -B "$build" -DPORTCULLIS_SANITIZE=address,undefined,fuzzer-no-link >"$build/log" 2>&1 || { cat "$build/log"; exit 1; }
targets=$(cmake --build "$build" --target help | sed -n 's/^\(fuzz_[a-z]*\): .*/\1/p' | sort -u)
[ -n "$targets" ] || { echo "no fuzz targets"; exit 1; }
# shellcheck disable=SC2086 # a list of words
cmake --build "$build" --target $targets >"$build/log" 2>&1 || { grep -v '^\[' "$build/log" | tail -n 100; exit 1; }
failed=0
for target in $targets; do
    kind=${target#fuzz_}
    corpus=$build/corpus/$kind
    mkdir -p "$corpus"
    for file in "$root"/../shared/scenes/*/*."$kind" "$root"/scenes/*."$kind"; do # the heads of real files; libFuzzer cuts and joins them
        if [ -f "$file" ]; then head -c 6000 "$file" >"$corpus/$(basename "$file")"; fi
    done
    case $kind in
    brushes) cp "$root/scenes/pillars.json" "$corpus/" ;;
    input | compile) # whole small maps: cut ones are refused before the compiler sees them
        for file in "$root"/../shared/scenes/*/*.map; do
            [ -f "$file" ] || continue
            awk '{ print; size += length + 1 } /^ *}/ && size > 4000 { print "}"; exit }' "$file" >"$corpus/$(basename "$file")"
        done
        number=0 # the boxes of the source
        sed -n 's/^ *"\(\\1[^"]*\)".*/\1/p' "$root/tests/compile/fuzz_$kind.c" | while read -r boxes; do
            number=$((number + 1))
            printf '%b' "$(printf '%s' "$boxes" | sed 's/\\/\\0/g')" >"$corpus/boxes$number"
        done
        ;;
    esac
    if "$build/bin/$target" -max_total_time="$seconds" -max_len=8192 -timeout=10 -rss_limit_mb=2048 -artifact_prefix="$build/$kind-" "$corpus" \
        >"$build/$kind.log" 2>&1; then
        printf '%s: %s\n' "$target" "$(tail -n 1 "$build/$kind.log")"
    else
        failed=1
        printf 'FAILED %s; the input stands in %s\n' "$target" "$build"
        tail -n 60 "$build/$kind.log"
    fi
done
exit "$failed"
