#!/bin/sh
# Every culler of ours passes its check: two seeds in the short tier, ten in the long one. usage: ours.sh PORTCULLIS
# SPDX-License-Identifier: MIT
set -eu
portcullis=$1
seeds="1 2"
[ "${PORTCULLIS_LONG:-0}" = 1 ] && seeds="1 2 3 4 5 6 7 8 9 10"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
for culler in none brute flood frustum octree bsp portal occlusion imagecache; do
    for seed in $seeds; do
        if "$portcullis" check "$culler" --seed "$seed" >"$work/said" 2>&1; then
            echo "$culler, seed $seed: $(tail -n 1 "$work/said")"
        else
            echo "FAILED $culler, seed $seed:"
            grep -v '^pass\|^skip' "$work/said" || :
            failed=1
        fi
    done
done
exit $failed
