# Reads CTest's JUnit file and ends in `N passed, N failed, N skipped`, naming what failed and what was skipped. A cmocka
# program counts as the test cases that it ran, anything else as one; a program that dies counts one failure more.
# SPDX-License-Identifier: MIT
function attribute(line, key,    from) {
    from = index(line, " " key "=\"")
    if (!from) return ""
    line = substr(line, from + length(key) + 3)
    return substr(line, 1, index(line, "\"") - 1)
}
function plain(text) {
    gsub(/&lt;/, "<", text)
    gsub(/&gt;/, ">", text)
    gsub(/&quot;/, "\"", text)
    gsub(/&amp;/, "\\&", text)
    return text
}
function number_before(text, mark) { # "[  PASSED  ] 12 test(s)." -> 12
    text = substr(text, index(text, mark) + length(mark))
    return text + 0
}
function close_case() {
    passed += case_passed
    failed += case_failed
    skipped += case_skipped
    if (status == "fail" && !case_failed) {
        failed++
        failures = failures "  failed: " name "\n"
    } else if (status == "notrun" && reason ~ /^SKIP_RETURN_CODE/) {
        skipped++
        skips = skips "  skipped: " name (last != "" ? ": " last : "") "\n"
    } else if (status == "disabled") {
        skipped++
        skips = skips "  skipped: " name ": disabled\n"
    } else if (status != "run" && status != "fail") {
        failed++
        failures = failures "  failed: " name ": " (reason != "" ? reason : "did not run") "\n"
    } else if (status == "run" && !seen_cmocka) {
        passed++
    }
}
/^[ \t]*<testcase / {
    name = plain(attribute($0, "name"))
    status = attribute($0, "status")
    reason = last = listing = ""
    case_passed = case_failed = case_skipped = seen_cmocka = 0
    inside = 1
    next
}
!inside { next }
/<\/testcase>/ { close_case(); inside = 0; next }
/<skipped message=/ { reason = plain(attribute($0, "message")) }
/\[  PASSED  \] [0-9]+ test\(s\)\./ { case_passed += number_before($0, "[  PASSED  ] "); seen_cmocka = 1; listing = ""; next }
/\[  SKIPPED \] [0-9]+ test\(s\), listed below/ { case_skipped += number_before($0, "[  SKIPPED ] "); listing = "skipped"; next }
/\[  FAILED  \] [0-9]+ test\(s\), listed below/ { case_failed += number_before($0, "[  FAILED  ] "); listing = "failed"; next }
/^\[  SKIPPED \] / && listing == "skipped" { skips = skips "  skipped: " name ": " substr($0, 14) "\n"; next }
/^\[  FAILED  \] / && listing == "failed" { failures = failures "  failed: " name ": " substr($0, 14) "\n"; next }
{
    line = $0
    sub(/^.*<system-out>/, "", line)
    sub(/<\/system-out>.*$/, "", line)
    if (line ~ /[^ \t]/ && line !~ /^[ \t]*</) last = plain(line)
}
END {
    if (inside) { status = "fail"; close_case() }
    if (passed + failed + skipped == 0) { failures = "  failed: no test ran\n"; failed = 1 }
    if (ctest_status + 0 != 0 && !failed) { failures = "  failed: ctest itself ended with " ctest_status "\n"; failed = 1 }
    printf "%s%s", skips, failures
    printf "%d passed, %d failed, %d skipped\n", passed, failed, skipped
    exit failed > 0
}
