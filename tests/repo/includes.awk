# Includes point one way: api <- plugins; api <- host/core <- import, compile, mesh, render <- bench <- app, tests.
# SPDX-License-Identifier: MIT
BEGIN {
    standard = " assert ctype errno fenv float inttypes iso646 limits locale math setjmp signal stdalign stdarg stdatomic stdbool" \
               " stddef stdint stdio stdlib stdnoreturn string tgmath threads time uchar wchar wctype "
    level["api"] = 0; level["host/core"] = 1; level["plugins"] = 1
    level["host/import"] = level["host/compile"] = level["host/mesh"] = level["host/render"] = 2
    level["bench"] = level["host/library"] = level["host/check"] = 3; level["host/app"] = 4; level["tests"] = 5
    beside["host/import host/mesh"] = beside["host/compile host/mesh"] = beside["host/compile host/import"] = 1
    owner["epoxy"] = owner["EGL"] = owner["GLFW"] = owner["GL"] = "host/render" # OpenGL
    owner["OpenMesh"] = "host/mesh"
}
function area_of(path,    part) {
    split(path, part, "/")
    return part[1] == "host" ? part[1] "/" part[2] : part[1]
}
function normal(path,    part, n, i, depth, kept, text) {
    n = split(path, part, "/")
    for (i = 1; i <= n; i++) {
        if (part[i] == "." || part[i] == "") continue
        if (part[i] == "..") { if (depth == 0) return "(outside)"; depth-- } else kept[++depth] = part[i]
    }
    for (i = 1; i <= depth; i++) text = text (i > 1 ? "/" : "") kept[i]
    return text
}
function there(path,    line, got) {
    got = (getline line < path)
    close(path)
    return got >= 0
}
function is_made(folder, name,    line, found) { # by the build, as the folder's CMakeLists.txt says
    while ((getline line < (folder "CMakeLists.txt")) > 0) if (index(line, "/generated/" name)) found = 1
    close(folder "CMakeLists.txt")
    return found
}
function say(why) { printf "%s:%d: %s: %s\n", FILENAME, FNR, named, why }
function plugin_of(path,    part) { split(path, part, "/"); return part[2] }

/^[ \t]*#[ \t]*include[ \t]*[<"]/ {
    named = $0
    sub(/^[^<"]*[<"]/, "", named)
    sub(/[>"].*$/, "", named)
    area = area_of(FILENAME)
    if (!(area in level)) { say("in a folder that the design doesn't know"); next }
    if ($0 ~ /include[ \t]*"/) {
        folder = FILENAME
        sub(/[^\/]*$/, "", folder)
        if (is_made(folder, named)) next
        target = normal(folder named)
        if (!there(target)) target = normal(named)
        if (!there(target)) { say("names no file of the tree"); next }
        to = area_of(target)
        if (area == "plugins" && (to != "plugins" || plugin_of(target) != plugin_of(FILENAME)))
            say("a plugin includes <portcullis/...> and its own files only")
        else if (to == "plugins" && area != "plugins") {
            if (area != "tests") say("nobody includes a plugin; open it as a library") # tests of its parts may
        }
        else if (to == "api" && area != "api") say("write it as <portcullis/...>")
        else if (level[to] > level[area] || (level[to] == level[area] && to != area && !((area " " to) in beside)))
            say("points the wrong way: " area " -> " to)
        next
    }
    if (named ~ /^portcullis\//) next
    plain = named
    sub(/\.h$/, "", plain)
    if ((area == "api" || area == "plugins") && index(standard, " " plain " ") == 0 && !(area == "plugins" && (named == "immintrin.h" || named == "emmintrin.h")))
        say(area " includes the C library and <portcullis/...> only")
    first = named
    sub(/\/.*/, "", first)
    if ((first in owner) && owner[first] != area && area != "tests") say("only " owner[first] " may include it")
    if (named !~ /\.h$/ && named !~ /\.hh$/ && area != "host/mesh" && area != "tests") say("C++ stands in host/mesh only")
}
