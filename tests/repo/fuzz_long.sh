#!/bin/sh
# The long tier's fuzzing: every libFuzzer target, built by clang with AddressSanitizer, UBSan and coverage of the whole
# host, for PORTCULLIS_FUZZ_SECONDS each (120). usage: fuzz_long.sh ROOT BUILD
# SPDX-License-Identifier: MIT
# PORTCULLIS_FUZZ_RECORD=FILE appends a line a target, and says what all lines of the file come to; PORTCULLIS_FUZZ_TARGETS="chain
# plugin" runs those only; PORTCULLIS_FUZZ_KEEP=1 makes the kept corpora anew, small, of what the run and they reach together. Such a
# run starts from the seeds of the source alone: nothing of others' files comes into the tree.
set -eu
root=$1
build=$2
seconds=${PORTCULLIS_FUZZ_SECONDS:-120}
record=${PORTCULLIS_FUZZ_RECORD:-}
keep=${PORTCULLIS_FUZZ_KEEP:-0}
[ "${PORTCULLIS_LONG:-0}" = 1 ] || { echo "skipped: takes minutes; ./run test --long"; exit 77; }
command -v clang-14 >/dev/null 2>&1 || { echo "skipped: no clang-14; packaging/apt.txt lists it"; exit 77; }
mkdir -p "$build"
case $record in '' | /*) ;; *) record=$PWD/$record ;; esac
cd "$root"
# shellcheck source=tests/fuzz/record.sh
. "$root/tests/fuzz/record.sh"
cmake --preset clang-asan -B "$build" -DPORTCULLIS_SANITIZE=address,undefined,fuzzer-no-link >"$build/log" 2>&1 || { cat "$build/log"; exit 1; }
targets=$(cmake --build "$build" --target help | sed -n 's/^\(fuzz_[a-z]*\): .*/\1/p' | sort -u)
if [ -n "${PORTCULLIS_FUZZ_TARGETS:-}" ]; then # shellcheck disable=SC2086 # a list of words
    targets=$(printf 'fuzz_%s\n' $PORTCULLIS_FUZZ_TARGETS)
fi
[ -n "$targets" ] || { echo "no fuzz targets"; exit 1; }
# shellcheck disable=SC2086 # a list of words
cmake --build "$build" --target $targets >"$build/log" 2>&1 || { grep -v '^\[' "$build/log" | tail -n 100; exit 1; }

length_most() { # short inputs run more often; a target takes what its kind needs to say everything once
    case $1 in chain) echo 256 ;; plugin) echo 192 ;; views) echo 512 ;; boxes) echo 1024 ;; obj | off | ply | bake) echo 2048 ;; pcs) echo 2048 ;; *) echo 4096 ;; esac
}

heads_of_real_files() { # KIND FOLDER: libFuzzer cuts and joins them
    [ "$keep" = 0 ] || return 0
    for file in "$root"/../shared/scenes/*/*."$1" "$root"/scenes/*."$1"; do
        if [ -f "$file" ]; then head -c 3000 "$file" >"$2/$(basename "$file")"; fi
    done
    case $1 in
    brushes) cp "$root/scenes/pillars.json" "$2/" ;;
    input | compile) # whole small maps: cut ones are refused before the compiler sees them
        for file in "$root"/../shared/scenes/*/*.map; do
            [ -f "$file" ] || continue
            awk '{ print; size += length + 1 } /^ *}/ && size > 2000 { print "}"; exit }' "$file" >"$2/$(basename "$file")"
        done
        ;;
    esac
}

keep_small() { # KIND LENGTH: what reaches as much, 120 inputs of all sizes, up to 10 kB
    rm -rf "$build/merged/$1" "$root/tests/fuzz/corpus/$1.new"
    mkdir -p "$build/merged/$1" "$root/tests/fuzz/corpus/$1.new"
    "$build/bin/fuzz_$1" -merge=1 -max_len="$2" "$build/merged/$1" "$root/tests/fuzz/corpus/$1" "$build/kept/$1" >"$build/$1.merge.log" 2>&1
    for file in "$root/tests/fuzz/corpus/$1"/once_* "$build/merged/$1"/*; do # once_...: an input that once failed, always kept
        if [ -f "$file" ]; then wc -c "$file"; fi
    done | awk '{ print ($2 ~ /\/once_/ ? 0 : 1), $0 }' | sort -s -n -k 1,1 -k 2,2 |
        awk '$1 == 0 { print; next } { line[++count] = $0 } END { step = count > 120 ? count / 120 : 1; for (i = 1; i <= count; i += step) print line[int(i)] }' |
        awk '{ sum += $2 } sum <= 10000 || $1 == 0 { print $3 }' | while read -r file; do
        cp "$file" "$root/tests/fuzz/corpus/$1.new/"
    done
    rm -rf "$root/tests/fuzz/corpus/$1"
    mv "$root/tests/fuzz/corpus/$1.new" "$root/tests/fuzz/corpus/$1"
}

failed=0
for target in $targets; do
    kind=${target#fuzz_}
    corpus=$build/corpus/$kind
    if [ "$keep" = 1 ]; then corpus=$build/kept/$kind; fi
    kept=$root/tests/fuzz/corpus/$kind
    mkdir -p "$corpus" "$kept"
    heads_of_real_files "$kind" "$corpus"
    PORTCULLIS_FUZZ_SEEDS=$corpus "$build/bin/$target" -runs=0 >"$build/$kind.log" 2>&1 || { cat "$build/$kind.log"; exit 1; }
    length=$(length_most "$kind")
    rm -f "$build/$kind-slow-unit"-* "$build/$kind-timeout"-*
    "$build/bin/$target" -max_total_time="$seconds" -max_len="$length" -timeout=60 -report_slow_units=1 -detect_leaks=1 -rss_limit_mb=2048 \
        -print_final_stats=1 -artifact_prefix="$build/$kind-" "$corpus" "$kept" >"$build/$kind.log" 2>&1 && ended=0 || ended=1
    fuzz_hangs "$build/bin/$target" "$build/$kind-slow-unit"-* "$build/$kind-timeout"-* >>"$build/$kind.log"
    if [ "$ended" -eq 0 ] && ! grep -q '^hang: ' "$build/$kind.log"; then
        printf '%s: %s\n' "$target" "$(fuzz_log_line "$build/$kind.log")"
    else
        failed=1
        printf 'FAILED %s; the input stands in %s\n' "$target" "$build"
        tail -n 60 "$build/$kind.log"
    fi
    if [ -n "$record" ]; then fuzz_record_append "$record" "$kind" "$build/$kind.log"; fi
    if [ "$keep" = 1 ]; then keep_small "$kind" "$length"; fi
    rmdir "$kept" 2>/dev/null || :
done
if [ -n "$record" ]; then fuzz_record_sum "$record"; fi
exit "$failed"
