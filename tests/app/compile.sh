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
{
  sed '/info_player_start/,$d' room.map | sed '$d' | sed '$d'
  box 60 0 0 68 40 128
  box 60 88 0 68 128 128
  box 60 40 96 68 88 128
  printf '}\n{\n"classname" "func_door"\n"angle" "90"\n'
  box 60 40 0 68 88 96
  printf '}\n{\n"classname" "info_player_start"\n"origin" "32 64 32"\n}\n{\n"classname" "light"\n"origin" "100 64 32"\n}\n'
} > rooms.map
printf '{\n"classname" "worldspawn"\n' > unclosed.map

expect compiles 0 '"zones": 1' "$portcullis" compile room.map -o room.pcs --portals none --json
for key in zones zones_sealed shells portals items polygons_in polygons_csg polygons_merged triangles t_junctions_inserted t_junctions_left open_edges \
  degenerate_triangles leak weld_moves brushes_dropped max_move cpu_ms stages_ms peak_bytes; do
  expect "key_$key" 0 "\"$key\": [0-9[]" "$portcullis" compile room.map -o room.pcs --json
done
expect watertight 0 '"open_edges": 0' "$portcullis" compile room.map -o room.pcs --json
expect opens 0 'zones +1$' "$portcullis" info room.pcs
cp room.pcs first.pcs
expect again 0 'zones' "$portcullis" compile room.map -o room.pcs
holds same_bytes cmp room.pcs first.pcs
expect leak_still_compiles 0 'leaks: the info_player_start' "$portcullis" compile leak.map -o leak.pcs
expect leak_is_told 0 '"leak": 1' "$portcullis" compile leak.map -o leak.pcs --json
expect leak_is_told_where_it_is 0 'the info_player_start at 640 64 32 in a map.s units' "$portcullis" compile leak.map -o leak.pcs
for stage in input relations csg weld merge portals zones t_junctions items; do
  expect "dump_$stage" 0 '^(brush|polygon|piece|vertex|zone [0-9]+ polygon|zone|portal|item) 0' "$portcullis" compile rooms.map -o rooms.pcs --dump $stage
done
expect dump_to_file 0 '"zones"' "$portcullis" compile room.map -o room.pcs --json --dump csg=csg.txt
holds dump_is_there grep -q '^polygon 5 ' csg.txt
expect dumps_together 0 '^brush 0 touching brush 2$' "$portcullis" compile rooms.map -o rooms.pcs --dump zones=z1.txt --dump relations --dump items=i1.txt
expect dumps_again 0 '"zones": 2' "$portcullis" compile rooms.map -o rooms.pcs --json --dump zones=z2.txt --dump items=i2.txt
holds dumps_are_the_same cmp z1.txt z2.txt
holds items_are_the_same cmp i1.txt i2.txt
expect shells_are_in_the_zones 0 '^shell [0-9]+ outer zone 0$' cat z1.txt
is_flat() { "$portcullis" compile rooms.map -o rooms.pcs --json | tr -d '\n' | grep -Eq '^\{[^{}]*\}$'; }
holds json_is_one_flat_object is_flat
stages_and_times() { # as many times as names
  "$portcullis" compile rooms.map -o rooms.pcs --json | tr -d '\n' | sed 's/.*"stages": "\([^"]*\)".*"stages_ms": \[\([^]]*\)\].*/\1|\2/' |
    awk -F'|' '{ exit !(split($1, names, " ") == 11 && split($2, times, ",") == 11) }'
}
holds each_stage_has_its_time stages_and_times

# ---- The plan ----
expect plan 0 '"zones": 2' "$portcullis" compile rooms.map -o rooms.pcs --json --plan rooms.png
holds plan_is_a_png sh -c 'head -c 4 rooms.png | grep -q PNG'
expect plan_full 2 '/dev/full: error:' "$portcullis" compile room.map -o no.pcs --plan /dev/full
expect plan_over_the_input 2 'room.map: error: is the input itself' "$portcullis" compile room.map -o no.pcs --plan room.map

# ---- .prt and .pts ----
expect prt 0 '"portals": 1' "$portcullis" compile rooms.map -o rooms.pcs --json --prt rooms.prt
expect prt_is_that_of_the_door 0 '^4 [01] [01] (\(64 (40|88) (0|96) \) ){4}$' sed -n 4p rooms.prt
expect prt_head 0 '^PRT1 2 1 $' sh -c 'head -n 3 rooms.prt | tr "\n" " "'
clockwise() { # seen from the first zone; the player's, at x under 64, is zone 0: n = (p0 - p1) x (p2 - p1) looks at it
  sed -n 4p rooms.prt | tr -d '()' | awk '{ nx = ($5 - $8) * ($12 - $9) - ($6 - $9) * ($11 - $8); exit !(nx != 0 && ($2 == 0 ? nx < 0 : nx > 0)) }'
}
holds prt_goes_clockwise clockwise

# ---- Two leaves that each close their half: a portal that the zones have once is two of the scene ----
{
  sed '/func_door/,$d' rooms.map | sed '$d'
  printf '{\n"classname" "func_door"\n"angle" "270"\n'
  box 60 40 0 68 64 96
  printf '}\n{\n"classname" "func_door"\n"angle" "90"\n'
  box 60 64 0 68 88 96
  printf '}\n{\n"classname" "info_player_start"\n"origin" "32 64 32"\n}\n'
} > leaves.map
expect portals_of_the_scene 0 '"portals": 2' "$portcullis" compile leaves.map -o leaves.pcs --json --prt leaves.prt
expect portals_of_its_file 0 'portals +2$' "$portcullis" info leaves.pcs
expect portals_of_the_zones 0 '^PRT1 2 1 $' sh -c 'head -n 3 leaves.prt | tr "\n" " "'
holds counts_of_the_report_are_those_of_the_file sh -c '
  "$0" compile leaves.map -o leaves.pcs --json | sed -n "s/^ *\"\(portals\|items\|triangles\)\": \([0-9]*\),*$/\1 \2/p" | sort > told.txt
  "$0" info leaves.pcs | sed -n "s/^\(portals\|items\|triangles\)  *\([0-9]*\)$/\1 \2/p" | sort > held.txt
  test "$(wc -l < told.txt)" = 3 && cmp told.txt held.txt' "$portcullis"

# ---- A portal brush whose thin way no whole numbers hold: none, and a word, not one across another way ----
{
  sed '/func_door/,$d' rooms.map | sed '$d'
  printf '{\n"classname" "zone_portal"\n{\n'
  side '48.58203125 -65514.25 -65506.58203125' '66.0390625 65509.3515625 -65514.4453125' '50.51171875 0.02734375 65500.9140625'
  side '56.58203125 -65514.25 -65506.58203125' '58.51171875 0.02734375 65500.9140625' '74.0390625 65509.3515625 -65514.4453125'
  side '0 -8 0' '0 -8 1' '1 -8 0'
  side '0 136 0' '1 136 0' '0 136 1'
  side '0 0 -8' '1 0 -8' '0 1 -8'
  side '0 0 136' '0 1 136' '1 0 136'
  printf '}\n}\n{\n"classname" "info_player_start"\n"origin" "32 64 32"\n}\n'
} > slanted.map
expect slanted_portal 0 'slanted.map:[0-9]+: warning: this zone_portal is too slanted' "$portcullis" compile slanted.map -o slanted.pcs
slanted_makes_none() { "$portcullis" compile slanted.map -o slanted.pcs --dump portals=pieces.txt && test -e pieces.txt && test ! -s pieces.txt; }
holds slanted_portal_is_none slanted_makes_none

expect leak_prt 0 '^PRT1 1 0 $' sh -c '"$0" compile leak.map -o leak.pcs --prt leak.prt >/dev/null 2>&1; tr "\n" " " <leak.prt' "$portcullis"
expect pts 0 '"leak": 1' "$portcullis" compile leak.map -o leak.pcs --json --pts leak.pts
expect pts_begins_at_the_entity 0 '^640 64 32$' head -n 1 leak.pts
dense() { awk 'NF != 3 { bad = 1 } NR > 1 { d = ($1 - x) ^ 2 + ($2 - y) ^ 2 + ($3 - z) ^ 2; if (d > 16.001 ^ 2) bad = 1 } { x = $1; y = $2; z = $3 } END { exit bad || NR < 3 }' leak.pts; }
holds pts_is_dense dense
outside() { tail -n 1 leak.pts | awk '{ exit $1 > -16 && $1 < 144 && $2 > -16 && $2 < 144 && $3 > -16 && $3 < 144 }'; }
holds pts_ends_in_the_void outside
expect pts_is_removed 0 'no leak: the old leak.pts is removed' "$portcullis" compile room.map -o room.pcs --pts leak.pts
holds pts_is_gone test ! -e leak.pts
expect no_pts_no_word 0 'leak +0' "$portcullis" compile room.map -o room.pcs --pts leak.pts
echo 'dear diary' > diary.txt
expect pts_of_another_kind 2 'diary.txt: error: what stands there is no .pts file, and is kept' "$portcullis" compile leak.map -o no.pcs --pts diary.txt
holds diary_is_there grep -q diary diary.txt
expect pts_to_a_device 0 'leak +0' "$portcullis" compile room.map -o room.pcs --pts /dev/null

# ---- Baked indices ----
expect bakes 0 '"bakes": 2' "$portcullis" compile rooms.map -o baked.pcs --json --bake frustum
expect baked_opens 0 'zones +2$' "$portcullis" info baked.pcs
expect nothing_to_bake 0 "warning: no culler of 'brute' keeps an index: nothing is baked" "$portcullis" compile rooms.map -o brute.pcs --bake brute
holds baking_nothing_changes_nothing cmp brute.pcs rooms.pcs
expect bad_chain 2 "chain 'frustum\[\[', at character 9" "$portcullis" compile room.map -o no.pcs --bake 'frustum[['
expect bad_option 2 "no option 'foo'; it has: backface, isa" "$portcullis" compile room.map -o no.pcs --bake 'frustum[foo=1]'

# ---- As editors and copies leave files ----
sed 's/$/\r/' room.map > crlf.map
{ printf '\357\273\277'; cat room.map; } > bom.map
sed '$d' room.map > cut.map
: > empty.map
mkdir -p folder.map
"$portcullis" compile room.map -o room.pcs > /dev/null
for kind in crlf bom; do
  expect "$kind" 0 '"zones": 1' "$portcullis" compile $kind.map -o $kind.pcs --json
  holds "${kind}_makes_the_same_file" cmp $kind.pcs room.pcs
done
expect empty 2 'empty.map:1: error: no entity in it' "$portcullis" compile empty.map -o no.pcs
expect cut 2 'cut.map:[0-9]+: error' "$portcullis" compile cut.map -o no.pcs
expect folder 2 'folder.map: error: not a regular file' "$portcullis" compile folder.map -o no.pcs
expect no_name 2 'an empty file name; name a .map' "$portcullis" compile '' -o no.pcs
expect onto_a_map 2 'room.map: error: a compiled scene is a .pcs file' "$portcullis" compile room.map -o room.map
expect no_ending 2 'room: error: a compiled scene is a .pcs file' "$portcullis" compile room.map -o room
ln -s room.map link.pcs
expect onto_itself_by_a_link 2 'link.pcs: error: is the input itself' "$portcullis" compile room.map -o link.pcs
holds input_is_kept grep -q worldspawn room.map
expect two_outputs 2 'no.prt: error: named for two outputs' "$portcullis" compile room.map -o no.pcs --prt no.prt --dump csg=no.prt
mkdir folder.pcs
expect into_a_folder 2 'folder.pcs: error: is a folder' "$portcullis" compile room.map -o folder.pcs
rmdir folder.pcs
expect full 2 '/dev/full: error: cannot write it whole' "$portcullis" compile room.map -o /dev/full
expect full_prt 2 '/dev/full: error: cannot write it whole' "$portcullis" compile room.map -o no.pcs --prt /dev/full
expect full_dump 2 '/dev/full: error: cannot write it whole' "$portcullis" compile room.map -o no.pcs --dump csg=/dev/full
expect full_stdout_dump 2 'stdout: error: cannot write the dump' sh -c '"$0" compile room.map -o no.pcs --dump csg > /dev/full' "$portcullis"
expect full_stdout 2 'cannot write to stdout' sh -c '"$0" compile room.map -o room.pcs --json > /dev/full' "$portcullis"

expect no_output 2 'INPUT and -o are needed' "$portcullis" compile room.map
expect bad_portals 2 "none, authored, doors or auto" "$portcullis" compile room.map -o no.pcs --portals some
expect bad_grid 2 'whole number' "$portcullis" compile room.map -o no.pcs --grid 1.5
expect bad_stage 2 'one of input relations csg weld merge portals zones t_junctions items' "$portcullis" compile room.map -o no.pcs --dump soup
expect grid_0 2 'whole number from 1 to 65536' "$portcullis" compile room.map -o no.pcs --grid 0
expect grid_over 2 'whole number from 1 to 65536' "$portcullis" compile room.map -o no.pcs --grid 65537
expect two_dumps_to_stdout 2 'one dump has stdout already' "$portcullis" compile room.map -o no.pcs --dump csg --dump weld
expect dump_or_json 2 'name a file' "$portcullis" compile room.map -o no.pcs --json --dump csg
expect missing 2 'nothere.map: error: cannot open it' "$portcullis" compile nothere.map -o no.pcs
expect wrong_kind 2 'compile takes a .map' "$portcullis" compile room.obj -o no.pcs
expect unclosed 2 'unclosed.map:[0-9]+: error' "$portcullis" compile unclosed.map -o no.pcs
expect no_folder 2 'cannot be written' "$portcullis" compile room.map -o nowhere/no.pcs
expect no_culler 2 "no culler 'nosuch'" "$portcullis" compile room.map -o no.pcs --bake nosuch
holds nothing_written test ! -e no.pcs
finish
