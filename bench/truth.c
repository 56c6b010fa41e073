// Truth: see truth.h.
// SPDX-License-Identifier: MIT
#include "truth.h"

#include <string.h>

static uint32_t all_items(const scene *s)
{
    return s->item_count + s->mover_count;
}

static void fill_lookups(truth *t)
{
    const scene *s = t->scene;
    for (uint32_t p = 0; p < s->polygon_count; ++p)
        for (uint32_t i = s->polygon_first_triangle[p]; i < s->polygon_first_triangle[p + 1]; ++i) t->triangle_polygon[i] = p;
    for (uint32_t i = 0; i < all_items(s); ++i)
        for (uint32_t p = 0; p < s->items[i].polygon_count; ++p) t->polygon_item[s->items[i].first_polygon + p] = i;
}

result truth_open(const truth_request *q, const allocator *memory, report *r, truth *out)
{
    const scene *s = q->scene;
    *out = (truth){.scene = s, .memory = memory, .triangle_count = s->index_count / 3, .walls = q->walls};
    out->items = buffer_make(memory, sizeof(truth_item));
    out->views = buffer_make(memory, sizeof(truth_view));
    out->triangle_polygon = memory_alloc(memory, out->triangle_count, sizeof(uint32_t));
    out->polygon_item = memory_alloc(memory, s->polygon_count, sizeof(uint32_t));
    out->polygon_stamp = memory_alloc_zeroed(memory, s->polygon_count, sizeof(uint32_t));
    out->item_pixels = memory_alloc_zeroed(memory, all_items(s), sizeof(uint32_t));
    out->item_polygons = memory_alloc_zeroed(memory, all_items(s), sizeof(uint32_t));
    out->floor_bits = memory_alloc_zeroed(memory, (all_items(s) + 31) / 32, sizeof(uint32_t));
    const size_t words = (all_items(s) + 31) / 32;
    if (q->walls != WALLS_BOTH_SIDES) {
        out->shown_bits = memory_alloc(memory, words, sizeof(uint32_t));
        out->edge_bits = memory_alloc(memory, words, sizeof(uint32_t));
    }
    if (q->walls == WALLS_MIXED) out->front_bits = memory_alloc(memory, words, sizeof(uint32_t));
    if (out->front_bits) memset(out->front_bits, 0xff, words * sizeof(uint32_t));
    const int has_walls = q->walls == WALLS_BOTH_SIDES || (out->shown_bits && out->edge_bits);
    const int has_bits = has_walls && (q->walls != WALLS_MIXED || out->front_bits) && out->floor_bits;
    const int has_lookups = out->triangle_polygon && out->polygon_item && out->polygon_stamp && out->item_pixels && out->item_polygons;
    if (!has_bits || !has_lookups || id_picture_open(s, q->width_px, q->height_px, memory, &out->picture) != RESULT_OK) {
        truth_close(out);
        return report_no_memory(r, s->path);
    }
    fill_lookups(out);
    return RESULT_OK;
}

void truth_close(truth *t)
{
    if (!t->scene) return;
    const allocator *memory = t->memory;
    memory_free(memory, t->triangle_polygon, t->triangle_count, sizeof(uint32_t));
    memory_free(memory, t->polygon_item, t->scene->polygon_count, sizeof(uint32_t));
    memory_free(memory, t->polygon_stamp, t->scene->polygon_count, sizeof(uint32_t));
    memory_free(memory, t->item_pixels, all_items(t->scene), sizeof(uint32_t));
    memory_free(memory, t->item_polygons, all_items(t->scene), sizeof(uint32_t));
    memory_free(memory, t->floor_bits, (all_items(t->scene) + 31) / 32, sizeof(uint32_t));
    memory_free(memory, t->front_bits, (all_items(t->scene) + 31) / 32, sizeof(uint32_t));
    memory_free(memory, t->edge_bits, (all_items(t->scene) + 31) / 32, sizeof(uint32_t));
    memory_free(memory, t->shown_bits, (all_items(t->scene) + 31) / 32, sizeof(uint32_t));
    if (t->picture.triangles) id_picture_free(&t->picture, memory);
    buffer_free(&t->items);
    buffer_free(&t->views);
    *t = (truth){0};
}

// One polygon seen: counted once a view; its item enters the view's list at its first polygon.
static int see_polygon(truth *t, uint32_t polygon, uint32_t pixels)
{
    const uint32_t item = t->polygon_item[polygon];
    if (t->polygon_stamp[polygon] != t->stamp) {
        t->polygon_stamp[polygon] = t->stamp;
        if (t->item_polygons[item]++ == 0 && !buffer_append(&t->items, &(truth_item){.item = item}, 1)) return 0;
    }
    t->item_pixels[item] += pixels;
    return 1;
}

static int see_picture(truth *t)
{
    const id_picture *p = &t->picture;
    const size_t count = (size_t)p->width_px * p->height_px;
    for (size_t i = 0; i < count;) { // equal neighbours at once
        size_t end = i + 1;
        const uint32_t triangle = p->triangles[i];
        while (end < count && p->triangles[end] == triangle) ++end;
        if (triangle && triangle <= t->triangle_count && !see_polygon(t, t->triangle_polygon[triangle - 1], (uint32_t)(end - i))) return 0;
        i = end;
    }
    for (uint32_t w = 0; w < p->see_through_words; ++w)
        for (uint32_t bits = p->see_through[w]; bits; bits &= bits - 1) {
            const uint32_t triangle = w * 32 + (uint32_t)__builtin_ctz(bits);
            if (triangle < t->triangle_count && !see_polygon(t, t->triangle_polygon[triangle], 0)) return 0;
        }
    return 1;
}

// Moves the counts of the items touched into the list, and clears them for the next view.
static void close_view(truth *t, truth_view *v)
{
    truth_item *items = t->items.items;
    v->count = (uint32_t)t->items.count - v->first;
    for (uint32_t i = v->first; i < v->first + v->count; ++i) {
        const uint32_t id = items[i].item;
        items[i].pixels = t->item_pixels[id];
        items[i].polygons = t->item_polygons[id];
        t->item_pixels[id] = t->item_polygons[id] = 0;
        if (id >= t->scene->item_count) {
            v->mover_polygons_visible += items[i].polygons;
            continue;
        }
        v->items_visible++;
        v->polygons_visible += items[i].polygons;
        v->polygons_items += t->scene->items[id].polygon_count;
    }
}

static uint64_t count_floor(const truth *t)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < t->scene->item_count; ++i)
        count += (t->shown_bits ? t->shown_bits[i / 32] & t->floor_bits[i / 32] : t->floor_bits[i / 32]) >> (i % 32) & 1;
    return count;
}

// Takes what is edge on from the picture's owners.
static void disown_edges(truth *t)
{
    id_picture *p = &t->picture;
    const size_t count = (size_t)p->width_px * p->height_px;
    for (size_t i = 0; i < count; ++i) {
        const uint32_t triangle = p->triangles[i];
        if (!triangle || triangle > t->triangle_count) continue;
        const uint32_t item = t->polygon_item[t->triangle_polygon[triangle - 1]];
        if (t->edge_bits[item / 32] >> (item % 32) & 1) p->triangles[i] = 0;
    }
}

// Leaves in shown_bits what counts. Some wall is edge on: 1.
static int judge_walls(truth *t, const camera *c)
{
    uint32_t any = 0;
    const walls_view view = {c, t->picture.width_px, t->picture.height_px};
    walls_in_front(t->scene, &view, t->shown_bits, t->edge_bits);
    for (uint32_t w = 0; w < (all_items(t->scene) + 31) / 32; ++w) {
        if (t->front_bits) t->shown_bits[w] |= ~t->front_bits[w];
        t->edge_bits[w] &= ~t->shown_bits[w];
        any |= t->edge_bits[w];
    }
    return any != 0;
}

result truth_draw(truth *t, renderer *g, const id_request *q, report *r)
{
    id_request shown = *q;
    if (!t->shown_bits) return renderer_id_picture(g, &shown, r, &t->picture);
    const uint32_t words = (all_items(t->scene) + 31) / 32;
    const int has_edges = judge_walls(t, q->camera);
    for (uint32_t w = 0; w < words; ++w) t->shown_bits[w] |= t->edge_bits[w];
    shown.item_bits = t->shown_bits;
    const result done = renderer_id_picture(g, &shown, r, &t->picture);
    for (uint32_t w = 0; w < words; ++w) t->shown_bits[w] &= ~t->edge_bits[w];
    if (done == RESULT_OK && has_edges) disown_edges(t);
    return done;
}

result truth_add_view(truth *t, renderer *g, const camera *c, report *r)
{
    truth_view view = {.first = (uint32_t)t->items.count};
    const id_request q = {.camera = c};
    result done = truth_draw(t, g, &q, r);
    if (done == RESULT_OK) done = renderer_floor(g, c, r, t->floor_bits);
    if (done != RESULT_OK) return done;
    t->stamp++;
    if (!see_picture(t)) return report_no_memory(r, t->scene->path);
    close_view(t, &view);
    view.floor_items = count_floor(t);
    return buffer_append(&t->views, &view, 1) ? RESULT_OK : report_no_memory(r, t->scene->path);
}

result truth_skip_view(truth *t, report *r)
{
    return buffer_append(&t->views, &(truth_view){.first = (uint32_t)t->items.count}, 1) ? RESULT_OK : report_no_memory(r, t->scene->path);
}

// Sub-pixel shifts on a 4 x 4 grid; a single one stands at the centre.
static void jitter_of(uint32_t i, uint32_t jitters, double out[2])
{
    out[0] = out[1] = 0;
    if (jitters < 2) return;
    out[0] = (i % 4 + 0.5) / 4 - 0.5;
    out[1] = ((i / 4) % 4 + 0.5) / 4 - 0.5;
}

result truth_add_finer(truth *t, renderer *g, const camera *c, const truth_finer *how, report *r)
{
    const id_picture kept = t->picture;
    truth_view view = {.first = (uint32_t)t->items.count};
    result done = id_picture_open(t->scene, kept.width_px * how->scale, kept.height_px * how->scale, t->memory, &t->picture);
    if (done != RESULT_OK) {
        t->picture = kept;
        return report_no_memory(r, t->scene->path);
    }
    t->stamp++;
    for (uint32_t i = 0; i < how->jitters && done == RESULT_OK; ++i) {
        id_request q = {.camera = c};
        jitter_of(i, how->jitters, q.jitter_px);
        done = truth_draw(t, g, &q, r);
        if (done == RESULT_OK && !see_picture(t)) done = report_no_memory(r, t->scene->path);
    }
    id_picture_free(&t->picture, t->memory);
    t->picture = kept;
    close_view(t, &view);
    if (done != RESULT_OK) return done;
    return buffer_append(&t->views, &view, 1) ? RESULT_OK : report_no_memory(r, t->scene->path);
}
