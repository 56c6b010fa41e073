// One zone's chain run for one view, step by step, with everything that a culler writes checked before use.
// SPDX-License-Identifier: MIT
#include "viewer.h"

#include <string.h>

// ---- What is drawn ----

// There is room for all pieces of runs that give each item once: who needs more repeats himself.
static void append_run(viewer *v, uint32_t first, uint32_t end)
{
    cull_run *drawn = v->drawn.items;
    if (end <= first) return;
    if (v->out_count < v->drawn.size / sizeof *drawn) drawn[v->out_count++] = (cull_run){first, end - first};
    else v->is_crowded = 1;
}

// The zone's shared items, passed in the order of its runs: most cullers give them ascending, and then the next is near.
// at: the first at `place` or behind it, which stands at `next`.
typedef struct shared_cursor { uint32_t at, place, next; } shared_cursor;

static void shared_seek(const viewer *v, uint32_t place, shared_cursor *c)
{
    enum { NEAR = 8 };
    uint32_t low = place < c->place ? 0 : c->at, high = v->chain->data->shared_count;
    const uint32_t near = high - low < NEAR ? high : low + NEAR;
    c->place = place;
    while (low < near && v->shared[low].place < place) ++low;
    if (low < near) high = low;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (v->shared[middle].place < place) low = middle + 1;
        else high = middle;
    }
    c->at = low;
    c->next = low < v->chain->data->shared_count ? v->shared[low].place : UINT32_MAX;
}

// Without the items that another zone has drawn already; those left become this zone's. Marked when visible, not when
// looked at: else a zone that only tested an item would take it from the one that sees it.
static void append_cut(viewer *v, const viewer_frame *f, cull_run run, shared_cursor *c)
{
    const uint32_t shared_count = v->chain->data->shared_count, zone = v->chain->data->index, end = run.first + run.count;
    uint32_t first = run.first;
    if (first >= c->place && end <= c->next) {
        append_run(v, first, end);
        return;
    }
    shared_seek(v, first, c);
    for (uint32_t i = c->at; i < shared_count && v->shared[i].place < end; ++i) {
        shared_stamp *stamp = &f->stamps[v->shared[i].number];
        if (stamp->serial == f->serial && stamp->zone != zone) {
            append_run(v, first, v->shared[i].place);
            first = v->shared[i].place + 1;
        }
        else *stamp = (shared_stamp){f->serial, zone};
    }
    append_run(v, first, end);
}

static void mark_slots(viewer *v, const viewer_frame *f, cull_run slots)
{
    const uint32_t *numbers = v->slot_movers.items;
    for (uint32_t i = slots.first; i < slots.first + slots.count; ++i) {
        const uint32_t slot = i - v->chain->zone.item_count;
        mover_mark(f->movers, v->slot_movers.size ? numbers[slot] : slot);
    }
}

// The runs of this step. What is drawn cannot be taken back: later steps may write over the batch, not over the host's copy.
static void take_runs(viewer *v, const viewer_frame *f, uint32_t earlier_runs)
{
    const uint32_t items = v->chain->zone.item_count;
    const cull_run *runs = v->batch.runs;
    const int is_plain = !v->chain->data->shared_count && !viewer_takes_movers(v);
    v->fresh = v->out_count;
    if (is_plain && v->visit.step == 0 && v->progress == CULL_DONE) {
        v->out = runs;
        v->out_count = v->batch.run_count;
        return;
    }
    shared_cursor at = {0, 0, 0};
    v->out = v->drawn.items;
    for (uint32_t i = earlier_runs; i < v->batch.run_count; ++i) {
        if (runs[i].first >= items) mark_slots(v, f, runs[i]);
        else if (is_plain) append_run(v, runs[i].first, runs[i].first + runs[i].count);
        else append_cut(v, f, runs[i], &at);
    }
}

static void draw_whole(viewer *v, const viewer_frame *f)
{
    v->fresh = v->out_count = 0;
    v->fresh_pictures = v->batch.picture_count = v->batch.test_count = v->batch.capture_count = 0;
    v->fresh_clipped = v->batch.clipped_count = 0;
    v->visit.picture_count = v->visit.capture_count = v->visit.clipped_count = 0;
    if (!v->chain->data->shared_count) {
        v->out = &v->whole;
        v->out_count = v->whole.count ? 1 : 0;
        return;
    }
    v->out = v->drawn.items;
    append_cut(v, f, v->whole, &(shared_cursor){0, 0, 0});
}

static void tell_fault(viewer *v, const viewer_frame *f, uint32_t stage, const char *what)
{
    const zone_data *data = v->chain->data;
    f->stats->faults++;
    v->state = VIEWER_FAULTY;
    draw_whole(v, f);
    if (v->told_fault) return;
    v->told_fault = 1;
    report_error(v->log, NULL, 0, "culler '%s' misbehaves: %s (zone '%s', frame %u); its zone is drawn whole where it does",
                 v->chain->stages[stage].plugin->descriptor->id, what, data->scene->zones[data->index].name, f->input->frame.frame);
}

// ---- Stages ----

static cull_progress call(viewer *v, const viewer_frame *f, uint32_t stage, cull_batch *b)
{
    const chain_stage *s = &v->chain->stages[stage];
    f->stats->steps++;
    v->visit.may_step = stage == v->last;
    return s->role == ROLE_SELECT ? s->plugin->select(v->stages[stage].query, &v->visit, b)
                                  : s->plugin->filter(v->stages[stage].query, &v->visit, b);
}

static void take_counts(const viewer_frame *f, const cull_batch *b)
{
    f->stats->nodes_visited += b->nodes_visited;
    f->stats->limits_hit += b->limits_hit;
}

static cull_batch batch_of_filter(viewer *v, uint32_t stage)
{
    if (v->visit.capture_count) memset(v->keep_captures.items, 1, v->visit.capture_count);
    if (v->visit.picture_count) memset(v->keep_pictures.items, 1, v->visit.picture_count);
    if (v->visit.clipped_count) memset(v->keep_clipped.items, 1, v->visit.clipped_count);
    return (cull_batch){.runs = v->stages[stage].runs.items, .keep_captures = v->keep_captures.items, .keep_pictures = v->keep_pictures.items,
                        .keep_clipped = v->keep_clipped.items};
}

// What a kept picture shows, and what a kept capture is composed of, is kept too: dropping it would leave a hole, or show
// what the slot held before.
static void keep_what_is_needed(viewer *v, uint8_t *keep_capture, const uint8_t *keep_picture)
{
    uint8_t *needed = v->room->slot_marks.items;
    memset(needed, 0, v->slot_count);
    for (uint32_t i = 0; i < v->visit.picture_count; ++i)
        if (keep_picture[i]) needed[v->visit.pictures[i].slot] = 1;
    for (uint32_t i = v->visit.capture_count; i-- > 0;) {
        const cull_capture *c = &v->visit.captures[i];
        if (!keep_capture[i] && !needed[c->slot]) continue;
        keep_capture[i] = 1;
        for (uint32_t k = 0; k < c->slot_count; ++k) needed[c->slots[k]] = 1;
    }
}

static void drop_unkept_clipped(viewer *v)
{
    cull_clipped *clipped = v->select_clipped.items;
    const uint8_t *keep = v->keep_clipped.items;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < v->visit.clipped_count; ++i)
        if (keep[i]) clipped[kept++] = clipped[i];
    v->visit.clipped_count = kept;
}

// After a filter: of the select's captures, pictures and clipped items only those that it kept.
static void drop_unkept(viewer *v)
{
    drop_unkept_clipped(v);
    cull_capture *captures = v->select_captures.items;
    cull_picture *pictures = v->select_pictures.items;
    uint8_t *keep_capture = v->keep_captures.items, *keep_picture = v->keep_pictures.items;
    uint32_t kept_captures = 0, kept_pictures = 0;
    if (!v->visit.capture_count && !v->visit.picture_count) return;
    keep_what_is_needed(v, keep_capture, keep_picture);
    for (uint32_t i = 0; i < v->visit.capture_count; ++i)
        if (keep_capture[i]) captures[kept_captures++] = captures[i];
        else v->slots[captures[i].slot] = 0; // the culler takes it for the new picture: what it holds is another
    for (uint32_t i = 0; i < v->visit.picture_count; ++i)
        if (keep_picture[i]) pictures[kept_pictures++] = pictures[i];
    v->visit.capture_count = kept_captures;
    v->visit.picture_count = kept_pictures;
}

static const char *early_fault(viewer *v, uint32_t stage, const cull_batch *b, batch_check *check, cull_progress progress)
{
    if (progress != CULL_DONE) return "it steps, but is not the last select or filter of its chain";
    const char *fault = batch_fault(v, b, check);
    if (!fault && b->test_count) fault = "it asks for tests, but is not the last select or filter of its chain";
    if (!fault && stage > 0 && (b->capture_count || b->picture_count)) fault = "it gives pictures, but is neither first nor last of its chain";
    if (!fault && stage > 0 && b->clipped_count) fault = "it clips items, but is neither first nor last of its chain";
    return fault;
}

// A stage before the last: one call, its runs become the next one's candidates. 0 on nonsense.
static int run_early_stage(viewer *v, const viewer_frame *f, uint32_t stage)
{
    const cull_built *built = &v->chain->stages[stage].built;
    cull_batch b = batch_of_filter(v, stage);
    b.tests = list_tail(&v->room->early_tests, built->max_tests * sizeof(cull_test));
    b.captures = stage == 0 ? v->select_captures.items : list_tail(&v->room->early_captures, built->max_captures * sizeof(cull_capture));
    b.pictures = stage == 0 ? v->select_pictures.items : list_tail(&v->room->early_pictures, built->max_pictures * sizeof(cull_picture));
    b.clipped = stage == 0 ? v->select_clipped.items : list_tail(&v->room->early_clipped, built->max_clipped * sizeof(cull_clipped));
    batch_check check = {.stage = stage, .lent = b};
    const cull_progress progress = call(v, f, stage, &b);
    const char *fault = early_fault(v, stage, &b, &check, progress);
    if (fault) {
        tell_fault(v, f, stage, fault);
        return 0;
    }
    if (stage > 0) drop_unkept(v);
    take_counts(f, &b);
    v->visit.candidates = b.runs;
    v->visit.candidate_count = v->stages[stage].run_count = b.run_count;
    if (stage > 0) return 1;
    v->visit.captures = b.captures;
    v->visit.pictures = b.pictures;
    v->visit.clipped = b.clipped;
    v->visit.clipped_count = b.clipped_count;
    v->visit.capture_count = b.capture_count;
    v->visit.picture_count = b.picture_count;
    return 1;
}

// A filter that walks the hierarchy takes no candidates; a select before it runs for its pictures alone. 0 on nonsense.
static int run_early_stages(viewer *v, const viewer_frame *f)
{
    const cull_built *select = &v->chain->stages[0].built;
    if (v->first > 0 && (select->max_pictures || select->max_captures || select->max_clipped)) {
        if (!run_early_stage(v, f, 0)) return 0;
        v->visit.candidates = NULL;
        v->visit.candidate_count = 0;
    }
    for (uint32_t i = v->first; i < v->last; ++i)
        if (v->chain->stages[i].role != ROLE_CROSS && !run_early_stage(v, f, i)) return 0;
    return 1;
}

static const char *step_fault(viewer *v)
{
    const char *fault = batch_fault(v, &v->batch, &v->check);
    if (fault || v->progress == CULL_DONE) return fault;
    if (v->progress != CULL_MORE && v->progress != CULL_WAIT) return "it returned neither DONE, MORE nor WAIT";
    return v->visit.step + 1 >= v->chain->stages[v->last].built.max_steps ? "it wants more steps than it told" : NULL;
}

static void count_batch(const viewer *v, const viewer_frame *f)
{
    f->stats->captures += v->batch.capture_count;
    f->stats->pictures += v->batch.picture_count - v->fresh_pictures;
    f->stats->clipped += v->batch.clipped_count - v->fresh_clipped;
    f->stats->queries += v->batch.test_count;
}

// Who gives pictures or clips leaves the items out of its runs; where nobody shows or clips them, they have to be drawn.
static int lacks_a_shower(const viewer *v, const frame_driver *d)
{
    return (!(d->capture && d->show) && (v->batch.picture_count || v->visit.picture_count)) ||
           (!d->draw_clipped && (v->batch.clipped_count || v->visit.clipped_count));
}

static void end_zone(viewer *v, const viewer_frame *f)
{
    v->state = VIEWER_DONE;
    take_counts(f, &v->batch);
    if (v->last > 0) drop_unkept(v);
    if (lacks_a_shower(v, &f->input->driver)) {
        f->stats->limits_hit++;
        draw_whole(v, f);
    }
    f->stats->captures += v->visit.capture_count; // of a select, kept by the filter: carried out with its last step
    f->stats->pictures += v->visit.picture_count;
    f->stats->clipped += v->visit.clipped_count;
}

// The stage that may step.
static void run_last_stage(viewer *v, const viewer_frame *f)
{
    const uint32_t earlier_runs = v->check.runs;
    v->fresh_pictures = v->check.pictures;
    v->fresh_clipped = v->check.clipped;
    v->batch.test_count = v->batch.capture_count = 0;
    v->progress = call(v, f, v->last, &v->batch);
    const char *fault = step_fault(v);
    if (fault) {
        tell_fault(v, f, v->last, fault);
        return;
    }
    take_runs(v, f, earlier_runs);
    if (v->is_crowded) {
        tell_fault(v, f, v->last, "an item given twice");
        return;
    }
    v->state = VIEWER_STEPS;
    if (v->progress == CULL_DONE) end_zone(v, f);
    count_batch(v, f);
}

// ---- Slots ----

// The driver may have given memory of one up, or have had none for it.
static void check_slots(viewer *v, const viewer_frame *f)
{
    const frame_driver *d = &f->input->driver;
    if (v->slot_count && d->check_slots) d->check_slots(d->user, v->chain->data->index, v->slots, v->slot_count);
}

static int touch(const cull_box *a, const cull_box *b)
{
    return a->min.x <= b->max.x && b->min.x <= a->max.x && a->min.y <= b->max.y && b->min.y <= a->max.y && a->min.z <= b->max.z && b->min.z <= a->max.z;
}

void viewer_empty_slots(viewer *v, const cull_box *box)
{
    for (uint32_t i = 0; i < v->slot_count; ++i) v->slots[i] &= (uint8_t)!touch(&v->slot_boxes[i], box);
}

void viewer_begin(viewer *v, const viewer_frame *f, const viewer_visit *seen)
{
    if (!v->serial) v->first_frame = f->input->frame.frame;
    v->serial = f->serial;
    v->state = VIEWER_STARTS;
    v->visit = (cull_visit){.view = seen->view, .volumes = seen->volumes, .volume_count = seen->volume_count,
                            .slots = v->slots, .scratch = v->room->scratch};
    v->progress = CULL_MORE;
    v->out_count = v->fresh = v->fresh_pictures = v->fresh_clipped = v->is_crowded = 0;
    for (uint32_t i = 0; i < v->last; ++i) v->stages[i].run_count = 0;
    check_slots(v, f);
}

static void start_last_stage(viewer *v)
{
    v->batch = batch_of_filter(v, v->last);
    v->batch.pictures = v->pictures.items;
    v->batch.tests = v->tests.items;
    v->batch.captures = v->captures.items;
    v->batch.clipped = v->clipped.items;
    v->check = (batch_check){.stage = v->last, .lent = v->batch};
}

void viewer_step(viewer *v, const viewer_frame *f)
{
    if (v->state == VIEWER_STARTS) {
        if (!run_early_stages(v, f)) return;
        start_last_stage(v);
        v->visit.step = 0;
    }
    else v->visit.step++;
    run_last_stage(v, f);
}

// ---- The driver's part ----

int viewer_has_work(const viewer *v, const frame_driver *d)
{
    const cull_batch *b = &v->batch;
    const int asks = b->capture_count || b->test_count || b->picture_count > v->fresh_pictures || b->clipped_count > v->fresh_clipped;
    const int keeps = v->last > 0 && v->state == VIEWER_DONE && (v->visit.capture_count || v->visit.picture_count || v->visit.clipped_count);
    return asks || keeps || (d->draw && v->out_count > v->fresh) || (v->state == VIEWER_STEPS && d->collect && v->answer_capacity);
}

static void capture(viewer *v, const viewer_frame *f, const cull_batch *b)
{
    const frame_driver *d = &f->input->driver;
    if (!d->capture || !b->capture_count) return;
    d->capture(d->user, v->chain->data->index, b->captures, b->capture_count);
    for (uint32_t i = 0; i < b->capture_count; ++i) {
        v->slots[b->captures[i].slot] = 1;
        v->slot_boxes[b->captures[i].slot] = b->captures[i].box;
    }
    check_slots(v, f);
}

// Of the batch, what earlier steps did not give.
static void clip_capture_and_show(viewer *v, const viewer_frame *f, const cull_batch *b, const batch_check *earlier)
{
    const frame_driver *d = &f->input->driver;
    const uint32_t zone = v->chain->data->index, clipped = b->clipped_count - earlier->clipped, pictures = b->picture_count - earlier->pictures;
    if (d->draw_clipped && clipped) d->draw_clipped(d->user, zone, b->clipped + earlier->clipped, clipped);
    capture(v, f, b);
    if (d->show && pictures) d->show(d->user, zone, b->pictures + earlier->pictures, pictures);
}

// A select's clipped items, captures and pictures that the filter kept are carried out once, with the filter's last step.
static void carry_out_kept(viewer *v, const viewer_frame *f)
{
    const cull_batch kept = {.captures = v->select_captures.items, .pictures = v->select_pictures.items, .clipped = v->select_clipped.items,
                             .capture_count = v->visit.capture_count, .picture_count = v->visit.picture_count,
                             .clipped_count = v->visit.clipped_count};
    clip_capture_and_show(v, f, &kept, &(batch_check){0});
}

void viewer_draw(viewer *v, const viewer_frame *f)
{
    const frame_driver *d = &f->input->driver;
    if (d->draw && v->out_count > v->fresh) d->draw(d->user, v->chain->data->index, v->out + v->fresh, v->out_count - v->fresh);
    clip_capture_and_show(v, f, &v->batch, &(batch_check){.pictures = v->fresh_pictures, .clipped = v->fresh_clipped});
    if (v->last > 0 && v->state == VIEWER_DONE) carry_out_kept(v, f);
}

void viewer_test(viewer *v, const viewer_frame *f)
{
    const frame_driver *d = &f->input->driver;
    if (d->test && v->batch.test_count) d->test(d->user, v->chain->data->index, v->batch.tests, v->batch.test_count, f->input->frame.frame);
}

// The list is full and there are more: those of earlier frames go, then the oldest. Answers come oldest first, so the
// newest max_tests of them hold all of the step that waits; what it asked in earlier steps of the frame may go unanswered: seen.
static uint32_t make_room(cull_answer *answers, uint32_t count, uint32_t keep_most)
{
    uint32_t facts = 0;
    for (uint32_t i = 0; i < count; ++i)
        if (answers[i].age == 0) answers[facts++] = answers[i];
    if (facts <= keep_most) return facts;
    memmove(answers, answers + (facts - keep_most), keep_most * sizeof *answers);
    return keep_most;
}

// The driver may still hold tests of the chain that was here before a swap: their tags mean nothing to this one.
static uint32_t drop_strangers(cull_answer *answers, uint32_t count, uint32_t got, uint32_t oldest)
{
    uint32_t kept = count;
    for (uint32_t i = count; i < count + got; ++i)
        if (answers[i].age <= oldest) answers[kept++] = answers[i];
    return kept;
}

void viewer_collect(viewer *v, const viewer_frame *f)
{
    const frame_driver *d = &f->input->driver;
    const collect_how how = v->progress == CULL_WAIT ? COLLECT_EVERYTHING : COLLECT_WHAT_IS_READY;
    const uint32_t frame = f->input->frame.frame, capacity = v->answer_capacity, room = how == COLLECT_EVERYTHING ? capacity : capacity - 1;
    cull_answer *answers = v->answers.items;
    uint32_t stalled = 0, count = 0;
    v->visit.answer_count = 0;
    if (!d->collect || !capacity) return;
    for (;;) {
        const uint32_t left = room - count, told = d->collect(d->user, v->chain->data->index, how, frame, answers + count, left, &stalled);
        count = drop_strangers(answers, count, told < left ? told : left, frame - v->first_frame);
        if (how != COLLECT_EVERYTHING || told < left) break;
        if (count == room) count = make_room(answers, count, capacity / 2);
    }
    v->visit.answer_count = count;
    v->visit.answers = answers;
    f->stats->stalls += stalled != 0;
}
