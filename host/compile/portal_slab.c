// Door groups and portal brushes as slabs: the thinnest way through along their faces' normals, in the middle of which the
// portal lies, and the sides that bound it. The same for a turned door as for an upright one; each of several ways as thin.
// SPDX-License-Identifier: MIT
#include "brush_shape.h"
#include "portals.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WAYS_MOST = 32 };
#define DOOR_MARGIN_UNITS 1.0 // past the frame: a door that just fills its opening ends inside the wall
#define AXIS_MARGIN_UNITS 2.0 // along axes that no face has: over sqrt(3), so that they cut no corner off a turned box
#define UNITS_A_METRE 32.0
#define SAME_THICKNESS 1e-6   // steps: no choice by rounding between two equal axes
#define WHOLE_MOST 4e15       // doubles below it are good to half a whole number
#define MARGIN_MOST 4e18      // and below it fit int64, with room for a way's end

typedef struct way { // a direction through the group, and how far it reaches that way: low <= n . p <= high
    int64_t normal[3];
    double length, low_at, high_at;
    int64_t low, high;
    uint32_t is_face; // of some brush; else only an axis of the scene
} way;

typedef struct slab_group {
    uint32_t entity, is_door, way_count, thin;
    double lost; // steps: the thinnest way between faces that whole numbers don't hold
    way ways[WAYS_MOST];
} slab_group;

typedef struct slab_build {
    const compile_input *in;
    report *report;
    slab_set *out;
    brush_shape shape;
    plane_ref cube[6];
    buffer planes; // of one brush
    buffer groups; // slab_group
    double unit;   // steps
} slab_build;

// ---- Ways ----

static way *find_way(slab_group *g, const int64_t normal[3])
{
    for (uint32_t i = 0; i < g->way_count; ++i) {
        way *w = &g->ways[i];
        if (memcmp(w->normal, normal, sizeof(w->normal)) == 0) return w;
    }
    if (g->way_count == WAYS_MOST) return NULL;
    way *w = &g->ways[g->way_count++];
    memcpy(w->normal, normal, sizeof(w->normal));
    w->length = sqrt((double)normal[0] * (double)normal[0] + (double)normal[1] * (double)normal[1] + (double)normal[2] * (double)normal[2]);
    w->low_at = INFINITY;
    w->high_at = -INFINITY;
    return w;
}

static void add_axes(slab_group *g)
{
    for (int k = 0; k < 3; ++k) {
        const int64_t normal[3] = {k == 0, k == 1, k == 2};
        find_way(g, normal);
    }
}

static void add_face_way(slab_group *g, const int64_t normal[3])
{
    way *w = find_way(g, normal);
    if (w) w->is_face = 1;
}

static void reach(way *w, const double p[3])
{
    const double at = (double)w->normal[0] * p[0] + (double)w->normal[1] * p[1] + (double)w->normal[2] * p[2];
    if (at < w->low_at) w->low_at = at;
    if (at > w->high_at) w->high_at = at;
}

// Whole numbers that hold the reach; where it ends on a whole number but for rounding, that number.
// 0: there is nothing. Axes come first, and doubles hold their ends. A way that a margin takes out of 62 bits bounds nothing.
static int round_ways(const slab_build *b, slab_group *g)
{
    for (uint32_t i = 0; i < g->way_count; ++i) {
        way *w = &g->ways[i];
        if (!(fabs(w->low_at) < WHOLE_MOST && fabs(w->high_at) < WHOLE_MOST && AXIS_MARGIN_UNITS * b->unit * w->length < MARGIN_MOST)) {
            if (i < 3) return 0;
            if (w->is_face) g->lost = fmin(g->lost, (w->high_at - w->low_at) / w->length);
            *w = g->ways[--g->way_count];
            --i;
            continue;
        }
        const double slack = 1e-6 * w->length + 4e-16 * fabs(w->high_at) + 4e-16 * fabs(w->low_at);
        w->low = (int64_t)floor(w->low_at + slack);
        w->high = (int64_t)ceil(w->high_at - slack);
    }
    return 1;
}

static double thickness(const way *w)
{
    return (double)(w->high - w->low) / w->length;
}

static int is_thinnest(const slab_group *g, uint32_t which)
{
    if (!g->ways[which].is_face) return 0;
    for (uint32_t i = 0; i < g->way_count; ++i)
        if (g->ways[i].is_face && thickness(&g->ways[i]) < thickness(&g->ways[which]) - SAME_THICKNESS) return 0;
    return 1;
}

// ---- Groups ----

static result cut_brush(slab_build *b, uint32_t brush, shape_fault *fault)
{
    const compile_brush *body = &b->in->brushes[brush];
    b->planes.count = 0;
    for (uint32_t f = 0; f < body->face_count; ++f)
        if (!buffer_append(&b->planes, &b->in->faces[body->first_face + f].plane, 1)) return RESULT_NO_MEMORY;
    *fault = brush_shape_cut(&b->shape, b->in->planes, b->cube, b->planes.items, body->face_count);
    return *fault == SHAPE_NO_MEMORY ? RESULT_NO_MEMORY : RESULT_OK;
}

static result reach_brushes(slab_build *b, slab_group *g, uint32_t first, uint32_t count)
{
    add_axes(g);
    for (int pass = 0; pass < 2; ++pass)
        for (uint32_t i = first; i < first + count; ++i) {
            shape_fault fault;
            const result r = cut_brush(b, i, &fault);
            if (r != RESULT_OK) return r;
            if (fault != SHAPE_SOUND) continue;
            const shape_face *faces = b->shape.faces.items;
            for (size_t f = 0; f < b->shape.faces.count && pass == 0; ++f)
                add_face_way(g, plane_table_canonical(b->in->planes, ((plane_ref *)b->planes.items)[faces[f].face])->normal);
            const shape_corner *corners = b->shape.corners.items;
            for (size_t c = 0; c < b->shape.corners.count && pass == 1; ++c)
                for (uint32_t w = 0; w < g->way_count; ++w) reach(&g->ways[w], corners[c].position);
        }
    return RESULT_OK;
}

static void tell_none(const slab_build *b, uint32_t entity)
{
    const compile_entity *e = &b->in->entities[entity];
    report_warning(b->report, b->in->path, e->line,
                   "this %s is too slanted or too far out to be halved exactly: it makes no portal; straighten it or take a coarser grid", e->class_name);
}


// Several ways as thin: which of them parts anything, the zones will tell. None, where a thinner one is lost: it was meant.
static result add_group(slab_build *b, uint32_t entity, uint32_t is_door, uint32_t first, uint32_t count)
{
    slab_group g = {.entity = entity, .is_door = is_door, .lost = INFINITY};
    const result r = reach_brushes(b, &g, first, count);
    if (r != RESULT_OK) return r;
    const size_t before = b->groups.count;
    const uint32_t ways = round_ways(b, &g) ? g.way_count : 0;
    for (g.thin = 0; g.thin < ways; ++g.thin) {
        if (!is_thinnest(&g, g.thin) || thickness(&g.ways[g.thin]) > g.lost + SAME_THICKNESS) continue;
        if (!buffer_append(&b->groups, &g, 1)) return RESULT_NO_MEMORY;
    }
    if (b->groups.count == before) tell_none(b, entity);
    return RESULT_OK;
}

static int makes_something(const compile_input *in, const compile_entity *e)
{
    for (uint32_t i = 0; i < e->brush_count; ++i) {
        const compile_brush *b = &in->brushes[e->first_brush + i];
        for (uint32_t f = 0; f < b->face_count; ++f)
            if (in->faces[b->first_face + f].material != COMPILE_NOTHING) return 1;
    }
    return 0;
}

static result add_groups(slab_build *b, portal_choice choice)
{
    const compile_input *in = b->in;
    result r = RESULT_OK;
    for (uint32_t e = 0; e < in->entity_count && r == RESULT_OK; ++e) {
        const compile_entity *entity = &in->entities[e];
        for (uint32_t i = 0; i < entity->brush_count && r == RESULT_OK; ++i)
            if (in->brushes[entity->first_brush + i].role == BRUSH_PORTAL) r = add_group(b, e, 0, entity->first_brush + i, 1);
        if (r != RESULT_OK || (choice != PORTALS_DOORS && choice != PORTALS_AUTO) || strncmp(entity->class_name, "func_door", 9) != 0) continue;
        if (makes_something(in, entity)) r = add_group(b, e, 1, entity->first_brush, entity->brush_count);
    }
    return r;
}

// ---- Doors that touch and lie in one slab are one portal ----

static int touch(const slab_group *a, const slab_group *b)
{
    const way *thin = &a->ways[a->thin], *other = &b->ways[b->thin];
    if (!a->is_door || !b->is_door || memcmp(thin->normal, other->normal, sizeof(thin->normal)) != 0) return 0;
    if (thin->low >= other->high || other->low >= thin->high) return 0;
    for (uint32_t i = 0; i < a->way_count; ++i) // the axes are the first of both
        for (uint32_t k = 0; k < b->way_count; ++k)
            if (memcmp(a->ways[i].normal, b->ways[k].normal, sizeof(thin->normal)) == 0 &&
                (a->ways[i].low > b->ways[k].high || b->ways[k].low > a->ways[i].high))
                return 0;
    return 1;
}

static void join(slab_group *into, const slab_group *from)
{
    way thin = into->ways[into->thin];
    for (uint32_t i = 0; i < into->way_count;) { // only ways that both know
        const way *same = NULL;
        for (uint32_t k = 0; k < from->way_count; ++k)
            if (memcmp(from->ways[k].normal, into->ways[i].normal, sizeof(thin.normal)) == 0) same = &from->ways[k];
        if (!same) {
            into->ways[i] = into->ways[--into->way_count];
            continue;
        }
        if (same->low < into->ways[i].low) into->ways[i].low = same->low;
        if (same->high > into->ways[i].high) into->ways[i].high = same->high;
        into->ways[i].is_face &= same->is_face;
        ++i;
    }
    const way *again = find_way(into, thin.normal);
    into->thin = (uint32_t)(again - into->ways);
}

static void join_doors(slab_build *b)
{
    slab_group *g = b->groups.items;
    for (size_t i = 0; i < b->groups.count; ++i)
        for (size_t k = i + 1; k < b->groups.count;) {
            if (!touch(&g[i], &g[k])) {
                ++k;
                continue;
            }
            join(&g[i], &g[k]);
            memmove(&g[k], &g[k + 1], (b->groups.count - k - 1) * sizeof(*g));
            b->groups.count--;
            k = i + 1; // it has grown
        }
}

// ---- Planes ----

static plane_ref side_plane(slab_build *b, const int64_t normal[3], int sign, int64_t reach_at)
{
    cull_wide_plane p = {{sign * normal[0], sign * normal[1], sign * normal[2]}, cull_wide_from(-sign * reach_at)};
    return plane_table_add(b->in->planes, &p);
}

static int64_t margin_of(const slab_build *b, const slab_group *g, const way *w)
{
    if (!g->is_door) return 0;
    return (int64_t)ceil((w->is_face ? DOOR_MARGIN_UNITS : AXIS_MARGIN_UNITS) * b->unit * w->length);
}

static result add_sides(slab_build *b, const slab_group *g, const way *w)
{
    for (int sign = 1; sign >= -1; sign -= 2) {
        const int64_t at = sign > 0 ? w->high + margin_of(b, g, w) : w->low - margin_of(b, g, w);
        const plane_ref side = side_plane(b, w->normal, sign, at);
        if (side == PLANE_NONE || !buffer_append(&b->out->sides, &side, 1)) return RESULT_NO_MEMORY;
    }
    return RESULT_OK;
}

static const int64_t NORMAL_MOST = (int64_t)1 << 48; // twice a normal has to stay within the predicates' 50 bits

static result add_slab(slab_build *b, const slab_group *g)
{
    const way *thin = &g->ways[g->thin];
    int main_axis = 0;
    for (int k = 0; k < 3; ++k) {
        if (llabs(thin->normal[k]) > NORMAL_MOST) {
            tell_none(b, g->entity);
            return RESULT_OK;
        }
        if (llabs(thin->normal[k]) > llabs(thin->normal[main_axis])) main_axis = k;
    }
    cull_wide_plane middle = {{2 * thin->normal[0], 2 * thin->normal[1], 2 * thin->normal[2]}, cull_wide_from(-(thin->low + thin->high))};
    portal_slab slab = {plane_table_add(b->in->planes, &middle), (uint32_t)b->out->sides.count, 0, g->entity, g->is_door};
    if (slab.plane == PLANE_NONE) return RESULT_NO_MEMORY;
    result r = add_sides(b, g, &g->ways[(main_axis + 1) % 3]);
    if (r == RESULT_OK) r = add_sides(b, g, &g->ways[(main_axis + 2) % 3]);
    for (uint32_t i = 3; i < g->way_count && r == RESULT_OK; ++i)
        if (i != g->thin) r = add_sides(b, g, &g->ways[i]);
    slab.side_count = (uint32_t)b->out->sides.count - slab.first_side;
    if (r == RESULT_OK && !buffer_append(&b->out->slabs, &slab, 1)) r = RESULT_NO_MEMORY;
    return r;
}

result slab_set_make(const compile_input *in, portal_choice choice, report *r, const allocator *memory, slab_set *out)
{
    slab_set set = {buffer_make(memory, sizeof(portal_slab)), buffer_make(memory, sizeof(plane_ref))};
    *out = set;
    if (choice == PORTALS_NONE) return RESULT_OK;
    slab_build b = {.in = in,
                    .report = r,
                    .out = out,
                    .shape = brush_shape_make(memory),
                    .planes = buffer_make(memory, sizeof(plane_ref)),
                    .groups = buffer_make(memory, sizeof(slab_group)),
                    .unit = in->steps_per_metre / UNITS_A_METRE};
    result made = brush_shape_cube(in->planes, b.cube) ? add_groups(&b, choice) : RESULT_NO_MEMORY;
    if (made == RESULT_OK) join_doors(&b);
    for (size_t i = 0; i < b.groups.count && made == RESULT_OK; ++i) made = add_slab(&b, (slab_group *)b.groups.items + i);
    brush_shape_free(&b.shape);
    buffer_free(&b.planes);
    buffer_free(&b.groups);
    if (made != RESULT_OK) slab_set_free(out);
    return made;
}

void slab_set_free(slab_set *s)
{
    buffer_free(&s->slabs);
    buffer_free(&s->sides);
}
