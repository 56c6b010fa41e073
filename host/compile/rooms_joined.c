// Portals of links: faces plane by plane into hulls. See rooms_joined.h.
// SPDX-License-Identifier: MIT
#include "rooms_joined.h"

#include <stdlib.h>

typedef struct plane_face { uint32_t plane, face; } plane_face;

link_joiner link_joiner_make(const cell_set *cells, const cell_input *from, const uint32_t *door_portals, const allocator *memory)
{
    return (link_joiner){cells, from->planes, from->doors, door_portals, flat_hulls_make(memory), buffer_make(memory, sizeof(plane_face))};
}

uint32_t link_plane_of(const cell_face *f, const cell_door *doors)
{
    return f->door == CELL_NO_DOOR ? f->shape.plane >> 1 : LINK_DOOR | doors[f->door].group;
}

void link_joiner_free(link_joiner *j)
{
    flat_hulls_free(&j->hulls);
    buffer_free(&j->faces);
}

static int by_plane(const void *a, const void *b)
{
    const plane_face *x = a, *y = b;
    if (x->plane != y->plane) return x->plane < y->plane ? -1 : 1;
    return (x->face > y->face) - (x->face < y->face);
}

static const cell_face *face_at(const link_joiner *j, uint32_t face)
{
    return (const cell_face *)j->cells->faces.items + face;
}

static result take_faces(const link_set *s, const room_link *l, link_joiner *j)
{
    j->faces.count = 0;
    for (uint32_t f = l->first_face; f != LINK_NO_FACE; f = s->next_face[f]) {
        const plane_face made = {link_plane_of(face_at(j, f), j->doors), f};
        if (!buffer_append(&j->faces, &made, 1)) return RESULT_NO_MEMORY;
    }
    qsort(j->faces.items, j->faces.count, sizeof(plane_face), by_plane);
    return RESULT_OK;
}

static result take_polygon(link_joiner *j, const cell_face *f)
{
    const polygon_edge *edges = (const polygon_edge *)j->cells->edges.items + f->shape.first;
    result r = RESULT_OK;
    for (uint32_t i = 0; i < f->shape.count && r == RESULT_OK; ++i) r = flat_hulls_corner(&j->hulls, edges[i].start);
    return r == RESULT_OK ? flat_hulls_close(&j->hulls) : r;
}

static result count_portals(const link_set *s, room_link *l, link_joiner *j)
{
    result r = take_faces(s, l, j);
    const plane_face *all = j->faces.items;
    uint32_t sum = 0;
    for (size_t i = 0, end; i < j->faces.count && r == RESULT_OK; i = end) {
        uint32_t left = 0;
        if (all[i].plane & LINK_DOOR) {
            for (end = i; end < j->faces.count && all[end].plane == all[i].plane;) ++end;
            sum += j->door_portals[all[i].plane & ~LINK_DOOR];
            continue;
        }
        flat_hulls_start(&j->hulls, j->planes, all[i].plane << 1);
        for (end = i; end < j->faces.count && all[end].plane == all[i].plane && r == RESULT_OK; ++end) r = take_polygon(j, face_at(j, all[end].face));
        if (r == RESULT_OK) r = flat_hulls_join(&j->hulls, &left);
        sum += left;
    }
    if (r == RESULT_OK) l->portals = sum;
    return r;
}

result links_portals(link_set *s, link_joiner *j, uint32_t *total)
{
    result r = RESULT_OK;
    *total = 0;
    for (uint32_t i = 0; i < link_count(s) && r == RESULT_OK; ++i) {
        room_link *l = link_at(s, i);
        if (l->is_gone) continue;
        if (l->portals == LINK_UNKNOWN) r = count_portals(s, l, j);
        *total += l->portals;
    }
    return r;
}
