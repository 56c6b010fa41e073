// Meetings of brushes: see input_meet.h. A corner meets a face when it lies within the weld of it; so do both ends of an edge
// that runs along a face and beyond it.
// SPDX-License-Identifier: MIT
#include "input_meet.h"

#include "../core/box_tree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MEETINGS_MOST = 1 << 21 }; // more is no level

typedef struct corner_pair { uint32_t a, b; } corner_pair;

meeting_set meeting_set_make(input_draft *d)
{
    const allocator *memory = d->faces.memory;
    return (meeting_set){.draft = d,
                         .corners = buffer_make(memory, sizeof(brush_corner)),
                         .first = buffer_make(memory, sizeof(uint32_t)),
                         .edges = buffer_make(memory, sizeof(corner_pair)),
                         .first_edge = buffer_make(memory, sizeof(uint32_t)),
                         .meetings = buffer_make(memory, sizeof(brush_meeting)),
                         .is_movable = buffer_make(memory, sizeof(uint8_t)),
                         .boxes = buffer_make(memory, sizeof(tree_box))};
}

void meeting_set_free(meeting_set *m)
{
    buffer *const all[] = {&m->corners, &m->first, &m->edges, &m->first_edge, &m->meetings, &m->is_movable, &m->boxes};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) buffer_free(all[i]);
}

int meeting_set_may_move(const meeting_set *m, uint32_t plane)
{
    return plane < m->is_movable.count && ((const uint8_t *)m->is_movable.items)[plane];
}

double plane_height(const plane_table *t, plane_ref plane, const double p[3])
{
    const cull_row *row = plane_table_row(t, plane);
    const double length = sqrt(row->n[0] * row->n[0] + row->n[1] * row->n[1] + row->n[2] * row->n[2]);
    return plane_ref_sign(plane) * (row->n[0] * p[0] + row->n[1] * p[1] + row->n[2] * p[2] + row->offset) / length;
}

// ---- What there is ----

static int is_welded(const compile_brush *b)
{
    return b->role == BRUSH_STRUCTURE || b->role == BRUSH_LIQUID;
}

static result find_movable(meeting_set *m, uint32_t *count)
{
    const input_draft *d = m->draft;
    const uint32_t planes = plane_table_count(d->in->planes);
    const compile_face *faces = d->faces.items;
    m->is_movable.count = 0;
    *count = 0;
    uint8_t *movable = buffer_push(&m->is_movable, planes);
    if (!movable) return RESULT_NO_MEMORY;
    memset(movable, 1, planes);
    for (size_t f = 0; f < d->faces.count; ++f)
        if (!faces[f].is_rounded) movable[faces[f].plane >> 1] = 0;
    for (size_t f = 0; f < d->faces.count; ++f) *count += movable[faces[f].plane >> 1];
    return RESULT_OK;
}

// A corner is listed by each of its faces; here once a brush.
static uint32_t corner_number(const meeting_set *m, uint32_t first, const shape_corner *c)
{
    const brush_corner *have = m->corners.items;
    uint32_t at = first;
    for (; at < m->corners.count; ++at) {
        int same = 1;
        for (int k = 0; k < 3 && same; ++k)
            same = fabs(have[at].position[k] - c->position[k]) < 1e-4 && plane_table_side(m->draft->in->planes, c->planes, have[at].planes[k]) == 0;
        if (same) break;
    }
    return at;
}

static result take_shape(meeting_set *m, uint32_t brush)
{
    const brush_shape *s = &m->draft->shape;
    const shape_corner *c = s->corners.items;
    const shape_face *faces = s->faces.items;
    const uint32_t first = (uint32_t)m->corners.count;
    for (size_t f = 0; f < s->faces.count; ++f) {
        uint32_t before = UINT32_MAX, start = UINT32_MAX;
        for (uint32_t i = 0; i <= faces[f].corner_count; ++i) {
            const shape_corner *at = &c[faces[f].first_corner + i % faces[f].corner_count];
            const uint32_t number = i < faces[f].corner_count ? corner_number(m, first, at) : start;
            const brush_corner made = {{at->planes[0], at->planes[1], at->planes[2]}, {at->position[0], at->position[1], at->position[2]}, brush};
            if (number == m->corners.count && !buffer_append(&m->corners, &made, 1)) return RESULT_NO_MEMORY;
            const corner_pair edge = {before, number};
            if (before < number && before != UINT32_MAX && !buffer_append(&m->edges, &edge, 1)) return RESULT_NO_MEMORY; // once of its two faces
            if (i == 0) start = number;
            before = number;
        }
    }
    return RESULT_OK;
}

static result take_brushes(meeting_set *m)
{
    input_draft *d = m->draft;
    const compile_brush *brushes = d->brushes.items;
    const uint32_t count = (uint32_t)d->brushes.count;
    m->corners.count = m->first.count = m->edges.count = m->first_edge.count = m->boxes.count = 0;
    uint32_t *first = buffer_push(&m->first, (size_t)count + 1), *first_edge = buffer_push(&m->first_edge, (size_t)count + 1);
    tree_box *boxes = buffer_push(&m->boxes, count);
    if (!first || !first_edge || !boxes) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < count; ++i) {
        first[i] = (uint32_t)m->corners.count;
        first_edge[i] = (uint32_t)m->edges.count;
        for (int k = 0; k < 3; ++k) {
            boxes[i].min[k] = brushes[i].min[k] - d->weld;
            boxes[i].max[k] = brushes[i].max[k] + d->weld;
        }
        if (!is_welded(&brushes[i])) continue;
        result done = input_cut_brush(d, i);
        if (done == RESULT_OK) done = take_shape(m, i);
        if (done != RESULT_OK) return done;
    }
    first[count] = (uint32_t)m->corners.count;
    first_edge[count] = (uint32_t)m->edges.count;
    return RESULT_OK;
}

// ---- What meets ----

static result add_meeting(meeting_set *m, uint32_t corner, plane_ref plane)
{
    const plane_table *t = m->draft->in->planes;
    const brush_corner *c = (const brush_corner *)m->corners.items + corner;
    for (int k = 0; k < 3; ++k)
        if (c->planes[k] >> 1 == plane >> 1) return RESULT_OK;
    const brush_meeting made = {corner, plane >> 1, plane_table_side_at(t, c->planes, c->position, plane) != 0};
    return buffer_append(&m->meetings, &made, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

// The part of the edge that lies within the weld of the brush, as two points of it; 0: there is none.
static int clip_edge(const meeting_set *m, const double a[3], const double b[3], const compile_brush *brush)
{
    const compile_face *faces = (const compile_face *)m->draft->faces.items + brush->first_face;
    double low = 0, high = 1;
    for (uint32_t f = 0; f < brush->face_count; ++f) {
        const double start = plane_height(m->draft->in->planes, faces[f].plane, a) - m->draft->weld;
        const double end = plane_height(m->draft->in->planes, faces[f].plane, b) - m->draft->weld;
        if (start > 0 && end > 0) return 0;
        if (start > 0) low = fmax(low, start / (start - end));
        else if (end > 0) high = fmin(high, start / (start - end));
    }
    return low <= high;
}

static result meet_edge(meeting_set *m, const corner_pair *edge, const compile_brush *other)
{
    const double *a = ((const brush_corner *)m->corners.items)[edge->a].position, *b = ((const brush_corner *)m->corners.items)[edge->b].position;
    if (!clip_edge(m, a, b, other)) return RESULT_OK;
    for (uint32_t f = 0; f < other->face_count; ++f) {
        const plane_ref plane = ((const compile_face *)m->draft->faces.items)[other->first_face + f].plane;
        if (fabs(plane_height(m->draft->in->planes, plane, a)) > m->draft->weld) continue;
        if (fabs(plane_height(m->draft->in->planes, plane, b)) > m->draft->weld) continue;
        result done = add_meeting(m, edge->a, plane);
        if (done == RESULT_OK) done = add_meeting(m, edge->b, plane);
        if (done != RESULT_OK) return done;
    }
    return RESULT_OK;
}

static result meet_corner(meeting_set *m, uint32_t corner, const compile_brush *other)
{
    const double *p = ((const brush_corner *)m->corners.items)[corner].position;
    const compile_face *faces = (const compile_face *)m->draft->faces.items + other->first_face;
    for (uint32_t f = 0; f < other->face_count; ++f)
        if (plane_height(m->draft->in->planes, faces[f].plane, p) > m->draft->weld) return RESULT_OK;
    for (uint32_t f = 0; f < other->face_count; ++f) {
        if (plane_height(m->draft->in->planes, faces[f].plane, p) < -m->draft->weld) continue;
        const result done = add_meeting(m, corner, faces[f].plane);
        if (done != RESULT_OK) return done;
    }
    return RESULT_OK;
}

static int is_in_box(const double p[3], const tree_box *box)
{
    for (int k = 0; k < 3; ++k)
        if (p[k] < box->min[k] || p[k] > box->max[k]) return 0;
    return 1;
}

static int spans_apart(const double a[3], const double b[3], const tree_box *box)
{
    for (int k = 0; k < 3; ++k)
        if ((a[k] < box->min[k] && b[k] < box->min[k]) || (a[k] > box->max[k] && b[k] > box->max[k])) return 1;
    return 0;
}

static result meet(meeting_set *m, uint32_t one, uint32_t other)
{
    const compile_brush *brush = (const compile_brush *)m->draft->brushes.items + other;
    const uint32_t *first = m->first.items, *first_edge = m->first_edge.items;
    const tree_box *box = (const tree_box *)m->boxes.items + other;
    const brush_corner *c = m->corners.items;
    result done = RESULT_OK;
    for (uint32_t i = first[one]; i < first[one + 1] && done == RESULT_OK; ++i)
        if (is_in_box(c[i].position, box)) done = meet_corner(m, i, brush);
    for (uint32_t i = first_edge[one]; i < first_edge[one + 1] && done == RESULT_OK; ++i) {
        const corner_pair *edge = (const corner_pair *)m->edges.items + i;
        if (is_in_box(c[edge->a].position, box) && is_in_box(c[edge->b].position, box)) continue; // as corners
        if (!spans_apart(c[edge->a].position, c[edge->b].position, box)) done = meet_edge(m, edge, brush);
    }
    return done;
}

static int has_movable(const meeting_set *m, const compile_brush *b)
{
    const compile_face *faces = (const compile_face *)m->draft->faces.items + b->first_face;
    for (uint32_t f = 0; f < b->face_count; ++f)
        if (meeting_set_may_move(m, faces[f].plane >> 1)) return 1;
    return 0;
}

static result meet_all(meeting_set *m)
{
    const compile_brush *brushes = m->draft->brushes.items;
    const uint32_t count = (uint32_t)m->draft->brushes.count;
    box_tree tree;
    result done = box_tree_open(m->boxes.items, count, m->boxes.memory, &tree);
    if (done != RESULT_OK) return done;
    for (uint32_t i = 0; i < count && done == RESULT_OK; ++i) {
        if (!is_welded(&brushes[i])) continue;
        const int moves = has_movable(m, &brushes[i]);
        box_walk walk;
        uint32_t other;
        box_walk_start(&walk, &tree, (const tree_box *)m->boxes.items + i);
        while (done == RESULT_OK && m->meetings.count < MEETINGS_MOST && box_walk_next(&walk, &other))
            if (other != i && is_welded(&brushes[other]) && (moves || has_movable(m, &brushes[other]))) done = meet(m, i, other);
    }
    box_tree_close(&tree, m->boxes.memory);
    return done;
}

static int compare_meetings(const void *left, const void *right)
{
    const brush_meeting *a = left, *b = right;
    if (a->plane != b->plane) return a->plane < b->plane ? -1 : 1;
    return a->corner < b->corner ? -1 : a->corner > b->corner;
}

result meeting_set_find(meeting_set *m, uint32_t *apart)
{
    uint32_t movable;
    *apart = 0;
    m->meetings.count = 0;
    result done = find_movable(m, &movable);
    if (done != RESULT_OK || movable == 0) return done;
    done = take_brushes(m);
    if (done == RESULT_OK) done = meet_all(m);
    if (done != RESULT_OK || m->meetings.count == 0) return done;
    if (m->meetings.count >= MEETINGS_MOST) {
        report_warning(m->draft->report, m->draft->path, 0, "over %d corners at faces of other brushes; none is welded to them", MEETINGS_MOST);
        return RESULT_OK;
    }
    brush_meeting *all = m->meetings.items;
    qsort(all, m->meetings.count, sizeof *all, compare_meetings);
    size_t kept = 0;
    for (size_t i = 0; i < m->meetings.count; ++i)
        if (i == 0 || compare_meetings(&all[i], &all[kept - 1]) != 0) all[kept++] = all[i];
    m->meetings.count = kept;
    for (size_t i = 0; i < kept; ++i) *apart += all[i].is_apart;
    return RESULT_OK;
}
