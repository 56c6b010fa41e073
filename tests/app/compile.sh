#!/bin/sh
# `portcullis compile`: a file that opens, the keys of its report, dumps, and clean refusals.
# SPDX-License-Identifier: MIT
# usage: compile.sh PORTCULLIS
portcullis=$1
. "$(dirname "$0")/check.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

side() { printf '( %s ) ( %s ) ( %s ) wall 0 0 0 1 1\n' "$1" "$2" "$3"; }
box() { # x y z X Y Z
  echo '{'
  side "$1 0 0" "$1 1 0" "$1 0 1"
  side "$4 0 0" "$4 0 1" "$4 1 0"
  side "0 $2 0" "0 $2 1" "1 $2 0"
  side "0 $5 0" "1 $5 0" "0 $5 1"
  side "0 0 $3" "1 0 $3" "0 1 $3"
  side "0 0 $6" "0 1 $6" "1 0 $6"
  echo '}'
}
{
  printf '{\n"classname" "worldspawn"\n'
  box -16 -16 -16 144 144 0
  box -16 -16 128 144 144 144
  box -16 -16 0 0 144 128
  box 128 -16 0 144 144 128
  box 0 -16 0 128 0 128
  box 0 128 0 128 144 128
  printf '}\n{\n"classname" "info_player_start"\n"origin" "64 64 32"\n}\n'
} > room.map
sed '/"origin"/s/64 64 32/640 64 32/' room.map > leak.map
printf '{\n"classname" "worldspawn"\n' > unclosed.map

expect compiles 0 '"zones": 1' "$portcullis" compile room.map -o room.pcs --portals none --json
for key in zones zones_sealed shells portals items polygons_in polygons_csg polygons_merged triangles t_junctions_inserted t_junctions_left open_edges \
  degenerate_triangles leak weld_moves max_move cpu_ms stages_ms peak_bytes; do
  expect "key_$key" 0 "\"$key\": [0-9[]" "$portcullis" compile room.map -o room.pcs --json
done
expect watertight 0 '"open_edges": 0' "$portcullis" compile room.map -o room.pcs --json
expect opens 0 'zones +1$' "$portcullis" info room.pcs
cp room.pcs first.pcs
expect again 0 'zones' "$portcullis" compile room.map -o room.pcs
holds same_bytes cmp room.pcs first.pcs
expect leak_still_compiles 0 'leaks: the info_player_start' "$portcullis" compile leak.map -o leak.pcs
expect leak_is_told 0 '"leak": 1' "$portcullis" compile leak.map -o leak.pcs --json
for stage in input csg zones items; do
  expect "dump_$stage" 0 '^(brush|polygon|zone|item) 0' "$portcullis" compile room.map -o room.pcs --dump $stage
done
expect dump_to_file 0 '"zones"' "$portcullis" compile room.map -o room.pcs --json --dump csg=csg.txt
holds dump_is_there grep -q '^polygon 5 ' csg.txt

expect no_output 2 'INPUT and -o are needed' "$portcullis" compile room.map
expect bad_portals 2 "none, authored or doors" "$portcullis" compile room.map -o no.pcs --portals some
expect bad_grid 2 'whole number' "$portcullis" compile room.map -o no.pcs --grid 1.5
expect bad_stage 2 'input, csg, zones or items' "$portcullis" compile room.map -o no.pcs --dump soup
expect dump_or_json 2 'name a file' "$portcullis" compile room.map -o no.pcs --json --dump csg
expect missing 2 'nothere.map: error: cannot open it' "$portcullis" compile nothere.map -o no.pcs
expect wrong_kind 2 'compile takes a .map' "$portcullis" compile room.obj -o no.pcs
expect unclosed 2 'unclosed.map:[0-9]+: error' "$portcullis" compile unclosed.map -o no.pcs
expect no_folder 2 'cannot be written' "$portcullis" compile room.map -o nowhere/no.pcs
expect no_culler 2 "no culler 'nosuch'" "$portcullis" compile room.map -o no.pcs --bake nosuch
holds nothing_written test ! -e no.pcs
finish
