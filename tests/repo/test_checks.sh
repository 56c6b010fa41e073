#!/bin/sh
# The checks of the tree find what they are for: each wrong tree below is refused, and a right one is not.
# SPDX-License-Identifier: MIT
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
HEAD='// A file.
// SPDX-License-Identifier: MIT'

fresh() { # a small right tree
    rm -rf "$work/t"
    mkdir -p "$work/t/api/portcullis" "$work/t/plugins/a" "$work/t/plugins/b" "$work/t/host/core" "$work/t/host/import" \
        "$work/t/host/mesh" "$work/t/host/render" "$work/t/host/app" "$work/t/bench" "$work/t/tests"
    cd "$work/t"
    for file in api/portcullis/culler.h plugins/a/own.h plugins/b/own.h host/core/scene.h host/import/import.h host/mesh/mesh.h \
        host/render/render.h host/app/app.h bench/bench.h; do
        printf '%s\n' "$HEAD" >"$file"
    done
    put plugins/a/a.c '#include "own.h"' '#include <portcullis/culler.h>' '#include <math.h>' '#include <immintrin.h>'
    put host/import/obj.c '#include "import.h"' '#include "../mesh/mesh.h"' '#include "../core/scene.h"'
    put host/app/main.c '#include "../../bench/bench.h"' '#include "../render/render.h"' '#include <portcullis/culler.h>'
    put tests/test.c '#include "host/core/scene.h"' '#include <EGL/egl.h>'
    printf '#!/bin/sh\n# Runs.\n# SPDX-License-Identifier: MIT\ntrue\n' >run
    chmod +x run
}
put() {
    to=$1
    shift
    { printf '%s\n' "$HEAD"; printf '%s\n' "$@"; } >"$to"
}
expect() { # expect good|bad CHECK WHAT
    if sh "$here/check_tree.sh" "$2" "$work/t" >"$work/said" 2>&1; then got=good; else got=bad; fi
    if [ "$got" != "$1" ]; then
        echo "$2: $3: expected $1, got $got:"
        cat "$work/said"
        failed=1
    fi
}
repeat() { awk -v "n=$1" -v "text=$2" 'BEGIN { while (n-- > 0) print text }'; }

fresh
for check in includes heads sizes paths scripts; do expect good "$check" "a right tree"; done

wrong_include() { # FILE LINE
    fresh
    put "$1" "$2"
    expect bad includes "$1 has $2"
}
wrong_include api/portcullis/culler.h '#include "../../host/core/scene.h"'
wrong_include api/portcullis/culler.h '#include <unistd.h>'
wrong_include plugins/a/a.c '#include "../b/own.h"'
wrong_include plugins/a/a.c '#include "../../host/core/scene.h"'
wrong_include plugins/a/a.c '#include "host/core/scene.h"'
wrong_include plugins/a/a.c '#include <epoxy/gl.h>'
wrong_include host/core/frame.c '#include "../import/import.h"'
wrong_include host/core/frame.c '  #  include "../render/render.h"'
wrong_include host/core/frame.c '#include <epoxy/gl.h>'
wrong_include host/import/obj.c '#include <OpenMesh/Core/IO/MeshIO.hh>'
wrong_include host/import/obj.c '#include <vector>'
wrong_include host/import/obj.c '#include "../render/render.h"'
wrong_include host/render/gl.c '#include "../../bench/bench.h"'
wrong_include host/render/gl.c '#include "../app/app.h"'
wrong_include host/core/frame.c '#include "nowhere.h"'
wrong_include bench/bench.c '#include "../host/app/app.h"'
wrong_include bench/bench.c '#include "../plugins/a/own.h"'

fresh
printf '// SPDX-License-Identifier: MIT\n// A file.\n' >bench/a.c
expect bad heads "licence first"
fresh
printf 'int a;\n// SPDX-License-Identifier: MIT\n' >bench/a.c
expect bad heads "no opening comment"
fresh
printf '// A file.\nint a;\n' >bench/a.c
expect bad heads "no licence"

function_of() { # FILE LINES BRACE: a function of that many lines, its brace on a line of its own or behind its name
    if [ "$3" = alone ]; then
        { printf '%s\nint long_one(void)\n{\n' "$HEAD"; repeat $(($2 - 3)) '    work();'; echo '}'; } >"$1"
    else
        { printf '%s\nint long_one(void) {\n' "$HEAD"; repeat $(($2 - 2)) '    work();'; echo '}'; } >"$1"
    fi
}
for brace in alone behind; do
    fresh
    function_of bench/a.c 80 $brace
    expect good sizes "a function of 80 lines, brace $brace"
    function_of bench/a.c 81 $brace
    expect bad sizes "a function of 81 lines, brace $brace"
done
fresh
{ printf '%s\n' "$HEAD"; repeat 798 'int a;'; } >bench/a.c
expect good sizes "a file of 800 lines"
echo 'int b;' >>bench/a.c
expect bad sizes "a file of 801 lines"

for place in wor"k" tm"p" hom"e" roo"t"; do
    fresh
    put bench/a.c "// see /$place/somewhere"
    expect bad paths "/$place"
done
fresh
printf '#!/bin/sh\nif\n' >tests/a.sh
expect bad scripts "a script that cannot be read"
fresh
chmod -x run
expect bad scripts "run not executable"
exit $failed
