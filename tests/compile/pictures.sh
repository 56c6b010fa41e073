#!/bin/sh
# What is compiled shows what the raw brushes show: pictures of materials from automatic views and from random points in
# air. And a map whose compiled side has one texture for another is told from it.
# PORTCULLIS_LONG: 200 views and 1,000 points on every map.
# usage: pictures.sh PORTCULLIS COMPARE_COMPILED
# SPDX-License-Identifier: MIT
portcullis=$1
compare=$2
. "$(dirname "$0")/../bench/counters.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
scenes=${PORTCULLIS_SCENES:-none}
[ -d "$scenes" ] || skip "real scenes; PORTCULLIS_SCENES names no folder"

pictures() { # RAW COMPILED VIEWS POINTS
  "$portcullis" compile "$2" -o "$work/compiled.pcs" >/dev/null 2>"$work/words" || cat "$work/words"
  "$compare" "$1" "$work/compiled.pcs" "$3" "$4" >"$work/said" 2>&1
  code=$?
  [ "$code" -ne 77 ] || skip "no OpenGL"
  head -2 "$work/said"
}

pictures_of() { # MAP VIEWS POINTS
  pictures "$scenes/$1" "$scenes/$1" "$2" "$3"
  is "$1 shows the same compiled" "$code" 0
}

if [ -n "${PORTCULLIS_LONG:-}" ]; then
  for map in "$scenes"/quake/*.map "$scenes"/librequake/*.map; do
    pictures_of "$(basename "$(dirname "$map")")/$(basename "$map")" 200 1000
  done
else
  pictures_of quake/dm4.map 20 20
  pictures_of librequake/lqdm12.map 20 20
fi
box() { # x0 y0 z0 x1 y1 z1 TEXTURE: a brush
  cat <<END
{
( $1 $2 $6 ) ( $1 $2 $3 ) ( $1 $5 $3 ) $7 0 0 0 1 1
( $4 $5 $3 ) ( $4 $2 $3 ) ( $4 $2 $6 ) $7 0 0 0 1 1
( $4 $2 $3 ) ( $1 $2 $3 ) ( $1 $2 $6 ) $7 0 0 0 1 1
( $1 $5 $6 ) ( $1 $5 $3 ) ( $4 $5 $3 ) $7 0 0 0 1 1
( $1 $5 $3 ) ( $1 $2 $3 ) ( $4 $2 $3 ) $7 0 0 0 1 1
( $4 $2 $6 ) ( $1 $2 $6 ) ( $1 $5 $6 ) $7 0 0 0 1 1
}
END
}

entity() { # CLASS: with the brush on stdin
  printf '{\n"classname" "%s"\n' "$1"
  cat
  echo '}'
}

{ # a room in a rock, with water, a fountain of water, stone and nothing, and a pillar in it
  {
    box -256 -256 -256 256 256 256 rock
    box -128 -128 -64 32 64 -24 '*water'
    box -100 80 -64 -40 128 20 '*water' | sed '3s/\*water/stone/; 4s/\*water/skip/; 7s/\*water/stone/'
  } | entity worldspawn
  box -128 -128 -64 128 128 64 room | entity csg_subtract
  box 48 48 -64 80 80 64 pillar | entity csg_add
  printf '{\n"classname" "info_player_start"\n"origin" "0 0 0"\n}\n'
} >"$work/carved.map"
pictures "$work/carved.map" "$work/carved.map" 20 20
is "a carved room shows the same compiled" "$code" 0

{ # one wall of the room is water, and nothing on its other sides, which look into the void
  {
    box -80 -80 -80 80 80 -64 floor
    box -80 -80 64 80 80 80 roof
    box -80 -80 -64 -64 80 64 west
    box -64 -80 -64 80 -64 64 south
    box -64 64 -64 80 80 64 north
    box 64 -64 -64 80 64 64 '*water' | sed '4,8s/\*water/skip/'
  } | entity worldspawn
  printf '{\n"classname" "info_player_start"\n"origin" "0 0 0"\n}\n'
} >"$work/fall.map"
pictures "$work/fall.map" "$work/fall.map" 8 8
is "a wall of water shows the same compiled" "$code" 0
is "a wall of water holds the void back" "$("$portcullis" compile "$work/fall.map" -o "$work/compiled.pcs" | sed -n 's/^leak  *//p')" 0

rooms=2 views=8
[ -z "${PORTCULLIS_LONG:-}" ] || rooms=40 views=30
for seed in $(seq "$rooms"); do
  awk -v seed=$((seed * 7919)) -f "$(dirname "$0")/random_room.awk" >"$work/room.map"
  pictures "$work/room.map" "$work/room.map" "$views" "$views"
  is "random room $seed shows the same compiled" "$code" 0
done

sed 's/) COP1_2 /) COP1_7 /' "$scenes/quake/dm4.map" >"$work/other.map"
pictures "$scenes/quake/dm4.map" "$work/other.map" 4 4
is "another texture is noticed" "$code" 1
finish
