#!/bin/sh
# Bad input at the command line: `FILE:LINE: error: what and what to do`, exit code 2, nothing written, no crash.
# SPDX-License-Identifier: MIT
# usage: bad_input.sh PORTCULLIS REFUSED_PLUGINS
portcullis=$1
plugins=$2
. "$(dirname "$0")/check.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

: > empty.map
: > empty.obj
: > empty.boxes
: > empty.views
head -c 4096 /dev/urandom > noise.map
cp noise.map noise.obj
cp noise.map noise.ply
cp noise.map noise.off
cp noise.map noise.boxes
cp noise.map noise.stl
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' > good.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n' > index.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n' > nan.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1e300 0\nf 1 2 3\n' > huge.obj
printf 'v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n' > flat.obj
{ printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf'; awk 'BEGIN { for (i = 0; i < 1000000; i++) printf " %d", i % 3 + 1; print "" }'; } > million.obj
printf '{\n"classname" "worldspawn"\n{\n( 0 0 0 ) ( 1 0 0 ) ( 0 1 0 ) wall 0 0 0 1 1\n' > unclosed.map
printf '{\n"classname" "worldspawn"\n{\n( 0 0 0 ) ( 64 0 0 ) ( 0 64 0 ) wall 0 0 0 1 1\n( 0 0 0 ) ( 0 64 0 ) ( 0 0 64 ) wall 0 0 0 1 1\n( 0 0 0 ) ( 0 0 64 ) ( 64 0 0 ) wall 0 0 0 1 1\n( 0 0 64 ) ( 0 64 64 ) ( 64 0 64 ) wall 0 0 0 1 1\n}\n}\n' > unbounded.map
printf 'boxes 2\n0 0 0 1 1 1\n' > short.boxes
printf 'boxes 1\n0 0 0 -1 1 1\n' > inverted.boxes
printf '0 0 0 0 0 -1 0 1 0 60 1 0.1 100\n0 0 0 nan 0 -1 0 1 0 60 1 0.1 100\n' > nan.views
printf '0 0 0 0 0 -1 0 1 0 60 1\n' > short.views
printf 'not a library\n' > text.culler.so

for kind in map obj boxes; do expect "empty .$kind" 2 "empty\.$kind(:[0-9]+)?: error: " "$portcullis" info "empty.$kind"; done
for kind in map obj ply off boxes stl; do expect "noise .$kind" 2 "noise\.$kind(:[0-9]+)?: error: " "$portcullis" info "noise.$kind"; done
expect 'index out of range' 2 'index.obj:4: error: ' "$portcullis" info index.obj
expect 'NaN coordinate' 2 'nan.obj:3: error: ' "$portcullis" info nan.obj
expect '1e300' 2 'huge.obj:3: error: ' "$portcullis" info huge.obj
expect 'only zero-area faces' 2 'flat.obj(:[0-9]+)?: error: ' "$portcullis" info flat.obj
expect 'a line of a million indices' 2 'million.obj:4: error: ' "$portcullis" info million.obj
expect 'unclosed map' 2 'unclosed.map:[0-9]+: error: ' "$portcullis" info unclosed.map
expect 'unbounded brush' 2 'unbounded.map:[0-9]+: error: .*brush' "$portcullis" info unbounded.map
expect 'fewer boxes than said' 2 'short.boxes:[0-9]+: error: ' "$portcullis" info short.boxes
expect 'box inside out' 2 'inverted.boxes:2: error: ' "$portcullis" info inverted.boxes
expect 'missing file' 2 'nowhere.map: error: .*check' "$portcullis" info nowhere.map
expect 'unknown ending' 2 'text.culler.so: error: .*\.map' "$portcullis" info text.culler.so
expect 'a folder' 2 'error: ' "$portcullis" info .

bench() { expect "$1" 2 "$2" "$portcullis" bench good.obj --views "$3" --culler "$4" --no-truth --json out.json; }
bench 'empty views' 'empty.views(:[0-9]+)?: error: ' empty.views none
bench 'NaN in views' 'nan.views:2: error: ' nan.views none
bench 'short view' 'short.views:1: error: ' short.views none
bench 'auto:0' 'error: .*auto' auto:0 none
bench 'no such culler' "error: no culler 'nothing'; found: .*none, brute" auto:2 nothing
bench 'empty chain' 'error: chain' auto:2 ''
bench 'open bracket' "error: chain .*'\\]'" auto:2 'brute[isa=plain'
bench 'no such option' "has no option 'depth'; it has: " auto:2 'brute[depth=3]'
bench 'bad value' 'brute.*isa' auto:2 'brute[isa=abacus]'
bench 'not first' 'error: ' auto:2 'none+none'
holds 'nothing was written' test ! -e out.json
expect 'no command' 2 'no command' "$portcullis" frobnicate
expect 'bad size' 2 'WxH' "$portcullis" bench good.obj --views auto:2 --size 12
expect 'no such zone' 2 'zones of this scene' "$portcullis" bench good.obj --views auto:2 --zone kitchen=none
expect 'no such zone, by name' 2 "there is no zone 'kitchen'; the zones of this scene are: all" "$portcullis" bench good.obj --views auto:2 --zone kitchen=none
expect 'no zone before the sign' 2 "'=none': write NAME=CHAIN" "$portcullis" bench good.obj --views auto:2 --zone =none
expect 'seed too large' 2 'whole number from 0 to 18446744073709551614' "$portcullis" generate city -s 18446744073709551615 -o city.boxes
printf '{"portcullis": 1, "boxes": [{"min": [0,0,0], "max": [1,1,1]}], "zones": [{"name": "hall", "chain": "nothing"}]}' > chain.json
expect 'a culler of the file that is not there' 2 "^chain.json: error: zone 'hall': no culler 'nothing'; found: " "$portcullis" bench chain.json --views auto:2 --culler scene
sed 's/nothing/brute[depth=3]/' chain.json > option.json
expect 'an option of the file that is not there' 2 "^option.json: error: zone 'hall': .*has no option 'depth'" "$portcullis" bench option.json --views auto:2 --culler scene
tab="$(printf 'tab\there.json')"
expect 'a name with a tab' 0 '' "$portcullis" generate maze -n 10 -o "$tab"
expect 'a scene whose name has a tab' 0 'zones +10' "$portcullis" info "$tab"
expect 'a name that is not UTF-8' 2 'not UTF-8' "$portcullis" generate maze -n 10 -o "$(printf 'b\377d.json')"
for culler in 'all=none' 'brute;all=none' ';none' 'all=none;' '=none;brute' 'all=;brute'; do
  expect "a culler without the other zones: $culler" 2 "'$culler': write NAME=CHAIN;CHAIN" "$portcullis" bench good.obj --views auto:2 --culler "$culler"
done
expect 'a culler of no such zone' 2 "there is no zone 'kitchen'" "$portcullis" bench good.obj --views auto:2 --culler 'kitchen=none;brute'
expect 'a culler of no such chain' 2 "no culler 'nobody'" "$portcullis" bench good.obj --views auto:2 --culler 'all=nobody;brute'
expect 'a zone named twice by a culler' 2 'already' "$portcullis" bench good.obj --views auto:2 --culler 'all=none;all=brute;none'
expect 'a zone named twice' 2 'already' "$portcullis" bench good.obj --views auto:2 --zone all=none --zone all=brute
expect 'unwritable result, told first' 2 'nowhere/out.json: error: cannot be written' "$portcullis" bench missing.obj --views auto:2 --json nowhere/out.json
expect 'unwritable picture, told first' 2 'nowhere/out.png: error: cannot be written' "$portcullis" render missing.obj --views auto:2 -o nowhere/out.png
expect 'no such culler, told before the scene is read' 2 "no culler 'nothing'" "$portcullis" bench missing.obj --views auto:2 --culler nothing --images pictures
holds 'no folder is left' test ! -e pictures
expect 'view out of range' 2 'counted from 0' "$portcullis" render good.obj --views auto:2 --view 2 -o out.png
holds 'no picture was written' test ! -e out.png
expect 'bad kind' 2 'city' "$portcullis" generate castle -o castle.obj
holds 'nothing was generated' test ! -e castle.obj

PORTCULLIS_PLUGIN_PATH=$work expect 'not a library' 2 'text.culler.so: error: refused: ' "$portcullis" bench good.obj --views auto:2 --culler text --no-truth
if [ -d "$plugins" ]; then
  for library in "$plugins"/abi-*.culler.so; do
    expect 'another ABI number, listed' 0 'refused .*ABI number' "$portcullis" plugins --plugin "$library"
    expect 'another ABI number, used' 2 'error: refused: .*ABI number' "$portcullis" bench good.obj --views auto:2 --no-truth --culler none --plugin "$library"
  done
  expect 'no symbol' 2 'error: refused: .*cull_entry' "$portcullis" bench good.obj --views auto:2 --no-truth --culler none --plugin "$plugins/no-symbol.culler.so"
fi
finish
