// Frames in which a zone rests from tests: see rest.h, and ledger.h for what pays.
// SPDX-License-Identifier: MIT
// Invariant: nothing here takes an item away.
#include "rest.h"

#include "ledger.h"

enum { SAMPLE_FRAMES = 8, SAMPLE_EVERY = 16, SAMPLE_MOST = 32 }; // a resting zone: frames from tests to tests, places from test to test; tests, roughly
enum { RUN_MOST = 4096 }; // items drawn as they lie, not near to far

// ---- Whether it rests ----

// What is known to be no more than a few rounds' cost cannot pay. Of candidates it is known well, of a whole zone badly.
static uint32_t least_polygons(const occlusion_walk *w)
{
    return (w->takes_candidates ? 4u : 1u) * LEDGER_ROUND / LEDGER_SCALE;
}

// What the frame might draw, in polygons, looked at up to `enough`.
static uint64_t polygons_at_most(const occlusion_walk *w, uint64_t enough)
{
    const cull_visit *visit = w->visit;
    uint64_t sum = (uint64_t)visit->mover_count * MOVER_POLYGONS;
    if (!w->takes_candidates) return sum + (w->tree->node_count ? w->tree->nodes[0].polygons : 0);
    for (uint32_t i = 0; i < visit->candidate_count && sum < enough; i++)
        for (uint32_t k = 0; k < visit->candidates[i].count && sum < enough; k++) {
            const uint32_t id = visit->candidates[i].first + k;
            sum += w->tree->polygons[w->places ? w->places[id] : id];
        }
    return sum;
}

// ---- Drawing ----

static int is_asking(const occlusion_walk *w)
{
    return w->h->zone.is_off && w->h->serial % SAMPLE_FRAMES == 0;
}

// Other places each time.
static void ask_some(occlusion_walk *w, uint32_t first, uint32_t count)
{
    const uint32_t every = w->h->sample_every, turn = w->h->serial / SAMPLE_FRAMES * 5u % every, ahead = (turn + every - first % every) % every;
    w->h->sampled_items += count;
    for (uint32_t k = ahead; k < count && is_asking(w); k += every)
        if (!walk_ask_final(w, first + k)) return;
}

// By what the frame before looked at: this one is not counted yet.
static void begin_sample(occlusion_history *h)
{
    h->sample_every = SAMPLE_EVERY;
    while (h->sampled_items / h->sample_every > SAMPLE_MOST) h->sample_every *= 2;
    h->sampled_items = 0;
}

static void push(occlusion_walk *w, uint32_t node)
{
    heap_push(w->h->heap, &w->h->heap_count, (heap_entry){walk_key(w, &w->tree->nodes[node].box), node});
}

static void draw_node(occlusion_walk *w, uint32_t node)
{
    const tree_node *n = &w->tree->nodes[node];
    const walk_place at = walk_place_of(w, &n->box);
    w->batch->nodes_visited++;
    if (at == WALK_OUT) return;
    if (at == WALK_IN && n->is_contiguous && n->below_count <= RUN_MOST && !w->h->mask_used && !w->ids) {
        walk_put_run(w, n->first_below, n->below_count);
        ask_some(w, n->first_below, n->below_count);
        return;
    }
    for (uint32_t place = n->first_item; place < n->first_item + n->item_count; place++) {
        if (!walk_wants(w, place, at)) continue;
        walk_put_run(w, w->ids ? w->ids[place] : place, 1);
        ask_some(w, place, 1);
    }
    for (uint32_t c = n->first_child; c < n->first_child + n->child_count; c++)
        if (walk_has(w, c)) push(w, c);
}

// Nodes near to far, as a select would.
static void draw_tree(occlusion_walk *w)
{
    occlusion_history *h = w->h;
    if (w->tree->node_count && walk_has(w, 0)) push(w, 0);
    while (h->heap_count) draw_node(w, heap_pop(h->heap, &h->heap_count).entry);
}

// What the culler before found, in its order.
static void draw_candidates(occlusion_walk *w)
{
    for (uint32_t i = 0; i < w->visit->candidate_count; i++) {
        const cull_run run = w->visit->candidates[i];
        walk_put_run(w, run.first, run.count);
        if (!is_asking(w)) w->h->sampled_items += run.count;
        for (uint32_t k = 0; k < run.count && is_asking(w); k++) ask_some(w, w->places ? w->places[run.first + k] : run.first + k, 1);
    }
}

// A zone hidden as a whole costs one test: it is tested again from now on.
void rest_hear(occlusion_walk *w, uint32_t place, uint32_t pixels)
{
    ledger_page *zone = &w->h->zone;
    if (place > w->tree->item_count) return;
    if (place == w->tree->item_count) {
        if (pixels == 0) ledger_wake(zone, w->h->serial);
        return;
    }
    ledger_enter_zone(zone, LEDGER_TEST, pixels ? 0 : w->tree->polygons[place]);
    if (pixels) ledger_show(zone, w->tree->polygons[place]);
}

int rest_frame(occlusion_walk *w)
{
    occlusion_history *h = w->h;
    const uint64_t least = least_polygons(w);
    if (polygons_at_most(w, least) >= least && !ledger_rests(&h->zone, h->serial)) return 0;
    h->counters.rests++;
    h->rested = h->serial;
    begin_sample(h);
    if (w->takes_candidates && !w->visit->picture_count) draw_candidates(w);
    else draw_tree(w);
    if (w->tree->node_count && is_asking(w) && !walk_is_near(w, walk_key(w, &w->tree->nodes[0].box))) walk_ask_final(w, w->tree->item_count);
    for (uint32_t m = 0; m < w->visit->mover_count; m++) walk_draw_mover(w, m);
    history_turn(h);
    return 1;
}

void rest_count_drawn(occlusion_walk *w)
{
    uint32_t polygons = 0;
    for (uint32_t i = 0; i < w->h->drawn_count; i++) polygons += w->tree->polygons[w->h->drawn_list[i]];
    ledger_show(&w->h->zone, polygons);
}
