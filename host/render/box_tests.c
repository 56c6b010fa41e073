// Box tests in flight: tests of any zones drawn together, read back together, answered to the zone that asked.
// SPDX-License-Identifier: MIT
// Invariant: a zone's answers come oldest first and are no other zone's; where memory fails, tests go unanswered, and an
// unanswered test counts as seen.
#include "gl.h"

#include <string.h>

static const uint64_t WAIT_NS = 1000000000u;
enum { WAITS_MOST = 10 }; // 10 s: systems restart a GPU that hangs for 2 s
enum { GROUP_LEAST = 4096, ENTRIES_LEAST = 1024, BY_DRIVER_STEPS = 4 }; // steps: how late a driver's answers are reckoned to be

// ---- Room ----

static void group_close(renderer *g, test_group *b)
{
    if (b->fence) glDeleteSync(b->fence);
    glDeleteBuffers(1, &b->counts);
    memory_free(g->memory, b->entries, b->capacity, sizeof *b->entries);
    memory_free(g->memory, b->pixels, b->capacity, sizeof *b->pixels);
    *b = (test_group){0};
}

// Of a group that nothing is in.
static int group_reserve(renderer *g, test_group *b, uint32_t count)
{
    if (count <= b->capacity) return 1;
    uint32_t capacity = GROUP_LEAST;
    while (capacity < count && capacity < 0x40000000u) capacity *= 2;
    if (capacity < count) return 0;
    group_close(g, b);
    b->capacity = capacity;
    b->entries = memory_alloc(g->memory, capacity, sizeof *b->entries);
    b->pixels = memory_alloc(g->memory, capacity, sizeof *b->pixels);
    if (!b->entries || !b->pixels) {
        group_close(g, b);
        return 0;
    }
    glCreateBuffers(1, &b->counts);
    glNamedBufferStorage(b->counts, (GLsizeiptr)(capacity * sizeof(uint32_t)), NULL, GL_DYNAMIC_STORAGE_BIT);
    glClearNamedBufferData(b->counts, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, NULL);
    return 1;
}

static result entries_grow(renderer *g, uint32_t capacity)
{
    test_queue *q = &g->tests;
    test_entry *entries = memory_alloc(g->memory, capacity, sizeof *entries);
    if (!entries) return RESULT_NO_MEMORY;
    if (q->capacity) memcpy(entries, q->entries, q->capacity * sizeof *entries);
    for (uint32_t i = q->capacity; i < capacity; ++i) entries[i].next = i + 1 < capacity ? i + 1 : q->capacity ? q->free : TEST_NONE;
    q->free = q->capacity;
    memory_free(g->memory, q->entries, q->capacity, sizeof *entries);
    q->entries = entries;
    q->capacity = capacity;
    return RESULT_OK;
}

// A zone's test waits for `latency` of its collects more; by the driver's clock nobody knows how many.
result tests_reserve(renderer *g, uint32_t tests_a_step)
{
    test_queue *q = &g->tests;
    const uint64_t steps = q->by_driver ? BY_DRIVER_STEPS : (uint64_t)q->latency + 2, entries = steps * tests_a_step;
    if (tests_a_step == 0) return RESULT_OK;
    if (entries > q->capacity && (entries >= TEST_NONE || entries_grow(g, (uint32_t)entries) != RESULT_OK)) return RESULT_NO_MEMORY;
    for (uint32_t i = q->count; i < TEST_GROUPS; ++i) // the others grow when they are free
        if (!(i == q->count && q->is_staging) && !group_reserve(g, &q->groups[(q->first + i) % TEST_GROUPS], tests_a_step)) return RESULT_NO_MEMORY;
    return RESULT_OK;
}

result renderer_reserve(renderer *g, uint32_t tests_a_step, report *r)
{
    if (tests_reserve(g, tests_a_step) == RESULT_OK) return gl_check(g, r, "making room for box tests");
    return report_no_memory(r, g->scene.scene ? g->scene.scene->path : NULL);
}

// ---- Groups ----

// 0: the driver does not answer; told once, and not waited for again.
static int wait_for(renderer *g, GLsync fence)
{
    if (!fence) return 1;
    GLenum state = GL_TIMEOUT_EXPIRED;
    for (int i = 0; i < WAITS_MOST && state == GL_TIMEOUT_EXPIRED; ++i) {
        state = glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, g->tests.is_lost ? 0 : WAIT_NS);
        if (g->tests.is_lost) break;
    }
    if (state != GL_TIMEOUT_EXPIRED && state != GL_WAIT_FAILED) return 1;
    if (!g->tests.is_lost)
        report_error(&g->sink, NULL, 0, "GL: box tests %s; all count as seen from now on. Restart, or try another driver",
                     state == GL_WAIT_FAILED ? "cannot be waited for" : "were not answered in 10 s");
    g->errors += !g->tests.is_lost;
    g->tests.is_lost = 1;
    return 0;
}

// Every zone's tests of the oldest group get what was counted. Waits for the driver.
static void resolve_oldest(renderer *g)
{
    test_queue *q = &g->tests;
    test_group *b = &q->groups[q->first];
    const int is_counted = wait_for(g, b->fence);
    glDeleteSync(b->fence);
    b->fence = NULL;
    const GLsizeiptr bytes = (GLsizeiptr)(b->count * sizeof(uint32_t));
    if (is_counted) glGetNamedBufferSubData(b->counts, 0, bytes, b->pixels);
    else memset(b->pixels, 0xFF, (size_t)bytes); // all seen
    glClearNamedBufferSubData(b->counts, GL_R32UI, 0, bytes, GL_RED_INTEGER, GL_UNSIGNED_INT, NULL);
    for (uint32_t i = 0; i < b->count; ++i) q->entries[b->entries[i]].pixels = b->pixels[i] < TEST_NONE ? b->pixels[i] : TEST_NONE - 1;
    b->count = 0;
    q->first = (q->first + 1) % TEST_GROUPS;
    q->count--;
}

static void resolve_what_is_done(renderer *g)
{
    test_queue *q = &g->tests;
    while (q->count) {
        const test_group *b = &q->groups[q->first];
        if (b->fence && glClientWaitSync(b->fence, GL_SYNC_FLUSH_COMMANDS_BIT, 0) == GL_TIMEOUT_EXPIRED) return;
        resolve_oldest(g);
    }
}

static test_group *staged_group(test_queue *q)
{
    return &q->groups[(q->first + q->count) % TEST_GROUPS];
}

void tests_submit(renderer *g)
{
    test_queue *q = &g->tests;
    if (!q->is_staging) return;
    test_group *b = staged_group(q);
    q->is_staging = 0;
    if (b->count == 0) return;
    frame_bind(g);
    boxes_end(g);
    b->fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glFlush();
    q->count++;
    gl_check(g, NULL, "testing boxes");
}

// A group with room for so many more, being staged. NULL: no memory.
static test_group *group_for(renderer *g, uint32_t count)
{
    test_queue *q = &g->tests;
    if (q->is_staging && staged_group(q)->capacity - staged_group(q)->count >= count) return staged_group(q);
    tests_submit(g);
    if (q->count == TEST_GROUPS) resolve_oldest(g);
    test_group *b = staged_group(q);
    if (!group_reserve(g, b, count)) return NULL;
    q->is_staging = 1;
    boxes_begin(g, &g->frame.view, b->counts);
    return b;
}

// ---- Asking ----

static uint32_t entry_take(renderer *g)
{
    test_queue *q = &g->tests;
    const uint32_t more = q->capacity ? q->capacity * 2 : ENTRIES_LEAST;
    if ((q->capacity == 0 || q->free == TEST_NONE) && (more < q->capacity || entries_grow(g, more) != RESULT_OK)) return TEST_NONE;
    const uint32_t e = q->free;
    q->free = q->entries[e].next;
    return e;
}

static void append(test_queue *q, layout_zone *z, uint32_t e)
{
    q->entries[e].next = TEST_NONE;
    if (z->newest_test == TEST_NONE) z->oldest_test = e;
    else q->entries[z->newest_test].next = e;
    z->newest_test = e;
}

static void move_box(const cull_box *box, const double offset[3], mover_box *out)
{
    const float low[3] = {box->min.x, box->min.y, box->min.z}, high[3] = {box->max.x, box->max.y, box->max.z};
    for (int k = 0; k < 3; ++k) {
        out->low[k] = (double)low[k] + offset[k];
        out->high[k] = (double)high[k] + offset[k];
    }
}

void renderer_test(renderer *g, const render_layout *l, uint32_t zone, const cull_test *tests, uint32_t count, uint32_t frame)
{
    test_queue *q = &g->tests;
    if (count == 0 || !g->frame.open || zone >= l->zone_count) return;
    layout_zone *z = &l->zones[zone];
    double offset[3];
    if (!q->is_staging) frame_flush(g); // tests see what was drawn so far
    test_group *b = group_for(g, count);
    if (!b) return;
    layout_zone_offset(g, zone, offset);
    frame_bind(g);
    for (uint32_t i = 0; i < count; ++i) {
        mover_box box;
        eye_box widened;
        const uint32_t e = entry_take(g);
        if (e == TEST_NONE) break;
        move_box(&tests[i].box, offset, &box);
        const box_fate fate = box_place(&g->frame.view, &box, &widened);
        q->entries[e] = (test_entry){.tag = tests[i].tag, .frame = frame, .asked = z->collects, .pixels = fate == BOX_NEAR ? 1 : fate == BOX_OUTSIDE ? 0 : TEST_NONE};
        append(q, z, e);
        if (fate != BOX_TESTED) continue;
        b->entries[b->count++] = e;
        boxes_add(g, &widened);
    }
}

// ---- Answering ----

static int is_ready(renderer *g, const layout_zone *z, const test_entry *e)
{
    const test_queue *q = &g->tests;
    if (!q->by_driver) return z->collects - e->asked > q->latency;
    if (e->pixels == TEST_NONE) resolve_what_is_done(g);
    return e->pixels != TEST_NONE;
}

static void drop_oldest(test_queue *q, layout_zone *z)
{
    const uint32_t e = z->oldest_test;
    z->oldest_test = q->entries[e].next;
    if (z->oldest_test == TEST_NONE) z->newest_test = TEST_NONE;
    q->entries[e].next = q->free;
    q->free = e;
}

uint32_t renderer_collect(renderer *g, const collect_request *c, cull_answer *answers, uint32_t capacity, uint32_t *stalled)
{
    test_queue *q = &g->tests;
    if (c->zone >= c->layout->zone_count) return 0;
    layout_zone *z = &c->layout->zones[c->zone];
    uint32_t given = 0;
    z->collects++;
    if (z->oldest_test == TEST_NONE) return 0;
    tests_submit(g);
    while (z->oldest_test != TEST_NONE && given < capacity) {
        const test_entry *e = &q->entries[z->oldest_test];
        if (!is_ready(g, z, e)) {
            if (c->how == COLLECT_READY) break;
            *stalled = 1;
        }
        while (e->pixels == TEST_NONE && q->count) resolve_oldest(g);
        answers[given++] = (cull_answer){.tag = e->tag, .pixels = e->pixels, .age = c->frame - e->frame};
        drop_oldest(q, z);
    }
    gl_check(g, NULL, "reading box tests");
    return given;
}

// ---- Forgetting ----

static void resolve_all(renderer *g)
{
    tests_submit(g);
    while (g->tests.count) resolve_oldest(g);
}

void tests_forget_zone(renderer *g, render_layout *l, uint32_t zone)
{
    layout_zone *z = &l->zones[zone];
    if (z->oldest_test == TEST_NONE) return;
    resolve_all(g); // groups in flight name entries
    while (z->oldest_test != TEST_NONE) drop_oldest(&g->tests, z);
}

void renderer_forget_tests(renderer *g)
{
    for (render_layout *l = g->layouts; l; l = l->next)
        for (uint32_t zone = 0; zone < l->zone_count; ++zone) tests_forget_zone(g, l, zone);
}

void renderer_query_latency(renderer *g, uint32_t steps)
{
    g->tests.latency = steps;
    g->tests.by_driver = 0;
}

void tests_close(renderer *g)
{
    test_queue *q = &g->tests;
    for (uint32_t i = 0; i < TEST_GROUPS; ++i) group_close(g, &q->groups[i]);
    memory_free(g->memory, q->entries, q->capacity, sizeof *q->entries);
    *q = (test_queue){0};
}
