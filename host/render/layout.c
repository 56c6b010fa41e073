// Layouts: the index buffer in a chain's order, movers behind it, and tables that turn runs into index ranges.
// SPDX-License-Identifier: MIT
#include "gl.h"

#include <string.h>

static uint32_t item_at(const render_layout *l, uint32_t place)
{
    return l->order && place < l->item_count ? l->order[place] : place;
}

// first_index of each place, and how many see-through places stand before it.
static void fill_tables(render_layout *l)
{
    const scene_gpu *p = &l->g->scene;
    uint32_t index = 0, see_through = 0;
    for (uint32_t place = 0; place <= l->total; ++place) {
        l->first_index[place] = index;
        if (l->see_through) l->see_through[place] = see_through;
        if (place == l->total) break;
        const uint32_t item = item_at(l, place);
        index += p->scene->items[item].index_count;
        see_through += p->is_see_through[item];
    }
}

static result fill_elements(render_layout *l)
{
    const scene_gpu *p = &l->g->scene;
    const uint32_t count = p->scene->index_count;
    uint32_t *indices = memory_alloc(l->g->memory, count, sizeof *indices);
    if (!indices) return RESULT_NO_MEMORY;
    for (uint32_t place = 0; place < l->total; ++place) {
        const scene_item *item = &p->scene->items[item_at(l, place)];
        memcpy(indices + l->first_index[place], p->indices + item->first_index, item->index_count * sizeof *indices);
    }
    glCreateBuffers(1, &l->elements);
    glNamedBufferStorage(l->elements, (GLsizeiptr)(count * sizeof *indices), indices, 0);
    memory_free(l->g->memory, indices, count, sizeof *indices);
    return RESULT_OK;
}

static result fill(render_layout *l, const uint32_t *order)
{
    const scene_gpu *p = &l->g->scene;
    const allocator *memory = l->g->memory;
    const size_t places = (size_t)l->total + 1;
    l->first_index = memory_alloc(memory, places, sizeof *l->first_index);
    if (!l->first_index) return RESULT_NO_MEMORY;
    if (p->see_through_count && !(l->see_through = memory_alloc(memory, places, sizeof *l->see_through))) return RESULT_NO_MEMORY;
    if (order) {
        l->order = memory_alloc(memory, l->item_count, sizeof *l->order);
        if (!l->order) return RESULT_NO_MEMORY;
        if (l->item_count) memcpy(l->order, order, l->item_count * sizeof *order);
    }
    fill_tables(l);
    const result done = order ? fill_elements(l) : RESULT_OK;
    if (done == RESULT_OK) l->vertices = scene_vertex_array(l->g, order ? l->elements : p->elements);
    return done;
}

result render_layout_open(renderer *g, const uint32_t *order, report *r, render_layout **out)
{
    if (!g->scene.scene) return report_error(r, NULL, 0, "a layout without a scene; upload one first");
    render_layout *l = memory_alloc_zeroed(g->memory, 1, sizeof *l);
    if (!l) return report_no_memory(r, g->scene.scene->path);
    l->g = g;
    l->total = g->scene.item_total;
    l->item_count = g->scene.scene->item_count;
    result done = fill(l, order);
    if (done == RESULT_NO_MEMORY) report_no_memory(r, g->scene.scene->path);
    else done = gl_check(g, r, "laying out the scene");
    if (done != RESULT_OK) {
        render_layout_close(l);
        return done;
    }
    *out = l;
    return RESULT_OK;
}

void render_layout_close(render_layout *l)
{
    if (!l) return;
    renderer *g = l->g;
    pictures_forget_layout(g, l);
    if (g->frame.last_layout == l) g->frame.last_layout = NULL;
    glDeleteVertexArrays(1, &l->vertices);
    glDeleteBuffers(1, &l->elements);
    g->state.vertices = 0; // its name may come again
    memory_free(g->memory, l->order, l->item_count, sizeof *l->order);
    memory_free(g->memory, l->first_index, (size_t)l->total + 1, sizeof *l->first_index);
    memory_free(g->memory, l->see_through, (size_t)l->total + 1, sizeof *l->see_through);
    memory_free(g->memory, l, 1, sizeof *l);
}
