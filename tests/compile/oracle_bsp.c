// Cells are lists of faces; a cell is cut by a plane of a brush until it lies inside or outside of every brush.
// SPDX-License-Identifier: MIT
#include "oracle_bsp.h"

#include "host/compile/brush_shape.h"
#include "host/compile/surface.h"

#include <math.h>
#include <stdlib.h>

#define MUST(x)        \
    do {               \
        if (!(x)) abort(); \
    } while (0)

typedef struct node { plane_ref plane; uint32_t child[2]; } node; // child: node, or CELL | cell
#define CELL 0x80000000u
typedef struct cell { uint32_t *faces, face_count, region, is_air, is_border; } cell;
typedef struct facet { plane_ref plane; uint32_t polygon, cell; } facet;

typedef struct bsp {
    const compile_input *in;
    surface s;
    plane_ref cube[6];
    buffer nodes, cells; // node, cell
} bsp;

typedef struct work { // a cell to be
    uint32_t *faces, face_count;
    uint32_t *brushes, brush_count; // that may reach into it, in file order
    int32_t inside;                 // the last brush that it is all inside of, or -1
} work;

static void *grown(void *old, size_t count, size_t size)
{
    void *p = realloc(old, (count ? count : 1) * size);
    MUST(p);
    return p;
}

// ---- Polygons and cells ----

static const surface_polygon portal_like = {.kind = SURFACE_WALL};

// The cube's square on the plane.
static uint32_t whole(bsp *b, plane_ref plane)
{
    const cull_wide_plane p = plane_table_get(b->s.planes, plane);
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (cull_magnitude(p.normal[k]) > cull_magnitude(p.normal[axis])) axis = k;
    plane_ref side[2][2]; // of the two other axes: low, high
    for (int k = 0; k < 2; ++k)
        for (int high = 0; high < 2; ++high) { // far enough that every cell's corner lies within
            cull_wide_plane far = {{0, 0, 0}, cull_wide_from(-((int64_t)1 << 25))};
            far.normal[(axis + 1 + k) % 3] = high ? 1 : -1;
            side[k][high] = plane_table_add(b->s.planes, &far);
        }
    const plane_ref forward[4] = {side[1][0], side[0][1], side[1][1], side[0][0]}, backward[4] = {side[0][0], side[1][1], side[0][1], side[1][0]};
    const plane_ref *edges = p.normal[axis] > 0 ? forward : backward;
    surface_corner corners[4];
    for (int i = 0; i < 4; ++i) {
        const plane_ref meet[3] = {plane, edges[(i + 3) % 4], edges[i]};
        MUST(surface_vertex(&b->s, meet, &corners[i].vertex) == RESULT_OK);
        corners[i].edge = edges[i];
    }
    uint32_t out;
    MUST(surface_add(&b->s, plane, corners, 4, &portal_like, &out) == RESULT_OK);
    return out;
}

// Of the polygon what lies behind the plane; 0: nothing.
static int behind(bsp *b, uint32_t *polygon, plane_ref plane)
{
    const cut_result place = surface_classify(&b->s, *polygon, plane);
    if (place == CUT_FRONT || place == CUT_ON) return 0;
    if (place == CUT_BOTH) MUST(surface_cut(&b->s, *polygon, plane, polygon) == RESULT_OK);
    return 1;
}

static plane_ref face_plane(const bsp *b, uint32_t polygon)
{
    return surface_polygon_at(&b->s, polygon)->plane;
}

static uint32_t copy_of(bsp *b, uint32_t polygon)
{
    const surface_polygon copy = *surface_polygon_at(&b->s, polygon);
    MUST(buffer_append(&b->s.polygons, &copy, 1));
    return surface_polygon_count(&b->s) - 1;
}

// 1: the plane passes through the cell; else where the cell lies.
static cut_result classify_cell(const bsp *b, const work *w, plane_ref plane)
{
    int front = 0, back = 0;
    for (uint32_t i = 0; i < w->face_count && !(front && back); ++i) {
        const cut_result place = surface_classify(&b->s, w->faces[i], plane);
        front |= place == CUT_FRONT || place == CUT_BOTH;
        back |= place == CUT_BACK || place == CUT_BOTH;
    }
    return front && back ? CUT_BOTH : front ? CUT_FRONT : CUT_BACK;
}

// Front keeps w's arrays' brushes copied; faces' planes have their fronts outside the cell.
static void split(bsp *b, const work *w, plane_ref plane, work out[2])
{
    for (int side = 0; side < 2; ++side) {
        out[side] = (work){grown(NULL, w->face_count + 1, sizeof(uint32_t)), 0, grown(NULL, w->brush_count, sizeof(uint32_t)), w->brush_count, w->inside};
        for (uint32_t i = 0; i < w->brush_count; ++i) out[side].brushes[i] = w->brushes[i];
    }
    uint32_t lid = whole(b, plane);
    int have = 1;
    for (uint32_t i = 0; i < w->face_count && have; ++i) have = behind(b, &lid, face_plane(b, w->faces[i]));
    for (uint32_t i = 0; i < w->face_count; ++i) {
        uint32_t f = w->faces[i], back;
        const cut_result place = surface_classify(&b->s, f, plane);
        if (place == CUT_BOTH) {
            MUST(surface_cut(&b->s, f, plane, &back) == RESULT_OK);
            out[1].faces[out[1].face_count++] = back;
        }
        if (place == CUT_BACK) out[1].faces[out[1].face_count++] = f;
        else out[0].faces[out[0].face_count++] = f;
    }
    MUST(have);
    const uint32_t other = copy_of(b, lid);
    surface_polygon_at(&b->s, other)->plane = plane_ref_flipped(plane); // same corners: only its side tells now
    out[1].faces[out[1].face_count++] = lid;
    out[0].faces[out[0].face_count++] = other;
}

// ---- The tree ----

// Drops brushes that the cell lies outside of, and those that a later one hides; the plane to cut by, or PLANE_NONE.
static plane_ref next_plane(bsp *b, work *w)
{
    uint32_t kept = 0;
    plane_ref best = PLANE_NONE;
    double best_score = INFINITY;
    for (uint32_t i = 0; i < w->brush_count; ++i) {
        const compile_brush *brush = &b->in->brushes[w->brushes[i]];
        int outside = 0, crosses = 0;
        plane_ref crossing = PLANE_NONE;
        for (uint32_t f = 0; f < brush->face_count && !outside; ++f) {
            const plane_ref plane = b->in->faces[brush->first_face + f].plane;
            const cut_result place = classify_cell(b, w, plane);
            outside = place == CUT_FRONT;
            if (place != CUT_BOTH) continue;
            crosses = 1;
            if (crossing == PLANE_NONE) crossing = plane;
        }
        if (outside) continue;
        if (!crosses) {
            if ((int32_t)w->brushes[i] > w->inside) w->inside = (int32_t)w->brushes[i];
            continue;
        }
        w->brushes[kept++] = w->brushes[i];
        double size = 0; // large brushes first
        for (int k = 0; k < 3; ++k) size -= (double)(brush->max[k] - brush->min[k]);
        if (size < best_score) {
            best_score = size;
            best = crossing;
        }
    }
    w->brush_count = kept;
    uint32_t over = 0;
    for (uint32_t i = 0; i < kept; ++i) over += (int32_t)w->brushes[i] > w->inside;
    return over ? best : PLANE_NONE;
}

static uint32_t add_cell(bsp *b, const work *w)
{
    cell c = {w->faces, w->face_count, 0, w->inside < 0 || b->in->brushes[w->inside].kind == BRUSH_SUBTRACT, 0};
    for (uint32_t i = 0; i < w->face_count; ++i)
        for (int k = 0; k < 6; ++k) c.is_border |= face_plane(b, w->faces[i]) >> 1 == b->cube[k] >> 1;
    MUST(buffer_append(&b->cells, &c, 1));
    return CELL | (uint32_t)(b->cells.count - 1);
}

typedef struct pending { work w; uint32_t parent, side; } pending;

static void build(bsp *b, work root)
{
    pending *stack = grown(NULL, 1, sizeof(*stack));
    size_t depth = 1;
    stack[0] = (pending){root, UINT32_MAX, 0};
    while (depth) {
        pending p = stack[--depth];
        const plane_ref plane = next_plane(b, &p.w);
        uint32_t made;
        if (plane == PLANE_NONE) {
            made = add_cell(b, &p.w);
        } else {
            const node n = {plane, {0, 0}};
            MUST(buffer_append(&b->nodes, &n, 1));
            made = (uint32_t)b->nodes.count - 1;
            work parts[2];
            split(b, &p.w, plane, parts);
            stack = grown(stack, depth + 2, sizeof(*stack));
            stack[depth++] = (pending){parts[0], made, 0};
            stack[depth++] = (pending){parts[1], made, 1};
            free(p.w.faces);
        }
        free(p.w.brushes);
        if (p.parent != UINT32_MAX) ((node *)b->nodes.items)[p.parent].child[p.side] = made;
    }
    free(stack);
}

// ---- Flood ----

static int facet_order(const void *a, const void *b)
{
    const facet *f = a, *g = b;
    if (f->plane >> 1 != g->plane >> 1) return f->plane >> 1 < g->plane >> 1 ? -1 : 1;
    if (f->plane != g->plane) return f->plane < g->plane ? -1 : 1;
    return (f->polygon > g->polygon) - (f->polygon < g->polygon);
}

static int separated(const bsp *b, uint32_t one, uint32_t two)
{
    const surface_polygon *p = surface_polygon_at(&b->s, one), *q = surface_polygon_at(&b->s, two);
    const surface_corner *edges = surface_corners(&b->s, p), *c = surface_corners(&b->s, q);
    for (uint32_t i = 0; i < p->count; ++i) {
        int all = 1;
        for (uint32_t k = 0; k < q->count && all; ++k) all = surface_side(&b->s, c[k].vertex, edges[i].edge) >= 0;
        if (all) return 1;
    }
    return 0;
}

static int boxes_apart(const bsp *b, uint32_t one, uint32_t two)
{
    const surface_polygon *p = surface_polygon_at(&b->s, one), *q = surface_polygon_at(&b->s, two);
    for (int k = 0; k < 3; ++k)
        if (p->min[k] > q->max[k] + 1 || q->min[k] > p->max[k] + 1) return 1;
    return 0;
}

static uint32_t root_of(cell *cells, uint32_t c)
{
    while (cells[c].region != c) c = cells[c].region = cells[cells[c].region].region;
    return c;
}

static void flood(bsp *b)
{
    cell *cells = b->cells.items;
    buffer facets = buffer_make(allocator_heap(), sizeof(facet));
    for (uint32_t c = 0; c < b->cells.count; ++c) {
        cells[c].region = c;
        for (uint32_t i = 0; i < cells[c].face_count && cells[c].is_air; ++i) {
            const facet f = {face_plane(b, cells[c].faces[i]), cells[c].faces[i], c};
            MUST(buffer_append(&facets, &f, 1));
        }
    }
    facet *f = facets.items;
    const size_t count = facets.count;
    if (count) qsort(f, count, sizeof(*f), facet_order);
    for (size_t i = 0; i < count; ++i)
        for (size_t k = i + 1; k < count && f[k].plane >> 1 == f[i].plane >> 1; ++k) {
            const uint32_t p = root_of(cells, f[i].cell), q = root_of(cells, f[k].cell);
            if (f[k].plane == f[i].plane || p == q || boxes_apart(b, f[i].polygon, f[k].polygon)) continue;
            if (!separated(b, f[i].polygon, f[k].polygon) && !separated(b, f[k].polygon, f[i].polygon)) cells[q].region = p;
        }
    buffer_free(&facets);
    for (uint32_t c = 0; c < b->cells.count; ++c) // the void is what touches the cube's border
        if (cells[c].is_border && cells[c].is_air) cells[root_of(cells, c)].is_border = 1;
}

// ---- Entities ----

// Air cells that the point lies in or on, *solid when it touches a solid one too.
static uint32_t locate(const bsp *b, uint32_t at, const int32_t p[3], int *solid)
{
    while (!(at & CELL)) {
        const node *n = (node *)b->nodes.items + at;
        const int side = plane_table_side_of_point(b->s.planes, p, n->plane);
        if (side == 0) {
            const uint32_t front = locate(b, n->child[0], p, solid), back = locate(b, n->child[1], p, solid);
            return front == UINT32_MAX ? back : front;
        }
        at = n->child[side < 0];
    }
    cell *c = (cell *)b->cells.items + (at & ~CELL);
    if (!c->is_air) *solid = 1;
    return c->is_air ? at & ~CELL : UINT32_MAX;
}

static void stand(bsp *b, uint32_t root, const compile_entity *e, uint8_t *seen, oracle_zones *out)
{
    static const int ways[][3] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}, {0, -1, 0}};
    cell *cells = b->cells.items;
    for (int i = 0; i < 7; ++i) {
        int32_t p[3];
        int solid = 0;
        for (int k = 0; k < 3; ++k)
            p[k] = (int32_t)floor(floor(e->origin[k] * b->in->steps_per_metre + 0.5) + ways[i][k] * b->in->steps_per_metre / 32 + 0.5);
        const uint32_t c = locate(b, root, p, &solid);
        if (solid || c == UINT32_MAX) continue;
        const uint32_t region = root_of(cells, c);
        if (cells[region].is_border && i > 0) continue;
        if (cells[region].is_border) out->leak = 1;
        else if (!seen[region]) seen[region] = 1, out->reached++;
        return;
    }
}

void oracle_bsp(const compile_input *in, oracle_zones *out)
{
    bsp b = {.in = in, .s = surface_make(in->planes, allocator_heap()), .nodes = buffer_make(allocator_heap(), sizeof(node))};
    b.cells = buffer_make(allocator_heap(), sizeof(cell));
    *out = (oracle_zones){0};
    for (int k = 0; k < 6; ++k) { // a cube round all brushes
        cull_wide_plane p = {{0, 0, 0}, cull_wide_from(-(CULL_GRID_MOST + 1))};
        p.normal[k % 3] = k < 3 ? 1 : -1;
        b.cube[k] = plane_table_add(in->planes, &p);
        MUST(b.cube[k] != PLANE_NONE);
    }
    work root = {grown(NULL, 6, sizeof(uint32_t)), 0, grown(NULL, in->brush_count, sizeof(uint32_t)), 0, -1};
    for (int k = 0; k < 6; ++k) {
        uint32_t f = whole(&b, b.cube[k]);
        for (int i = 0; i < 6; ++i)
            if (i != k && i % 3 != k % 3) MUST(behind(&b, &f, b.cube[i]));
        root.faces[root.face_count++] = f;
    }
    for (uint32_t i = 0; i < in->brush_count; ++i)
        if (in->brushes[i].role == BRUSH_STRUCTURE) root.brushes[root.brush_count++] = i;
    build(&b, root);
    flood(&b);
    cell *cells = b.cells.items;
    uint8_t *seen = calloc(b.cells.count, 1);
    MUST(seen);
    for (uint32_t c = 0; c < b.cells.count; ++c) out->regions += cells[c].is_air && root_of(cells, c) == c && !cells[c].is_border;
    const uint32_t top = b.nodes.count ? 0 : CELL;
    for (uint32_t e = 0; e < in->entity_count; ++e)
        if (in->entities[e].has_origin && !in->entities[e].brush_count) stand(&b, top, &in->entities[e], seen, out);
    out->cells = (uint32_t)b.cells.count;
    for (uint32_t c = 0; c < b.cells.count; ++c) free(cells[c].faces);
    free(seen);
    surface_free(&b.s);
    buffer_free(&b.nodes);
    buffer_free(&b.cells);
}
