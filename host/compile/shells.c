// The faces round each segment in exact radial order, neighbours joined by union-find.
// SPDX-License-Identifier: MIT
#include "shells.h"

#include <assert.h>

#define NO_FACE UINT32_MAX

typedef struct spoke { // a polygon at a segment
    uint32_t polygon;
    int along;                // 1: its edge runs along the line's direction, -1: against it
    cull_wide_plane outward;  // normal times `along`: all spokes' normals are turned from their polygons alike
} spoke;

typedef struct shell_build {
    const line_set *l;
    shell_set *out;
    uint32_t *parent;
    buffer starts, covering; // of one line: the edges over each segment
    buffer spokes;
} shell_build;

static uint32_t root_of(uint32_t *parent, uint32_t f)
{
    while (parent[f] != f) f = parent[f] = parent[parent[f]];
    return f;
}

static result join(shell_build *b, uint32_t one, uint32_t two, const surface_line *line, uint32_t segment)
{
    const uint32_t *v = (const uint32_t *)b->l->vertices.items + line->first_vertex + segment;
    const face_pair pair = {one, two, v[0], v[1]};
    const uint32_t p = root_of(b->parent, one), q = root_of(b->parent, two);
    if (p < q) b->parent[q] = p;
    else b->parent[p] = q;
    return buffer_append(&b->out->pairs, &pair, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

// ---- Radial order ----

// Quarters and their borders, counterclockwise from the first spoke: 0 at it, 1 before the half turn, 2 at it, 3 after.
static int turn_class(const spoke *first, const spoke *s, const cull_wide_vector *line)
{
    const int turn = cull_normals_turn(&first->outward, &s->outward, line);
    if (turn) return turn > 0 ? 1 : 3;
    return cull_normals_dot_sign(&first->outward, &s->outward) > 0 ? 0 : 2;
}

// Of two in one place: the two sides of a wall without thickness have the solid between them; a sheet lies in the air of
// a wall; of two sheets the one of the lower number lies on the side of the plane's canonical normal, at every segment.
static int comes_first(const shell_build *b, const spoke *one, const spoke *two)
{
    const surface_polygon *p = surface_polygon_at(b->l->s, one->polygon), *q = surface_polygon_at(b->l->s, two->polygon);
    const int p_sheet = surface_is_two_sided(p->kind), q_sheet = surface_is_two_sided(q->kind);
    if (!p_sheet && !q_sheet) return one->along < two->along;
    if (p_sheet != q_sheet) return p_sheet ? two->along < 0 : one->along > 0;
    const int towards_normal = one->along * plane_ref_sign(p->plane) > 0; // counterclockwise
    return (one->polygon > two->polygon) == towards_normal;
}

static int is_before(const shell_build *build, const spoke *first, const spoke *a, const spoke *b, const cull_wide_vector *line)
{
    const int in_a = turn_class(first, a, line), in_b = turn_class(first, b, line);
    if (in_a != in_b) return in_a < in_b;
    const int turn = in_a & 1 ? cull_normals_turn(&a->outward, &b->outward, line) : 0;
    return turn ? turn > 0 : comes_first(build, a, b);
}

static void sort_spokes(const shell_build *b, spoke *s, size_t count, const cull_wide_vector *line)
{
    const spoke first = s[0];
    for (size_t i = 1; i < count; ++i) {
        const spoke moved = s[i];
        size_t at = i;
        for (; at > 0 && is_before(b, &first, &moved, &s[at - 1], line); --at) s[at] = s[at - 1];
        s[at] = moved;
    }
}

// ---- Faces that look into a wedge ----

static surface_kind kind_of(const shell_build *b, uint32_t polygon)
{
    return surface_polygon_at(b->l->s, polygon)->kind;
}

// The face that looks counterclockwise (or clockwise) from the spoke.
static uint32_t face_towards(const shell_build *b, const spoke *s, int counterclockwise)
{
    if (s->along == counterclockwise) return 2 * s->polygon;
    return surface_is_two_sided(kind_of(b, s->polygon)) ? 2 * s->polygon + 1 : NO_FACE;
}

static result join_round(shell_build *b, const surface_line *line, uint32_t segment)
{
    spoke *s = b->spokes.items;
    const size_t count = b->spokes.count;
    const cull_wide_vector *direction = &((line_direction *)b->l->directions.items)[line->direction].exact;
    if (count > 2) sort_spokes(b, s, count, direction);
    for (size_t i = 0; i < count; ++i) {
        const uint32_t one = face_towards(b, &s[i], 1), two = face_towards(b, &s[i + 1 < count ? i + 1 : 0], -1);
        if (one != NO_FACE && two != NO_FACE) {
            const result r = join(b, one, two, line, segment);
            if (r != RESULT_OK) return r;
        } else if (one != two) {
            b->out->open_segments++;
        }
    }
    return RESULT_OK;
}

static result gather_spokes(shell_build *b, const uint32_t *edges, uint32_t count)
{
    b->spokes.count = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const line_edge *e = (line_edge *)b->l->edges.items + edges[i];
        const surface_polygon *p = surface_polygon_at(b->l->s, e->polygon);
        if (p->kind == SURFACE_LIQUID) continue;
        spoke made = {.polygon = e->polygon, .along = e->from < e->to ? 1 : -1};
        made.outward = plane_table_get(b->l->s->planes, p->plane);
        if (made.along < 0) made.outward = cull_wide_plane_flipped(made.outward);
        if (!buffer_append(&b->spokes, &made, 1)) return RESULT_NO_MEMORY;
    }
    return RESULT_OK;
}

// ---- Segments of a line ----

static void edge_range(const shell_build *b, uint32_t edge, uint32_t *low, uint32_t *high)
{
    const line_edge *e = (line_edge *)b->l->edges.items + edge;
    assert(e->from != e->to);
    *low = e->from < e->to ? e->from : e->to;
    *high = e->from < e->to ? e->to : e->from;
}

// The edges over each segment, by counting.
static result cover_segments(shell_build *b, const surface_line *line)
{
    b->starts.count = b->covering.count = 0;
    uint32_t *starts = buffer_push(&b->starts, line->vertex_count + 1);
    if (!starts) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i <= line->vertex_count; ++i) starts[i] = 0;
    uint32_t low, high, total = 0;
    for (uint32_t i = 0; i < line->edge_count; ++i) {
        edge_range(b, line->first_edge + i, &low, &high);
        for (uint32_t k = low; k < high; ++k) starts[k + 1]++;
        total += high - low;
    }
    for (uint32_t i = 0; i < line->vertex_count; ++i) starts[i + 1] += starts[i];
    uint32_t *covering = buffer_push(&b->covering, total);
    if (!covering) return RESULT_NO_MEMORY;
    for (uint32_t i = line->edge_count; i-- > 0;) {
        edge_range(b, line->first_edge + i, &low, &high);
        for (uint32_t k = low; k < high; ++k) covering[--starts[k + 1]] = line->first_edge + i;
    }
    return RESULT_OK; // now starts[k + 1] is where segment k begins
}

static result trace_line(shell_build *b, const surface_line *line)
{
    result r = cover_segments(b, line);
    for (uint32_t k = 0; k + 1 < line->vertex_count && r == RESULT_OK; ++k) {
        const uint32_t *starts = b->starts.items;
        const uint32_t first = starts[k + 1], end = k + 2 < line->vertex_count ? starts[k + 2] : (uint32_t)b->covering.count;
        r = gather_spokes(b, (const uint32_t *)b->covering.items + first, end - first);
        if (r == RESULT_OK && b->spokes.count) r = join_round(b, line, k);
    }
    return r;
}

// Numbers in the order of the shells' first faces.
static void number_shells(shell_build *b)
{
    shell_set *out = b->out;
    for (uint32_t f = 0; f < out->face_count; ++f) {
        const surface_kind kind = kind_of(b, f >> 1);
        if (kind == SURFACE_LIQUID || (kind == SURFACE_WALL && (f & 1))) {
            out->shell_of[f] = SHELL_NONE;
            continue;
        }
        const uint32_t root = root_of(b->parent, f); // the least of its faces: numbered before the others
        out->shell_of[f] = root == f ? out->shell_count++ : out->shell_of[root];
    }
}

result shell_set_make(const line_set *l, const allocator *memory, shell_set *out)
{
    shell_set s = {.memory = memory, .face_count = 2 * surface_polygon_count(l->s), .pairs = buffer_make(memory, sizeof(face_pair))};
    shell_build b = {.l = l,
                     .out = &s,
                     .parent = memory_alloc(memory, s.face_count, sizeof(uint32_t)),
                     .starts = buffer_make(memory, sizeof(uint32_t)),
                     .covering = buffer_make(memory, sizeof(uint32_t)),
                     .spokes = buffer_make(memory, sizeof(spoke))};
    s.shell_of = memory_alloc(memory, s.face_count, sizeof(uint32_t));
    result r = b.parent && s.shell_of ? RESULT_OK : RESULT_NO_MEMORY;
    for (uint32_t f = 0; f < s.face_count && r == RESULT_OK; ++f) b.parent[f] = f;
    for (uint32_t i = 0; i < l->lines.count && r == RESULT_OK; ++i) r = trace_line(&b, (surface_line *)l->lines.items + i);
    if (r == RESULT_OK) number_shells(&b);
    memory_free(memory, b.parent, s.face_count, sizeof(uint32_t));
    buffer_free(&b.starts);
    buffer_free(&b.covering);
    buffer_free(&b.spokes);
    if (r == RESULT_OK) *out = s;
    else shell_set_free(&s);
    return r;
}

void shell_set_free(shell_set *s)
{
    memory_free(s->memory, s->shell_of, s->face_count, sizeof(uint32_t));
    buffer_free(&s->pairs);
}
