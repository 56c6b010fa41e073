// Translucent items of a frame: noted while runs are drawn, drawn behind all that is opaque, farthest first: by their distance, or in
// exact order where the layout has pieces (pieces_draw.c).
// SPDX-License-Identifier: MIT
#include "pieces.h"

static double distance2_of(const renderer *g, uint32_t item)
{
    mover_box box;
    double sum = 0;
    item_box(g, item, &box);
    for (int k = 0; k < 3; ++k) {
        const double away = (box.low[k] + box.high[k]) / 2 - g->frame.view.eye[k];
        sum += away * away;
    }
    return sum;
}

// An item may stand in several pictures and be clipped at several seams: it is drawn once, as two layers of it would tint twice.
static void drop_repeats(renderer *g)
{
    frame_state *f = &g->frame;
    uint32_t kept = 0;
    if (!f->may_repeat && f->translucent_count <= f->translucent_capacity / 2) return; // there is room for each twice
    translucent_sort(f->translucent, f->translucent_count); // by distance, then by item: the same item lies together
    for (uint32_t i = 0; i < f->translucent_count; ++i) {
        const translucent_item *t = &f->translucent[i], *last = &f->translucent[kept ? kept - 1 : 0];
        if (kept && last->item == t->item && last->layout == t->layout && last->place == t->place) continue;
        f->translucent[kept++] = *t;
    }
    f->translucent_count = kept;
}

static void note(renderer *g, const layout_runs *r, uint32_t place)
{
    frame_state *f = &g->frame;
    if (f->translucent_count == f->translucent_capacity) drop_repeats(g);
    if (f->translucent_count == f->translucent_capacity) { // an item came twice, by two lists
        frame_flush(g);
        translucent_draw(g);
    }
    const uint32_t item = layout_item(r->layout, place);
    f->translucent[f->translucent_count++] = (translucent_item){
        .distance2 = distance2_of(g, item), .layout = r->layout, .cut = frame_cut(g, r->zone), .place = place, .item = item, .zone = r->zone};
}

void translucent_note(renderer *g, const layout_runs *r)
{
    const uint32_t *see_through = r->layout->see_through;
    if (!see_through || r->layout->g->frame.request.mode == RENDER_IDS) return;
    const uint32_t from = layout_first_place(r->layout, r->zone);
    for (uint32_t i = 0; i < r->count; ++i) {
        const uint32_t first = from + r->runs[i].first, end = first + r->runs[i].count;
        if (see_through[first] == see_through[end]) continue;
        for (uint32_t place = first; place < end; ++place)
            if (see_through[place] != see_through[place + 1]) note(g, r, place);
    }
}

// Farthest first; at one distance by global id, so no culler's order shows.
static int stands_before(const translucent_item *a, const translucent_item *b)
{
    if (a->rank != b->rank) return a->rank < b->rank;
    return a->distance2 != b->distance2 ? a->distance2 > b->distance2 : a->item < b->item;
}

static void sift_down(translucent_item *items, uint32_t root, uint32_t count)
{
    const translucent_item moved = items[root];
    for (uint32_t child; (child = 2 * root + 1) < count; root = child) {
        if (child + 1 < count && stands_before(&items[child], &items[child + 1])) child++;
        if (!stands_before(&moved, &items[child])) break;
        items[root] = items[child];
    }
    items[root] = moved;
}

// Heap sort (Williams 1964), as the C library's qsort may allocate.
void translucent_sort(translucent_item *items, uint32_t count)
{
    for (uint32_t root = count / 2; root-- > 0;) sift_down(items, root, count);
    for (uint32_t end = count; end-- > 1;) {
        const translucent_item last = items[end];
        items[end] = items[0];
        items[0] = last;
        sift_down(items, 0, end);
    }
}

static int share_a_draw(const translucent_item *a, const translucent_item *b)
{
    return a->layout == b->layout && a->cut.x == b->cut.x && a->cut.y == b->cut.y && a->cut.width == b->cut.width && a->cut.height == b->cut.height;
}

// Whose all of it is, where it has pieces; NULL: it goes by distance.
static render_layout *layout_with_pieces(const frame_state *f)
{
    const render_layout *l = f->translucent[0].layout;
    for (uint32_t i = 1; i < f->translucent_count; ++i)
        if (f->translucent[i].layout != l) return NULL;
    return l->pieces ? (render_layout *)(uintptr_t)l : NULL; // a frame's scratch hangs on it
}

static void draw_by_distance(renderer *g)
{
    frame_state *f = &g->frame;
    ranges *a = &g->scene.ranges;
    translucent_sort(f->translucent, f->translucent_count);
    for (uint32_t i = 0; i < f->translucent_count; ++i) {
        const translucent_item *t = &f->translucent[i];
        const uint32_t first = t->layout->first_index[t->place];
        ranges_add(a, first, t->layout->first_index[t->place + 1] - first);
        if (i + 1 < f->translucent_count && share_a_draw(t, t + 1)) continue;
        state_vertices(g, t->layout->vertices);
        cut_begin(g, &t->cut);
        ranges_draw(g, a);
        cut_end(g, &t->cut);
    }
}

void translucent_draw(renderer *g)
{
    frame_state *f = &g->frame;
    if (f->translucent_count == 0) return;
    drop_repeats(g);
    frame_bind(g);
    if (frame_pass(g, &(draw_pass){.view = &f->view}, WORD_TRANSLUCENT)) {
        frame_state_pass(g, BLEND_MIX, DEPTH_OFF);
        render_layout *l = layout_with_pieces(f);
        if (l) pieces_draw_all(g, l);
        else draw_by_distance(g);
    }
    f->translucent_count = 0;
}
