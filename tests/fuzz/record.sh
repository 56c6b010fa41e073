# The record of fuzzing, for fuzz_long.sh to read in: a line a target and run, tabs between, and what all lines come to.
# SPDX-License-Identifier: MIT

fuzz_log_number() { # LOG NAME: of libFuzzer's final figures; 0 where it said none
    sed -n "s/^stat::$2: *//p" "$1" | tail -n 1 | grep . || echo 0
}

fuzz_log_seconds() { # LOG
    sed -n 's/^Done [0-9]* runs in \([0-9]*\) second.*/\1/p' "$1" | tail -n 1 | grep . || echo 0
}

fuzz_log_count() { # LOG PATTERN: 1 or 0, a run ends with the first
    if grep -qE "$2" "$1"; then echo 1; else echo 0; fi
}

# libFuzzer's clock goes on while others have the processor: what took it over 1 s is run again alone, and judged by its own time.
fuzz_hangs() { # PROGRAM INPUT...: a line for each input that takes over 1 s of the processor
    program=$1
    shift
    for input in "$@"; do
        [ -f "$input" ] || continue
        # shellcheck disable=SC2016 # the inner shell's
        sh -c '"$0" -timeout=60 "$1" >/dev/null 2>&1; times' "$program" "$input" | tail -n 1 | tr 'ms' '  ' |
            awk -v input="$input" '{ seconds = 60 * ($1 + $3) + $2 + $4 } seconds > 1 { printf "hang: %.1f s, %s\n", seconds, input }'
    done
}

fuzz_log_line() { # LOG
    printf '%s executions in %s s, %s a second\n' "$(fuzz_log_number "$1" number_of_executed_units)" "$(fuzz_log_seconds "$1")" \
        "$(fuzz_log_number "$1" average_exec_per_sec)"
}

fuzz_record_append() { # RECORD KIND LOG
    [ -s "$1" ] || printf 'date\tcommit\ttarget\texecutions\tseconds\tcrashes\tleaks\thangs\n' >>"$1"
    commit=$(git rev-parse --short=12 HEAD 2>/dev/null || echo unknown)
    if [ "$commit" != unknown ] && ! git diff --quiet HEAD -- api host plugins tests 2>/dev/null; then commit=$commit+; fi # + changes
    printf '%s\t%s\t%s\t%s\t%s\t%s\t%s\t%s\n' "$(date -u +%Y-%m-%d)" "$commit" "$2" "$(fuzz_log_number "$3" number_of_executed_units)" \
        "$(fuzz_log_seconds "$3")" "$(fuzz_log_count "$3" 'ERROR: AddressSanitizer|runtime error:|deadly signal|out-of-memory')" \
        "$(fuzz_log_count "$3" 'ERROR: LeakSanitizer')" "$(grep -c '^hang: ' "$3")" >>"$1"
}

fuzz_record_sum() { # RECORD
    awk -F '\t' 'NR > 1 { runs += $4; time += $5; crashes += $6; leaks += $7; hangs += $8 }
        END { printf "%.0f executions in %.0f s over %d runs: %d crashes, %d leaks, %d hangs\n", runs, time, (NR > 1 ? NR - 1 : 0), crashes, leaks, hangs }' "$1"
}
