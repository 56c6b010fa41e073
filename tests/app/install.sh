#!/bin/sh
# An installed portcullis finds the plugins that were installed with it, wherever that is.
# SPDX-License-Identifier: MIT
# usage: install.sh CMAKE BUILD
cmake=$1
build=$2
. "$(dirname "$0")/check.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
unset PORTCULLIS_PLUGIN_PATH DESTDIR

expect 'installing' 0 'frustum\.culler\.so' "$cmake" --install "$build" --prefix "$work/here"
expect 'the culler that was installed' 0 "^ +$work/here/.*lib/portcullis/frustum\.culler\.so" "$work/here/bin/portcullis" plugins
unknown() { # files of an install that belong to nothing
  find "$1" ! -type d | sed "s|^$1/||" | grep -Ev '^(bin/portcullis|lib/portcullis/[a-z]+\.culler\.so|lib/libportcullis\.so[.0-9]*|lib/pkgconfig/portcullis(-plugin)?\.pc|lib/cmake/Portcullis/(Portcullis[A-Za-z-]*\.cmake|culler\.map)|share/man/man1/portcullis[a-z-]*\.1|include/portcullis/[a-z_]+\.h|share/portcullis/[a-z.]+\.json)$'
}
is_empty() { [ -z "$(unknown "$1")" ]; }
holds 'nothing but the executable, its plugins, the library with its headers and packages, manual pages and the schema' is_empty "$work/here"
mv "$work/here" "$work/there"
expect 'moved, it is found all the same' 0 "^ +$work/there/.*lib/portcullis/frustum\.culler\.so" "$work/there/bin/portcullis" plugins
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' > "$work/good.obj"
expect 'and used' 0 '^frustum ' "$work/there/bin/portcullis" bench "$work/good.obj" --views auto:2 --culler frustum --no-truth
rm -r "$work/there/lib"
expect 'without it there is none' 2 "no culler 'frustum'" "$work/there/bin/portcullis" bench "$work/good.obj" --views auto:2 --culler frustum --no-truth
finish
