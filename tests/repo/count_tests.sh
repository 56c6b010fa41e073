#!/bin/sh
# The last line of ./run test counts cmocka cases, programs, skips, crashes and tests that could not start.
# SPDX-License-Identifier: MIT
set -eu
root=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cat >"$work/all.xml" <<'XML'
<?xml version="1.0" encoding="UTF-8"?>
<testsuite name="(empty)"
	tests="8"
	>
	<testcase name="unit" classname="unit" time="0.1" status="fail">
		<failure message=""/>
		<system-out>[==========] Running 3 test(s).
[  SKIPPED ] c
[==========] 3 test(s) run.
[  PASSED  ] 1 test(s).
[  SKIPPED ] 1 test(s), listed below:
[  SKIPPED ] c

 1 SKIPPED TEST(S)
[  FAILED  ] 1 test(s), listed below:
[  FAILED  ] b
</system-out>
	</testcase>
	<testcase name="two_groups" classname="x" time="0.1" status="run">
		<system-out>[==========] 4 test(s) run.
[  PASSED  ] 4 test(s).
[==========] 2 test(s) run.
[  PASSED  ] 2 test(s).
</system-out>
	</testcase>
	<testcase name="crash" classname="x" time="0.1" status="fail">
		<failure message=""/>
		<system-out>[==========] Running 2 test(s).
[  PASSED  ] 2 test(s).
[==========] Running 2 test(s).
hello &amp; &lt;x&gt;
</system-out>
	</testcase>
	<testcase name="skips" classname="x" time="0.1" status="notrun">
		<skipped message="SKIP_RETURN_CODE=77"/>
		<system-out>no debootstrap &amp; no root
</system-out>
	</testcase>
	<testcase name="plain" classname="x" time="0.1" status="run">
		<system-out></system-out>
	</testcase>
	<testcase name="missing" classname="x" time="0" status="notrun">
		<skipped message="Unable to find executable"/>
		<system-out>Unable to find executable: x</system-out>
	</testcase>
	<testcase name="off" classname="x" time="0" status="disabled">
		<system-out>Disabled</system-out>
	</testcase>
</testsuite>
XML
count() { # EXPECTED_STATUS EXPECTED_LAST_LINE CTEST_STATUS FILE
    status=0
    awk -v "ctest_status=$3" -f "$root/packaging/count_tests.awk" "$4" >"$work/said" || status=$?
    if [ "$status" != "$1" ] || [ "$(tail -n 1 "$work/said")" != "$2" ]; then
        echo "expected status $1 and '$2', got $status and:"
        cat "$work/said"
        exit 1
    fi
}
count 1 '10 passed, 3 failed, 3 skipped' 8 "$work/all.xml"
for line in 'failed: unit: b' 'failed: crash' 'failed: missing: Unable to find executable' 'skipped: unit: c' \
    'skipped: skips: no debootstrap & no root' 'skipped: off: disabled'; do
    grep -q "$line" "$work/said" || { echo "doesn't say: $line"; cat "$work/said"; exit 1; }
done
printf '<testsuite>\n\t<testcase name="a" status="run">\n\t\t<system-out></system-out>\n\t</testcase>\n</testsuite>\n' >"$work/good.xml"
count 0 '1 passed, 0 failed, 0 skipped' 0 "$work/good.xml"
count 1 '1 passed, 1 failed, 0 skipped' 8 "$work/good.xml"
printf '<testsuite>\n</testsuite>\n' >"$work/none.xml"
count 1 '0 passed, 1 failed, 0 skipped' 0 "$work/none.xml"
printf '<testsuite>\n\t<testcase name="cut" status="run">\n\t\t<system-out>half\n' >"$work/cut.xml"
count 1 '0 passed, 1 failed, 0 skipped' 0 "$work/cut.xml"
echo "counted"
