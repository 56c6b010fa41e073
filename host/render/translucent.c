// Translucent items of a frame: noted while runs are drawn, drawn behind all that is opaque, farthest first.
// SPDX-License-Identifier: MIT
#include "gl.h"

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

static void note(renderer *g, const layout_runs *r, uint32_t place)
{
    frame_state *f = &g->frame;
    if (f->translucent_count == f->translucent_capacity) { // an item came twice
        frame_flush(g);
        translucent_draw(g);
    }
    const uint32_t item = layout_item(r->layout, place);
    f->translucent[f->translucent_count++] = (translucent_item){distance2_of(g, item), r->layout, frame_cut(g, r->zone), place, item};
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
static void sort(translucent_item *items, uint32_t count)
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

void translucent_draw(renderer *g)
{
    frame_state *f = &g->frame;
    ranges *a = &g->scene.ranges;
    if (f->translucent_count == 0) return;
    sort(f->translucent, f->translucent_count);
    frame_bind(g);
    const GLuint program = frame_pass(g, &(draw_pass){.view = &f->view}, WORD_TRANSLUCENT);
    if (program) frame_state_pass(g, BLEND_MIX, DEPTH_OFF);
    for (uint32_t i = 0; program && i < f->translucent_count; ++i) {
        const translucent_item *t = &f->translucent[i];
        const uint32_t first = t->layout->first_index[t->place];
        ranges_add(a, first, t->layout->first_index[t->place + 1] - first);
        if (i + 1 < f->translucent_count && share_a_draw(t, t + 1)) continue;
        state_vertices(g, t->layout->vertices);
        cut_begin(g, &t->cut);
        ranges_draw(g, a);
        cut_end(g, &t->cut);
    }
    f->translucent_count = 0;
}
