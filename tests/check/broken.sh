#!/bin/sh
# Each broken culler fails with a check that is about its fault, and with no other; the right one they are made of passes.
# One seed in the short tier, three in the long one. usage: broken.sh PORTCULLIS FAULTS FOLDER
# SPDX-License-Identifier: MIT
set -eu
portcullis=$1
faults=$2
folder=$3
seeds=1
[ "${PORTCULLIS_LONG:-0}" = 1 ] && seeds="1 2 3"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
count=0

judge() { # NAME SEED CODE ALLOWED...: what the run said stands in $work/said
    name=$1
    seed=$2
    code=$3
    shift 3
    named=$(sed -n 's/^FAIL \([a-z]*\):.*/\1/p' "$work/said")
    wrong=
    if [ $# = 0 ]; then
        [ "$code" = 0 ] && [ -z "$named" ] || wrong="a right culler does not pass"
    else
        [ "$code" = 1 ] && [ -n "$named" ] || wrong="its fault is not found"
    fi
    for check in $named; do
        case " $* " in
        *" $check "*) ;;
        *) wrong="$check fails, which is not about its fault" ;;
        esac
    done
    count=$((count + 1))
    [ -z "$wrong" ] && return
    echo "FAILED $name, seed $seed: $wrong"
    grep -e '^FAIL' "$work/said" || :
    failed=1
}

while read -r name macro checks; do
    case $name in '#'*) continue ;; esac
    [ -n "$macro" ] || continue
    for seed in $seeds; do
        code=0
        "$portcullis" check "$folder/$name.culler.so" --seed "$seed" >"$work/said" 2>&1 </dev/null || code=$?
        # shellcheck disable=SC2086 # a list of words
        judge "$name" "$seed" "$code" $checks
    done
done <"$faults"
echo "$count runs looked at"
[ "$count" -ge 20 ] || failed=1
exit $failed
