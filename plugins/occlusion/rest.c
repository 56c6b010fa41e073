// Frames in which a zone rests from tests: see rest.h, and ledger.h for what pays.
// SPDX-License-Identifier: MIT
// Invariant: nothing here takes an item away.
#include "rest.h"

#include "ledger.h"

enum { SAMPLE_FRAMES = 8, SAMPLE_EVERY = 16, SAMPLE_MOST = 32 }; // a resting zone: frames from tests to tests, places from test to test; tests, roughly
enum { RUN_MOST = 4096, NEAR_ITEMS = 256, CHILDREN_SORTED = 16 }; // items drawn as they lie, not near to far, wholly inside; or cut; children sorted

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
    uint64_t sum = (uint64_t)visit->mover_count * MOVER_POLYGONS + (uint64_t)visit->picture_count * DROP_PICTURE_POLYGONS;
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
static void ask_every(occlusion_walk *w, uint32_t first, uint32_t count)
{
    const uint32_t every = w->h->sample_every, turn = w->h->serial / SAMPLE_FRAMES * 5u % every, ahead = (turn + every - first % every) % every;
    for (uint32_t k = ahead; k < count; k += every)
        if (!walk_ask_final(w, first + k)) return;
}

static inline void ask_some(occlusion_walk *w, uint32_t first, uint32_t count)
{
    w->h->sampled_items += count;
    if (is_asking(w)) ask_every(w, first, count);
}

// By what the frame before looked at: this one is not counted yet.
static void begin_sample(occlusion_history *h)
{
    h->sample_every = SAMPLE_EVERY;
    while (h->sampled_items / h->sample_every > SAMPLE_MOST) h->sample_every *= 2;
    h->sampled_items = 0;
}

static void put_items(occlusion_walk *w, uint32_t first, uint32_t count)
{
    for (uint32_t place = first; w->ids && place < first + count; place++) walk_put_run(w, w->ids[place], 1);
    if (!w->ids) walk_put_run(w, first, count);
    ask_some(w, first, count);
}

static void push(occlusion_walk *w, uint32_t node)
{
    heap_push(w->h->heap, &w->h->heap_count, (heap_entry){walk_key(w, &w->tree->nodes[node].box), node});
}

static int is_one_run(const occlusion_walk *w, const tree_node *n)
{
    return n->is_contiguous && n->below_count <= RUN_MOST && !w->h->mask_used;
}

static void draw_node(occlusion_walk *w, uint32_t node)
{
    const tree_node *n = &w->tree->nodes[node];
    const walk_place at = walk_place_of(w, &n->box);
    w->batch->nodes_visited++;
    if (at == WALK_OUT) return;
    if (at == WALK_IN && is_one_run(w, n)) {
        put_items(w, n->first_below, n->below_count);
        return;
    }
    for (uint32_t place = n->first_item; place < n->first_item + n->item_count; place++)
        if (walk_wants(w, place, at)) put_items(w, place, 1);
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

// ---- The same through one volume, as most zones are seen ----

// Planes that have all of a node inside are not looked at below it (Assarsson and Moeller, "Optimized View Frustum Culling
// Algorithms for Bounding Boxes", 2000), and what comes next is asked of memory ahead: the renderer has emptied the caches.

// A box against the planes that have a bit in *which: of those that cut it bits are left.
static walk_place hold(const cull_volume *volume, const cull_box *box, uint32_t *which)
{
    uint32_t cut = 0;
    for (uint32_t k = 0, rest = *which; rest; k++, rest >>= 1) {
        if (!(rest & 1)) continue;
        if (cull_plane_height(volume->planes[k], cull_box_corner(*box, volume->planes[k].normal)) < 0) return WALK_OUT;
        if (!cull_plane_contains(volume->planes[k], *box)) cut |= UINT32_C(1) << k;
    }
    *which = cut;
    return cut ? WALK_CUT : WALK_IN;
}

static void prefetch(const void *from, size_t size)
{
#if defined(__GNUC__)
    for (size_t at = 0; at < size; at += 64) __builtin_prefetch((const char *)from + at);
#else
    (void)from, (void)size;
#endif
}

static void draw_own(occlusion_walk *w, const tree_node *n, uint32_t which)
{
    const cull_volume *volume = &w->visit->volumes[0];
    for (uint32_t place = n->first_item; place < n->first_item + n->item_count; place++) {
        uint32_t planes = which;
        if (hold(volume, &w->tree->boxes[place], &planes) != WALK_OUT) put_items(w, place, 1);
    }
}

// The node's children that touch: a stack in pending and pixels, which a frame at rest has no other use for; the nearest on top, of a
// small node the first: what lies together makes fewer runs then.
static void stack_children(occlusion_walk *w, const tree_node *n, uint32_t which)
{
    occlusion_history *h = w->h;
    const uint32_t bottom = h->pending_count;
    const int is_sorted = n->below_count > NEAR_ITEMS && n->child_count <= CHILDREN_SORTED;
    float keys[CHILDREN_SORTED];
    for (uint32_t c = n->first_child + n->child_count; c-- > n->first_child;) {
        const tree_node *child = &w->tree->nodes[c];
        uint32_t planes = which, at = h->pending_count;
        if (!child->below_count || hold(&w->visit->volumes[0], &child->box, &planes) == WALK_OUT) continue;
        if (planes || !is_one_run(w, child)) {
            prefetch(&w->tree->nodes[child->first_child], child->child_count * sizeof *child);
            prefetch(&w->tree->boxes[child->first_item], child->item_count * sizeof *w->tree->boxes);
        }
        if (is_sorted) {
            const float key = walk_key(w, &child->box);
            for (; at > bottom && keys[at - 1 - bottom] < key; at--) {
                keys[at - bottom] = keys[at - 1 - bottom];
                h->pending[at] = h->pending[at - 1];
                h->pixels[at] = h->pixels[at - 1];
            }
            keys[at - bottom] = key;
        }
        h->pending[at] = c;
        h->pixels[at] = planes;
        h->pending_count++;
    }
}

static void draw_tree_through_one(occlusion_walk *w)
{
    occlusion_history *h = w->h;
    const cull_volume *volume = &w->visit->volumes[0];
    uint32_t which = volume->plane_count ? UINT32_MAX >> (CULL_MAX_PLANES - volume->plane_count) : 0;
    if (!w->tree->node_count || !w->tree->nodes[0].below_count || hold(volume, &w->tree->nodes[0].box, &which) == WALK_OUT) return;
    h->pending[0] = 0;
    h->pixels[0] = which;
    for (h->pending_count = 1; h->pending_count;) {
        const uint32_t top = --h->pending_count;
        const tree_node *n = &w->tree->nodes[h->pending[top]];
        which = h->pixels[top];
        w->batch->nodes_visited++;
        if (!which && is_one_run(w, n)) {
            put_items(w, n->first_below, n->below_count);
            continue;
        }
        draw_own(w, n, which);
        stack_children(w, n, which);
    }
}

// Ids that follow each other are one run.
static void draw_movers(occlusion_walk *w)
{
    const cull_mover *movers = w->visit->movers;
    const uint32_t count = w->visit->mover_count;
    for (uint32_t m = 0, end; m < count; m = end) {
        for (end = m + 1; end < count && movers[end].id == movers[m].id + (end - m);) end++;
        walk_put_run(w, movers[m].id, end - m);
    }
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
    if (w->takes_candidates) draw_candidates(w);
    else if (w->visit->volume_count == 1 && !h->mask_used) draw_tree_through_one(w);
    else draw_tree(w);
    if (w->tree->node_count && is_asking(w) && !walk_is_near(w, walk_key(w, &w->tree->nodes[0].box))) walk_ask_final(w, w->tree->item_count);
    draw_movers(w);
    history_turn(h);
    return 1;
}

void rest_count_drawn(occlusion_walk *w)
{
    uint32_t polygons = 0;
    for (uint32_t i = 0; i < w->h->drawn_count; i++) polygons += w->tree->polygons[w->h->drawn_list[i]];
    ledger_show(&w->h->zone, polygons);
}
