# Every source opens with a comment that says what it is, and carries its licence within the first lines.
# SPDX-License-Identifier: MIT
function close_file() {
    if (name != "" && !licensed) printf "%s:1: no SPDX-License-Identifier: MIT in the first lines\n", name
}
FNR == 1 {
    close_file()
    name = FILENAME
    licensed = 0
    if ($0 !~ /^(\/\/|\/\*|#)/) printf "%s:1: opens without a comment\n", name
    if ($0 ~ /^(\/\/|#) *SPDX/) printf "%s:1: says its licence before what it is\n", name
}
FNR <= 10 && /SPDX-License-Identifier: MIT/ { licensed = 1 }
END { close_file() }
