// Coarser triangles for captures: see levels.h. Where they are not far fewer there are none: a level costs memory, and its error costs a picture life.
// SPDX-License-Identifier: MIT
// Invariant: what moves, is see-through, cut out or sky is the same in every level, and no item's triangles stand among another's.
#include "levels.h"

#include "simplify.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// Of the power of two at or over the scene's radius: a tenth of a pixel of a 720p picture at a sixteenth of it, then four times as far each.
#define FINEST 0x1p-17
enum { COARSER = 4, LEVELS = CULL_LEVELS_MOST };
enum { TRIED_OF = 16, CHUNK = 4096, TRIANGLES_MOST = 1 << 23 }; // a chunk in so many tells whether to go on; beyond the most it would take a minute
#define CHUNK_EDGES 0.1 // of a chunk's triangles, that its cut edges keep, about
#define WORTH 0.7 // of the triangles of the next finer level: one that leaves more is not kept

typedef struct scene_level {
    uint32_t *indices, *first_index; // first_index: of each item, one more at the end
    size_t count;
    double away_m;
} scene_level;

struct scene_levels {
    scene_level all[LEVELS];
    uint32_t count, item_count;
    uint64_t triangles; // of the scene, movers not counted
};

// ---- The scene's ----

static int is_simple_material(const scene *s, uint32_t vertex)
{
    return (s->materials[s->vertex_materials[vertex]].flags & (MATERIAL_TRANSLUCENT | MATERIAL_CUT_OUT | MATERIAL_SKY | MATERIAL_NORMAL_MAP)) == 0;
}

static uint32_t group_of(const scene *s, uint32_t item)
{
    const scene_item *it = &s->items[item];
    if (it->flags & (CULL_ITEM_SEE_THROUGH | CULL_ITEM_CUT_OUT)) return SIMPLIFY_KEPT;
    for (uint32_t k = 0; k < it->index_count; ++k)
        if (!is_simple_material(s, s->indices[it->first_index + k])) return SIMPLIFY_KEPT;
    return item;
}

static void free_levels(scene_levels *v, const allocator *memory)
{
    if (!v) return;
    for (uint32_t k = 0; k < LEVELS; ++k) {
        memory_free(memory, v->all[k].indices, v->all[k].count, sizeof(uint32_t));
        memory_free(memory, v->all[k].first_index, (size_t)v->item_count + 1, sizeof(uint32_t));
    }
    memory_free(memory, v, 1, sizeof *v);
}

// What is left, item by item, without gaps.
static result keep_level(const scene *s, const uint32_t *corners, uint32_t left, double away_m, scene_levels *v, const allocator *memory)
{
    scene_level *to = &v->all[v->count];
    uint32_t at = 0;
    *to = (scene_level){.count = (size_t)3 * left, .away_m = away_m};
    to->indices = memory_alloc(memory, to->count, sizeof *to->indices);
    to->first_index = memory_alloc(memory, (size_t)s->item_count + 1, sizeof *to->first_index);
    if (!to->indices || !to->first_index) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < s->item_count; ++i) {
        const scene_item *it = &s->items[i];
        to->first_index[i] = at;
        for (uint32_t k = it->first_index; k < it->first_index + it->index_count; k += 3) {
            if (corners[k] == SIMPLIFY_GONE) continue;
            memcpy(to->indices + at, corners + k, 3 * sizeof *corners);
            at += 3;
        }
    }
    to->first_index[s->item_count] = at;
    assert(at == to->count);
    v->count++;
    return RESULT_OK;
}

// NAN-free: a radius of 0 gives bounds of 0, and nothing moves.
static double finest_of(const scene *s)
{
    int exponent;
    frexp((double)s->whole.radius, &exponent);
    return ldexp(FINEST, exponent);
}

// Chunks of neighbours, simplified to the coarsest level: their cut edges stay, so a little more is left of them than of the whole. *out_share: is left.
static result try_chunks(const simplify_input *in, const uint32_t *corners, double away_m, const allocator *memory, double *out_share)
{
    const size_t most = in->triangle_count / TRIED_OF + CHUNK;
    uint32_t *some = memory_alloc(memory, 3 * most, sizeof *some), *groups = memory_alloc(memory, most, sizeof *groups);
    simplify_input part = *in;
    simplify *work = NULL;
    result done = some && groups ? RESULT_OK : RESULT_NO_MEMORY;
    part.groups = groups;
    part.triangle_count = 0;
    for (size_t first = 0; done == RESULT_OK && first < in->triangle_count; first += (size_t)TRIED_OF * CHUNK) {
        const size_t here = in->triangle_count - first < CHUNK ? in->triangle_count - first : CHUNK;
        memcpy(some + (size_t)3 * part.triangle_count, corners + 3 * first, 3 * here * sizeof *some);
        memcpy(groups + part.triangle_count, in->groups + first, here * sizeof *groups);
        part.triangle_count += (uint32_t)here;
    }
    if (done == RESULT_OK) done = simplify_open(&part, some, memory, &work);
    if (done == RESULT_OK) *out_share = (double)simplify_to(work, away_m) / (double)part.triangle_count;
    simplify_close(work);
    memory_free(memory, some, 3 * most, sizeof *some);
    memory_free(memory, groups, most, sizeof *groups);
    return done;
}

static result simplify_all(const scene *s, const uint32_t *groups, uint32_t *corners, scene_levels *v, const allocator *memory)
{
    const simplify_input in = {&s->positions->x, s->normals, groups, s->position_count, (uint32_t)v->triangles};
    double away_m = finest_of(s), share = 1;
    simplify *work = NULL;
    result done = try_chunks(&in, corners, away_m * COARSER * COARSER, memory, &share);
    if (done != RESULT_OK || share > WORTH + CHUNK_EDGES) return done;
    done = simplify_open(&in, corners, memory, &work);
    uint64_t before = v->triangles;
    for (uint32_t k = 0; k < LEVELS && done == RESULT_OK; ++k, away_m *= COARSER) {
        const uint32_t left = simplify_to(work, away_m);
        if ((double)left > WORTH * (double)before) continue;
        done = keep_level(s, corners, left, away_m, v, memory);
        before = left;
    }
    simplify_close(work);
    return done;
}

static result make_levels(const scene *s, const allocator *memory, scene_levels **out)
{
    const scene_item *last = s->item_count ? &s->items[s->item_count - 1] : NULL;
    const uint32_t count = last ? last->first_index + last->index_count : 0;
    scene_levels *v = memory_alloc_zeroed(memory, 1, sizeof *v);
    uint32_t *groups = memory_alloc(memory, count / 3, sizeof *groups), *corners = memory_alloc(memory, count, sizeof *corners);
    result done = v && groups && corners ? RESULT_OK : RESULT_NO_MEMORY;
    if (done == RESULT_OK) {
        v->item_count = s->item_count;
        v->triangles = count / 3;
        if (count) memcpy(corners, s->indices, count * sizeof *corners);
        for (uint32_t i = 0; i < s->item_count; ++i) {
            const uint32_t group = group_of(s, i), first = s->items[i].first_index / 3;
            for (uint32_t t = first; t < first + s->items[i].index_count / 3; ++t) groups[t] = group;
        }
        if (s->normals && count && v->triangles <= TRIANGLES_MOST) done = simplify_all(s, groups, corners, v, memory);
    }
    memory_free(memory, groups, count / 3, sizeof *groups);
    memory_free(memory, corners, count, sizeof *corners);
    if (done == RESULT_OK) *out = v;
    else free_levels(v, memory);
    return done;
}

void levels_release(renderer *g)
{
    free_levels(g->scene.levels, g->memory);
    g->scene.levels = NULL;
}

// ---- A layout's ----

static result lay_level(render_layout *l, const scene_level *from, layout_level *to)
{
    const allocator *memory = l->g->memory;
    uint64_t count = 0;
    to->away_m = from->away_m;
    to->first_index = memory_alloc(memory, (size_t)l->place_count + 1, sizeof *to->first_index);
    if (!to->first_index) return RESULT_NO_MEMORY;
    for (uint32_t p = 0; p < l->place_count; ++p) { // fewer than the layout's own, which fit
        const uint32_t item = layout_item(l, p);
        to->first_index[p] = (uint32_t)count;
        count += from->first_index[item + 1] - from->first_index[item];
    }
    to->first_index[l->place_count] = (uint32_t)count;
    uint32_t *all = memory_alloc(memory, (size_t)count, sizeof *all);
    if (!all) return RESULT_NO_MEMORY;
    for (uint32_t p = 0; p < l->place_count; ++p) {
        const uint32_t size = to->first_index[p + 1] - to->first_index[p];
        if (size) memcpy(all + to->first_index[p], from->indices + from->first_index[layout_item(l, p)], size * sizeof *all);
    }
    glCreateBuffers(1, &to->elements);
    glNamedBufferStorage(to->elements, (GLsizeiptr)((count ? count : 1) * sizeof *all), count ? all : NULL, 0);
    memory_free(memory, all, (size_t)count, sizeof *all);
    to->vertices = scene_vertex_array(l->g, to->elements);
    return RESULT_OK;
}

void levels_close_layout(render_layout *l)
{
    for (uint32_t k = 0; k < l->level_count; ++k) {
        layout_level *v = &l->levels[k];
        glDeleteVertexArrays(1, &v->vertices);
        glDeleteBuffers(1, &v->elements);
        memory_free(l->g->memory, v->first_index, (size_t)l->place_count + 1, sizeof *v->first_index);
        l->g->state.vertices = 0; // its name may come again
    }
    memory_free(l->g->memory, l->levels, l->level_count, sizeof *l->levels);
    l->levels = NULL;
    l->level_count = 0;
}

static result lay_all(render_layout *l, const scene_levels *v)
{
    levels_close_layout(l);
    if (v->count == 0) return RESULT_OK;
    l->levels = memory_alloc_zeroed(l->g->memory, v->count, sizeof *l->levels);
    if (!l->levels) return RESULT_NO_MEMORY;
    l->level_count = v->count;
    result done = RESULT_OK;
    for (uint32_t k = 0; k < v->count && done == RESULT_OK; ++k) done = lay_level(l, &v->all[k], &l->levels[k]);
    if (done != RESULT_OK) levels_close_layout(l);
    return done;
}

result render_layout_levels(render_layout *l, report *r, cull_costs *out)
{
    renderer *g = l->g;
    assert(!g->frame.open);
    result done = g->scene.levels ? RESULT_OK : make_levels(g->scene.scene, g->memory, &g->scene.levels);
    if (done == RESULT_OK) done = lay_all(l, g->scene.levels);
    if (done != RESULT_OK) return report_no_memory(r, g->scene.scene->path);
    out->level_count = l->level_count;
    for (uint32_t k = 0; k < l->level_count; ++k) {
        const scene_level *v = &g->scene.levels->all[k];
        out->levels[k] = (cull_level){v->away_m, (double)v->count / 3 / (double)g->scene.levels->triangles};
    }
    return gl_check(g, r, "laying out coarser triangles");
}

// Other modes tell by their triangles' numbers and sides who is who: these have none of their own.
static int takes_levels(const renderer *g)
{
    const frame_request *q = &g->frame.request;
    return (q->mode == RENDER_SHADED || q->mode == RENDER_DEPTH) && !(q->faces == FACES_FRONT && g->scene.has_two_sided);
}

const layout_level *levels_find(const render_layout *l, double detail_m)
{
    if (!takes_levels(l->g)) return NULL;
    for (uint32_t k = l->level_count; k-- > 0;)
        if (l->levels[k].away_m <= detail_m) return &l->levels[k];
    return NULL;
}
