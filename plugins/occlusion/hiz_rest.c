// When method=hiz rests: see hiz_rest.h. Its own account and rest.c's way of drawing.
// SPDX-License-Identifier: MIT
// Invariant: nothing here takes an item away.
#include "hiz_rest.h"

#include "rest.h"

enum { HALVES = 2, COST_FACE = 1, COST_BOX = 2 * HALVES, COST_FRAME = 16 * HALVES }; // in halves of a polygon
enum { FIRST_FRAMES = 4, LOOK_EVERY = 8, LEVEL_LEAST = 3, LEVEL_MOST = 6, EARLY = 4, ACCOUNT_MOST = 1 << 26 };
// Judged before the first pause; frames from look to look; pauses of 2^3 to 2^6 frames; their part after which a change is heeded

// ---- What the frame has ----

static uint64_t run_polygons(const occlusion_walk *w, cull_run run)
{
    uint64_t sum = 0;
    for (uint32_t k = 0; k < run.count; k++) sum += w->tree->polygons[w->places ? w->places[run.first + k] : run.first + k];
    return sum;
}

// Of items that touch the volumes; of candidates all.
static uint64_t polygons_in_view(const occlusion_walk *w)
{
    uint64_t sum = 0;
    walk_cursor c = walk_from(0);
    tree_way way;
    if (w->takes_candidates) {
        for (uint32_t i = 0; i < w->visit->candidate_count; i++) sum += run_polygons(w, w->visit->candidates[i]);
        return sum;
    }
    if (!w->tree->node_count) return 0;
    do {
        const tree_node *n = &w->tree->nodes[c.node];
        const walk_place at = walk_has(w, c.node) ? walk_look(w, &c) : WALK_OUT;
        const int is_whole = at == WALK_IN && !w->h->mask_used;
        way = at == WALK_OUT || is_whole ? TREE_PASS : TREE_ENTER;
        if (is_whole) sum += n->polygons;
        for (uint32_t place = n->first_item; way == TREE_ENTER && place < n->first_item + n->item_count; place++)
            if (walk_wants(w, place, at)) sum += w->tree->polygons[place];
    } while (walk_go(w, &c, way));
    return sum;
}

static uint64_t items_said(const occlusion_walk *w)
{
    uint64_t sum = 0;
    for (uint32_t i = w->h->first_run; i < w->batch->run_count; i++) sum += w->batch->runs[i].count;
    return sum;
}

// ---- The account ----

static int is_due(const occlusion_walk *w, const hiz_rest *r)
{
    const uint64_t items = items_said(w), pause = UINT64_C(1) << r->level;
    if ((int32_t)(r->serial - r->due) >= 0) return 1;
    if ((int32_t)(r->due - r->serial) > (int32_t)(pause - pause / EARLY)) return 0;
    return items * 4 > r->off_items * 5 || items * 5 < r->off_items * 4;
}

static void begin_anew(hiz_rest *r)
{
    r->spent = r->gained = 0;
    r->on_since = r->serial;
}

static void pause_begin(hiz_rest *r)
{
    const uint32_t next = r->has_paused ? r->level + 1 : LEVEL_LEAST;
    r->level = next < LEVEL_MOST ? next : LEVEL_MOST;
    r->due = r->serial + 1 + (1u << r->level);
    r->is_off = 1;
    r->has_paused = 1;
    r->off_items = 0;
    begin_anew(r);
}

int hiz_rest_frame(occlusion_walk *w, hiz_rest *r)
{
    ledger_page *zone = &w->h->zone;
    r->serial++;
    walk_begin(w);
    w->h->first_run = w->batch->run_count;
    zone->is_off = r->is_off;
    zone->off_until = w->h->serial + 1; // rest.c is told, frame by frame
    if (!rest_frame(w)) return 0;
    if (!r->is_off) return 1; // too little to be worth it
    if (!r->off_items) r->off_items = items_said(w);
    if (is_due(w, r)) { // the next frame is tried
        r->is_off = 0;
        r->on_since = r->serial + 1;
    }
    return 1;
}

void hiz_rest_judge(occlusion_walk *w, const hiz *h, uint64_t saved, hiz_rest *r)
{
    const uint32_t age = r->serial - r->on_since;
    if (age >= FIRST_FRAMES && r->serial % LOOK_EVERY) return;
    const uint64_t all = polygons_in_view(w);
    uint64_t shown = 0, cost = COST_FRAME;
    for (uint32_t i = w->h->first_run; i < w->batch->run_count; i++) {
        const cull_run run = w->batch->runs[i];
        if (run.first >= w->tree->item_count) continue; // a mover
        shown += run_polygons(w, run);
        for (uint32_t k = 0; k < run.count; k++) {
            const uint32_t item = w->places ? run.first + k : w->tree->ids[run.first + k];
            const hiz_shape *shape = &h->index.shapes.shapes[h->index.tree.slots[item]];
            cost += shape->kind == HIZ_HIDES_AS_BOX ? COST_BOX : shape->face_count * (uint64_t)COST_FACE;
        }
    }
    if (r->spent > ACCOUNT_MOST || r->gained > ACCOUNT_MOST || r->serial % (16 * LOOK_EVERY) == 0) { // what is long past counts less
        r->spent /= 2;
        r->gained /= 2;
    }
    r->spent += cost;
    r->gained += (all > shown ? (all - shown) * HALVES : 0) + saved * HALVES;
    if (r->gained < r->spent && (r->has_paused || age + 1 >= FIRST_FRAMES)) pause_begin(r);
    else if (age > 1u << LEVEL_MOST) r->has_paused = 0;
}
