#!/bin/sh
# Rooms that stand elsewhere: 1 km, 100 km and 10,000 km from the origin, a thousandth to a thousand times as large, turned. The same
# zones are reached, the same items drawn but for those at a plane of a volume, pictures equal in 99.99% of pixels, nothing missed.
# The own cellar; with the real maps beside it e1m1 too, in automatic rooms (it is too wide for a thousandfold: 300).
# usage: indoor_moved.sh PORTCULLIS TEST_PLUGINS MOVE_SCENE COMPARE_MOVED CELLAR_JSON
# SPDX-License-Identifier: MIT
portcullis=$1
. "$(dirname "$0")/common.sh"
export PORTCULLIS_PLUGIN_PATH="$2"
move_scene=$3
compare_moved=$4
set -- "$5"
chains='frustum[backface=1]+portal bsp[backface=1]+portal bsp[backface=1,cells=rect]+portal bsp[backface=1,cells=hull]+portal bsp[backface=1,cells=exact]+portal'

moved() { # NAME same|turned STEP PLACE: SCALE TURN X Y Z
  name=$1 kind=$2 step=$3
  shift 3
  "$move_scene" "$work/$name.pcs" auto:100 "$work/moved.pcs" "$@" || is "$name $*: moves" 1 0
  # shellcheck disable=SC2086
  "$compare_moved" "$work/$name-home.pcs" "$work/moved.pcs" "$step" "$kind" $chains >"$work/compared"
  code=$?
  [ "$code" -ne 77 ] || skip 'no OpenGL'
  printf '# %s at %s\n' "$name" "$*"
  cat "$work/compared"
  is "$name $*: zones, items, pictures" "$code" 0
  cullers=
  for chain in $chains; do cullers="$cullers --culler $chain"; done
  # shellcheck disable=SC2086
  measure "$name at $*" "$work/moved.pcs" path:moved 320x180 $cullers
}

everywhere() { # NAME INPUT PORTALS LARGEST STEP
  "$portcullis" compile "$2" --portals "$3" -o "$work/$1.pcs" >"$work/table" || is "$1 compiles" 1 0
  "$move_scene" "$work/$1.pcs" auto:100 "$work/$1-home.pcs" 1 0 0 0 0 || is "$1 stays" 1 0
  moved "$1" same "$5" 1 0 1000 0 -1000
  moved "$1" same "$5" 1 0 10000000 0 -10000000
  moved "$1" turned "$5" 1 37 0 0 0
  [ -n "${PORTCULLIS_LONG:-}" ] || return 0
  moved "$1" same "$5" 1 0 100000 0 -100000
  moved "$1" turned "$5" 1 -71.3 100000 0 100000
  for scale in 0.001 0.01 0.1 10 100 "$4"; do moved "$1" same "$5" "$scale" 0 0 0 0; done
}

everywhere cellar "$1" authored 1000 5
map=${PORTCULLIS_SCENES:-none}/quake/e1m1.map
if [ -f "$map" ]; then
  [ -z "${PORTCULLIS_LONG:-}" ] || everywhere e1m1 "$map" auto 300 2
else
  echo 'SKIPPED in part: no real maps'
fi
finish
