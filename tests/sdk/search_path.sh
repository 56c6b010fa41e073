#!/bin/sh
# Where plugins are looked for, in which order, and that `portcullis plugins` says so.
# SPDX-License-Identifier: MIT
# usage: search_path.sh CMAKE BUILD
set -u # expect and holds look at exit codes
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
. "$here/install.sh"
. "$here/../app/check.sh"
install_moved "$1" "$2"
installed=$(dirname "$(find "$sdk" -name frustum.culler.so)")
put() { mkdir -p "$2" && cp "$installed/$1.culler.so" "$2"; }
plugins() { "$portcullis" plugins "$@"; }
with() { # VALUE OF THE VARIABLE
    PORTCULLIS_PLUGIN_PATH=$1 plugins
}

expect 'installed ones' 0 'frustum\.culler\.so \(installed\)$' plugins
expect 'built-in ones' 0 '^ +built in$' plugins
put frustum "$work/data/portcullis/plugins"
expect 'the user'\''s folder comes before' 0 'data/portcullis/plugins/frustum\.culler\.so \(the user.s folder\)$' plugins
expect 'and the installed one is named as refused' 0 '^refused .*frustum\.culler\.so: its id is taken' plugins
put frustum "$work/variable"
expect 'the variable comes before both' 0 'variable/frustum\.culler\.so \(PORTCULLIS_PLUGIN_PATH\)$' with "$work/none:$work/variable"
put frustum "$work/named"
expect 'a file that is named comes first' 0 'named/frustum\.culler\.so \(named by the caller\)$' plugins --plugin "$work/named/frustum.culler.so"
expect 'a folder that is missing is told' 0 'none \(PORTCULLIS_PLUGIN_PATH\): not there$' with "$work/none:$work/variable"
expect 'JSON too' 0 '"origin": "the user.s folder"' plugins --json

home_only() { XDG_DATA_HOME=$1 HOME=$work/house plugins; }
put octree "$work/house/.local/share/portcullis/plugins"
expect 'without XDG_DATA_HOME it is ~/.local/share' 0 'house/.local/share/portcullis/plugins/octree\.culler\.so \(the user' home_only ''
expect 'a relative XDG_DATA_HOME is none' 0 'house/.local/share/portcullis/plugins/octree\.culler\.so \(the user' home_only data

put frustum "$work/empty/here"
not_here() { (cd "$work/empty/here" && ! PORTCULLIS_PLUGIN_PATH=: XDG_DATA_HOME=$work/none "$portcullis" plugins | grep "empty/here"); }
holds 'never the current folder' not_here
finish
