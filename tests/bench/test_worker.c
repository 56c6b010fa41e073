// The worker: jobs are done once each, in order, and waited for.
// SPDX-License-Identifier: MIT
#include "bench/worker.h"
#include "tests/common/failing_allocator.h"
#include "tests/common/test.h"

enum { JOBS = 200 };

typedef struct log { uint64_t jobs[JOBS + 1], count; } log_of_jobs;

static void note(void *context, uint64_t job)
{
    log_of_jobs *l = context;
    l->jobs[l->count++] = job;
}

static void jobs_are_done_in_order_before_it_is_closed(void **state)
{
    (void)state;
    log_of_jobs l = {.count = 0};
    worker *w = worker_open(&(worker_request){note, &l}, allocator_heap());
    assert_non_null(w);
    for (uint64_t i = 1; i <= JOBS; ++i) assert_int_equal(worker_give(w), i);
    worker_close(w);
    assert_int_equal(l.count, JOBS);
    for (uint64_t i = 0; i < JOBS; ++i) assert_int_equal(l.jobs[i], i + 1);
}

static void who_waits_finds_the_job_done(void **state)
{
    (void)state;
    log_of_jobs l = {.count = 0};
    worker *w = worker_open(&(worker_request){note, &l}, allocator_heap());
    assert_non_null(w);
    worker_wait(w, 0);
    for (uint64_t i = 1; i <= JOBS; ++i) {
        worker_wait(w, worker_give(w));
        assert_int_equal(l.count, i);
    }
    worker_close(w);
}

static void one_without_work_is_closed(void **state)
{
    (void)state;
    failing_allocator memory;
    log_of_jobs l = {.count = 0};
    failing_allocator_init(&memory, 0);
    worker_close(worker_open(&(worker_request){note, &l}, &memory.memory));
    worker_close(NULL);
    assert_int_equal(l.count, 0);
    assert_true(failing_allocator_is_clean(&memory));
    failing_allocator_init(&memory, 1);
    assert_null(worker_open(&(worker_request){note, &l}, &memory.memory));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jobs_are_done_in_order_before_it_is_closed),
        cmocka_unit_test(who_waits_finds_the_job_done),
        cmocka_unit_test(one_without_work_is_closed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
