// Viewers: opens the queries of a chain and sizes every list of a frame from what the cullers told after build.
// SPDX-License-Identifier: MIT
#include "viewer.h"

#include <string.h>

static uint32_t max_u32(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

static size_t max_size(size_t a, size_t b)
{
    return a > b ? a : b;
}

// Which stage starts, which steps: the last filter that walks the hierarchy needs nothing of those before it.
static void choose_stages(const chain *c, uint32_t *first, uint32_t *last)
{
    *first = *last = 0;
    for (uint32_t i = 1; i < c->stage_count; ++i) {
        if (c->stages[i].role != ROLE_FILTER) continue;
        *last = i;
        if (c->stages[i].built.walks_hierarchy) *first = i;
    }
}

// ---- The room ----

// Stages before the last may give no tests, and those that are not first no pictures: they learn it from the check of
// what they wrote, so there has to be room for it.
void viewer_room_size_add(viewer_room_size *size, const chain *c)
{
    uint32_t first, last;
    choose_stages(c, &first, &last);
    for (uint32_t i = 0; i < c->stage_count; ++i) {
        const cull_built *b = &c->stages[i].built;
        size->scratch = max_size(size->scratch, b->scratch_size);
        size->slot_marks = max_size(size->slot_marks, b->slot_count);
        size->seen = max_size(size->seen, viewer_seen_bytes(c, i));
        if (i >= last) continue;
        size->early_tests = max_size(size->early_tests, b->max_tests * sizeof(cull_test));
        size->early_captures = max_size(size->early_captures, b->max_captures * sizeof(cull_capture));
        size->early_pictures = max_size(size->early_pictures, b->max_pictures * sizeof(cull_picture));
        size->early_clipped = max_size(size->early_clipped, b->max_clipped * sizeof(cull_clipped));
    }
}

static int grow_list(list *l, size_t before, size_t *now, const allocator *memory)
{
    if (*now <= before && l->items) {
        *now = before;
        return 1;
    }
    const list grown = list_open(memory, *now, 1);
    if (!grown.items) return 0;
    list_close(l, memory);
    *l = grown;
    return 1;
}

static int grow_scratch(viewer_room *room, size_t size, const allocator *memory)
{
    if (size <= room->size.scratch) return 1;
    void *scratch = memory_alloc(memory, size, 1);
    if (!scratch) return 0;
    memory_free(memory, room->scratch, room->size.scratch, 1);
    room->scratch = scratch;
    room->size.scratch = size;
    return 1;
}

result viewer_room_fit(viewer_room *room, const viewer_room_size *size, const allocator *memory)
{
    struct { list *l; size_t *before, now; } all[] = {{&room->early_tests, &room->size.early_tests, size->early_tests},
                                                      {&room->early_captures, &room->size.early_captures, size->early_captures},
                                                      {&room->early_pictures, &room->size.early_pictures, size->early_pictures},
                                                      {&room->early_clipped, &room->size.early_clipped, size->early_clipped},
                                                      {&room->slot_marks, &room->size.slot_marks, size->slot_marks},
                                                      {&room->seen, &room->size.seen, size->seen}};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) {
        if (!grow_list(all[i].l, *all[i].before, &all[i].now, memory)) return RESULT_NO_MEMORY; // those grown so far are just larger
        *all[i].before = all[i].now;
    }
    return grow_scratch(room, size->scratch, memory) ? RESULT_OK : RESULT_NO_MEMORY;
}

void viewer_room_close(viewer_room *room, const allocator *memory)
{
    list *const all[] = {&room->early_tests, &room->early_captures, &room->early_pictures, &room->early_clipped, &room->slot_marks, &room->seen};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) list_close(all[i], memory);
    memory_free(memory, room->scratch, room->size.scratch, 1);
    *room = (viewer_room){0};
}

// ---- One zone ----

static result open_query(viewer *v, uint32_t stage, report *r)
{
    const chain_stage *s = &v->chain->stages[stage];
    cull_query *query = NULL; // not the stage's own: what a failed open leaves there is nothing to close
    const cull_result code = s->plugin->open(s->culler, &query);
    if (code == CULL_ERR_MEMORY) return report_no_memory(r, NULL);
    if (code != CULL_OK || !query)
        return report_error(r, NULL, 0, "culler '%s' could not open a query (result %d); try another chain", s->plugin->descriptor->id, (int)code);
    v->stages[stage].query = query;
    return RESULT_OK;
}

static result open_queries(viewer *v, report *r)
{
    result done = RESULT_OK;
    for (uint32_t i = 0; i < v->chain->stage_count && done == RESULT_OK; ++i) done = open_query(v, i, r);
    return done;
}

typedef struct list_plan { list *l; size_t count, item_size; } list_plan;

static int open_planned(viewer *v, const viewer_request *q, const list_plan *plans, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        *plans[i].l = list_open_as(q->lists, v->memory, plans[i].count, plans[i].item_size);
        if (!plans[i].l->items) return 0;
    }
    return 1;
}

static int open_stages(viewer *v, const viewer_request *q)
{
    const chain *c = v->chain;
    for (uint32_t i = 0; i < c->stage_count; ++i) {
        const cull_built *b = &c->stages[i].built;
        const uint32_t movers = i == v->last && b->takes_movers ? c->zone.mover_capacity : 0;
        v->stages[i].run_capacity = b->max_runs + movers;
        v->slot_count = max_u32(v->slot_count, b->slot_count);
        const list_plan plan = {&v->stages[i].runs, v->stages[i].run_capacity, sizeof(cull_run)};
        if (c->stages[i].role != ROLE_CROSS && !open_planned(v, q, &plan, 1)) return 0;
    }
    return 1;
}

// Cutting a shared item out of a run makes two of one, at most.
static size_t drawn_capacity(const viewer *v)
{
    const cull_built *last = &v->chain->stages[v->last].built;
    const uint32_t shared = v->chain->data->shared_count;
    if (last->max_steps <= 1 && !shared && !last->takes_movers) return 0;
    return (size_t)max_u32(v->stages[v->last].run_capacity, 1) + shared;
}

static int open_lists(viewer *v, const viewer_request *q)
{
    const chain *c = v->chain;
    const cull_built *last = &c->stages[v->last].built, *select = &c->stages[0].built;
    const uint32_t movers = last->takes_movers ? c->zone.mover_capacity : 0, is_filtered = v->last > 0;
    const int keeps_seen = v->checks == VIEWER_CHECK_ALL && last->max_steps > 1;
    v->answer_capacity = last->max_tests ? last->max_tests * 2 + 1 : 0; // one more than is lent: a full list says that there are more
    v->whole = (cull_run){0, c->zone.item_count};
    const list_plan plans[] = {
        {&v->tests, last->max_tests, sizeof(cull_test)},
        {&v->captures, last->max_captures, sizeof(cull_capture)},
        {&v->pictures, last->max_pictures, sizeof(cull_picture)},
        {&v->clipped, last->max_clipped, sizeof(cull_clipped)},
        {&v->select_captures, is_filtered ? select->max_captures : 0, sizeof(cull_capture)},
        {&v->select_pictures, is_filtered ? select->max_pictures : 0, sizeof(cull_picture)},
        {&v->select_clipped, is_filtered ? select->max_clipped : 0, sizeof(cull_clipped)},
        {&v->keep_captures, is_filtered ? select->max_captures : 0, 1},
        {&v->keep_pictures, is_filtered ? select->max_pictures : 0, 1},
        {&v->keep_clipped, is_filtered ? select->max_clipped : 0, 1},
        {&v->drawn, drawn_capacity(v), sizeof(cull_run)},
        {&v->answers, v->answer_capacity, sizeof(cull_answer)},
        {&v->slot_movers, movers < q->mover_numbers ? movers : 0, sizeof(uint32_t)},
        {&v->slot_lent, movers, sizeof(uint32_t)},
        {&v->seen, keeps_seen ? viewer_seen_bytes(c, v->last) : 0, 1},
    };
    if (!open_planned(v, q, plans, sizeof plans / sizeof *plans)) return 0;
    memset(v->slot_movers.items, 0xFF, v->slot_movers.size); // SCENE_NONE
    memset(v->slot_lent.items, 0, v->slot_lent.size);        // serials count from 1
    if (!v->slot_count) return 1;
    v->slots = memory_alloc_zeroed(v->memory, v->slot_count, 1);
    v->slot_boxes = memory_alloc_zeroed(v->memory, v->slot_count, sizeof *v->slot_boxes);
    return v->slots && v->slot_boxes;
}

static size_t viewer_bytes(const chain *c)
{
    return sizeof(viewer) + c->stage_count * sizeof(viewer_stage);
}

static const cull_sight *sight_of(const chain *c)
{
    uint32_t crosser = 1;
    while (crosser < c->stage_count && c->stages[crosser].role != ROLE_CROSS) ++crosser;
    if (crosser >= c->stage_count) return NULL;
    const cull_sight *sight = c->stages[0].plugin->get_extension(c->stages[0].culler, CULL_EXT_SIGHT);
    return sight && sight->part ? sight : NULL;
}

result viewer_open(const viewer_request *q, report *r, viewer **out)
{
    const allocator *memory = q->services->memory;
    viewer *v = memory_alloc_zeroed(memory, 1, viewer_bytes(q->chain));
    if (!v) return report_no_memory(r, NULL);
    v->chain = q->chain;
    v->shared = q->shared;
    v->room = q->room;
    v->memory = memory;
    v->log = q->services->log;
    v->kernel = runs_kernel_best();
    v->checks = q->checks;
#ifndef NDEBUG
    v->checks = VIEWER_CHECK_ALL;
#endif
    choose_stages(v->chain, &v->first, &v->last);
    v->sight = sight_of(v->chain);
    result done = open_queries(v, r);
    if (done == RESULT_OK && (!open_stages(v, q) || !open_lists(v, q))) done = report_no_memory(r, NULL);
    if (done != RESULT_OK) {
        viewer_close(v);
        return done;
    }
    *out = v;
    return RESULT_OK;
}

void viewer_close(viewer *v)
{
    if (!v) return;
    for (uint32_t i = 0; i < v->chain->stage_count; ++i) {
        if (v->stages[i].query) v->chain->stages[i].plugin->close(v->stages[i].query);
        list_close(&v->stages[i].runs, v->memory);
    }
    list *const all[] = {&v->tests, &v->captures, &v->pictures, &v->clipped, &v->drawn, &v->select_captures, &v->select_pictures, &v->select_clipped,
                         &v->keep_captures, &v->keep_pictures, &v->keep_clipped, &v->answers, &v->slot_movers, &v->slot_lent, &v->seen};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) list_close(all[i], v->memory);
    memory_free(v->memory, v->slots, v->slot_count, 1);
    memory_free(v->memory, v->slot_boxes, v->slot_count, sizeof *v->slot_boxes);
    memory_free(v->memory, v, 1, viewer_bytes(v->chain));
}
