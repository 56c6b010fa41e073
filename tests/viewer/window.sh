#!/bin/sh
# The viewer in a real window: what it shows is what is rendered without one, and its keys do what they say.
# SPDX-License-Identifier: MIT
# usage: window.sh PORTCULLIS SCENE SAME_REGION
portcullis=$1
scene=$2
same_region=$3
. "$(dirname "$0")/../app/check.sh"
for tool in xvfb-run Xvfb xauth; do
    command -v "$tool" >/dev/null || { echo "SKIPPED viewer: no $tool; install xvfb and xauth to run this test"; exit 77; }
done
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
words=$work/words

# press KEYS NAME: the viewer with these keys, its last frame as NAME.png
press() {
    expect "keys $1" 0 '^$' xvfb-run -a -s '-screen 0 1024x768x24' "$portcullis" view "$scene" --views path: --size 640x360 --doors shut --keys "$1" -o "$work/$2.png"
}
same() { holds "$1" "$same_region" "$work/$2.png" "$work/$3.png" 0 160 640 170; }
differs() { holds "$1" sh -c '"$1" "$2" "$3" 0 160 640 170 >"$4"; test $? = 1' sh "$same_region" "$work/$2.png" "$work/$3.png" "$words"; }

press 't...' still
expect 'the same view without a window' 0 '' "$portcullis" render "$scene" --views path: --size 640x360 --doors shut -o "$work/alone.png"
same 'the window shows what is rendered without one' still alone
press 'tc.c.c.c.' swapped
same 'other cullers of the zone show the same' swapped still
press 'tcccccccc' round
same 'round all of them' round still
chosen() { expect "cullers $1" 0 '^$' xvfb-run -a -s '-screen 0 1024x768x24' "$portcullis" view "$scene" --views path: --size 640x360 --doors shut --keys "$1" -o "$work/$2.png" \
    --culler frustum --culler none --culler 'frustum[isa=plain]'; }
words_same() { holds "$1" "$same_region" "$work/$2.png" "$work/$3.png" 0 330 400 30; }
words_differ() { holds "$1" sh -c '"$1" "$2" "$3" 0 330 400 30 >"$4"; test $? = 1' sh "$same_region" "$work/$2.png" "$work/$3.png" "$words"; }
chosen 'tc....' one
chosen 'tcc...' two
chosen 'tccc..' three
chosen 'tcccc.' four
words_differ 'C goes through the cullers that were named' one two
words_differ 'one after the other' two three
holds 'back to the chain of the file and on' sh -c '"$1" "$2" "$3" 0 330 400 30 >"$4" || "$1" "$2" "$5" 0 330 400 30 >"$4"' sh "$same_region" "$work/four.png" "$work/one.png" "$words" "$work/two.png"
press 'to..' opened
differs 'the door in front opens' opened still
press 'too.' shut
same 'and shuts again' shut still
press 'tx..' scissor
same 'cut to the rectangles of the zones it shows the same' scissor still
press 'tfssssss' frozen
press 'tssssss.' free
differs 'frozen culling shows its volumes' frozen free
press 'tv..' items
differs 'another mode' items still
expect 'a picture taken on the way' 0 '' xvfb-run -a "$portcullis" view "$scene" --views path: --size 640x360 --keys 'p.' -o "$work/taken.png"
holds 'is there' test -s "$work/taken.png"
expect 'a window needs a display' 3 'error' env -u DISPLAY -u WAYLAND_DISPLAY "$portcullis" view "$scene" --frames 1
expect 'and a scene' 2 'SCENE is needed' "$portcullis" view
finish
