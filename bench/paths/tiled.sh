#!/bin/sh
# A scene of N x N copies of a mesh beside one another, a gap of a thousandth between them: a city of millions of triangles from one that is small.
# usage: tiled.sh PORTCULLIS MESH N > SCENE.json
# SPDX-License-Identifier: MIT
[ $# = 3 ] || { echo 'usage: tiled.sh PORTCULLIS MESH N > SCENE.json' >&2; exit 2; }
mesh=$(CDPATH='' cd -- "$(dirname -- "$2")" && pwd)/$(basename -- "$2") || exit 2
bounds=$("$1" info "$mesh" | sed -n 's/^bounds *\[\(.*\)\]$/\1/p' | tr -d ',')
[ -n "$bounds" ] || { echo "tiled.sh: error: no bounds of $2; is it a mesh?" >&2; exit 2; }
# shellcheck disable=SC2086
printf '%s\n' $bounds | awk -v n="$3" -v mesh="$mesh" '
  { b[NR] = $1 }
  END {
    wide = 1.001 * (b[4] - b[1]); deep = 1.001 * (b[6] - b[3])
    print "{\"portcullis\": 1, \"include\": ["
    for (i = 0; i < n * n; i++)
      printf "  {\"file\": \"%s\", \"at\": [%.3f, 0, %.3f]}%s\n", mesh, (i % n - n / 2) * wide - b[1], (int(i / n) - n / 2) * deep - b[3], i < n * n - 1 ? "," : ""
    print "]}"
  }'
