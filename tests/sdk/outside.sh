#!/bin/sh
# A project outside the tree, built from the installed files alone by CMake and by pkg-config: plugins and hosts in C and C++.
# SPDX-License-Identifier: MIT
# usage: outside.sh CMAKE BUILD SOURCE cmake|pkgconfig
set -u # expect and holds look at exit codes
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
. "$here/install.sh"
. "$here/../app/check.sh"
install_moved "$1" "$2"
cp -r "$here/outside" "$work/project"
cp "$3/api/examples/minimal_host.c" "$work/project/host.c"
cd "$work/project" || exit 1
"$portcullis" new-culler outside-c "$work/from_template" 2>/dev/null
cp "$work/from_template/outside-c.c" culler.c

by_cmake() {
    "$1" -S . -B made -DCMAKE_PREFIX_PATH="$sdk" >"$work/log" 2>&1 && "$1" --build made >>"$work/log" 2>&1
}
by_pkgconfig() { # exactly what README.md tells, in both languages
    PKG_CONFIG_PATH=$packages
    export PKG_CONFIG_PATH
    strict="-Wall -Wextra -Wpedantic -Werror"
    plugin="-fPIC -shared -fvisibility=hidden -Wl,--version-script=$(pkg-config --variable=version_script portcullis-plugin)"
    flags=$(pkg-config --cflags portcullis-plugin)
    library=$(pkg-config --cflags --libs portcullis)
    mkdir made
    # shellcheck disable=SC2086 # flags are words
    cc -std=c11 $strict $plugin $flags culler.c -o made/outside-c.culler.so -lm &&
        c++ -std=c++17 $strict $plugin $flags culler.cc -o made/outside-cc.culler.so &&
        cc -std=c11 $strict host.c -o made/host_c $library &&
        c++ -std=c++17 $strict host.cc -o made/host_cc $library
    printf '%s\n' "$(pkg-config --variable=portcullis portcullis-plugin)" "$(pkg-config --variable=plugindir portcullis-plugin)" \
        "$(pkg-config --variable=plugin_abi portcullis-plugin)" >made/tool
}
"by_$4" "$1" || { cat "$work/log"; echo "it does not build by $4"; exit 1; }

LD_LIBRARY_PATH=$(dirname "$(find "$sdk" -name libportcullis.so)") # by pkg-config nothing says where it lies
export LD_LIBRARY_PATH
tool=$(sed -n 1p made/tool)
export PORTCULLIS_PLUGIN_PATH="$work/project/made"
expect 'the tool that the package names lists the culler in C' 0 '^outside-c 1 \(select\)' "$tool" plugins
expect 'and the one in C++, and where it came from' 0 '/made/outside-cc\.culler\.so \(PORTCULLIS_PLUGIN_PATH\)' "$tool" plugins
expect 'the installed ones lie where the package says' 0 'frustum\.culler\.so' ls "$(sed -n 2p made/tool)"
expect 'its ABI number is the tool'\''s' 0 "\"abi\": $(sed -n 3p made/tool)," "$tool" plugins --json
holds 'each plugin shows one symbol, templates or not' sh "$here/../repo/plugin_symbols.sh" made/outside-c.culler.so made/outside-cc.culler.so
"$portcullis" generate swarm --size 3000 --seed 5 -o swarm.boxes
expect 'both run beside the others' 0 '^outside-cc ' "$tool" bench swarm.boxes --views auto:8 --no-truth --culler brute --culler outside-c \
    --culler outside-cc --json found.json
alike() { [ "$(grep '"items_drawn"' found.json | sort -u | wc -l)" = 1 ] && [ "$(grep -c '"items_drawn"' found.json)" = 3 ]; }
holds 'and find the same' alike
printf 'v 0 0 -5\nv 1 0 -5\nv 0 1 -5\nf 1 2 3\n' >one.obj
expect 'the host in C finds installed plugins' 0 '1 items in 1 runs' made/host_c one.obj
expect 'the host in C++ runs the culler in C++' 0 '^1 items' made/host_cc one.obj outside-cc
expect 'the host in C++ runs the culler in C' 0 '^1 items' made/host_cc one.obj 'outside-c[group=2]'
finish
