#!/bin/sh
# README.md's "add a culler in ten lines", line by line from an empty folder: what it says is what happens.
# SPDX-License-Identifier: MIT
# usage: ten_lines.sh CMAKE BUILD SOURCE
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset PORTCULLIS_PLUGIN_PATH DESTDIR PKG_CONFIG_PATH
HOME=$work/house
mkdir "$HOME" "$work/sdk"
unset XDG_DATA_HOME
command -v make >/dev/null 2>&1 || export CMAKE_GENERATOR=Ninja # what CMake takes where nobody says
printf '#!/bin/sh\nsed -i "s/fallback = .16./fallback = \\"8\\"/" "$1"\n' >"$work/editor"
chmod +x "$work/editor"
EDITOR=$work/editor
export HOME EDITOR

awk '/^Add a culler in ten lines/ { found = 1 } found && /^```$/ { exit } found && inside { print } found && /^```sh$/ { inside = 1 }' \
    "$3/README.md" >"$work/said"
[ "$(wc -l <"$work/said")" = 10 ] || { echo "README.md has no ten lines"; cat "$work/said"; exit 1; }
# only places and the length of the path are other ones
sed -e "s|cmake --install build/release|'$1' --install '$2'|" -e "s|DIR\\([/ ]\\)|$work/sdk\\1|g" -e 's/auto:100/auto:3/' "$work/said" >"$work/lines"
mkdir "$work/empty"
cd "$work/empty"
sh -eux "$work/lines" >"$work/log" 2>&1 || { cat "$work/log"; echo "it stops there"; exit 1; }
saw() { grep -Eq -e "$1" "$work/log" || { cat "$work/log"; echo "it doesn't say $1"; exit 1; }; }
saw '100% tests passed'
[ "$(grep -c '100% tests passed' "$work/log")" = 2 ] || { cat "$work/log"; exit 1; }
saw '^mine  .* 0  *0 *$'
grep -q 'fallback = "8"' mine/mine.c
[ -f "$HOME/.local/share/portcullis/plugins/mine.culler.so" ]
echo 'ten lines, and a culler is there'
