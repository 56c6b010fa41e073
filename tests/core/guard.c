// Tests of the guard pages: a culler that writes behind the end of what it was lent stops at that write. list.c and
// viewer.c are compiled into this test as a debug build has them.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "host/core/list.h"
#include "session.h"
#include "tests/common/test.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

// The signal that ended the child, 0: it ended by itself.
static int signal_of(void (*work)(const char *), const char *argument)
{
    fflush(NULL);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        const struct rlimit none = {0, 0};
        (void)setrlimit(RLIMIT_CORE, &none);
        (void)signal(SIGSEGV, SIG_DFL); // a sanitizer's handler would turn it into an exit
        (void)signal(SIGBUS, SIG_DFL);
        work(argument);
        _exit(0);
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

static void run_a_frame(const char *fault)
{
    static session s;
    char chain[160];
    snprintf(chain, sizeof chain, "testbad[fault=%s]", fault);
    const session_request q = {.chain = chain, .boxes = {.items = 16, .movers = 3, .seed = 7}};
    if (session_open(&s, &q) != RESULT_OK) _exit(0);
    session_frame(&s, &(session_view){.frame = 1});
}

static void a_culler_that_writes_behind_the_end_is_stopped_there(void **state)
{
    (void)state;
    static const char *const faults[] = {"writes_past_runs", "writes_past_tests", "writes_past_captures", "writes_past_pictures"};
    for (int i = 0; i < 4; ++i) {
        const int signal = signal_of(run_a_frame, faults[i]);
        if (signal != SIGSEGV && signal != SIGBUS) fail_msg("%s: ended with signal %d", faults[i], signal);
    }
}

static void a_culler_that_stays_within_is_not(void **state)
{
    (void)state;
    assert_int_equal(signal_of(run_a_frame, "none"), 0);
    assert_int_equal(signal_of(run_a_frame, "runs_too_many"), 0);
}

static void write_at(const char *place)
{
    list l = list_open(allocator_heap(), 100, 24);
    ((char *)l.items)[strtol(place, NULL, 10)] = 1;
}

static void every_byte_of_a_list_may_be_written_and_none_behind(void **state)
{
    (void)state;
    assert_int_equal(signal_of(write_at, "0"), 0);
    assert_int_equal(signal_of(write_at, "2399"), 0);
    assert_true(signal_of(write_at, "2400") != 0);
    assert_true(signal_of(write_at, "4000") != 0);
}

static void a_list_of_nothing_or_of_whole_pages_opens_and_closes(void **state)
{
    (void)state;
    static const size_t counts[] = {0, 1, 512, 4096, 100000};
    failing_allocator a;
    for (int i = 0; i < 5; ++i) {
        failing_allocator_init(&a, 0);
        list l = list_open(&a.memory, counts[i], 8);
        assert_non_null(l.items);
        assert_int_equal((uintptr_t)l.items % 8, 0);
        assert_int_equal(l.size, counts[i] * 8);
        list_close(&l, &a.memory);
        list_close(&l, &a.memory);
        assert_null(l.items);
        failing_allocator_init(&a, 1);
        l = list_open(&a.memory, counts[i], 8);
        assert_null(l.items);
        list_close(&l, &a.memory);
        assert_true(failing_allocator_is_clean(&a));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_culler_that_writes_behind_the_end_is_stopped_there),
        cmocka_unit_test(a_culler_that_stays_within_is_not),
        cmocka_unit_test(every_byte_of_a_list_may_be_written_and_none_behind),
        cmocka_unit_test(a_list_of_nothing_or_of_whole_pages_opens_and_closes),
    };
    return cmocka_run_group_tests_name("core guard", tests, NULL, NULL);
}
