// See grid_cells.h.
// SPDX-License-Identifier: MIT
#include "grid_cells.h"

#include "tests/common/random.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- A host ----

static void *host_alloc(const cull_host *host, size_t size, size_t align)
{
    (void)host;
    (void)align;
    return aligned_alloc(64, (size + 63) / 64 * 64);
}

static void host_free(const cull_host *host, void *memory, size_t size)
{
    (void)host;
    (void)size;
    free(memory);
}

const cull_host *grid_host(void)
{
    static const cull_host host = {.abi = CULL_ABI, .alloc = host_alloc, .free = host_free};
    return &host;
}

// ---- Poses ----

static void turn_make(const double angles[3], double m[3][3])
{
    double r[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int axis = 0; axis < 3; axis++) {
        const int b = (axis + 1) % 3, c = (axis + 2) % 3;
        const double co = cos(angles[axis]), si = sin(angles[axis]);
        for (int col = 0; col < 3; col++) {
            const double rb = r[b][col], rc = r[c][col];
            r[b][col] = co * rb - si * rc;
            r[c][col] = si * rb + co * rc;
        }
    }
    memcpy(m, r, sizeof r);
}

void grid_pose_way(const grid_cells *g, const double in[3], double out[3])
{
    for (int i = 0; i < 3; i++) out[i] = g->turned[i][0] * in[0] + g->turned[i][1] * in[1] + g->turned[i][2] * in[2];
}

void grid_unpose_way(const grid_cells *g, const double in[3], double out[3])
{
    for (int i = 0; i < 3; i++) out[i] = g->turned[0][i] * in[0] + g->turned[1][i] * in[1] + g->turned[2][i] * in[2];
}

void grid_pose(const grid_cells *g, const double in[3], double out[3])
{
    const double scaled[3] = {in[0] * g->scale, in[1] * g->scale, in[2] * g->scale};
    grid_pose_way(g, scaled, out);
    for (int i = 0; i < 3; i++) out[i] += g->move[i];
}

// ---- The block ----

static uint32_t room_of(const grid_cells *g, const uint32_t at[3])
{
    return (at[2] * g->size[1] + at[1]) * g->size[0] + at[0];
}

static grid_face *face_at(const grid_cells *g, int axis, const uint32_t at[3]) // below room `at` along the axis
{
    uint32_t n[3] = {g->size[0], g->size[1], g->size[2]};
    n[axis]++;
    return &g->faces[axis][(at[2] * n[1] + at[1]) * n[0] + at[0]];
}

static uint32_t plane_of(const grid_cells *g, int axis, uint32_t i, int flipped)
{
    uint32_t first = 0;
    for (int a = 0; a < axis; a++) first += g->size[a] + 1;
    return 2 * (first + i) + (uint32_t)flipped;
}

static void planes_make(grid_cells *g)
{
    g->data.plane_count = 2 * (g->size[0] + g->size[1] + g->size[2] + 3);
    g->data.planes = calloc(g->data.plane_count, sizeof *g->data.planes);
    for (int axis = 0; axis < 3; axis++)
        for (uint32_t i = 0; i <= g->size[axis]; i++)
            for (int flipped = 0; flipped < 2; flipped++) {
                bsp_plane *p = &g->data.planes[plane_of(g, axis, i, flipped)];
                double n[3] = {0, 0, 0}, point[3] = {0, 0, 0}, posed[3];
                n[axis] = flipped ? -1 : 1;
                point[axis] = g->places[axis][i];
                grid_pose_way(g, n, p->normal);
                grid_pose(g, point, posed);
                p->offset = -(p->normal[0] * posed[0] + p->normal[1] * posed[1] + p->normal[2] * posed[2]);
            }
}

// A rectangle at plane i of the axis; counterclockwise from above, or from below.
static void rectangle_put(const grid_cells *g, int axis, uint32_t i, const double r[4], int from_below, cull_point *out)
{
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    const double corners[4][2] = {{r[0], r[2]}, {r[1], r[2]}, {r[1], r[3]}, {r[0], r[3]}};
    for (int k = 0; k < 4; k++) {
        const double *corner = corners[from_below ? 3 - k : k];
        double p[3], posed[3];
        p[axis] = g->places[axis][i];
        p[b] = corner[0];
        p[c] = corner[1];
        grid_pose(g, p, posed);
        out[k] = (cull_point){posed[0], posed[1], posed[2]};
    }
}

static void room_extent(const grid_cells *g, int axis, const uint32_t at[3], double r[4])
{
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    r[0] = g->places[b][at[b]];
    r[1] = g->places[b][at[b] + 1];
    r[2] = g->places[c][at[c]];
    r[3] = g->places[c][at[c] + 1];
}

static int is_foreign(const grid_cells *g, const uint32_t at[3])
{
    return room_of(g, at) == g->foreign;
}

// The room on the other side of the face belongs to another zone, or this one does.
static int is_foreign_face(const grid_cells *g, int axis, const uint32_t face[3])
{
    uint32_t below[3] = {face[0], face[1], face[2]};
    if (g->foreign == BSP_NONE) return 0;
    below[axis]--;
    return (face[axis] < g->size[axis] && is_foreign(g, face)) || (face[axis] > 0 && is_foreign(g, below));
}

static void face_choose(grid_cells *g, int axis, const uint32_t at[3], const grid_wish *wish, uint64_t *random)
{
    grid_face *f = face_at(g, axis, at);
    memset(f->items, 0xff, sizeof f->items);
    const double choice = random_between(random, 0, 1);
    double r[4];
    room_extent(g, axis, at, r);
    for (int k = 0; k < 2; k++) {
        const double size = r[2 * k + 1] - r[2 * k];
        const uint32_t low = random_below(random, 4), high = low + 1 + random_below(random, 8 - low);
        f->door[2 * k] = r[2 * k] + size * low / 8;
        f->door[2 * k + 1] = r[2 * k] + size * high / 8;
    }
    if (at[axis] == 0 || at[axis] == g->size[axis]) f->kind = GRID_SHUT;
    else if (is_foreign_face(g, axis, at)) f->kind = GRID_PORTAL;
    else if (choice < wish->open) f->kind = GRID_OPEN;
    else if (choice < wish->open + wish->shut) f->kind = GRID_SHUT;
    else if (choice < wish->open + wish->shut + wish->one_way) f->kind = random_bits(random) & 1 ? GRID_ONE_WAY_UP : GRID_ONE_WAY_DOWN;
    else f->kind = GRID_DOOR;
}

// The walls round a door; fewer where it touches the room's edge.
static uint32_t wall_rectangles(const grid_cells *g, int axis, const uint32_t at[3], double out[GRID_PIECES][4])
{
    const grid_face *f = face_at(g, axis, at);
    double r[4];
    room_extent(g, axis, at, r);
    if (f->kind == GRID_OPEN || f->kind == GRID_PORTAL) return 0;
    if (f->kind != GRID_DOOR) {
        memcpy(out[0], r, sizeof r);
        return 1;
    }
    const double *d = f->door, all[GRID_PIECES][4] = {{r[0], d[0], r[2], r[3]}, {d[1], r[1], r[2], r[3]}, {d[0], d[1], r[2], d[2]}, {d[0], d[1], d[3], r[3]}};
    uint32_t n = 0;
    for (int i = 0; i < GRID_PIECES; i++)
        if (all[i][0] < all[i][1] && all[i][2] < all[i][3]) memcpy(out[n++], all[i], sizeof all[i]);
    return n;
}

static int has_side(grid_kind kind, int side) // walls that face up (0) or down (1)
{
    return kind == GRID_SHUT || kind == GRID_DOOR || (kind == GRID_ONE_WAY_UP && side == 0) || (kind == GRID_ONE_WAY_DOWN && side == 1);
}

static int is_open_from(grid_kind kind, int side) // from above (0) or below (1)
{
    return kind == GRID_OPEN || kind == GRID_DOOR || kind == GRID_PORTAL || (kind == GRID_ONE_WAY_UP && side == 1) || (kind == GRID_ONE_WAY_DOWN && side == 0);
}

static int place_next(const uint32_t n[3], uint32_t at[3])
{
    for (int k = 0; k < 3; k++) {
        if (++at[k] < n[k]) return 1;
        at[k] = 0;
    }
    return 0;
}

static void faces_make(grid_cells *g, const grid_wish *wish)
{
    uint64_t random = wish->seed;
    for (int axis = 0; axis < 3; axis++) {
        uint32_t n[3] = {g->size[0], g->size[1], g->size[2]}, at[3] = {0, 0, 0};
        n[axis]++;
        g->faces[axis] = calloc((size_t)n[0] * n[1] * n[2], sizeof(grid_face));
        do {
            double walls[GRID_PIECES][4];
            face_choose(g, axis, at, wish, &random);
            grid_face *f = face_at(g, axis, at);
            const uint32_t count = wall_rectangles(g, axis, at, walls);
            for (int side = 0; side < 2; side++) {
                if (at[axis] == 0 && side == 1) continue; // the block's outside has no walls
                if (at[axis] == g->size[axis] && side == 0) continue;
                for (uint32_t i = 0; i < count && has_side(f->kind, side); i++) f->items[side][i] = g->item_count++;
            }
        } while (place_next(n, at));
    }
}

// ---- Cells ----

typedef struct grid_lists { bsp_opening *openings; cull_point *opening_points; bsp_entry *entries; cull_point *entry_points; } grid_lists;

static void entries_put(grid_cells *g, int axis, const uint32_t face[3], int wall_side)
{
    bsp_cells_data *d = &g->data;
    const grid_face *f = face_at(g, axis, face);
    double walls[GRID_PIECES][4];
    const uint32_t count = wall_rectangles(g, axis, face, walls);
    for (uint32_t i = 0; i < count; i++) {
        if (f->items[wall_side][i] == BSP_NONE) continue;
        d->entries[d->entry_count++] = (bsp_entry){f->items[wall_side][i], d->entry_point_count, 4, plane_of(g, axis, face[axis], wall_side)};
        rectangle_put(g, axis, face[axis], walls[i], wall_side, d->entry_points + d->entry_point_count);
        d->entry_point_count += 4;
    }
}

static void opening_put(grid_cells *g, int axis, const uint32_t face[3], int side, uint32_t to)
{
    bsp_cells_data *d = &g->data;
    const grid_face *f = face_at(g, axis, face);
    double r[4];
    if (!is_open_from(f->kind, side) || f->kind == GRID_PORTAL) return;
    room_extent(g, axis, face, r);
    if (f->kind == GRID_DOOR) memcpy(r, f->door, sizeof r);
    d->openings[d->opening_count++] = (bsp_opening){to, plane_of(g, axis, face[axis], 0), (uint32_t)side, d->opening_point_count, 4};
    rectangle_put(g, axis, face[axis], r, side, d->opening_points + d->opening_point_count);
    d->opening_point_count += 4;
}

static void cell_make(grid_cells *g, const uint32_t at[3])
{
    bsp_cells_data *d = &g->data;
    bsp_cell *cell = &d->cells[room_of(g, at)];
    cell->first_opening = d->opening_count;
    cell->first_entry = d->entry_count;
    for (int pass = 0; pass < 2; pass++) { // fronts, then backs
        if (pass == 1) cell->first_back = d->entry_count;
        for (int k = 0; k < 6; k++) {
            const int axis = k / 2, above = k % 2; // the room lies below the face where `above`
            uint32_t face[3] = {at[0], at[1], at[2]}, to[3] = {at[0], at[1], at[2]};
            face[axis] += (uint32_t)above;
            const int is_border = face[axis] == 0 || face[axis] == g->size[axis];
            to[axis] = above ? at[axis] + 1 : at[axis] - 1;
            if (!is_foreign(g, at)) entries_put(g, axis, face, pass == 0 ? above : 1 - above);
            if (pass == 0 && !is_border) opening_put(g, axis, face, above, room_of(g, to));
        }
        if (pass == 1) continue;
        if (!is_foreign(g, at)) d->entries[d->entry_count++] = (bsp_entry){g->first_box + room_of(g, at), 0, 0, 0};
        cell->entry_count = d->entry_count - cell->first_entry;
    }
    cell->opening_count = d->opening_count - cell->first_opening;
    cell->back_count = d->entry_count - cell->first_back;
}

static void cells_make(grid_cells *g)
{
    bsp_cells_data *d = &g->data;
    uint32_t at[3] = {0, 0, 0};
    d->cell_count = g->size[0] * g->size[1] * g->size[2];
    d->cells = calloc(d->cell_count, sizeof *d->cells);
    d->openings = calloc((size_t)d->cell_count * 6, sizeof *d->openings);
    d->opening_points = calloc((size_t)d->cell_count * 24, sizeof *d->opening_points);
    d->entries = calloc((size_t)d->cell_count * 49, sizeof *d->entries);
    d->entry_points = calloc((size_t)d->cell_count * 192, sizeof *d->entry_points);
    do cell_make(g, at);
    while (place_next(g->size, at));
}

static uint32_t node_make(grid_cells *g, uint32_t parent, const uint32_t low[3], const uint32_t high[3], uint64_t *random)
{
    int axis = (int)random_below(random, 3);
    for (int k = 0; k < 3 && high[axis] - low[axis] == 1; k++) axis = (axis + 1) % 3;
    if (high[axis] - low[axis] == 1) {
        const uint32_t room = room_of(g, low);
        g->data.cells[room].parent = parent;
        return room | BSP_LEAF;
    }
    const uint32_t node = g->data.node_count++, cut = low[axis] + 1 + random_below(random, high[axis] - low[axis] - 1);
    uint32_t middle_high[3] = {high[0], high[1], high[2]}, middle_low[3] = {low[0], low[1], low[2]};
    middle_high[axis] = middle_low[axis] = cut;
    g->data.nodes[node] = (bsp_node){.plane = plane_of(g, axis, cut, 0), .parent = parent};
    g->data.nodes[node].child[0] = node_make(g, node, middle_low, high, random);
    g->data.nodes[node].child[1] = node_make(g, node, low, middle_high, random);
    return node;
}

// ---- Portals ----

static void portal_put(grid_cells *g, int axis, const uint32_t face[3], int inside, uint32_t room) // inside: the zone lies above (0) or below (1) the face
{
    const uint32_t i = g->zone.portal_count++;
    const int from_below = inside == 1;
    cull_point points[4];
    double r[4];
    room_extent(g, axis, face, r);
    rectangle_put(g, axis, face[axis], r, from_below, points);
    for (int k = 0; k < 4; k++) g->portal_points[i][k] = (cull_vec3){(float)points[k].x, (float)points[k].y, (float)points[k].z};
    const bsp_plane *p = &g->data.planes[plane_of(g, axis, face[axis], from_below)];
    g->portals[i] = (cull_portal){.points = g->portal_points[i], .point_count = 4};
    g->portals[i].plane = (cull_plane){{(float)p->normal[0], (float)p->normal[1], (float)p->normal[2]}, (float)p->offset};
    g->data.stands[i] = (bsp_stand){room, 4 * i, 4, 0};
    memcpy(g->data.stand_points + (size_t)4 * i, g->portal_points[i], sizeof g->portal_points[i]);
}

static void portals_make(grid_cells *g)
{
    g->data.portal_offsets = calloc(7, sizeof *g->data.portal_offsets);
    g->data.stands = calloc(6, sizeof *g->data.stands);
    g->data.stand_points = calloc(24, sizeof *g->data.stand_points);
    g->zone.portals = g->portals;
    for (int k = 0; k < 6 && g->foreign != BSP_NONE; k++) {
        const int axis = k / 2, above = k % 2;
        uint32_t room[3] = {g->foreign % g->size[0], g->foreign / g->size[0] % g->size[1], g->foreign / g->size[0] / g->size[1]};
        uint32_t face[3] = {room[0], room[1], room[2]};
        face[axis] += (uint32_t)above;
        if (face[axis] == 0 || face[axis] == g->size[axis]) continue;
        room[axis] = above ? room[axis] + 1 : room[axis] - 1;
        portal_put(g, axis, face, above ? 0 : 1, room_of(g, room));
    }
    g->data.portal_count = g->zone.portal_count;
    for (uint32_t i = 0; i <= g->zone.portal_count; i++) g->data.portal_offsets[i] = i;
}

// ---- The zone ----

static void box_put(grid_cells *g, const uint32_t at[3])
{
    const uint32_t item = g->first_box + room_of(g, at), stride = g->item_count + CULL_PADDING;
    for (int axis = 0; axis < 3; axis++) {
        double least = 1e300, most = -1e300;
        for (int corner = 0; corner < 8; corner++) {
            double p[3], posed[3];
            for (int k = 0; k < 3; k++) {
                const double low = g->places[k][at[k]], high = g->places[k][at[k] + 1];
                p[k] = low + (high - low) * (corner >> k & 1 ? 0.75 : 0.25);
            }
            grid_pose(g, p, posed);
            least = fmin(least, posed[axis]);
            most = fmax(most, posed[axis]);
        }
        g->box_memory[(uint32_t)axis * stride + item] = nextafterf((float)least, -INFINITY);
        g->box_memory[(uint32_t)(axis + 3) * stride + item] = nextafterf((float)most, INFINITY);
    }
}

static void zone_make(grid_cells *g)
{
    const uint32_t stride = g->item_count + CULL_PADDING;
    uint32_t at[3] = {0, 0, 0};
    double far_most = 0, low[3] = {1e300, 1e300, 1e300}, high[3] = {-1e300, -1e300, -1e300};
    g->items = calloc(g->item_count, sizeof *g->items);
    g->box_memory = calloc((size_t)stride * 6, sizeof *g->box_memory);
    const float *m = g->box_memory;
    g->zone.boxes = (cull_boxes){m, m + stride, m + 2 * stride, m + 3 * stride, m + 4 * stride, m + 5 * stride};
    do box_put(g, at);
    while (place_next(g->size, at));
    for (int corner = 0; corner < 8; corner++) {
        double p[3], posed[3];
        for (int k = 0; k < 3; k++) p[k] = g->places[k][corner >> k & 1 ? g->size[k] : 0];
        grid_pose(g, p, posed);
        for (int k = 0; k < 3; k++) {
            far_most = fmax(far_most, fabs(posed[k]));
            low[k] = fmin(low[k], posed[k]);
            high[k] = fmax(high[k], posed[k]);
        }
    }
    g->zone.items = g->items;
    g->zone.item_count = g->item_count;
    g->zone.radius = (float)far_most;
    g->zone.box = (cull_box){{(float)low[0], (float)low[1], (float)low[2]}, {(float)high[0], (float)high[1], (float)high[2]}};
    memcpy(g->data.box_low, low, sizeof low);
    memcpy(g->data.box_high, high, sizeof high);
    g->data.slack = 3.0 / 16777216 * far_most;
}

void grid_make(const grid_wish *wish, grid_cells *g)
{
    uint64_t random = wish->seed ^ 0x5bd1e995u;
    const uint32_t none[3] = {0, 0, 0};
    memset(g, 0, sizeof *g);
    memcpy(g->size, wish->size, sizeof g->size);
    memcpy(g->move, wish->move, sizeof g->move);
    g->scale = wish->scale;
    turn_make(wish->turn, g->turned);
    for (int axis = 0; axis < 3; axis++) {
        assert(g->size[axis] >= 1 && g->size[axis] <= GRID_MOST);
        for (uint32_t i = 0; i < g->size[axis]; i++) g->places[axis][i + 1] = g->places[axis][i] + (8 + random_below(&random, 32)) / 8.0;
    }
    g->foreign = wish->has_foreign ? random_below(&random, g->size[0] * g->size[1] * g->size[2]) : BSP_NONE;
    planes_make(g);
    faces_make(g, wish);
    g->first_box = g->item_count;
    g->item_count += g->size[0] * g->size[1] * g->size[2];
    cells_make(g);
    g->data.nodes = calloc(g->data.cell_count, sizeof *g->data.nodes);
    node_make(g, BSP_NONE, none, g->size, &random);
    zone_make(g);
    portals_make(g);
    if (bsp_flow_build(grid_host(), &g->zone, NULL, &g->data, &g->index) != CULL_OK) abort();
}

void grid_free(grid_cells *g)
{
    bsp_flow_free(grid_host(), &g->index);
    free(g->data.planes);
    free(g->data.nodes);
    free(g->data.cells);
    free(g->data.openings);
    free(g->data.opening_points);
    free(g->data.entries);
    free(g->data.entry_points);
    free(g->data.portal_offsets);
    free(g->data.stands);
    free(g->data.stand_points);
    free(g->items);
    free(g->box_memory);
    for (int axis = 0; axis < 3; axis++) free(g->faces[axis]);
}

// ---- Rays ----

static int room_find(const grid_cells *g, const double from[3], const double way[3], uint32_t at[3])
{
    for (int k = 0; k < 3; k++) {
        uint32_t i = 0;
        while (i < g->size[k] && !(from[k] < g->places[k][i + 1] || (from[k] == g->places[k][i + 1] && way[k] < 0))) i++;
        if (i == g->size[k] || from[k] < g->places[k][0] || (from[k] == g->places[k][0] && way[k] < 0)) return 0;
        at[k] = i;
    }
    return 1;
}

static int next_face(const grid_cells *g, const double from[3], const double way[3], const uint32_t at[3], double *t)
{
    int first = -1;
    *t = INFINITY;
    for (int k = 0; k < 3; k++) {
        if (way[k] == 0) continue;
        const double here = (g->places[k][way[k] > 0 ? at[k] + 1 : at[k]] - from[k]) / way[k];
        if (here < *t) {
            *t = here;
            first = k;
        }
    }
    return first;
}

// 1: inside, 0: outside, -1: too near to the border to tell.
static int in_rectangle(const double r[4], double b, double c, double clear)
{
    if (b > r[0] + clear && b < r[1] - clear && c > r[2] + clear && c < r[3] - clear) return 1;
    if (b < r[0] - clear || b > r[1] + clear || c < r[2] - clear || c > r[3] + clear) return 0;
    return -1;
}

int grid_trace_ray(const grid_cells *g, const double from[3], const double way[3], double clear, grid_trace *out)
{
    uint32_t at[3];
    out->room_count = out->seen_count = 0;
    out->hit = BSP_NONE;
    if (!room_find(g, from, way, at)) return 0;
    while (out->room_count < GRID_STEPS) {
        double t, r[4], walls[GRID_PIECES][4];
        out->rooms[out->room_count++] = room_of(g, at);
        const int axis = next_face(g, from, way, at, &t), b = (axis + 1) % 3, c = (axis + 2) % 3, below = way[axis] > 0;
        const double pb = from[b] + t * way[b], pc = from[c] + t * way[c];
        room_extent(g, axis, at, r);
        if (in_rectangle(r, pb, pc, clear) != 1) return 0;
        uint32_t face[3] = {at[0], at[1], at[2]};
        face[axis] += (uint32_t)below;
        const grid_face *f = face_at(g, axis, face);
        const int door = f->kind == GRID_DOOR ? in_rectangle(f->door, pb, pc, clear) : 1;
        if (door < 0) return 0;
        if (!is_open_from(f->kind, below) || !door) {
            const uint32_t count = wall_rectangles(g, axis, face, walls);
            for (uint32_t i = 0; i < count; i++)
                if (in_rectangle(walls[i], pb, pc, clear) == 1 && !is_foreign(g, at)) out->hit = f->items[below][i];
            return out->hit != BSP_NONE;
        }
        if (f->kind != GRID_OPEN && f->kind != GRID_DOOR && f->kind != GRID_PORTAL) out->seen[out->seen_count++] = f->items[1 - below][0];
        at[axis] = below ? at[axis] + 1 : at[axis] - 1;
    }
    return 0;
}
