// Tests of host/core/memory: sizes that overflow, growth, arenas, and failures that change nothing.
// SPDX-License-Identifier: MIT
#include "tests/common/failing_allocator.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <string.h>

static void sizes_that_overflow_are_refused_and_never_wrap(void **state)
{
    (void)state;
    failing_allocator a;
    failing_allocator_init(&a, 0);
    assert_null(memory_alloc(&a.memory, SIZE_MAX, 2));
    assert_null(memory_alloc(&a.memory, SIZE_MAX / 2 + 2, 2)); // wraps to 2
    assert_null(memory_alloc(&a.memory, 2, SIZE_MAX));
    assert_null(memory_alloc_zeroed(&a.memory, SIZE_MAX / 8, 16));
    assert_null(memory_alloc(&a.memory, SIZE_MAX, 1));
    assert_true(failing_allocator_is_clean(&a));
}

static void no_items_give_memory_that_can_be_freed(void **state)
{
    (void)state;
    failing_allocator a;
    failing_allocator_init(&a, 0);
    void *none = memory_alloc(&a.memory, 0, 16), *zeroed = memory_alloc_zeroed(&a.memory, 0, 16);
    assert_non_null(none);
    assert_non_null(zeroed);
    memory_free(&a.memory, none, 0, 16);
    memory_free(&a.memory, zeroed, 0, 16);
    memory_free(&a.memory, NULL, 5, 5);
    assert_true(failing_allocator_is_clean(&a));
}

static void memory_is_aligned_to_64_bytes(void **state)
{
    (void)state;
    failing_allocator a;
    failing_allocator_init(&a, 0);
    arena texts = arena_make(&a.memory);
    for (size_t size = 1; size < 300; size += 7) {
        void *of_heap = memory_alloc(allocator_heap(), size, 1), *of_arena = arena_push(&texts, size, 1);
        assert_int_equal((uintptr_t)of_heap % 64, 0);
        assert_int_equal((uintptr_t)of_arena % 64, 0);
        memory_free(allocator_heap(), of_heap, size, 1);
    }
    arena_free(&texts);
    assert_true(failing_allocator_is_clean(&a));
}

static void a_buffer_keeps_its_items_while_it_grows(void **state)
{
    (void)state;
    failing_allocator a;
    failing_allocator_init(&a, 0);
    buffer b = buffer_make(&a.memory, sizeof(uint32_t));
    uint64_t random = 1;
    uint32_t pushed = 0;
    while (pushed < 20000) {
        const uint32_t count = random_below(&random, 50);
        uint32_t *to = buffer_push(&b, count);
        assert_non_null(to); // of no items too
        for (uint32_t i = 0; i < count; ++i) to[i] = pushed++;
    }
    assert_int_equal(b.count, pushed);
    for (uint32_t i = 0; i < pushed; ++i) assert_int_equal(((uint32_t *)b.items)[i], i);
    assert_non_null(buffer_append(&b, NULL, 0));
    buffer_free(&b);
    buffer_free(&b);
    assert_true(failing_allocator_is_clean(&a));
}

static void a_buffer_that_cannot_grow_stays_as_it_was(void **state)
{
    (void)state;
    failing_allocator a;
    failing_allocator_init(&a, 0);
    buffer b = buffer_make(&a.memory, 8);
    assert_null(buffer_push(&b, SIZE_MAX));
    assert_null(buffer_push(&b, SIZE_MAX / 8));
    assert_non_null(buffer_append(&b, "12345678", 1));
    const buffer before = b;
    assert_null(buffer_push(&b, SIZE_MAX));
    assert_null(buffer_push(&b, SIZE_MAX / 4));
    assert_null(buffer_push(&b, SIZE_MAX / 8 + 1));
    a.fail_at = a.calls + 1;
    assert_null(buffer_push(&b, 1000));
    assert_memory_equal(&b, &before, sizeof b);
    assert_memory_equal(b.items, "12345678", 8);
    buffer_free(&b);
    assert_true(failing_allocator_is_clean(&a));
}

static void nothing_in_an_arena_moves_or_overlaps(void **state)
{
    (void)state;
    enum { PIECES = 500 };
    failing_allocator a;
    failing_allocator_init(&a, 0);
    arena texts = arena_make(&a.memory);
    unsigned char *pieces[PIECES];
    size_t sizes[PIECES], sum = 0;
    uint64_t random = 2;
    for (uint32_t i = 0; i < PIECES; ++i) {
        sizes[i] = random_below(&random, i % 50 == 0 ? 200000 : 2000); // some larger than a block
        pieces[i] = arena_push(&texts, sizes[i], 1);
        assert_non_null(pieces[i]);
        memset(pieces[i], (int)(i % 256), sizes[i]);
        sum += sizes[i];
    }
    assert_true(texts.bytes >= sum);
    for (uint32_t i = 0; i < PIECES; ++i)
        for (size_t k = 0; k < sizes[i]; ++k) assert_int_equal(pieces[i][k], i % 256);
    arena_free(&texts);
    assert_true(failing_allocator_is_clean(&a));
}

static void an_arena_of_little_takes_little_and_one_of_much_few_blocks(void **state)
{
    (void)state;
    failing_allocator a;
    failing_allocator_init(&a, 0);
    arena small = arena_make(&a.memory), large = arena_make(&a.memory);
    assert_non_null(arena_push(&small, 100, 1));
    assert_int_equal(a.live_bytes, 1024);
    const uint64_t calls = a.calls;
    for (int i = 0; i < 16384; ++i) assert_non_null(arena_push(&large, 64, 1)); // 1 MiB
    assert_in_range(a.calls - calls, 16, 24);
    assert_true(a.live_bytes < 1300 * 1024);
    arena_free(&small);
    arena_free(&large);
    assert_true(failing_allocator_is_clean(&a));
}

static void an_arena_refuses_sizes_that_overflow(void **state)
{
    (void)state;
    failing_allocator a;
    failing_allocator_init(&a, 0);
    arena texts = arena_make(&a.memory);
    assert_null(arena_push(&texts, SIZE_MAX, 1));
    assert_null(arena_push(&texts, SIZE_MAX / 2, 1));
    assert_null(arena_push(&texts, SIZE_MAX / 2 + 2, 2));
    assert_null(arena_push(&texts, SIZE_MAX / 4, 2));
    assert_int_equal(texts.bytes, 0);
    assert_string_equal(arena_text(&texts, "abcdef", 3), "abc");
    assert_string_equal(arena_text(&texts, NULL, 0), "");
    arena_free(&texts);
    assert_true(failing_allocator_is_clean(&a));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes_that_overflow_are_refused_and_never_wrap),
        cmocka_unit_test(no_items_give_memory_that_can_be_freed),
        cmocka_unit_test(memory_is_aligned_to_64_bytes),
        cmocka_unit_test(a_buffer_keeps_its_items_while_it_grows),
        cmocka_unit_test(a_buffer_that_cannot_grow_stays_as_it_was),
        cmocka_unit_test(nothing_in_an_arena_moves_or_overlaps),
        cmocka_unit_test(an_arena_of_little_takes_little_and_one_of_much_few_blocks),
        cmocka_unit_test(an_arena_refuses_sizes_that_overflow),
    };
    return cmocka_run_group_tests_name("core memory", tests, NULL, NULL);
}
