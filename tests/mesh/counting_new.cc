// Operator new, counted and made to fail: see counting_new.h. Replaces the program's, so OpenMesh's too.
// SPDX-License-Identifier: MIT
#include "counting_new.h"

#include <cstdlib>
#include <new>

static long calls, live, fail_at; // of this test program

void new_fails_at(long call)
{
    calls = 0;
    fail_at = call;
}

long new_calls(void)
{
    return calls;
}

long new_live(void)
{
    return live;
}

static void *take(std::size_t size)
{
    if (++calls == fail_at) throw std::bad_alloc();
    void *memory = std::malloc(size ? size : 1);
    if (!memory) throw std::bad_alloc();
    ++live;
    return memory;
}

static void give(void *memory)
{
    if (!memory) return;
    --live;
    std::free(memory);
}

__attribute__((visibility("default"))) void *operator new(std::size_t size) { return take(size); }
__attribute__((visibility("default"))) void *operator new[](std::size_t size) { return take(size); }
__attribute__((visibility("default"))) void operator delete(void *memory) noexcept { give(memory); }
__attribute__((visibility("default"))) void operator delete[](void *memory) noexcept { give(memory); }
__attribute__((visibility("default"))) void operator delete(void *memory, std::size_t) noexcept { give(memory); }
__attribute__((visibility("default"))) void operator delete[](void *memory, std::size_t) noexcept { give(memory); }
