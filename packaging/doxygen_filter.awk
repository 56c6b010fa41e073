# The headers of api/ have plain comments; Doxygen is shown them as its own: above a declaration, behind a member, of the file.
# SPDX-License-Identifier: MIT
# A word behind \file is its name; then the text may begin on the same line.
# usage: awk -f doxygen_filter.awk HEADER; line numbers stay
function escaped(text) {
    gsub(/\\/, "\\\\", text)
    gsub(/[@<>&#%"]/, "\\\\&", text)
    return text
}
function flush_block(mark,   i) { # the comment lines held back, as documentation or, with a blank line behind them, of the file
    for (i = 1; i <= held; ++i) print (i == 1 && mark != "" ? indent[i] "/// " mark : indent[i] "///") " " escaped(block[i])
    held = 0
}
FNR == 1 {
    about = FILENAME
    sub(/.*\//, "", about)
    about = "\\file " about
    sub(/^\/\/ [a-z_]+\.h: /, "// ") # its name stands before it already
}
{
    match($0, /^ */)
    column = RLENGTH
    if ($0 ~ /^ *\/\/ ----/ || $0 ~ /^ *\/\/ SPDX/) { # headings
        flush_block(about)
        print ""
        behind = 0
        next
    }
    if ($0 ~ /^ *\/\//) {
        text = $0
        sub(/^ *\/\/ ?/, "", text)
        if (behind && column >= behind - 1) { # goes on behind a member
            printf "%*s///< %s\n", column, "", escaped(text)
            next
        }
        behind = 0
        indent[++held] = substr($0, 1, column)
        block[held] = text
        next
    }
    flush_block($0 ~ /^ *$/ ? about : "")
    behind = 0
    at = match($0, /[^ ].*[;,{)] *\/\/ |^ *[^ ].* \/\/ /) ? match($0, / \/\/ /) : 0
    if (at && $0 !~ /^#if|^#endif|^#else/) {
        behind = at + 1
        code = substr($0, 1, at)
        if (code ~ /^#define/ || code ~ /^static inline|^ *return|^ *for|^ *if/ || code ~ /\{ *$/ && code !~ /^enum|^typedef/) {
            print code
            next
        }
        print code (code ~ /\{ *$/ ? "" : "///< " escaped(substr($0, at + 4)))
        next
    }
    print
}
END { flush_block(about) }
