# No file over 800 lines, no function over 80: from the line of its name to its closing brace, both in column one.
# SPDX-License-Identifier: MIT
function close_file() {
    if (name != "" && lines > 800) printf "%s: %d lines, 800 are the most; split it\n", name, lines
    if (start) printf "%s:%d: a function without a closing brace in column one\n", name, start
}
FNR == 1 {
    close_file()
    name = FILENAME
    start = head = 0
}
{ lines = FNR }
!start && /^[A-Za-z_]/ { head = FNR }
!start && (/^\{[ \t]*$/ || (/^[A-Za-z_].*\)[ a-z]*\{[ \t]*$/ && !/^(struct|enum|union|typedef|namespace|extern)/)) {
    start = head ? head : FNR
    next
}
start && /^\}/ {
    size = FNR - start + 1
    if (size > 80) printf "%s:%d: a function of %d lines, 80 are the most\n", name, start, size
    start = head = 0
}
END { close_file() }
