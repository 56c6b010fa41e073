#!/bin/sh
# The first wrong pixel of broken plugins: view, item, reason, a picture, and a command that shows it again; nothing of a healthy one.
# usage: test_first_miss.sh PORTCULLIS MUTANTS_FOLDER TWO_ROOMS CELLAR
# SPDX-License-Identifier: MIT
portcullis=$1 mutants=$2 rooms=$3 cellar=$4
. "$(dirname "$0")/counters.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
says() { # NAME PATTERN: `out` holds it
  if grep -q "$2" "$work/out"; then passed=$((passed + 1)); else
    printf 'FAILED %s: no line like %s in\n' "$1" "$2"
    cat "$work/out"
    failed=$((failed + 1))
  fi
}
hunt() { # words: the exit code goes to $code
  "$portcullis" first-miss "$@" --size 320x180 -o "$work/miss.png" >"$work/out" 2>"$work/errors"
  code=$?
  [ "$code" -ne 3 ] || skip 'no OpenGL'
}

hunt "$rooms" --views auto:4 --culler frustum
is 'a healthy culler' "$code" 0
says 'a healthy culler' '^no miss: .* 4 views'
is 'no picture of nothing' "$([ -e miss.png ] && echo there)" ''

"$portcullis" compile "$cellar" --portals auto -o cellar.pcs >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
broken=$mutants/portal-skips-a-portal-in-8
hunt cellar.pcs --views auto:edges:16 --plugin "$broken/portal.culler.so" --culler 'frustum[backface=1]+portal[clip=planes]'
is 'a portal left out' "$code" 1
says 'view and pixel' '^first miss: view [0-9]* of 16, pixel [0-9]* [0-9]* of 320x180'
says 'item' '^item: [0-9]*, of .* owns [0-9]* pixel'
says 'promise' 'items missed, all promised'
says 'history' '^history: none'
says 'reason' "^ *zone '.*' was not reached:"
is 'a picture' "$(head -c 4 miss.png | od -An -c | tr -d ' ')" '211PNG'
says 'the command' "^again: portcullis explain cellar.pcs .*--culler 'frustum.backface=1.+portal.clip=planes.' .*--view [0-9]* --item [0-9]* --truth"
again=$(sed -n 's/^again: portcullis explain//p' "$work/out")
eval "\"\$portcullis\" explain $again" >"$work/explained"
is 'it shows the miss again' "$(grep -c ': missed$' "$work/explained")" 1

"$portcullis" generate city -n 3000 -o city.boxes >"$work/log" 2>&1 || exit 1
stale=$mutants/occlusion-believes-the-last-frame
hunt city.boxes --views auto:walk:60 --plugin "$stale/occlusion.culler.so" --culler occlusion
is 'a stale answer' "$code" 1
says 'history is needed' '^history: from view [0-9]* on'
says 'reason' "^ *culler 'occlusion' dropped it"
again=$(sed -n 's/^again: portcullis first-miss//p' "$work/out")
eval "\"\$portcullis\" first-miss $again -o again.png" >"$work/out"
is 'the walk misses again' "$?" 1

hunt "$rooms" --views auto:4 --from 4
is 'a view that is not there' "$code" 2
hunt "$rooms" --views auto:4 --culler nothing-of-that-name
is 'a culler that is not there' "$code" 2
finish
