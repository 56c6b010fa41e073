// One query stepped as a host steps it, with everything that it writes looked at: see stand.h.
// SPDX-License-Identifier: MIT
// Invariant: nonsense is named in the answer and left out of it, so that one fault fails one check.
#include "picture.h"
#include "stand.h"

#include <portcullis/plane.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS_MOST = 4096 }; // of a scene of some hundred items; a culler may tell more, and is then cut here

typedef struct list_want { fence *to; size_t count, size; const char *name; } list_want;

static int lists_open(sitting *t, sitting_lists lists)
{
    const cull_built *b = &t->stand->built;
    const size_t slack = lists == LISTS_ROOMY ? 1 << 16 : 0, planes = VIEW_VOLUMES_MOST * CULL_MAX_PLANES;
    t->run_capacity = b->max_runs + (b->takes_movers ? t->stand->scene->zone.mover_capacity : 0);
    const list_want wants[] = {
        {&t->runs, t->run_capacity, sizeof(cull_run), "memory behind batch.runs, over max_runs"},
        {&t->pictures, b->max_pictures, sizeof(cull_picture), "memory behind batch.pictures, over max_pictures"},
        {&t->tests, b->max_tests, sizeof(cull_test), "memory behind batch.tests, over max_tests"},
        {&t->captures, b->max_captures, sizeof(cull_capture), "memory behind batch.captures, over max_captures"},
        {&t->clipped, b->max_clipped, sizeof(cull_clipped), "memory behind batch.clipped, over max_clipped"},
        {&t->keep_pictures, 0, 1, "memory behind batch.keep_pictures"},
        {&t->keep_captures, 0, 1, "memory behind batch.keep_captures"},
        {&t->keep_clipped, 0, 1, "memory behind batch.keep_clipped"},
        {&t->slots, b->slot_count, 1, "memory behind visit.slots"},
        {&t->scratch, b->scratch_size, 1, "memory behind visit.scratch, over scratch_size"},
        {&t->lent_planes, planes, sizeof(cull_plane), "memory behind a volume's planes"},
        {&t->lent_volumes, VIEW_VOLUMES_MOST, sizeof(cull_volume), "memory behind visit.volumes"},
        {&t->lent_candidates, t->stand->scene->zone.item_count, sizeof(cull_run), "memory behind visit.candidates"},
    };
    for (size_t i = 0; i < sizeof wants / sizeof *wants; ++i) {
        *wants[i].to = fence_open(wants[i].count * wants[i].size, wants[i].to == &t->scratch ? 64 : wants[i].size >= 8 ? 8 : 1, slack, wants[i].name);
        if (!wants[i].to->memory) return 0;
    }
    return 1;
}

cull_result sitting_open(sitting *t, stand *s, sitting_lists lists)
{
    *t = (sitting){.stand = s};
    if (!lists_open(t, lists)) return CULL_ERR_MEMORY;
    t->answer_capacity = 2 * s->built.max_tests + 1;
    t->answers = calloc(t->answer_capacity, sizeof *t->answers);
    if (!t->answers) return CULL_ERR_MEMORY;
    return s->plugin->open(s->culler, &t->query);
}

void sitting_close(sitting *t)
{
    if (t->query) t->stand->plugin->close(t->query);
    fence *const all[] = {&t->runs, &t->pictures, &t->tests, &t->captures, &t->clipped, &t->keep_pictures, &t->keep_captures,
                          &t->keep_clipped, &t->slots, &t->scratch, &t->lent_planes, &t->lent_volumes, &t->lent_candidates};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) fence_close(all[i]);
    free(t->answers);
    *t = (sitting){0};
}

// ---- Answers ----

void answer_open(sitting_answer *a, const made_scene *s)
{
    const size_t count = (size_t)s->zone.item_count + s->zone.mover_capacity + 1;
    *a = (sitting_answer){.item_count = s->zone.item_count};
    a->drawn = calloc(count, 1);
    a->order = calloc(count, sizeof *a->order);
    a->runs = calloc(count, sizeof *a->runs);
}

void answer_close(sitting_answer *a)
{
    free(a->drawn);
    free(a->order);
    free(a->runs);
    *a = (sitting_answer){0};
}

int answers_equal(const sitting_answer *a, const sitting_answer *b)
{
    if (a->order_count != b->order_count || memcmp(a->crossings, b->crossings, sizeof a->crossings) != 0) return 0;
    if (a->order_count && memcmp(a->order, b->order, a->order_count * sizeof *a->order) != 0) return 0;
    if (a->item_count && memcmp(a->drawn, b->drawn, a->item_count) != 0) return 0;
    for (uint32_t i = 0; i < SCENE_PORTALS_MOST; ++i) {
        if (a->plane_counts[i] != b->plane_counts[i]) return 0;
        if (memcmp(a->planes + i * CULL_MAX_PLANES, b->planes + i * CULL_MAX_PLANES, a->plane_counts[i] * sizeof *a->planes) != 0) return 0;
    }
    return 1;
}

static void fault(sitting_answer *a, const char *text)
{
    if (!*a->fault) snprintf(a->fault, sizeof a->fault, "%s", text);
}

static void draw_place(const sitting *t, uint32_t place, sitting_answer *a)
{
    const uint32_t item = stand_item(t->stand, place);
    if (a->drawn[item]) {
        fault(a, "it gave an item twice in a frame");
        return;
    }
    a->drawn[item] = 1;
    a->order[a->order_count++] = item;
}

static void draw_runs(const sitting *t, const cull_run *runs, uint32_t count, sitting_answer *a)
{
    const made_scene *s = t->stand->scene;
    const uint32_t items = s->zone.item_count + (t->stand->built.takes_movers ? s->zone.mover_capacity : 0);
    for (uint32_t i = 0; i < count; ++i) {
        if (runs[i].count == 0) fault(a, "it gave an empty run");
        if (runs[i].first >= items || runs[i].count > items - runs[i].first) {
            fault(a, "it gave a run outside the zone");
            if (runs[i].first >= items) continue;
        }
        for (uint32_t k = runs[i].first; k < items && k - runs[i].first < runs[i].count; ++k) draw_place(t, k, a);
    }
}

// What pictures and clipped geometry stand for is drawn too, once or more.
static void draw_lent(const sitting *t, const cull_run *runs, uint32_t count, sitting_answer *a)
{
    const uint32_t items = t->stand->scene->zone.item_count;
    if (count && !runs) fault(a, "it gave a picture or clipped items without runs");
    for (uint32_t i = 0; runs && i < count; ++i) {
        if (runs[i].first >= items || runs[i].count > items - runs[i].first) {
            fault(a, "it gave a picture or clipped items outside the zone");
            continue;
        }
        for (uint32_t k = 0; k < runs[i].count; ++k) {
            const uint32_t item = stand_item(t->stand, runs[i].first + k);
            if (a->drawn[item]) continue;
            a->drawn[item] = 1;
            a->order[a->order_count++] = item;
        }
    }
}

// ---- A frame ----

static cull_batch batch_make(const sitting *t)
{
    return (cull_batch){.runs = t->runs.memory, .pictures = t->pictures.memory, .tests = t->tests.memory, .captures = t->captures.memory,
                        .keep_pictures = t->keep_pictures.memory, .keep_captures = t->keep_captures.memory, .clipped = t->clipped.memory,
                        .keep_clipped = t->keep_clipped.memory};
}

static const char *lists_fault(const cull_batch *b, const cull_batch *lent)
{
    const int same = b->runs == lent->runs && b->pictures == lent->pictures && b->tests == lent->tests &&
                     b->captures == lent->captures && b->clipped == lent->clipped;
    return same ? NULL : "it replaced a list of the batch";
}

// Cuts counts to what there is room for.
static void counts_judge(const sitting *t, cull_batch *b, const cull_batch *before, sitting_answer *a)
{
    const cull_built *c = &t->stand->built;
    struct { uint32_t *count, least, most; const char *over; } const lists[] = {
        {&b->run_count, before->run_count, t->run_capacity, "it gave more runs than max_runs"},
        {&b->picture_count, before->picture_count, c->max_pictures, "it gave more pictures than max_pictures"},
        {&b->clipped_count, before->clipped_count, c->max_clipped, "it gave more clipped items than max_clipped"},
        {&b->test_count, 0, c->max_tests, "it gave more tests than max_tests"},
        {&b->capture_count, 0, c->max_captures, "it gave more captures than max_captures"},
    };
    for (size_t i = 0; i < sizeof lists / sizeof *lists; ++i) {
        if (*lists[i].count > lists[i].most) {
            fault(a, lists[i].over);
            *lists[i].count = lists[i].most;
        }
        if (*lists[i].count < lists[i].least) {
            fault(a, "it took back what it had given in an earlier step");
            *lists[i].count = lists[i].least;
        }
    }
}

static int is_lucky(sitting *t, uint32_t of) // in a careless world, once in `of`; always in a prompt one
{
    t->random = t->random * 6364136223846793005u + 1442695040888963407u;
    return t->world == WORLD_PROMPT || (t->random >> 33) % of == 0;
}

static void pictures_take(sitting *t, const cull_batch *b, const cull_batch *before, sitting_answer *a)
{
    uint8_t *slots = t->slots.memory;
    const uint32_t count = t->stand->built.slot_count;
    for (uint32_t i = before->clipped_count; i < b->clipped_count; ++i) draw_lent(t, b->clipped[i].runs, b->clipped[i].run_count, a);
    uint8_t *captured = calloc(count + 1u, 1); // a later picture may show it in this very frame, whatever becomes of it
    for (uint32_t i = 0; captured && i < b->capture_count; ++i) {
        if (b->captures[i].slot >= count) fault(a, "it captured into a slot that is not there");
        else captured[b->captures[i].slot] = 1;
    }
    for (uint32_t i = before->picture_count; i < b->picture_count; ++i) {
        const cull_picture *p = &b->pictures[i];
        if (p->slot >= count) fault(a, "it showed a slot that is not there");
        else if (captured && !slots[p->slot] && !captured[p->slot]) fault(a, "it showed a slot that is empty");
        else draw_lent(t, p->runs, p->run_count, a);
    }
    for (uint32_t i = 0; captured && i < count; ++i)
        if (captured[i]) slots[i] = (uint8_t)is_lucky(t, 2);
    free(captured);
}

static void answers_take(sitting *t, const cull_batch *b, cull_progress progress, sample_picture *p, sitting_answer *a)
{
    for (uint32_t i = 0; i < b->test_count; ++i) {
        const cull_test *test = &b->tests[i];
        const float c[6] = {test->box.min.x, test->box.min.y, test->box.min.z, test->box.max.x, test->box.max.y, test->box.max.z};
        for (int k = 0; k < 6; ++k)
            if (!isfinite(c[k]) || c[k % 3] > c[k % 3 + 3]) fault(a, "it gave a test whose box is not finite or is inside out");
        if (t->answer_count == t->answer_capacity || (progress != CULL_WAIT && !is_lucky(t, 2))) continue;
        t->answers[t->answer_count++] = (cull_answer){test->tag, sample_picture_test(p, &test->box), 0};
    }
}

static uint32_t candidates_make(sitting *t, const made_view *v)
{
    const made_scene *s = t->stand->scene;
    cull_run *runs = t->lent_candidates.memory;
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->zone.item_count; ++i) {
        int touches = 0;
        for (uint32_t k = 0; k < v->volume_count && !touches; ++k) touches = cull_volume_touches(&v->volumes[k], s->boxes[i]);
        if (!touches) continue;
        if (count && runs[count - 1].first + runs[count - 1].count == i) runs[count - 1].count++;
        else runs[count++] = (cull_run){i, 1};
    }
    return count;
}

// The volumes in memory that ends with them.
static const cull_volume *volumes_lend(sitting *t, const made_view *v)
{
    cull_plane *plane = t->lent_planes.memory;
    cull_volume *volumes = t->lent_volumes.memory;
    volumes += VIEW_VOLUMES_MOST - v->volume_count;
    plane += VIEW_VOLUMES_MOST * CULL_MAX_PLANES;
    for (uint32_t i = 0; i < v->volume_count; ++i) {
        plane -= v->volumes[i].plane_count;
        if (v->volumes[i].plane_count) memcpy(plane, v->volumes[i].planes, v->volumes[i].plane_count * sizeof *plane);
        volumes[i] = (cull_volume){v->volumes[i].plane_count ? plane : NULL, v->volumes[i].plane_count, v->volumes[i].entry};
    }
    return volumes;
}

static void cross_portals(sitting *t, const sitting_frame *f, const cull_view *view, sitting_answer *a)
{
    const cull_zone *z = &t->stand->scene->zone;
    const cull_volume *volumes = volumes_lend(t, f->view);
    for (uint32_t i = 0; i < z->portal_count && f->view->volume_count; ++i) {
        fence planes = fence_open(CULL_MAX_PLANES * sizeof(cull_plane), 8, 0, "memory behind the planes of cross, over CULL_MAX_PLANES");
        uint32_t count = 0;
        if (!planes.memory) return;
        if (f->hooks) f->hooks->before(f->hooks->user);
        const cull_crossing c = t->stand->plugin->cross(t->query, view, &volumes[0], i, planes.memory, &count);
        if (f->hooks) f->hooks->after(f->hooks->user);
        if (c < CULL_CROSS_NONE || c > CULL_CROSS_SAME) fault(a, "cross returned no crossing");
        if (c == CULL_CROSS_NARROW && count > CULL_MAX_PLANES) fault(a, "cross wrote more than CULL_MAX_PLANES planes"), count = CULL_MAX_PLANES;
        a->crossings[i] = c;
        a->plane_counts[i] = c == CULL_CROSS_NARROW ? count : 0;
        memcpy(a->planes + i * CULL_MAX_PLANES, planes.memory, a->plane_counts[i] * sizeof *a->planes);
        fence_close(&planes);
    }
}

static void frame_begins(sitting *t)
{
    uint8_t *slots = t->slots.memory;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < t->answer_count; ++i) {
        cull_answer answer = t->answers[i];
        answer.age++;
        if (answer.age < 3 && is_lucky(t, 2)) t->answers[kept++] = answer;
    }
    t->answer_count = kept;
    for (uint32_t i = 0; t->world == WORLD_CARELESS && i < t->stand->built.slot_count; ++i)
        if (is_lucky(t, 7)) slots[i] = 0;
    memset(t->scratch.memory, (int)(t->frame * 37 + 0x5a) & 0xff, t->scratch.size); // of undefined content
}

static cull_progress one_step(sitting *t, const sitting_frame *f, const cull_visit *visit, cull_batch *batch)
{
    const cull_plugin *p = t->stand->plugin;
    if (f->hooks) f->hooks->before(f->hooks->user);
    const cull_progress progress = t->stand->role == ROLE_SELECT ? p->select(t->query, visit, batch) : p->filter(t->query, visit, batch);
    if (f->hooks) f->hooks->after(f->hooks->user);
    return progress;
}

static void runs_keep(const sitting *t, const cull_batch *b, sitting_answer *a)
{
    const uint32_t most = a->item_count + t->stand->scene->zone.mover_capacity;
    a->run_count = b->run_count < most ? b->run_count : most;
    if (a->run_count) memcpy(a->runs, b->runs, a->run_count * sizeof *a->runs);
}

void sitting_step(sitting *t, const sitting_frame *f, sitting_answer *a)
{
    const cull_built *built = &t->stand->built;
    cull_view view = f->view->view;
    sample_picture p = {0};
    view.frame = t->frame++;
    view.flags = f->flags;
    a->order_count = a->run_count = a->steps = 0;
    a->fault[0] = 0;
    memset(a->drawn, 0, (size_t)a->item_count + t->stand->scene->zone.mover_capacity);
    if (t->stand->role == ROLE_CROSS) {
        cross_portals(t, f, &view, a);
        return;
    }
    frame_begins(t);
    cull_visit visit = {.view = &view, .volumes = volumes_lend(t, f->view), .volume_count = f->view->volume_count, .movers = f->movers,
                        .mover_count = built->takes_movers ? f->mover_count : 0, .slots = t->slots.memory, .scratch = t->scratch.memory, .may_step = 1};
    if (t->stand->role == ROLE_FILTER && !built->walks_hierarchy) {
        visit.candidate_count = candidates_make(t, f->view);
        visit.candidates = t->lent_candidates.memory;
    }
    cull_batch batch = batch_make(t), before = batch;
    const cull_batch lent = batch;
    if (built->max_tests) sample_picture_open(&p, t->stand->scene, f->view, t->stand->backs);
    cull_progress progress = CULL_MORE;
    while (progress != CULL_DONE) {
        if (a->steps >= built->max_steps || a->steps >= STEPS_MOST) {
            if (a->steps >= built->max_steps) fault(a, "it took more steps than max_steps");
            break;
        }
        visit.step = a->steps++;
        visit.answers = t->answers;
        visit.answer_count = t->answer_count;
        batch.test_count = batch.capture_count = 0;
        progress = one_step(t, f, &visit, &batch);
        t->answer_count = 0;
        if (progress < CULL_DONE || progress > CULL_WAIT) fault(a, "it returned no progress"), progress = CULL_DONE;
        if (lists_fault(&batch, &lent)) fault(a, lists_fault(&batch, &lent));
        batch.runs = lent.runs, batch.pictures = lent.pictures, batch.tests = lent.tests, batch.captures = lent.captures, batch.clipped = lent.clipped;
        counts_judge(t, &batch, &before, a);
        const uint32_t drawn_before = a->order_count;
        draw_runs(t, batch.runs + before.run_count, batch.run_count - before.run_count, a);
        pictures_take(t, &batch, &before, a);
        for (uint32_t i = drawn_before; built->max_tests && i < a->order_count; ++i) sample_picture_draw(&p, a->order[i]);
        answers_take(t, &batch, progress, &p, a);
        before = batch;
    }
    runs_keep(t, &batch, a);
    sample_picture_close(&p);
}
