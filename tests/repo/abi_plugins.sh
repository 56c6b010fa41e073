#!/bin/sh
# Plugins built with the recorded header of ABI number 1 work in today's host: the same counts on a scene as those built with
# today's. usage: abi_plugins.sh ROOT BUILD PORTCULLIS
# SPDX-License-Identifier: MIT
set -eu
root=$1
build=$2
portcullis=$3
. "$root/tests/bench/counters.sh"
rm -rf "$build"
mkdir -p "$build/api/portcullis" "$build/plugins"
cp "$root"/api/portcullis/*.h "$build/api/portcullis/"
cp "$root/tests/abi/culler_abi1.h" "$build/api/portcullis/culler.h"
number=$(sed -n 's/^#define CULL_ABI \([0-9]*u\)$/\1/p' "$root/api/portcullis/culler.h")
[ "$number" = 0u ] || number=1u # recorded as 1

compile() { # PLUGIN: not optimized, that would take minutes; the counts are the same
    for source in "$root/plugins/$1"/*.c; do
        case $(uname -m)/$source in
        x86_64/*_avx2.c) isa="-mavx2 -mbmi2 -mpopcnt" ;;
        x86_64/*_avx512.c) isa="-mavx512f -mavx512dq -mavx512bw -mbmi2 -mpopcnt" ;;
        *) isa= ;;
        esac
        # shellcheck disable=SC2086 # a list of words
        gcc -std=c11 -O0 -fPIC -fvisibility=hidden -ffp-contract=off -DCULL_ABI="$number" $isa -I"$build/api" -c "$source" \
            -o "$build/$1-$(basename "$source" .c).o"
    done
    gcc -shared "$build/$1"-*.o -lm -o "$build/plugins/$1.culler.so"
}
for plugin in octree portal occlusion imagecache; do compile "$plugin"; done
is 'plugins built' "$(ls "$build/plugins" | wc -l)" 4

bench() { # NAME FOLDER
    PORTCULLIS_PLUGIN_PATH=$2 "$portcullis" bench "$root/scenes/two_rooms.json" --views path:walk --size 320x180 --culler octree --culler octree+portal \
        --culler octree+portal+occlusion --culler octree+occlusion[method=hiz] --culler imagecache --json "$build/$1.json" >"$build/$1.log" 2>&1 || {
        code=$?
        [ "$code" -ne 3 ] || { echo "skipped: no OpenGL"; exit 77; }
        cat "$build/$1.log"
        exit 1
    }
}
bench today "$(dirname "$(dirname "$portcullis")")/plugins"
bench recorded "$build/plugins"
PORTCULLIS_PLUGIN_PATH=$build/plugins "$portcullis" plugins >"$build/list" 2>&1
is 'taken from the folder of the recorded ABI' "$(grep -c "$build/plugins/" "$build/list")" 4
for name in polygons_drawn polygons_visible missed_pixels items_drawn faults limits_hit tests stalls; do
    is "$name" "$(counter "$build/recorded.json" "$name" | tr '\n' ' ')" "$(counter "$build/today.json" "$name" | tr '\n' ' ')"
done
is 'missed pixels' "$(same "$build/recorded.json" missed_pixels)" 0
is 'faults' "$(same "$build/recorded.json" faults)" 0
finish
