#!/bin/sh
# Checks of the tree itself. usage: check_tree.sh includes|heads|sizes|paths|scripts [ROOT]; each finding is one line.
# SPDX-License-Identifier: MIT
set -eu
LC_ALL=C
export LC_ALL
check=$1
root=${2:-$(CDPATH='' cd -- "$(dirname -- "$0")/../.." && pwd)}
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
cd "$root"

files() { # files of the tree that match the given find expression, names without spaces
    find . \( -path ./.git -o -path ./build -o -path ./out \) -prune -o -type f "$@" -print | sed 's|^\./||' | sort
}
sources() { files \( -name '*.c' -o -name '*.h' -o -name '*.cc' \); }

found=$(
    case $check in
    includes) sources | xargs awk -f "$here/includes.awk" ;;
    heads) { sources; files \( -name '*.sh' -o -name '*.awk' -o -name run \); } | xargs awk -f "$here/heads.awk" ;;
    sizes) sources | xargs awk -f "$here/sizes.awk" ;;
    paths)
        # what only one machine has; the patterns are taken apart so that they don't find themselves
        files \( ! -name '*.png' \) | xargs grep -nE -e "/wo[r]k/" -e "/tm[p]/" -e "/hom[e]/" -e "/roo[t]/" -e "deb[.]debian[.]org" \
            -e "registry[.]npmjs" -e "pypi[.]org" || :
        ;;
    scripts)
        files \( -name '*.sh' -o -name run \) | while read -r script; do
            case $(sed -n 1p "$script") in
            '#!/bin/sh'*) dash -n "$script" 2>&1 || echo "$script: dash cannot read it" ;;
            '#!/bin/bash'*) bash -n "$script" 2>&1 || echo "$script: bash cannot read it" ;;
            '# '*) dash -n "$script" 2>&1 || : ;;
            *) echo "$script:1: no #! line" ;;
            esac
        done
        [ -x run ] || echo "run: not executable"
        [ "$(wc -l <run)" -lt 150 ] || echo "run: 150 lines or more"
        ;;
    *) echo "no check is called $check" ;;
    esac
)
count=$(sources | wc -l)
[ "$count" -gt 0 ] || found="no source file under $root"
if [ -n "$found" ]; then
    printf '%s\n' "$found"
    exit 1
fi
echo "$check: $count source files looked at, nothing found"
