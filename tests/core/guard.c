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
    static const char *const faults[] = {"writes_past_runs", "writes_past_tests", "writes_past_captures", "writes_past_pictures",
                                         "writes_past_clipped"};
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
        assert_int_equal(l.items == NULL, counts[i] > 0); // a list of nothing takes nothing
        assert_int_equal(a.calls > 0, counts[i] > 0);
        list_close(&l, &a.memory);
        assert_true(failing_allocator_is_clean(&a));
    }
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { IS_SANITIZED = 1 };
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
enum { IS_SANITIZED = 1 };
#else
enum { IS_SANITIZED = 0 };
#endif
#else
enum { IS_SANITIZED = 0 };
#endif

// Each guarded list is two mappings of the few that the system gives.
static void take_more_lists_than_there_are_mappings(const char *count)
{
    const long most = strtol(count, NULL, 10);
    for (long i = 0; i < most; ++i) {
        list l = list_open(allocator_heap(), 10, 8);
        if (!l.items) _exit(1);
        ((char *)l.items)[79] = 1;
        if (l.block_size == l.size) _exit(2); // plain
    }
    _exit(3);
}

static int exit_of(void (*work)(const char *), const char *argument)
{
    fflush(NULL);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) work(argument);
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static void without_mappings_a_list_is_plain_memory(void **state)
{
    (void)state;
    long most = 0;
    if (IS_SANITIZED) {
        print_message("lists without mappings are NOT tested: a sanitizer's own memory needs mappings\n");
        skip();
    }
    FILE *f = fopen("/proc/sys/vm/max_map_count", "r");
    if (!f || fscanf(f, "%ld", &most) != 1 || most > 100000) {
        if (f) fclose(f);
        print_message("lists without mappings are NOT tested: the system gives too many\n");
        skip();
    }
    fclose(f);
    assert_int_equal(exit_of(take_more_lists_than_there_are_mappings, "200000"), 2);
}

static void a_tail_of_a_shared_list_ends_at_the_guard_page_too(void **state)
{
    (void)state;
    list l = list_open(allocator_heap(), 100, 8);
    assert_ptr_equal((char *)list_tail(&l, 24) + 24, (char *)l.items + 800);
    assert_ptr_equal(list_tail(&l, 800), l.items);
    list_close(&l, allocator_heap());
    l = list_open_as(LIST_PLAIN, allocator_heap(), 100, 8);
    for (int i = 0; i < 800; ++i) assert_int_equal(((char *)l.items)[i], 0);
    assert_int_equal(l.block_size, 800);
    list_close(&l, allocator_heap());
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_culler_that_writes_behind_the_end_is_stopped_there),
        cmocka_unit_test(a_culler_that_stays_within_is_not),
        cmocka_unit_test(every_byte_of_a_list_may_be_written_and_none_behind),
        cmocka_unit_test(without_mappings_a_list_is_plain_memory),
        cmocka_unit_test(a_tail_of_a_shared_list_ends_at_the_guard_page_too),
        cmocka_unit_test(a_list_of_nothing_or_of_whole_pages_opens_and_closes),
    };
    return cmocka_run_group_tests_name("core guard", tests, NULL, NULL);
}
