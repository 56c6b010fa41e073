#!/bin/sh
# `portcullis new-culler`: the project that it writes builds by CMake and by make, and its test passes; made wrong, it fails.
# SPDX-License-Identifier: MIT
# usage: new_culler.sh CMAKE BUILD
set -u # expect and holds look at exit codes
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
. "$here/install.sh"
. "$here/../app/check.sh"
cmake=$1
install_moved "$1" "$2"
cd "$work" || exit 1
new() { "$portcullis" new-culler "$@"; }

expect 'a project' 0 "mine: the culler 'my-own2'" new my-own2 mine/
for file in CMakeLists.txt Makefile README.md my-own2.c test.sh; do holds "it has $file" test -s "mine/$file"; done
holds 'and nothing else' test "$(find mine -type f | wc -l)" = 5
no_marks() { ! grep -rE '@[A-Z]+@' mine; }
holds 'no mark is left' no_marks
holds 'folders are as usual' test "$(stat -c %a mine)" = "$(mkdir usual && stat -c %a usual)"

expect 'it builds by CMake' 0 'my-own2\.culler\.so' sh -c "'$cmake' -S mine -B built -DCMAKE_PREFIX_PATH='$sdk' && '$cmake' --build built"
tested() { ctest --test-dir built --output-on-failure; }
expect 'and passes its test' 0 '100% tests passed' tested
"$cmake" --install built >/dev/null
expect 'it is installed for the user' 0 'data/portcullis/plugins/my-own2\.culler\.so \(the user' "$portcullis" plugins
expect 'after that its name is taken' 2 "error: a culler 'my-own2' is there already" new my-own2 again
if command -v make >/dev/null 2>&1; then
    PKG_CONFIG_PATH=$packages
    export PKG_CONFIG_PATH
    expect 'it builds by make' 0 'my-own2\.culler\.so' make -C mine
    expect 'and would be tested as it was by CMake' 0 "test\\.sh \`pkg-config --variable=portcullis portcullis-plugin\` ./my-own2" make -C mine -n test
    holds 'and shows one symbol' sh "$here/../repo/plugin_symbols.sh" mine/my-own2.culler.so built/my-own2.culler.so
else
    echo 'not tried: no make; packaging/apt.txt lists it'
fi

# each a mistake that somebody makes; sed must find the line that it breaks
wrong() { # NAME SED WHAT_THE_TEST_SAYS
    cp mine/my-own2.c right.c
    sed "$2" right.c >mine/my-own2.c
    holds "$1: is another text" test "$(cksum <right.c)" != "$(cksum <mine/my-own2.c)"
    "$cmake" --build built >"$work/log" 2>&1 || { cat "$work/log"; failed=1; }
    expect "$1: its test fails" 8 "$3" tested
    cp right.c mine/my-own2.c
}
wrong 'one item in a hundred is forgotten' 's/if (is_seen(visit, cull_box_at(/if (i % 100 != 7 \&\& is_seen(visit, cull_box_at(/' \
    'FAIL conservative: it drops item'
wrong 'only the first item of a group is around its box' \
    's/box = cull_box_union(box, cull_box_at(&zone->boxes, i));/if (i % c->group_size == 0) box = cull_box_at(\&zone->boxes, i);/' \
    'FAIL conservative: it drops item'
wrong 'more runs than were told' 's/out->max_runs = .*/out->max_runs = 1;/' 'FAIL batch: it gave more runs than max_runs'

for name in '' 'Mine' '3d' '-x' 'a b' 'a/b' '../x' "$(printf 'a%.0s' $(seq 64))"; do
    expect "name '$name'" 2 "error: .*no name for a culler" new -- "$name" other
done
expect 'a name that is taken by one built in' 2 "a culler 'brute' is there already" new brute other
expect 'a folder that is there' 2 'usual: error: is there already' new other usual
expect 'a file that is there' 2 'right.c: error: is there already' new other right.c
ln -s nowhere dangling
expect 'a link to nothing' 2 'dangling: error: is there already' new other dangling
expect 'no place for it' 2 'none/other: error: ' new other none/other
expect 'no folder' 2 'NAME and DIR are needed' new other
expect 'too many words' 2 'also' new other one two
# a file system that takes 1 KiB of a file, and no more: the source is longer
no_room() { (trap '' XFSZ && ulimit -f 2 && exec "$portcullis" new-culler other other); }
expect 'no room for it' 2 'other.*error: ' no_room
if [ "$(id -u)" != 0 ]; then
    mkdir shut && chmod 500 shut
    expect 'a folder that may not be written to' 2 'error: ' new other shut/other
fi
holds 'nothing is left of those' test "$(find . -name 'other*' -o -name '*.??????' -prune | wc -l)" = 0
finish
