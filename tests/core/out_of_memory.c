// Tests of the whole way from an empty builder to a closed viewer with every single allocation failing in turn.
// SPDX-License-Identifier: MIT
#include "session.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <string.h>

static const char *const chains[] = {
    "none", "brute", "testmore", "testpicture", "testorder+testfilter[walk=1,movers=1]", "brute+testcross+testfilter+testfilter[keep=all]",
    "testbad[fault=run_wild,movers=1]", "testpicture+testfilter",
};

// 1 when the k-th allocation does not exist any more and all went well.
static int passes_with_failure(const char *chain, viewer_checks checks, uint64_t k)
{
    static session s;
    const session_request q = {.chain = chain, .boxes = {.items = 40, .movers = 5, .seed = 3}, .checks = checks, .fail_at = k};
    const result done = session_open(&s, &q);
    if (done == RESULT_OK)
        for (uint32_t frame = 1; frame < 4; ++frame) session_frame(&s, &(session_view){.frame = frame, .right_m = 200});
    const uint64_t failures = s.memory.failures;
    const uint32_t lines = s.lines.count;
    char line[REPORT_LINE_BYTES];
    snprintf(line, sizeof line, "%s", s.lines.lines[0]);
    session_close(&s); // asserts that nothing is left
    if (failures == 0) {
        assert_int_equal(done, RESULT_OK);
        return 1;
    }
    if (done != RESULT_NO_MEMORY) fail_msg("%s: allocation %u failed, result %d", chain, (unsigned)k, (int)done);
    assert_true(lines <= 1); // the builder's own functions leave the line to their caller
    if (lines) assert_non_null(strstr(line, "out of memory"));
    return 0;
}

static void every_allocation_may_fail_without_a_crash_or_a_leak(void **state)
{
    (void)state;
    for (size_t n = 0; n < sizeof chains / sizeof *chains; ++n)
        for (int checks = 0; checks < 2; ++checks) {
            uint64_t k = 1;
            while (!passes_with_failure(chains[n], checks ? VIEWER_CHECK_ALL : VIEWER_CHECK_BOUNDS, k)) ++k;
            assert_true(k > 30); // the way is long enough to mean something
        }
}

static void opening_and_closing_again_and_again_leaves_nothing(void **state)
{
    (void)state;
    for (int round = 0; round < 5; ++round)
        for (size_t n = 0; n < sizeof chains / sizeof *chains; ++n) assert_true(passes_with_failure(chains[n], VIEWER_CHECK_BOUNDS, 0));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_allocation_may_fail_without_a_crash_or_a_leak),
        cmocka_unit_test(opening_and_closing_again_and_again_leaves_nothing),
    };
    return cmocka_run_group_tests_name("core out of memory", tests, NULL, NULL);
}
