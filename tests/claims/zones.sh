#!/bin/sh
# Zones lose nothing: the flagship, mazes, rooms and the house under every chain, mixed over zones, swapped every 10 views, with a crosser that
# narrows; doors open and shut. The long tier takes every view of the paths and a maze of 10,000 rooms.
# usage: zones.sh PORTCULLIS TEST_PLUGINS
# SPDX-License-Identifier: MIT
portcullis=$1
. "$(dirname "$0")/common.sh"
export PORTCULLIS_PLUGIN_PATH="$2"

look() { # KIND SIZE STEP PICTURE
  generated "$1" "$2"
  for path in walk tour; do
    every "$3" "$work/$1$2.json" "$path"
    views=$work/$path.views
    [ "$3" -ne 1 ] || views=path:$path
    measure "$1 $2 $path, doors open" "$work/$1$2.json" "$views" "$4" --culler scene --culler frustum --culler none --culler frustum+flood \
      --culler brute --culler frustum+portal --swap 10
    true_that "$1 $2 $path: zones were swapped" "$(counter "$json" swaps | tail -n 1) > 0"
    true_that "$1 $2 $path: a crosser narrows" "$(counter "$json" zones | sed -n 7p) <= $(counter "$json" zones | sed -n 3p)"
    is "$1 $2 $path: brute draws what frustum does" "$(counter "$json" polygons_drawn | sed -n '2p;5p' | sort -u | wc -l)" 1
    measure "$1 $2 $path, doors shut" "$work/$1$2.json" "$views" "$4" --culler scene --culler frustum+portal --swap 10 --doors shut
  done
}

if [ -n "${PORTCULLIS_LONG:-}" ]; then
  look flagship '' 1 640x360
  for size in 10 100 1000 10000; do look maze $size 1 640x360; done
  for size in 64 1024; do look rooms $size 1 640x360; done
  look house '' 1 640x360
else
  look flagship '' 23 160x90
  for size in 10 1000; do look maze $size 20 160x90; done
  look rooms 64 20 160x90
  look house '' 20 160x90
fi
finish
