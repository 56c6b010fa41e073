// Frames: one zone's chain run for one view, step by step, with everything that a culler writes checked before use.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "viewer.h"

#include <portcullis/plane.h>

#include <string.h>
#include <time.h>

// One frame in the making.
typedef struct frame {
    viewer *v;
    const frame_input *q;
    frame_stats *stats;
    cull_view view;
    view_volume planes;
    cull_volume volume;
    cull_visit visit;
    struct timespec since; // cullers' time runs from here
    uint32_t mover_count;
    uint32_t has_stepped; // the set is the host's copy: the frame took more than one step
} frame;

static void time_start(frame *f)
{
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &f->since);
}

static void time_stop(frame *f)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    const double ns = (double)(now.tv_sec - f->since.tv_sec) * 1e9 + (double)(now.tv_nsec - f->since.tv_nsec) - f->v->clock_overhead_ns;
    if (ns > 0) f->stats->cull_ns += ns;
}

// ---- Movers: the host's ----

static void find_movers(frame *f)
{
    const scene *s = f->v->chain->scene;
    cull_mover *movers = f->v->movers.items;
    for (uint32_t i = s->item_count; i < s->item_count + s->mover_count; ++i) {
        const cull_box box = cull_box_at(&s->boxes, i);
        if (cull_volume_touches(&f->volume, box)) movers[f->mover_count++] = (cull_mover){box, i, 0};
    }
    f->stats->movers_tested = s->mover_count;
}

// Movers that no culler decides about, as runs.
static uint32_t draw_movers(frame *f)
{
    const cull_mover *movers = f->v->movers.items;
    cull_run *runs = f->v->mover_runs.items;
    uint32_t count = 0;
    for (uint32_t i = 0; i < f->mover_count; ++i) {
        if (count && runs[count - 1].first + runs[count - 1].count == movers[i].id) runs[count - 1].count++;
        else runs[count++] = (cull_run){movers[i].id, 1};
    }
    return count;
}

// ---- Carrying out batches ----

// The list is full and there are more: those of earlier frames go, then the oldest. Answers come oldest first, so the
// newest max_tests of them hold all of the step that waits.
static uint32_t make_room(cull_answer *answers, uint32_t count, uint32_t keep_most)
{
    uint32_t facts = 0;
    for (uint32_t i = 0; i < count; ++i)
        if (answers[i].age == 0) answers[facts++] = answers[i];
    if (facts <= keep_most) return facts;
    memmove(answers, answers + (facts - keep_most), keep_most * sizeof *answers);
    return keep_most;
}

static void collect_answers(frame *f, collect_how how)
{
    const frame_driver *d = &f->q->driver;
    const uint32_t capacity = f->v->answer_capacity, room = how == COLLECT_EVERYTHING ? capacity : capacity - 1;
    cull_answer *answers = f->v->answers.items;
    uint32_t stalled = 0, count = 0;
    f->visit.answer_count = 0;
    if (!d->collect || !capacity) return;
    time_stop(f);
    for (;;) {
        const uint32_t got = d->collect(d->user, how, f->q->frame.frame, answers + count, room - count, &stalled);
        count += got < room - count ? got : room - count;
        if (how != COLLECT_EVERYTHING || count < room) break;
        count = make_room(answers, count, capacity / 2);
    }
    time_start(f);
    f->visit.answer_count = count;
    f->visit.answers = answers;
    f->stats->stalls += stalled != 0;
}

static void carry_out(frame *f, const cull_batch *b, uint32_t earlier_runs, uint32_t earlier_pictures)
{
    const frame_driver *d = &f->q->driver;
    time_stop(f);
    if (d->draw && b->run_count > earlier_runs) d->draw(d->user, b->runs + earlier_runs, b->run_count - earlier_runs);
    if (d->capture && b->capture_count) {
        d->capture(d->user, b->captures, b->capture_count);
        for (uint32_t i = 0; i < b->capture_count; ++i) f->v->slots[b->captures[i].slot] = 1;
    }
    if (d->show && b->picture_count > earlier_pictures) d->show(d->user, b->pictures + earlier_pictures, b->picture_count - earlier_pictures);
    if (d->test && b->test_count) d->test(d->user, b->tests, b->test_count, f->q->frame.frame);
    f->stats->captures += b->capture_count;
    f->stats->pictures += b->picture_count - earlier_pictures;
    f->stats->queries += b->test_count;
    time_start(f);
}

static void tell_fault(frame *f, uint32_t stage, const char *what)
{
    f->stats->faults++;
    if (f->v->told_fault) return;
    f->v->told_fault = 1;
    report_error(f->v->log, NULL, 0, "culler '%s' misbehaves: %s (frame %u); its zone is drawn whole where it does",
                   f->v->chain->stages[stage].plugin->descriptor->id, what, f->q->frame.frame);
}

// ---- Stages ----

static cull_progress call(frame *f, uint32_t stage, cull_batch *b)
{
    const chain_stage *s = &f->v->chain->stages[stage];
    f->stats->steps++;
    return s->role == ROLE_SELECT ? s->plugin->select(f->v->stages[stage].query, &f->visit, b)
                                  : s->plugin->filter(f->v->stages[stage].query, &f->visit, b);
}

static void take_counts(frame *f, const cull_batch *b)
{
    f->stats->nodes_visited += b->nodes_visited;
    f->stats->limits_hit += b->limits_hit;
}

static cull_batch batch_of_filter(frame *f, uint32_t stage)
{
    viewer *v = f->v;
    if (f->visit.capture_count) memset(v->keep_captures.items, 1, f->visit.capture_count);
    if (f->visit.picture_count) memset(v->keep_pictures.items, 1, f->visit.picture_count);
    return (cull_batch){.runs = v->stages[stage].runs.items, .keep_captures = v->keep_captures.items, .keep_pictures = v->keep_pictures.items};
}

// What a kept picture shows, and what a kept capture is composed of, is kept too: dropping it would leave a hole, or show
// what the slot held before.
static void keep_what_is_needed(frame *f, uint8_t *keep_capture, const uint8_t *keep_picture)
{
    uint8_t *needed = f->v->slot_marks.items;
    memset(needed, 0, f->v->slot_count);
    for (uint32_t i = 0; i < f->visit.picture_count; ++i)
        if (keep_picture[i]) needed[f->visit.pictures[i].slot] = 1;
    for (uint32_t i = f->visit.capture_count; i-- > 0;) {
        const cull_capture *c = &f->visit.captures[i];
        if (!keep_capture[i] && !needed[c->slot]) continue;
        keep_capture[i] = 1;
        for (uint32_t k = 0; k < c->slot_count; ++k) needed[c->slots[k]] = 1;
    }
}

// After a filter: of the select's captures and pictures only those that it kept.
static void drop_unkept(frame *f)
{
    viewer *v = f->v;
    cull_capture *captures = v->select_captures.items;
    cull_picture *pictures = v->select_pictures.items;
    uint8_t *keep_capture = v->keep_captures.items, *keep_picture = v->keep_pictures.items;
    uint32_t kept_captures = 0, kept_pictures = 0;
    if (!f->visit.capture_count && !f->visit.picture_count) return;
    keep_what_is_needed(f, keep_capture, keep_picture);
    for (uint32_t i = 0; i < f->visit.capture_count; ++i)
        if (keep_capture[i]) captures[kept_captures++] = captures[i];
    for (uint32_t i = 0; i < f->visit.picture_count; ++i)
        if (keep_picture[i]) pictures[kept_pictures++] = pictures[i];
    f->visit.capture_count = kept_captures;
    f->visit.picture_count = kept_pictures;
}

// A stage before the last: one call, its runs become the next one's candidates. 0 on nonsense.
static int run_early_stage(frame *f, uint32_t stage)
{
    viewer *v = f->v;
    cull_batch b = batch_of_filter(f, stage);
    b.tests = v->early_tests.items;
    b.captures = stage == 0 ? v->select_captures.items : v->early_captures.items;
    b.pictures = stage == 0 ? v->select_pictures.items : v->early_pictures.items;
    batch_check check = {.stage = stage, .lent = b};
    const cull_progress progress = call(f, stage, &b);
    const char *fault = progress != CULL_DONE ? "it steps, but is not the last select or filter of its chain" : batch_fault(v, &b, &check);
    if (!fault && b.test_count) fault = "it asks for tests, but is not the last select or filter of its chain";
    if (!fault && stage > 0 && (b.capture_count || b.picture_count)) fault = "it gives pictures, but is neither first nor last of its chain";
    if (fault) {
        tell_fault(f, stage, fault);
        return 0;
    }
    if (stage > 0) drop_unkept(f);
    take_counts(f, &b);
    f->visit.candidates = b.runs;
    f->visit.candidate_count = b.run_count;
    if (stage > 0) return 1;
    f->visit.captures = b.captures;
    f->visit.pictures = b.pictures;
    f->visit.capture_count = b.capture_count;
    f->visit.picture_count = b.picture_count;
    return 1;
}

// A select's captures and pictures that the filter kept are carried out once, with the filter's last step.
static void carry_out_kept(frame *f)
{
    const cull_batch kept = {.captures = f->v->select_captures.items, .pictures = f->v->select_pictures.items,
                             .capture_count = f->visit.capture_count, .picture_count = f->visit.picture_count};
    if (kept.capture_count || kept.picture_count) carry_out(f, &kept, 0, 0);
}

static const char *step_fault(frame *f, const cull_batch *b, cull_progress progress, batch_check *check)
{
    const char *fault = batch_fault(f->v, b, check);
    if (fault || progress == CULL_DONE) return fault;
    if (progress != CULL_MORE && progress != CULL_WAIT) return "it returned neither DONE, MORE nor WAIT";
    return f->visit.step + 1 >= f->v->chain->stages[check->stage].built.max_steps ? "it wants more steps than it told" : NULL;
}

// What is drawn cannot be taken back: later steps may write over the batch, not over this.
static void remember_drawn(frame *f, const cull_batch *b, uint32_t earlier_runs)
{
    cull_run *drawn = f->v->drawn.items;
    f->has_stepped = 1;
    memcpy(drawn + earlier_runs, b->runs + earlier_runs, (b->run_count - earlier_runs) * sizeof *drawn);
}

// The stage that may step. Returns its runs, or UINT32_MAX on nonsense.
static uint32_t run_last_stage(frame *f)
{
    viewer *v = f->v;
    const uint32_t stage = v->last;
    cull_batch b = batch_of_filter(f, stage);
    b.pictures = v->pictures.items;
    b.tests = v->tests.items;
    b.captures = v->captures.items;
    batch_check check = {.stage = stage, .lent = b};
    collect_answers(f, COLLECT_WHAT_IS_READY);
    for (uint32_t step = 0;; ++step) {
        const uint32_t earlier_runs = check.runs, earlier_pictures = check.pictures;
        b.test_count = b.capture_count = 0;
        f->visit.step = step;
        const cull_progress progress = call(f, stage, &b);
        const char *fault = step_fault(f, &b, progress, &check);
        if (fault) {
            tell_fault(f, stage, fault);
            return UINT32_MAX;
        }
        if (step > 0 || progress != CULL_DONE) remember_drawn(f, &b, earlier_runs);
        if (b.run_count > earlier_runs || b.test_count || b.capture_count || b.picture_count > earlier_pictures)
            if (f->q->driver.draw || b.test_count || b.capture_count || b.picture_count) carry_out(f, &b, earlier_runs, earlier_pictures);
        if (progress == CULL_DONE) break;
        collect_answers(f, progress == CULL_WAIT ? COLLECT_EVERYTHING : COLLECT_WHAT_IS_READY);
    }
    if (stage > 0) drop_unkept(f);
    take_counts(f, &b);
    if (stage > 0) carry_out_kept(f);
    return b.run_count;
}

static void draw_whole(frame *f, visible_set *out)
{
    const scene *s = f->v->chain->scene;
    cull_run *movers = f->v->mover_runs.items;
    *out = (visible_set){.runs = &f->v->whole, .run_count = f->v->whole.count ? 1 : 0, .mover_runs = movers};
    if (s->mover_count) {
        movers[0] = (cull_run){s->item_count, s->mover_count};
        out->mover_run_count = 1;
    }
}

// The last stage's runs, where it takes movers split into items and movers by their ids.
static void finish_set(frame *f, uint32_t run_count, visible_set *out)
{
    viewer *v = f->v;
    const uint32_t items = v->chain->zone.item_count;
    cull_run *runs = f->has_stepped ? v->drawn.items : v->stages[v->last].runs.items;
    *out = (visible_set){.runs = runs, .run_count = run_count, .mover_runs = v->mover_runs.items};
    if (!v->chain->stages[v->last].built.takes_movers) {
        out->mover_run_count = draw_movers(f);
        return;
    }
    cull_run *mover_runs = v->mover_runs.items;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < run_count; ++i) {
        if (runs[i].first < items) runs[kept++] = runs[i];
        else mover_runs[out->mover_run_count++] = runs[i];
    }
    out->run_count = kept;
}

static void begin(frame *f)
{
    const chain *c = f->v->chain;
    view_derive(f->q->camera, &f->q->frame, c->scene->whole.origin, &c->scene->whole.box, &f->view, &f->planes);
    f->volume = (cull_volume){f->planes.planes, f->planes.plane_count, 0};
    f->visit = (cull_visit){.view = &f->view, .volumes = &f->volume, .volume_count = 1, .slots = f->v->slots, .scratch = f->v->scratch};
    if (c->zone.mover_capacity) find_movers(f);
    if (c->stages[f->v->last].built.takes_movers) {
        f->visit.movers = f->v->movers.items;
        f->visit.mover_count = f->mover_count;
    }
}

// A filter that walks the hierarchy takes no candidates; a select before it runs for its pictures alone. 0 on nonsense.
static int run_early_stages(frame *f)
{
    const viewer *v = f->v;
    const cull_built *select = &v->chain->stages[0].built;
    if (v->first > 0 && (select->max_pictures || select->max_captures)) {
        if (!run_early_stage(f, 0)) return 0;
        f->visit.candidates = NULL;
        f->visit.candidate_count = 0;
    }
    for (uint32_t i = v->first; i < v->last; ++i)
        if (v->chain->stages[i].role != ROLE_CROSS && !run_early_stage(f, i)) return 0;
    return 1;
}

void frame_run(viewer *v, const frame_input *q, visible_set *out_set, frame_stats *out_stats)
{
    frame f = {.v = v, .q = q, .stats = out_stats};
    visible_set set;
    *out_stats = (frame_stats){0};
    time_start(&f);
    begin(&f);
    const uint32_t run_count = run_early_stages(&f) ? run_last_stage(&f) : UINT32_MAX;
    if (run_count == UINT32_MAX) draw_whole(&f, &set);
    else finish_set(&f, run_count, &set);
    time_stop(&f);
    const frame_driver *d = &q->driver;
    if (d->draw && run_count == UINT32_MAX) d->draw(d->user, set.runs, set.run_count);
    if (d->draw && set.mover_run_count && (run_count == UINT32_MAX || !v->chain->stages[v->last].built.takes_movers)) d->draw(d->user, set.mover_runs, set.mover_run_count);
    for (uint32_t i = 0; i < set.run_count; ++i) out_stats->items_drawn += set.runs[i].count;
    for (uint32_t i = 0; i < set.mover_run_count; ++i) out_stats->movers_drawn += set.mover_runs[i].count;
    if (out_set) *out_set = set;
}
