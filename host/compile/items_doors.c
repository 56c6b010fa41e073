// The doors that close a portal: its polygon parted among the opaque brushes of shut doors, exactly, so that two leaves that
// move apart close their own halves.
// SPDX-License-Identifier: MIT
// Invariant: what of a portal no leaf hides stays open for ever, or what is seen past the leaves would be lost: leaves with
// keyholes, leaves smaller than their opening. A portal is parted only where leaves hide all of it.
#include "items.h"

#include <math.h>
#include <string.h>

enum { PIECES_MOST = 8 }; // of one portal; flow pays for each
static const double WIDTH_LEAST_UNITS = 1.0 / 8; // of a piece: slivers are no portals

typedef struct cover {
    const item_job *job;
    portal_pieces *out;
    buffer rest, next; // plane_polygon: what no brush so far covers
    buffer signs;      // int8_t
    double min[3], max[3]; // of the portal, steps, with room to spare
    uint32_t door;
} cover;

static result take_portal(cover *c, const compiled_portal *from)
{
    const compile_mesh *m = c->job->zones->mesh;
    const compile_polygon q = {.plane = from->plane, .first_vertex = from->first_vertex, .vertex_count = from->vertex_count};
    plane_polygon shape = {from->plane, 0, 0};
    for (uint32_t i = 0; i < q.vertex_count; ++i) {
        if (item_goes_straight(c->job, &q, i)) continue;
        polygon_edge *e = buffer_push(&c->out->edges, 1);
        if (!e) return RESULT_NO_MEMORY;
        *e = (polygon_edge){.plane = m->edge_planes[q.first_vertex + i]};
        memcpy(e->start, m->vertices[m->loop[q.first_vertex + i]].position, sizeof e->start);
        for (int k = 0; k < 3; ++k) {
            c->min[k] = shape.count ? fmin(c->min[k], e->start[k] - 1) : e->start[k] - 1;
            c->max[k] = shape.count ? fmax(c->max[k], e->start[k] + 1) : e->start[k] + 1;
        }
        shape.count++;
    }
    const portal_piece_of_door whole = {shape, SCENE_NONE};
    return buffer_append(&c->rest, &shape, 1) && buffer_append(&c->out->pieces, &whole, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

static int is_near(const double min[3], const double max[3], const compile_brush *b)
{
    for (int k = 0; k < 3; ++k)
        if (b->min[k] > max[k] || b->max[k] < min[k]) return 0;
    return 1;
}

// Of a polygon in the plane of a face: inside, when the brush lies in front of the polygon.
static result side_of(cover *c, const plane_polygon *p, plane_ref by, polygon_place *out)
{
    c->signs.count = 0;
    int8_t *signs = buffer_push(&c->signs, p->count);
    if (!signs) return RESULT_NO_MEMORY;
    *out = p->plane == by ? POLYGON_FRONT : POLYGON_BEHIND;
    if (p->plane >> 1 == by >> 1) return RESULT_OK;
    *out = polygon_signs(c->job->in->planes, p->plane, (const polygon_edge *)c->out->edges.items + p->first, p->count, by, signs);
    return RESULT_OK;
}

// What of the polygon lies outside of the brush goes to `next`; *p becomes what lies inside, of count 0: nothing.
static result cut_by(cover *c, const compile_brush *b, plane_polygon *p)
{
    for (uint32_t f = b->first_face; f < b->first_face + b->face_count; ++f) {
        const plane_ref by = c->job->in->faces[f].plane;
        polygon_place place;
        if (side_of(c, p, by, &place) != RESULT_OK) return RESULT_NO_MEMORY;
        if (place == POLYGON_BEHIND) continue;
        plane_polygon behind = {.count = 0}, front = *p;
        if (place == POLYGON_ACROSS && !polygon_cut(c->job->in->planes, p, c->signs.items, by, &c->out->edges, (polygon_parts){&behind, &front}))
            return RESULT_NO_MEMORY;
        if (!buffer_append(&c->next, &front, 1)) return RESULT_NO_MEMORY;
        *p = behind;
        if (!p->count) return RESULT_OK;
    }
    return RESULT_OK;
}

// All of `rest`; what lies inside becomes pieces of the door, but for SCENE_NONE.
static result cut_rest(cover *c, const compile_brush *b, uint32_t door)
{
    c->next.count = 0;
    for (size_t i = 0; i < c->rest.count; ++i) {
        portal_piece_of_door inside = {((const plane_polygon *)c->rest.items)[i], door};
        if (cut_by(c, b, &inside.shape) != RESULT_OK) return RESULT_NO_MEMORY;
        if (door != SCENE_NONE && inside.shape.count && !buffer_append(&c->out->pieces, &inside, 1)) return RESULT_NO_MEMORY;
    }
    const buffer swap = c->rest;
    c->rest = c->next;
    c->next = swap;
    return RESULT_OK;
}

// ---- Leaves that hide what is behind them ----

static int is_window(const item_job *j, uint32_t face)
{
    const uint32_t material = j->in->faces[face].material;
    return material == COMPILE_NOTHING || (j->in->materials[material].flags & (MATERIAL_TRANSLUCENT | MATERIAL_CUT_OUT)) != 0;
}

static int has_window(const item_job *j, const compile_brush *b)
{
    for (uint32_t f = b->first_face; f < b->first_face + b->face_count; ++f)
        if (is_window(j, f)) return 1;
    return 0;
}

// Whether structure that nobody sees through lies against all of the face. Uses `rest`, which is given back as it was.
static result is_walled(cover *c, const compile_brush *leaf, const body_polygon *face, int *out)
{
    const double min[3] = {leaf->min[0], leaf->min[1], leaf->min[2]}, max[3] = {leaf->max[0], leaf->max[1], leaf->max[2]};
    const buffer kept = c->rest;
    const plane_polygon shape = {face->shape.plane, (uint32_t)c->out->edges.count, face->shape.count};
    const polygon_edge *edges = (const polygon_edge *)c->job->bodies.edges.items + face->shape.first;
    c->rest = buffer_make(c->job->memory, sizeof(plane_polygon));
    result done = buffer_append(&c->out->edges, edges, shape.count) && buffer_append(&c->rest, &shape, 1) ? RESULT_OK : RESULT_NO_MEMORY;
    int carved = 0;
    for (uint32_t b = 0; b < c->job->in->brush_count && done == RESULT_OK && c->rest.count && !carved; ++b) {
        const compile_brush *brush = &c->job->in->brushes[b];
        if (brush->role != BRUSH_STRUCTURE || !is_near(min, max, brush)) continue;
        carved = brush->kind == BRUSH_SUBTRACT;
        if (!carved && !has_window(c->job, brush)) done = cut_rest(c, brush, SCENE_NONE);
    }
    *out = !carved && !c->rest.count;
    buffer_free(&c->rest);
    c->rest = kept;
    return done;
}

// A line of sight enters a convex brush by one face and leaves it by another: one window alone shows nothing.
static result is_opaque(cover *c, uint32_t brush, int *out)
{
    const compile_brush *b = &c->job->in->brushes[brush];
    const brush_body *body = &c->job->bodies.of[brush];
    uint32_t windows = 0;
    result done = RESULT_OK;
    *out = 0;
    if (b->role != BRUSH_ENTITY || b->kind != BRUSH_ADD || !body->polygon_count) return RESULT_OK;
    for (uint32_t i = 0; i < body->polygon_count && done == RESULT_OK && windows < 2; ++i) {
        const body_polygon *face = (const body_polygon *)c->job->bodies.polygons.items + body->first_polygon + i;
        int walled = 1;
        if (is_window(c->job, face->face)) done = is_walled(c, b, face, &walled);
        windows += !walled;
    }
    *out = windows < 2;
    return done;
}

static result cover_by(cover *c, const compile_entity *door)
{
    result done = RESULT_OK;
    for (uint32_t b = door->first_brush; b < door->first_brush + door->brush_count && c->rest.count && done == RESULT_OK; ++b) {
        int opaque = 0;
        if (!is_near(c->min, c->max, &c->job->in->brushes[b])) continue;
        done = is_opaque(c, b, &opaque);
        if (done == RESULT_OK && opaque) done = cut_rest(c, &c->job->in->brushes[b], c->door);
    }
    return done;
}

// Its own door first, so that one leaf's portal is that leaf's.
static result cover_all(cover *c, uint32_t own)
{
    result done = RESULT_OK;
    for (uint32_t i = 0; i <= c->job->in->entity_count && done == RESULT_OK; ++i) {
        const uint32_t entity = i ? i - 1 : own;
        c->door = c->job->door_of[entity];
        if (c->door != SCENE_NONE && (!i || entity != own)) done = cover_by(c, &c->job->in->entities[entity]);
    }
    return done;
}

static int is_sliver(const cover *c, const plane_polygon *p)
{
    const polygon_edge *e = (const polygon_edge *)c->out->edges.items + p->first;
    double longest = 0;
    for (uint32_t i = 0; i < p->count; ++i) {
        const double *a = e[i].start, *b = e[i + 1 < p->count ? i + 1 : 0].start;
        longest = fmax(longest, sqrt((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]) + (b[2] - a[2]) * (b[2] - a[2])));
    }
    return polygon_area(e, p->count) < longest * WIDTH_LEAST_UNITS * c->job->in->steps_per_metre / ITEM_UNITS_PER_METRE;
}

// The pieces as they are, or the whole portal, with the one door that hides it, or with none.
static void choose_pieces(cover *c)
{
    portal_piece_of_door *all = c->out->pieces.items;
    const size_t count = c->out->pieces.count;
    int one_door = count > 1 && !c->rest.count, parted = one_door && count - 1 <= PIECES_MOST;
    for (size_t i = 1; i < count; ++i) {
        one_door &= all[i].door == all[1].door;
        parted &= !is_sliver(c, &all[i].shape);
    }
    if (one_door) all[0].door = all[1].door;
    if (one_door || !parted) {
        c->out->pieces.count = 1;
        return;
    }
    memmove(all, all + 1, (count - 1) * sizeof *all);
    c->out->pieces.count--;
}

result portal_pieces_make(const item_job *j, const compiled_portal *portal, portal_pieces *out)
{
    out->pieces.count = out->edges.count = 0;
    cover c = {.job = j, .out = out, .rest = buffer_make(j->memory, sizeof(plane_polygon)), .next = buffer_make(j->memory, sizeof(plane_polygon)),
               .signs = buffer_make(j->memory, sizeof(int8_t))};
    const int is_made = portal->entity == COMPILE_NOTHING;
    const uint32_t authored = j->in->portal_doors && !is_made ? j->in->portal_doors[portal->entity] : SCENE_NONE;
    result done = take_portal(&c, portal);
    if (done == RESULT_OK && authored != SCENE_NONE) ((portal_piece_of_door *)out->pieces.items)[0].door = authored;
    else if (done == RESULT_OK && !is_made && j->door_of[portal->entity] != SCENE_NONE) done = cover_all(&c, portal->entity);
    if (done == RESULT_OK) choose_pieces(&c);
    buffer *const all[] = {&c.rest, &c.next, &c.signs};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) buffer_free(all[i]);
    return done;
}
