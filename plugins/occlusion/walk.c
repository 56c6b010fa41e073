// What the methods share: see walk.h.
// SPDX-License-Identifier: MIT
#include "walk.h"

#include "ledger.h"
#include "rest.h"

#include <string.h>

enum { CALM_SMALL = 2, CALM_MOST = 4, CALM_PIXELS = 1024 }; // an item is tested every 2^calm frames
enum { SAVED_LOOKED_AT = 64 };                             // items
enum { OPEN_LEAST = 2, OPEN_MOST = 3 };                    // a node seen is not tested again for about 2^OPEN_LEAST frames and more

// ---- A frame begins ----

static uint32_t place_of(const occlusion_walk *w, uint32_t id)
{
    return w->places ? w->places[id] : id;
}

static void mask_runs(occlusion_walk *w, const cull_run *runs, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t id = runs[i].first; id - runs[i].first < runs[i].count && id < w->tree->item_count; id++) {
            const uint32_t place = place_of(w, id);
            w->h->masked[place / 64] |= UINT64_C(1) << (place % 64);
        }
}

// A candidate's bit is cleared and the nodes above it are marked.
static void unmask_candidate(occlusion_walk *w, uint32_t place)
{
    occlusion_history *h = w->h;
    h->masked[place / 64] &= ~(UINT64_C(1) << (place % 64));
    for (uint32_t n = w->tree->item_nodes[place]; n != TREE_NONE && h->node_marks[n] != h->serial; n = w->tree->nodes[n].parent)
        h->node_marks[n] = h->serial;
}

static void mask_all_but_candidates(occlusion_walk *w)
{
    const cull_visit *visit = w->visit;
    memset(w->h->masked, 0xFF, ((size_t)w->tree->item_count / 64 + 1) * sizeof(uint64_t));
    for (uint32_t i = 0; i < visit->candidate_count; i++) {
        const cull_run run = visit->candidates[i];
        for (uint32_t id = run.first; id - run.first < run.count; id++) unmask_candidate(w, place_of(w, id));
    }
}

void walk_begin(occlusion_walk *w)
{
    occlusion_history *h = w->h;
    const cull_visit *visit = w->visit;
    if (h->drawn_count) history_turn(h); // of a frame that was broken off
    if (++h->serial == 0) { // after 2^32 frames: no stamp may look like one of this frame
        memset(h->drawn, 0, w->tree->item_count * sizeof *h->drawn);
        memset(h->node_marks, 0, w->tree->node_count * sizeof *h->node_marks);
        h->serial = 1;
    }
    h->counters.frames++;
    h->heap_count = h->pending_count = h->tested_count = h->is_over = 0;
    h->mask_used = w->takes_candidates || visit->picture_count || visit->clipped_count;
    if (w->takes_candidates) mask_all_but_candidates(w);
    else if (h->mask_used) memset(h->masked, 0, ((size_t)w->tree->item_count / 64 + 1) * sizeof(uint64_t));
    if (w->takes_candidates) return; // the culler before has left out what it shows otherwise
    for (uint32_t i = 0; i < visit->picture_count; i++) mask_runs(w, visit->pictures[i].runs, visit->pictures[i].run_count);
    for (uint32_t i = 0; i < visit->clipped_count; i++) mask_runs(w, visit->clipped[i].runs, visit->clipped[i].run_count);
}

// ---- Where boxes lie ----

walk_place walk_place_of(const occlusion_walk *w, const cull_box *box)
{
    const cull_visit *visit = w->visit;
    walk_place best = WALK_OUT;
    if (w->takes_candidates) return WALK_IN;
    for (uint32_t v = 0; v < visit->volume_count; v++) {
        const cull_volume *volume = &visit->volumes[v];
        int touches = 1, contains = 1;
        for (uint32_t k = 0; k < volume->plane_count && touches; k++) {
            touches = !(cull_plane_height(volume->planes[k], cull_box_corner(*box, volume->planes[k].normal)) < 0);
            contains = contains && cull_plane_contains(volume->planes[k], *box);
        }
        if (!touches) continue;
        if (contains) return WALK_IN;
        best = WALK_CUT;
    }
    return best;
}

// Half the work of walk_place_of, for what has no parts.
static int touches(const occlusion_walk *w, const cull_box *box)
{
    const cull_visit *visit = w->visit;
    if (w->takes_candidates) return 1;
    for (uint32_t v = 0; v < visit->volume_count; v++) {
        const cull_volume *volume = &visit->volumes[v];
        uint32_t k = 0;
        while (k < volume->plane_count && !(cull_plane_height(volume->planes[k], cull_box_corner(*box, volume->planes[k].normal)) < 0)) k++;
        if (k == volume->plane_count) return 1;
    }
    return 0;
}

static float beyond(float low, float high, float eye)
{
    return eye < low ? low - eye : eye > high ? eye - high : 0;
}

static int is_box(const cull_box *box)
{
    return box->min.x <= box->max.x && box->min.y <= box->max.y && box->min.z <= box->max.z;
}

float walk_key(const occlusion_walk *w, const cull_box *box)
{
    float key;
    if (!is_box(box)) return WALK_NO_NUMBER;
    if (w->visit->view->eye[3] == 0) {
        const cull_vec3 towards = {w->eye[0], w->eye[1], w->eye[2]}, p = cull_box_corner(*box, towards);
        key = -(towards.x * p.x + towards.y * p.y + towards.z * p.z);
    } else {
        const float x = beyond(box->min.x, box->max.x, w->eye[0]), y = beyond(box->min.y, box->max.y, w->eye[1]), z = beyond(box->min.z, box->max.z, w->eye[2]);
        key = x * x + y * y + z * z;
    }
    return key == key ? key : WALK_NO_NUMBER;
}

cull_box walk_box(const occlusion_walk *w, tree_entry e)
{
    const uint32_t first_mover = walk_mover_entry(w, 0);
    return e >= first_mover ? w->visit->movers[e - first_mover].box : tree_entry_box(w->tree, e);
}

// ---- Drawing ----

// first_run: runs of earlier steps are the host's already.
void walk_put_run(occlusion_walk *w, uint32_t first, uint32_t count)
{
    cull_batch *b = w->batch;
    cull_run *last = b->run_count > w->h->first_run ? &b->runs[b->run_count - 1] : NULL;
    const uint32_t items = w->tree->item_count;
    if (last && last->first + last->count == first && (first != items)) last->count += count; // items and movers don't join
    else b->runs[b->run_count++] = (cull_run){first, count};
}

void walk_draw(occlusion_walk *w, uint32_t place)
{
    occlusion_history *h = w->h;
    if (h->drawn[place] == h->serial) return;
    h->drawn[place] = h->serial;
    h->drawn_list[h->drawn_count++] = place;
    walk_put_run(w, w->ids ? w->ids[place] : place, 1);
}

// ---- Subtrees ----

walk_place walk_look(const occlusion_walk *w, walk_cursor *c)
{
    if (c->inside_from != TREE_NONE) return WALK_IN;
    const walk_place at = walk_place_of(w, &w->tree->nodes[c->node].box);
    if (at == WALK_IN) c->inside_from = c->node;
    return at;
}

int walk_go(const occlusion_walk *w, walk_cursor *c, tree_way way)
{
    const uint32_t from = c->node;
    const int is_entered = way == TREE_ENTER && w->tree->nodes[from].child_count;
    c->node = tree_next(w->tree, c->start, from, way);
    if (c->node == TREE_NONE) return 0;
    for (uint32_t n = from; !is_entered && c->inside_from != TREE_NONE && n != w->tree->nodes[c->node].parent; n = w->tree->nodes[n].parent)
        if (n == c->inside_from) c->inside_from = TREE_NONE;
    return 1;
}

int walk_wants(const occlusion_walk *w, uint32_t place, walk_place node_at)
{
    return !walk_is_masked(w, place) && (node_at == WALK_IN || touches(w, &w->tree->boxes[place]));
}

// Items of a unit that is off enter no list: nothing asks about them afterwards.
static void draw_unlisted(occlusion_walk *w, uint32_t place)
{
    if (w->h->drawn[place] == w->h->serial) return;
    w->h->drawn[place] = w->h->serial;
    walk_put_run(w, w->ids ? w->ids[place] : place, 1);
}

static void draw_whole(occlusion_walk *w, const tree_node *node)
{
    for (uint32_t i = 0; i < node->below_count; i++) w->h->drawn[node->first_below + i] = w->h->serial;
    walk_put_run(w, node->first_below, node->below_count);
}

uint32_t walk_draw_below(occlusion_walk *w, uint32_t node)
{
    const int has_runs = !w->h->mask_used && !w->ids;
    walk_cursor c = walk_from(node);
    uint32_t drawn = 0;
    tree_way way;
    do {
        const tree_node *n = &w->tree->nodes[c.node];
        const walk_place at = walk_has(w, c.node) ? walk_look(w, &c) : WALK_OUT;
        const int is_off = n->unit != TREE_NONE && w->h->pages[n->unit].is_off;
        w->batch->nodes_visited++;
        way = at == WALK_OUT ? TREE_PASS : TREE_ENTER;
        if (at == WALK_IN && has_runs && n->is_contiguous && is_off) {
            draw_whole(w, n);
            drawn += n->below_count;
            way = TREE_PASS;
        }
        for (uint32_t i = 0; way == TREE_ENTER && i < n->item_count; i++) {
            const uint32_t place = n->first_item + i;
            if (!walk_wants(w, place, at)) continue;
            drawn++;
            if (is_off) draw_unlisted(w, place);
            else walk_draw(w, place);
        }
    } while (walk_go(w, &c, way));
    return drawn;
}

// Of the unit's polygons in the volumes over an eighth was not seen last frame: its tests were of another part of it.
static int hides_much(const occlusion_walk *w, uint32_t node)
{
    uint64_t all = 0, unseen = 0;
    walk_cursor c = walk_from(node);
    tree_way way;
    do {
        const tree_node *n = &w->tree->nodes[c.node];
        const walk_place at = walk_has(w, c.node) ? walk_look(w, &c) : WALK_OUT;
        way = at == WALK_OUT ? TREE_PASS : TREE_ENTER;
        for (uint32_t place = n->first_item; way == TREE_ENTER && place < n->first_item + n->item_count; place++) {
            if (!walk_wants(w, place, at)) continue;
            all += w->tree->polygons[place];
            if (!(w->h->items[place] & ITEM_SEEN)) unseen += w->tree->polygons[place];
        }
    } while (walk_go(w, &c, way));
    return unseen * 8 > all;
}

static void page_reopen(occlusion_walk *w, ledger_page *page)
{
    page->is_off = page->tests = page->spent = page->gained = 0;
    page->on_since = w->h->serial;
}

int walk_draw_untested(occlusion_walk *w, uint32_t node)
{
    if (w->tree->nodes[node].unit != node) return 0;
    ledger_page *page = &w->h->pages[node];
    const uint32_t was_off = page->is_off;
    ledger_turn turn = ledger_look(page, &w->h->zone, w->h->serial, node);
    if (turn == LEDGER_OFF && !was_off && hides_much(w, node)) {
        page_reopen(w, page);
        turn = LEDGER_ON;
    }
    if (page->is_off != was_off) history_keep(w->h, node, page->is_off ? 1 : -1);
    if (turn == LEDGER_ON) return 0;
    const uint32_t drawn = walk_draw_below(w, node);
    w->h->counters.off_units += turn == LEDGER_OFF;
    if (!was_off) page->drawn = drawn;
    else if (turn == LEDGER_OFF && drawn > page->drawn + page->drawn / 4 + 4) page->off_until = w->h->serial + 1;
    return 1;
}

void walk_draw_mover(occlusion_walk *w, uint32_t mover)
{
    walk_put_run(w, w->visit->movers[mover].id, 1);
}

// ---- Testing ----

void walk_pend(occlusion_walk *w, tree_entry e)
{
    w->h->pending[w->h->pending_count++] = e;
}

void walk_pend_below(occlusion_walk *w, uint32_t node)
{
    walk_cursor c = walk_from(node);
    tree_way way;
    do {
        const tree_node *n = &w->tree->nodes[c.node];
        const walk_place at = walk_has(w, c.node) ? walk_look(w, &c) : WALK_OUT;
        w->batch->nodes_visited++;
        way = at == WALK_OUT ? TREE_PASS : TREE_ENTER;
        if (at != WALK_OUT && walk_draw_untested(w, c.node)) way = TREE_PASS;
        for (uint32_t i = 0; way == TREE_ENTER && i < n->item_count; i++) {
            const uint32_t place = n->first_item + i;
            if (walk_wants(w, place, at)) walk_pend(w, tree_entry_of_item(w->tree, place));
        }
    } while (walk_go(w, &c, way));
}

void walk_put_test(occlusion_walk *w, const cull_box *box, uint32_t tag)
{
    w->batch->tests[w->batch->test_count++] = (cull_test){*box, tag, 0};
    w->h->counters.tests++;
}

static void enter(occlusion_walk *w, tree_entry e, uint32_t cost, uint32_t polygons)
{
    ledger_page *page = &w->h->movers;
    if (e < walk_mover_entry(w, 0)) {
        const uint32_t unit = tree_entry_unit(w->tree, e);
        page = unit == TREE_NONE ? NULL : &w->h->pages[unit];
    }
    if (page) ledger_enter(page, cost, polygons);
    ledger_enter_zone(&w->h->zone, cost, polygons);
}

uint32_t walk_ask(occlusion_walk *w, uint32_t most)
{
    occlusion_history *h = w->h;
    const uint32_t left = h->test_most - w->batch->test_count, room = left < most ? left : most;
    h->tested_count = h->pending_count < room ? h->pending_count : room;
    for (uint32_t i = 0; i < h->tested_count; i++) {
        const cull_box box = walk_box(w, h->pending[i]);
        walk_put_test(w, &box, i);
    }
    h->counters.waited += h->tested_count;
    return h->tested_count;
}

// Long seen and large: looked at seldom, as what covers many pixels costs much to count and is rarely lost.
static uint8_t calmer(uint8_t flags, uint32_t pixels)
{
    uint32_t calm = flags >> ITEM_CALM_SHIFT, most = CALM_SMALL;
    for (uint32_t p = pixels / CALM_PIXELS; p && most < CALM_MOST; p /= 4) most++;
    if (calm < most) calm++;
    else calm = most;
    return (uint8_t)(ITEM_SEEN | calm << ITEM_CALM_SHIFT);
}

static void hear_final(occlusion_walk *w, const cull_answer *a)
{
    occlusion_history *h = w->h;
    const uint32_t place = a->tag & ~WALK_FINAL;
    if (h->zone.is_off) {
        rest_hear(w, place, a->pixels);
        return;
    }
    if (place >= w->tree->item_count || !(h->items[place] & ITEM_SEEN)) return;
    const tree_entry e = tree_entry_of_item(w->tree, place);
    enter(w, e, LEDGER_TEST, a->pixels ? 0 : w->tree->polygons[place]);
    if (a->pixels) {
        h->items[place] = calmer(h->items[place], a->pixels);
        return;
    }
    history_lose(h, place);
    if (h->drawn[place] == h->serial && !h->is_over) h->items[place] = ITEM_LOST;
}

// Of a hidden entry: what would have been drawn without the test. Of a large node on the border of the volumes nobody knows
// without looking at each item; it counts for nothing.
static uint32_t polygons_saved(const occlusion_walk *w, tree_entry e)
{
    if (e >= walk_mover_entry(w, 0)) return MOVER_POLYGONS;
    if (!tree_is_node(w->tree, e)) return w->tree->polygons[e - w->tree->node_count];
    const tree_node *n = &w->tree->nodes[e];
    const walk_place at = walk_place_of(w, &n->box);
    if (at != WALK_IN && n->below_count > SAVED_LOOKED_AT) return 0;
    if (at == WALK_IN && !w->h->mask_used) return n->polygons;
    uint64_t kept = 0; // of a subtree that does not lie together: an estimate, by as many places
    for (uint32_t i = 0; i < n->below_count && n->first_below + i < w->tree->item_count; i++) kept += walk_wants(w, n->first_below + i, at) != 0;
    return (uint32_t)(n->polygons * kept / n->below_count);
}

// A node whose box is seen while none of its items is would be tested in vain frame after frame, and its parts a round later.
static void open_for_a_while(occlusion_walk *w, uint32_t node)
{
    occlusion_history *h = w->h;
    const uint32_t level = h->nodes[node] < OPEN_MOST ? h->nodes[node] : OPEN_MOST, pause = 1u << (level + OPEN_LEAST);
    h->open_until[node] = h->serial + pause / 2 + node * 2654435761u % pause;
    h->nodes[node] = (uint8_t)(level + 1);
}

static void settle(occlusion_walk *w)
{
    occlusion_history *h = w->h;
    const uint32_t round = h->tested_count ? LEDGER_ROUND / h->tested_count : 0;
    for (uint32_t i = 0; i < h->tested_count; i++) {
        const tree_entry e = h->pending[i];
        const uint32_t pixels = h->pixels[i];
        if (pixels == UINT32_MAX) {
            h->counters.unanswered++;
            continue;
        }
        h->counters.wasted += pixels != 0;
        enter(w, e, LEDGER_TEST + round, pixels ? 0 : polygons_saved(w, e));
        if (!tree_is_node(w->tree, e)) continue;
        if (pixels) open_for_a_while(w, e);
        else h->nodes[e] = 0;
    }
}

void walk_hear(occlusion_walk *w)
{
    occlusion_history *h = w->h;
    const cull_visit *visit = w->visit;
    for (uint32_t i = 0; i < h->pending_count; i++) h->pixels[i] = UINT32_MAX;
    for (uint32_t i = 0; i < visit->answer_count; i++) {
        const cull_answer *a = &visit->answers[i];
        h->counters.late_answers += a->age != 0;
        h->counters.age_sum += a->age;
        if (walk_is_of_picture(a->tag)) continue;
        if (a->tag & WALK_FINAL) {
            if (a->age || h->is_over) hear_final(w, a);
        } else if (a->age == 0 && visit->step && a->tag < h->tested_count) {
            h->pixels[a->tag] = a->pixels < UINT32_MAX ? a->pixels : 1;
        }
    }
    if (visit->step) settle(w);
}

int walk_ask_final(occlusion_walk *w, uint32_t place)
{
    if (w->batch->test_count >= w->h->test_most) return 0;
    walk_put_test(w, place == w->tree->item_count ? &w->tree->nodes[0].box : &w->tree->boxes[place], WALK_FINAL | place);
    return 1;
}

void walk_count_turns(occlusion_walk *w)
{
    occlusion_history *h = w->h;
    const uint32_t draws = w->batch->run_count > h->first_run, tests = w->batch->test_count > 0;
    if (draws && h->is_testing) h->counters.turns++;
    if (draws) h->is_testing = 0;
    if (tests && !h->is_testing) h->counters.turns++;
    if (tests) h->is_testing = 1;
}

// ---- Who keeps tests of his own ----

void walk_settle(occlusion_walk *w, const walk_finding *f)
{
    const uint32_t cost = (LEDGER_TEST + f->step_cost) / f->shared_by;
    w->h->counters.wasted += f->pixels != 0 && f->shared_by == 1;
    enter(w, f->entry, cost ? cost : 1, f->pixels ? 0 : polygons_saved(w, f->entry));
    if (!tree_is_node(w->tree, f->entry)) return;
    if (!f->pixels) w->h->nodes[f->entry] = 0;
    else if (f->shared_by == 1) open_for_a_while(w, f->entry);
}

void walk_hear_drawn(occlusion_walk *w, uint32_t place, uint32_t pixels)
{
    occlusion_history *h = w->h;
    const int is_drawn = h->drawn[place] == h->serial && !h->is_over;
    enter(w, tree_entry_of_item(w->tree, place), LEDGER_TEST, pixels ? 0 : w->tree->polygons[place]);
    if (pixels) return;
    history_lose(h, place);
    if (is_drawn) h->items[place] = ITEM_LOST;
}
