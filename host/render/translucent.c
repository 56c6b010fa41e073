// Translucent items of a frame: noted while runs are drawn, drawn behind all that is opaque, farthest first.
// SPDX-License-Identifier: MIT
#include "gl.h"

static double distance2_of(const renderer *g, uint32_t item)
{
    const scene *s = g->scene.scene;
    const cull_boxes *b = &s->boxes;
    const double centre[3] = {((double)b->min_x[item] + b->max_x[item]) / 2, ((double)b->min_y[item] + b->max_y[item]) / 2,
                              ((double)b->min_z[item] + b->max_z[item]) / 2};
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += (centre[k] - g->frame.view.eye[k]) * (centre[k] - g->frame.view.eye[k]);
    return sum;
}

static void note(renderer *g, const render_layout *l, uint32_t place)
{
    frame_state *f = &g->frame;
    if (f->translucent_count == f->translucent_capacity) translucent_draw(g); // an item came twice
    const uint32_t item = l->order && place < l->item_count ? l->order[place] : place;
    f->translucent[f->translucent_count++] = (translucent_item){distance2_of(g, item), l, place, item};
}

void translucent_note(renderer *g, const render_layout *l, const cull_run *runs, uint32_t run_count)
{
    if (!l->see_through) return;
    for (uint32_t i = 0; i < run_count; ++i) {
        const uint32_t end = runs[i].first + runs[i].count;
        if (l->see_through[runs[i].first] == l->see_through[end]) continue;
        for (uint32_t place = runs[i].first; place < end; ++place)
            if (l->see_through[place] != l->see_through[place + 1]) note(g, l, place);
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

void translucent_draw(renderer *g)
{
    frame_state *f = &g->frame;
    if (f->translucent_count == 0) return;
    const GLuint program = program_find(g, PROGRAM_SHADED + (program_kind)f->request.mode, frame_variant(g));
    const draw_pass pass = {.view = &f->view};
    sort(f->translucent, f->translucent_count);
    frame_bind(g);
    if (program) {
        state_program(g, program);
        frame_uniforms(g, &pass, program, WORD_TRANSLUCENT);
        frame_state_pass(g, BLEND_MIX, DEPTH_OFF);
    }
    for (uint32_t i = 0; program && i < f->translucent_count; ++i) {
        const translucent_item *t = &f->translucent[i];
        const uint32_t first = t->layout->first_index[t->place];
        state_vertices(g, t->layout->vertices);
        ranges_add(&g->scene.ranges, first, t->layout->first_index[t->place + 1] - first);
        if (i + 1 == f->translucent_count || t[1].layout != t->layout) ranges_draw(g, &g->scene.ranges);
    }
    f->translucent_count = 0;
}
