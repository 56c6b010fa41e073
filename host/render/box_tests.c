// Box tests in flight: batches of counts, read back when the driver is done or when the bench says that it is.
// SPDX-License-Identifier: MIT
// Invariant: answers come oldest first; where memory fails, tests go unanswered, and an unanswered test counts as seen.
#include "gl.h"

static const uint32_t SLOT_HIDDEN = 0xffffffffu, SLOT_SEEN = 0xfffffffeu; // known without drawing
static const uint64_t WAIT_NS = 1000000000u;
enum { BATCHES = 16 }; // places of a ring that nothing is known about

static void batch_close(renderer *g, test_batch *b)
{
    if (b->fence) glDeleteSync(b->fence);
    glDeleteBuffers(1, &b->counts);
    memory_free(g->memory, b->tags, b->capacity, sizeof *b->tags);
    memory_free(g->memory, b->slots, b->capacity, sizeof *b->slots);
    memory_free(g->memory, b->pixels, b->capacity, sizeof *b->pixels);
    *b = (test_batch){0};
}

static int batch_reserve(renderer *g, test_batch *b, uint32_t count)
{
    if (count <= b->capacity) return 1;
    uint32_t capacity = 256;
    while (capacity < count && capacity < 0x40000000u) capacity *= 2;
    if (capacity < count) return 0;
    batch_close(g, b);
    b->capacity = capacity;
    b->tags = memory_alloc(g->memory, capacity, sizeof *b->tags);
    b->slots = memory_alloc(g->memory, capacity, sizeof *b->slots);
    b->pixels = memory_alloc(g->memory, capacity, sizeof *b->pixels);
    if (!b->tags || !b->slots || !b->pixels) {
        batch_close(g, b);
        return 0;
    }
    glCreateBuffers(1, &b->counts);
    glNamedBufferStorage(b->counts, (GLsizeiptr)(capacity * sizeof(uint32_t)), NULL, GL_DYNAMIC_STORAGE_BIT);
    return 1;
}

static test_batch *queue_place(test_queue *q, uint32_t i)
{
    return &q->batches[(q->first + i) % q->capacity];
}

static int queue_grow(renderer *g, uint32_t capacity)
{
    test_queue *q = &g->tests;
    test_batch *batches = memory_alloc_zeroed(g->memory, capacity, sizeof *batches);
    if (!batches) return 0;
    for (uint32_t i = 0; i < q->capacity; ++i) batches[i] = *queue_place(q, i); // free places too: they keep their buffers
    memory_free(g->memory, q->batches, q->capacity, sizeof *q->batches);
    q->batches = batches;
    q->capacity = capacity;
    q->first = 0;
    return 1;
}

static int queue_reserve(renderer *g)
{
    const test_queue *q = &g->tests;
    return q->count < q->capacity || queue_grow(g, q->capacity ? q->capacity * 2 : BATCHES);
}

// A test waits for `latency` calls of renderer_collect more; by the driver's clock nobody knows how many.
result tests_reserve(renderer *g, uint32_t tests_a_step)
{
    test_queue *q = &g->tests;
    const uint32_t places = q->by_driver ? BATCHES : q->latency + 2;
    if (tests_a_step == 0) return RESULT_OK;
    if (places > q->capacity && !queue_grow(g, places)) return RESULT_NO_MEMORY;
    for (uint32_t i = q->count; i < q->capacity; ++i)
        if (!batch_reserve(g, queue_place(q, i), tests_a_step)) return RESULT_NO_MEMORY;
    return RESULT_OK;
}

static void batch_fill(renderer *g, test_batch *b, const cull_test *tests, uint32_t count)
{
    boxes_begin(g, &g->frame.view, b->counts);
    b->tested = 0;
    for (uint32_t i = 0; i < count; ++i) {
        eye_box widened;
        const box_fate fate = box_place(&g->frame.view, &tests[i].box, &widened);
        b->tags[i] = tests[i].tag;
        b->slots[i] = fate == BOX_NEAR ? SLOT_SEEN : fate == BOX_OUTSIDE ? SLOT_HIDDEN : b->tested;
        if (fate != BOX_TESTED) continue;
        b->tested++;
        boxes_add(g, &widened);
    }
    boxes_end(g);
    if (b->tested) b->fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    if (b->tested) glFlush();
}

void renderer_test(renderer *g, const cull_test *tests, uint32_t count, uint32_t frame)
{
    test_queue *q = &g->tests;
    if (count == 0 || !g->frame.open || !queue_reserve(g)) return;
    test_batch *b = queue_place(q, q->count);
    if (!batch_reserve(g, b, count)) return;
    b->count = count;
    b->taken = b->is_read = 0;
    b->frame = frame;
    b->asked = q->collects;
    frame_bind(g); // every opaque run given so far was drawn at once
    glClearNamedBufferSubData(b->counts, GL_R32UI, 0, (GLsizeiptr)(count * sizeof(uint32_t)), GL_RED_INTEGER, GL_UNSIGNED_INT, NULL);
    batch_fill(g, b, tests, count);
    q->count++;
    gl_check(g, NULL, "testing boxes");
}

static int is_ready(const test_queue *q, const test_batch *b)
{
    if (!q->by_driver) return q->collects - b->asked > q->latency;
    if (!b->fence) return 1;
    const GLenum state = glClientWaitSync(b->fence, GL_SYNC_FLUSH_COMMANDS_BIT, 0);
    return state != GL_TIMEOUT_EXPIRED;
}

static void batch_read(test_batch *b)
{
    if (b->is_read) return;
    b->is_read = 1;
    if (!b->fence) return;
    while (glClientWaitSync(b->fence, GL_SYNC_FLUSH_COMMANDS_BIT, WAIT_NS) == GL_TIMEOUT_EXPIRED) continue;
    glDeleteSync(b->fence);
    b->fence = NULL;
    glGetNamedBufferSubData(b->counts, 0, (GLsizeiptr)(b->tested * sizeof(uint32_t)), b->pixels);
}

static uint32_t batch_take(test_batch *b, uint32_t frame, cull_answer *answers, uint32_t capacity)
{
    uint32_t given = 0;
    for (; b->taken < b->count && given < capacity; ++b->taken) {
        const uint32_t slot = b->slots[b->taken];
        const uint32_t pixels = slot == SLOT_SEEN ? 1 : slot == SLOT_HIDDEN ? 0 : b->pixels[slot];
        answers[given++] = (cull_answer){.tag = b->tags[b->taken], .pixels = pixels, .age = frame - b->frame};
    }
    return given;
}

uint32_t renderer_collect(renderer *g, collect how, uint32_t frame, cull_answer *answers, uint32_t capacity, uint32_t *stalled)
{
    test_queue *q = &g->tests;
    uint32_t given = 0;
    q->collects++;
    while (q->count && given < capacity) {
        test_batch *b = queue_place(q, 0);
        if (!b->is_read && !is_ready(q, b)) {
            if (how == COLLECT_READY) break;
            *stalled = 1;
        }
        batch_read(b);
        given += batch_take(b, frame, answers + given, capacity - given);
        if (b->taken < b->count) break;
        q->first = (q->first + 1) % q->capacity;
        q->count--;
    }
    gl_check(g, NULL, "reading box tests");
    return given;
}

void renderer_forget_tests(renderer *g)
{
    test_queue *q = &g->tests;
    for (uint32_t i = 0; i < q->count; ++i) {
        test_batch *b = queue_place(q, i);
        if (b->fence) glDeleteSync(b->fence);
        b->fence = NULL;
    }
    q->first = q->count = 0;
}

void renderer_query_latency(renderer *g, uint32_t steps)
{
    g->tests.latency = steps;
    g->tests.by_driver = 0;
}

void tests_close(renderer *g)
{
    test_queue *q = &g->tests;
    for (uint32_t i = 0; i < q->capacity; ++i) batch_close(g, &q->batches[i]);
    memory_free(g->memory, q->batches, q->capacity, sizeof *q->batches);
    *q = (test_queue){0};
}
