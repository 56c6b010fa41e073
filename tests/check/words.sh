#!/bin/sh
# What `portcullis check` says to a person and to a program: exit codes, the line that repeats a failure, JSON, wrong use.
# usage: words.sh PORTCULLIS FOLDER
# SPDX-License-Identifier: MIT
set -eu
portcullis=$1
folder=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
go() { # sets code
    code=0
    "$portcullis" "$@" >"$work/out" 2>"$work/err" </dev/null || code=$?
}
expect() { # WHAT CODE PATTERN FILE
    if [ "$code" != "$2" ] || ! grep -q -e "$3" "$work/$4"; then
        echo "failed: $1: exit $code, wanted $2 and '$3'"
        cat "$work/out" "$work/err"
        failed=1
    fi
}
bad=$folder/drops-one-in-1000.culler.so
go check
expect "no culler is wrong use" 2 "no culler was named" err
go check no-such-culler
expect "an unknown id is wrong use" 2 "no-such-culler" err
go check "$work/none.so"
expect "a file that is not there is wrong use" 2 "cannot be opened" err
go check brute --seed x
expect "a seed is a number" 2 "seed" err
go check brute --only nothing
expect "an unknown check is wrong use" 2 "no check 'nothing'" err
go check --list
expect "the checks can be listed" 0 "^conservative " out
echo "no library" >"$work/text.so"
go check "$work/text.so"
expect "a file that is no library fails" 1 "^FAIL entry" out
go check "$folder/none.culler.so" --only bake
expect "one check alone" 0 "^1 passed, 0 failed" out
go check "$bad" --seed 7 --only conservative
expect "a failure says what and where" 1 "^FAIL conservative: it drops item [0-9]*, .*; in scene [a-z]*, view" out
expect "and how to see it again" 1 "again: portcullis check $bad --seed 7 --only conservative" out
cp "$work/out" "$work/first"
go check "$bad" --seed 7 --only conservative
cmp "$work/first" "$work/out" || { echo "failed: a seed does not repeat its failure"; failed=1; }
go check "$bad" --json
expect "JSON has each verdict" 1 '"verdict": "fail"' out
expect "JSON counts" 1 '"failed": [1-9]' out
exit $failed
