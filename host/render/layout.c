// Layouts: the index buffer in the order of every zone's chain, movers behind, and tables that turn runs into index ranges.
// SPDX-License-Identifier: MIT
// Invariant: an item stands as often as zones list it; a zone's part lies together, so a swap rewrites that part alone.
#include "levels.h"
#include "pieces.h"

#include <assert.h>
#include <string.h>

uint32_t layout_item(const render_layout *l, uint32_t place)
{
    if (place >= l->place_count) return l->g->scene.scene->item_count + (place - l->place_count);
    return l->items ? l->items[place] : place;
}

uint32_t layout_first_place(const render_layout *l, uint32_t zone)
{
    return zone == LAYOUT_MOVERS ? l->place_count : l->zones[zone].first_place;
}

void layout_zone_offset(const renderer *g, uint32_t zone, double out[3])
{
    const scene *s = g->scene.scene;
    for (int k = 0; k < 3; ++k) out[k] = zone < s->zone_count ? s->zones[zone].origin[k] - s->whole.origin[k] : 0;
}

// first_index of each place from `first` on, and how many see-through places stand before it.
static void fill_tables(render_layout *l, uint32_t first, uint32_t end)
{
    const scene_gpu *p = &l->g->scene;
    for (uint32_t place = first; place < end; ++place) {
        const uint32_t item = layout_item(l, place);
        l->first_index[place + 1] = l->first_index[place] + p->scene->items[item].index_count;
        if (l->see_through) l->see_through[place + 1] = l->see_through[place] + p->is_see_through[item];
    }
}

static GLuint make_elements(const render_layout *l)
{
    const size_t count = l->first_index[l->total];
    GLuint name = 0;
    glCreateBuffers(1, &name);
    glNamedBufferStorage(name, (GLsizeiptr)((count ? count : 1) * sizeof(uint32_t)), NULL, GL_DYNAMIC_STORAGE_BIT);
    return name;
}

// `part` holds the zone's indices.
static void write_zone(const render_layout *l, const layout_zone *z, uint32_t *part)
{
    const scene_gpu *p = &l->g->scene;
    uint32_t *at = part;
    for (uint32_t place = z->first_place; place < z->first_place + z->count; ++place) {
        const scene_item *item = &p->scene->items[layout_item(l, place)];
        if (item->index_count) memcpy(at, p->indices + item->first_index, item->index_count * sizeof *at);
        at += item->index_count;
    }
    const GLintptr first = (GLintptr)(l->first_index[z->first_place] * sizeof *at);
    if (at > part) glNamedBufferSubData(l->elements, first, (GLsizeiptr)((size_t)(at - part) * sizeof *at), part);
}

static uint32_t zone_indices(const render_layout *l, const layout_zone *z)
{
    return l->first_index[z->first_place + z->count] - l->first_index[z->first_place];
}

static void write_movers(const render_layout *l)
{
    const scene *s = l->g->scene.scene;
    const size_t first = l->first_index[l->place_count], count = l->first_index[l->total] - first;
    if (count == 0) return;
    const uint32_t *from = l->g->scene.indices + s->items[s->item_count].first_index; // all of them, without gaps
    glNamedBufferSubData(l->elements, (GLintptr)(first * sizeof *from), (GLsizeiptr)(count * sizeof *from), from);
}

static result write_all(render_layout *l)
{
    const allocator *memory = l->g->memory;
    uint32_t most = 0;
    for (uint32_t zone = 0; zone < l->zone_count; ++zone) {
        const uint32_t count = zone_indices(l, &l->zones[zone]);
        most = count > most ? count : most;
    }
    uint32_t *part = memory_alloc(memory, most, sizeof *part);
    if (!part) return RESULT_NO_MEMORY;
    l->elements = make_elements(l);
    for (uint32_t zone = 0; zone < l->zone_count; ++zone) write_zone(l, &l->zones[zone], part);
    write_movers(l);
    memory_free(memory, part, most, sizeof *part);
    return RESULT_OK;
}

static int is_scene_order(const scene *s, const render_layout_zone *zones, uint32_t zone_count)
{
    if (zone_count != 1 || zones[0].count != s->item_count) return 0;
    for (uint32_t i = 0; i < s->item_count; ++i)
        if (zones[0].items[i] != i) return 0;
    return 1;
}

static void place_zones(render_layout *l, const render_layout_zone *zones)
{
    uint32_t place = 0;
    for (uint32_t zone = 0; zone < l->zone_count; ++zone) {
        l->zones[zone] = (layout_zone){.first_place = place, .count = zones[zone].count, .oldest_test = TEST_NONE, .newest_test = TEST_NONE};
        if (l->items && zones[zone].count) memcpy(l->items + place, zones[zone].items, zones[zone].count * sizeof *l->items);
        place += zones[zone].count;
    }
}

static result fill(render_layout *l, const render_layout_zone *zones)
{
    const scene_gpu *p = &l->g->scene;
    const allocator *memory = l->g->memory;
    const size_t places = (size_t)l->total + 1;
    const int is_own = !is_scene_order(p->scene, zones, l->zone_count);
    l->zones = memory_alloc(memory, l->zone_count, sizeof *l->zones);
    l->first_index = memory_alloc_zeroed(memory, places, sizeof *l->first_index);
    if (p->see_through_count) l->see_through = memory_alloc_zeroed(memory, places, sizeof *l->see_through);
    if (is_own) l->items = memory_alloc(memory, l->place_count, sizeof *l->items);
    if (!l->zones || !l->first_index || (p->see_through_count && !l->see_through) || (is_own && !l->items)) return RESULT_NO_MEMORY;
    place_zones(l, zones);
    fill_tables(l, 0, l->total);
    const uint32_t translucent = l->see_through ? l->see_through[l->total] : 0;
    if (frame_reserve(l->g, l->zone_count, l->total, translucent) != RESULT_OK) return RESULT_NO_MEMORY;
    const result done = is_own ? write_all(l) : RESULT_OK;
    if (done == RESULT_OK) l->vertices = scene_vertex_array(l->g, is_own ? l->elements : p->elements);
    return done;
}

static result count_places(const scene *s, const render_layout_zone *zones, uint32_t zone_count, report *r, uint32_t *out)
{
    uint64_t places = 0, indices = 0;
    for (uint32_t zone = 0; zone < zone_count; ++zone) {
        places += zones[zone].count;
        for (uint32_t i = 0; i < zones[zone].count; ++i) {
            assert(zones[zone].items[i] < s->item_count);
            indices += s->items[zones[zone].items[i]].index_count;
        }
    }
    for (uint32_t i = 0; i < s->mover_count; ++i) indices += s->items[s->item_count + i].index_count;
    if (places + s->mover_count >= UINT32_MAX || indices > UINT32_MAX)
        return report_error(r, s->path, 0, "zones list 2^32 items or corners of triangles together; make their borders smaller");
    *out = (uint32_t)places;
    return RESULT_OK;
}

result render_layout_open(renderer *g, const render_layout_zone *zones, uint32_t zone_count, report *r, render_layout **out)
{
    const scene *s = g->scene.scene;
    uint32_t places = 0;
    if (!s) return report_error(r, NULL, 0, "a layout without a scene; upload one first");
    result done = count_places(s, zones, zone_count, r, &places);
    if (done != RESULT_OK) return done;
    render_layout *l = memory_alloc_zeroed(g->memory, 1, sizeof *l);
    if (!l) return report_no_memory(r, s->path);
    l->g = g;
    l->zone_count = zone_count;
    l->place_count = places;
    l->total = places + s->mover_count;
    done = fill(l, zones);
    if (done == RESULT_NO_MEMORY) report_no_memory(r, s->path);
    else done = gl_check(g, r, "laying out the scene");
    l->next = g->layouts;
    g->layouts = l;
    if (done != RESULT_OK) {
        render_layout_close(l);
        return done;
    }
    *out = l;
    return RESULT_OK;
}

// From the scene's index buffer to one of its own, the same in content but for the zone, which is to be written.
static result part_from_scene(render_layout *l)
{
    renderer *g = l->g;
    uint32_t *items = memory_alloc(g->memory, l->place_count, sizeof *items);
    if (!items) return RESULT_NO_MEMORY;
    for (uint32_t place = 0; place < l->place_count; ++place) items[place] = place;
    l->items = items;
    l->elements = make_elements(l);
    write_movers(l);
    glDeleteVertexArrays(1, &l->vertices);
    g->state.vertices = 0; // its name may come again
    l->vertices = scene_vertex_array(g, l->elements);
    return RESULT_OK;
}

result render_layout_reorder(render_layout *l, uint32_t zone, const uint32_t *items, report *r)
{
    renderer *g = l->g;
    assert(zone < l->zone_count && !g->frame.open); // what the frame holds back names places
    layout_zone *z = &l->zones[zone];
    const uint32_t indices = zone_indices(l, z);
    uint32_t *part = memory_alloc(g->memory, indices, sizeof *part);
    if (!part) return report_no_memory(r, g->scene.scene->path);
    if (!l->items && part_from_scene(l) != RESULT_OK) {
        memory_free(g->memory, part, indices, sizeof *part);
        return report_no_memory(r, g->scene.scene->path);
    }
    if (z->count) memcpy(l->items + z->first_place, items, z->count * sizeof *items);
    fill_tables(l, z->first_place, z->first_place + z->count);
    assert(zone_indices(l, z) == indices); // the same items
    write_zone(l, z, part);
    memory_free(g->memory, part, indices, sizeof *part);
    tests_forget_zone(g, l, zone);
    pictures_forget_zone(g, l, zone);
    pieces_forget_zone(l, zone);
    levels_close_layout(l); // in the old order
    return gl_check(g, r, "laying out a zone anew");
}

void render_layout_close(render_layout *l)
{
    if (!l) return;
    renderer *g = l->g;
    frame_flush(g);
    for (uint32_t zone = 0; l->vertices && zone < l->zone_count; ++zone) tests_forget_zone(g, l, zone);
    pictures_close_layout(g, l);
    pieces_close(l);
    levels_close_layout(l);
    render_layout **at = &g->layouts;
    while (*at != l) at = &(*at)->next;
    *at = l->next;
    glDeleteVertexArrays(1, &l->vertices);
    glDeleteBuffers(1, &l->elements);
    g->state.vertices = 0; // its name may come again
    memory_free(g->memory, l->zones, l->zone_count, sizeof *l->zones);
    memory_free(g->memory, l->items, l->place_count, sizeof *l->items);
    memory_free(g->memory, l->first_index, (size_t)l->total + 1, sizeof *l->first_index);
    memory_free(g->memory, l->see_through, (size_t)l->total + 1, sizeof *l->see_through);
    memory_free(g->memory, l, 1, sizeof *l);
}
