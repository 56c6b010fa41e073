// Bodies taken out of bodies: what a carving brush leaves of the solids before it, as convex pieces.
// SPDX-License-Identifier: MIT
// Invariant: the pieces of a solid lie in it, touch each other at most, and together are all of it but what was taken. Where
// that would make too much of it the solid stays whole: no place that is solid ever counts as free.
#include "hull.h"
#include "scene_builder.h"

#include <string.h>

static const size_t SOLIDS_MOST = 1u << 20; // no more pieces are made then

typedef struct carving {
    scene_builder *b;
    buffer solids, planes;         // what the builder's become
    buffer work;                   // scene_solid_plane: of a piece
    const scene_solid_plane *body; // that is taken
    uint32_t body_planes;
    double min[3], max[3];
} carving;

static int boxes_overlap(const scene_solid *s, const carving *c)
{
    for (int k = 0; k < 3; ++k)
        if (s->max[k] <= c->min[k] || s->min[k] >= c->max[k]) return 0;
    return 1;
}

// Whether one of the planes has the whole box in front: the bodies are apart, without a look at their corners.
static int parts_box(const scene_solid_plane *planes, uint32_t plane_count, const double min[3], const double max[3])
{
    for (uint32_t i = 0; i < plane_count; ++i) {
        const double *n = planes[i].normal;
        double least = -planes[i].distance;
        for (int k = 0; k < 3; ++k) least += n[k] * (n[k] > 0 ? min[k] : max[k]);
        if (least >= 0) return 1;
    }
    return 0;
}

static int is_carved(const carving *c, const scene_solid *s)
{
    if (s->kind != SOLID_STRUCTURE || !boxes_overlap(s, c) || s->plane_count + c->body_planes > HULL_CUTS_MOST) return 0;
    const scene_solid_plane *planes = (const scene_solid_plane *)c->b->solid_planes.items + s->first_plane;
    return !parts_box(c->body, c->body_planes, s->min, s->max) && !parts_box(planes, s->plane_count, c->min, c->max);
}

static result keep(carving *c, const scene_solid *like, const scene_solid_plane *planes, uint32_t plane_count)
{
    scene_solid made = *like;
    made.first_plane = (uint32_t)c->planes.count;
    made.plane_count = plane_count;
    return buffer_append(&c->planes, planes, plane_count) && buffer_append(&c->solids, &made, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

static scene_solid_plane flipped(const scene_solid_plane *p)
{
    return (scene_solid_plane){{-p->normal[0], -p->normal[1], -p->normal[2]}, -p->distance};
}

static uint32_t keep_needed(scene_solid_plane *planes, uint32_t plane_count, const uint8_t *is_needed)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < plane_count; ++i)
        if (is_needed[i]) planes[kept++] = planes[i];
    return kept;
}

// Of the solid's planes and the body's, those that bound what they share: no other plane of the body parts the solid.
static uint32_t sharing_planes(carving *c, const scene_solid *s, scene_solid_plane *work, uint32_t *own)
{
    uint8_t is_needed[HULL_CUTS_MOST];
    double min[3] = {s->min[0], s->min[1], s->min[2]}, max[3] = {s->max[0], s->max[1], s->max[2]};
    if (hull_needed(work, s->plane_count + c->body_planes, is_needed, min, max)) return 0; // they share nothing
    *own = s->plane_count; // all of these bound the pieces
    return *own + keep_needed(work + *own, c->body_planes, is_needed + *own);
}

// Outside of the last plane, inside of the others, in the piece's box, which becomes its own. *kept planes bound it: they
// are moved to the front.
static int make_piece(scene_solid_plane *planes, uint32_t count, scene_solid *piece, uint32_t *kept)
{
    uint8_t is_needed[HULL_CUTS_MOST];
    planes[count - 1] = flipped(&planes[count - 1]);
    if (hull_needed(planes, count, is_needed, piece->min, piece->max)) return 0;
    *kept = keep_needed(planes, count, is_needed);
    return 1;
}

// A piece for each plane of the body that parts the solid: outside of it, inside of those before it.
static result carve(carving *c, const scene_solid *s, const scene_solid_plane *planes)
{
    const uint32_t most = s->plane_count + c->body_planes;
    c->work.count = 0;
    scene_solid_plane *work = buffer_push(&c->work, 2 * (size_t)most);
    if (!work) return RESULT_NO_MEMORY;
    memcpy(work, planes, s->plane_count * sizeof *work);
    memcpy(work + s->plane_count, c->body, c->body_planes * sizeof *work);
    uint32_t own = 0;
    const uint32_t count = sharing_planes(c, s, work, &own);
    if (count == 0) return keep(c, s, planes, s->plane_count);
    result done = RESULT_OK;
    for (uint32_t i = own; i < count && done == RESULT_OK; ++i) {
        scene_solid piece = *s;
        uint32_t kept;
        memcpy(work + most, work, (i + 1) * sizeof *work);
        if (make_piece(work + most, i + 1, &piece, &kept)) done = keep(c, &piece, work + most, kept);
    }
    return done;
}

static result carve_all(carving *c)
{
    const scene_solid *solids = c->b->solids.items;
    const scene_solid_plane *planes = c->b->solid_planes.items;
    result done = RESULT_OK;
    for (size_t i = 0; i < c->b->solids.count && done == RESULT_OK; ++i) {
        const scene_solid *s = &solids[i];
        if (is_carved(c, s) && c->solids.count < SOLIDS_MOST) done = carve(c, s, planes + s->first_plane);
        else done = keep(c, s, planes + s->first_plane, s->plane_count);
    }
    return done;
}

static int carves_any(const carving *c)
{
    const scene_solid *solids = c->b->solids.items;
    for (size_t i = 0; i < c->b->solids.count; ++i)
        if (is_carved(c, &solids[i])) return 1;
    return 0;
}

static void swap_buffers(buffer *a, buffer *b)
{
    const buffer c = *a;
    *a = *b;
    *b = c;
}

result scene_builder_solid_subtract(scene_builder *b, const scene_solid_plane *planes, uint32_t plane_count)
{
    carving c = {.b = b, .body_planes = plane_count};
    scene_solid_plane *body = plane_count && plane_count < HULL_CUTS_MOST ? memory_alloc(b->memory, plane_count, sizeof *body) : NULL;
    if (!body) return plane_count && plane_count < HULL_CUTS_MOST ? RESULT_NO_MEMORY : RESULT_OK;
    for (uint32_t i = 0; i < plane_count; ++i) body[i] = builder_plane(b, &planes[i]);
    c.body = body;
    c.solids = buffer_make(b->memory, sizeof(scene_solid));
    c.planes = buffer_make(b->memory, sizeof(scene_solid_plane));
    c.work = buffer_make(b->memory, sizeof(scene_solid_plane));
    result done = RESULT_OK;
    if (!hull_fault(body, plane_count, c.min, c.max) && carves_any(&c)) {
        done = carve_all(&c);
        if (done == RESULT_OK) {
            swap_buffers(&b->solids, &c.solids);
            swap_buffers(&b->solid_planes, &c.planes);
        }
    }
    buffer_free(&c.solids);
    buffer_free(&c.planes);
    buffer_free(&c.work);
    memory_free(b->memory, body, plane_count, sizeof *body);
    return done;
}
