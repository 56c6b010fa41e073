#!/bin/sh
# Every mutant is reported by the bench: exit code 1 and missed pixels, or many more cracks, or pictures 2 dB worse; the healthy plugin on the same views is not.
# A folder PLUGIN-NAME of MUTANTS_FOLDER holds one; what each plugin is looked at with is told below.
# SPDX-License-Identifier: MIT
# usage: mutants.sh PORTCULLIS MUTANTS_FOLDER SCENES_FOLDER
portcullis=$1
mutants=$2
scenes=$3
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
passed=0
failed=0

# prepare PLUGIN: $scene, $views (several, each a run of its own; FILE=VIEWS where each has a scene of its own) and $chains.
prepare() {
  size=640x360
  case $1 in
    frustum | octree)
      scene=$work/demo.obj views=$work/demo.views chains=$1
      [ -f "$scene" ] || "$portcullis" generate demo -o "$scene" || exit 1
      ;;
    occlusion)
      scene=$work/city.boxes views='auto:24 auto:walk:100' chains='occlusion frustum+occlusion occlusion[method=hiz] occlusion[method=chc]'
      [ -f "$scene" ] || "$portcullis" generate city -n 3000 -o "$scene" || exit 1
      ;;
    imagecache)
      views='pictures.boxes=auto:street:24 pictures.obj=auto:walk:24' chains=imagecache
      "$portcullis" generate city -n 20000 -o "$work/pictures.boxes" || exit 1
      "$portcullis" generate forest -n 100000 -o "$work/pictures.obj" || exit 1
      ;;
    portal | bsp)
      scene=$work/cellar.pcs views=auto:edges:32 size=320x180
      [ -f "$scene" ] || "$portcullis" compile "$scenes/cellar.json" --portals auto -o "$scene" >"$work/compiled" 2>&1 || { cat "$work/compiled"; exit 1; }
      chains='frustum[backface=1]+portal frustum[backface=1]+portal[clip=octagon] frustum[backface=1]+portal[clip=planes]'
      [ "$1" = portal ] || chains='bsp[backface=1]+portal bsp[backface=1,cells=rect]+portal bsp[backface=1,cells=hull]+portal bsp[backface=1,cells=exact]+portal'
      ;;
  esac
}

# counter NAME: its values in the runs' JSON, but for those not measured.
counter() {
  sed -n 's/.*"'"$1"'": \([0-9][0-9.eE+-]*\).*/\1/p' "$work/out.json"
}

# measure words: options before the chains. The worst exit code of the runs, $missed and $cracks of all, and the least $psnr.
measure() {
  code=0
  missed=0
  cracks=0
  psnr=100
  for chain in $chains; do set -- "$@" "--culler=$chain"; done
  for path in $views; do
    rm -f "$work/out.json"
    file=$scene
    case $path in *=*) file=$work/${path%%=*} path=${path#*=} ;; esac
    "$portcullis" bench "$file" --views "$path" --size $size --repeat 1 --json "$work/out.json" "$@" >"$work/table" 2>&1
    got=$?
    [ "$got" -ne 3 ] || { echo "SKIPPED: no OpenGL"; exit 77; }
    [ "$got" -le "$code" ] || code=$got
    missed=$((missed + $(counter missed_pixels | awk '{ n += $1 } END { print n + 0 }')))
    cracks=$((cracks + $(counter crack_pixels | awk '{ n += $1 } END { print n + 0 }')))
    psnr=$(counter psnr | awk -v least="$psnr" '{ if ($1 < least) least = $1 } END { print least }')
  done
}

judge() { # NAME healthy|broken; beside $usual cracks and $least dB
  reported=$(awk "BEGIN { r = ($missed > 0 && $code == 1) || $cracks > 2 * $usual + 100 || $psnr < $least; print r ? \"broken\" : $code ? \"neither\" : \"healthy\" }")
  printf '%s: %s missed pixels, %s cracks, %s dB at least, exit code %s\n' "$1" "$missed" "$cracks" "$psnr" "$code"
  if [ "$reported" = "$2" ]; then passed=$((passed + 1)); else
    failed=$((failed + 1))
    cat "$work/table"
  fi
}

plugins=$(for folder in "$mutants"/*; do basename "$folder" | sed 's/-.*//'; done | sort -u)
for plugin in $plugins; do
  prepare "$plugin"
  measure
  usual=$cracks
  least=$(awk "BEGIN { print $psnr - 2 }")
  judge "$plugin, healthy" healthy
  count=0
  for folder in "$mutants/$plugin"-*; do
    measure --plugin "$folder/$plugin.culler.so"
    judge "$(basename "$folder")" broken
    count=$((count + 1))
  done
  if [ "$count" -lt 5 ]; then
    printf '%s has %s mutants, not 5\n' "$plugin" "$count"
    failed=$((failed + 1))
  fi
done
printf '%s passed, %s failed\n' "$passed" "$failed"
[ "$failed" -eq 0 ] && [ "$passed" -ge 12 ]
