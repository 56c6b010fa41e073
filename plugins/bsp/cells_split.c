// Space cut by the planes of all walls and zone portals until every cell has its walls on its border alone (Fuchs, Kedem and Naylor,
// On Visible Surface Generation by A Priori Tree Structures, 1980). Its planes are chosen for few cuts: the flow pays for each cell.
// SPDX-License-Identifier: MIT
//
// Invariant: a node's piece in its plane goes on to the side that its face looks to, its back to the other, so that each arrives in
// the cells that it is seen from; each node places one piece at least, so the work ends.
#include "cells_build.h"

enum {
    CANDIDATES_MOST = 128, // planes tried at a node
    SAMPLES_MOST = 512,    // pieces that each is tried on
    CLEAN_MOST = 4,        // of those, that cut nothing: one is as good as another
    CUT_COST = 4,
};

typedef struct split_task { uint32_t first, count, parent, side, depth; } split_task; // pieces: the top of the stack

typedef struct split {
    cells_build *b;
    bsp_vector stack, tasks, parts[2]; // cells_piece, split_task, cells_piece in front and behind
    bsp_vector seen;                   // uint32_t a plane: the turn in which it was tried last
    uint32_t turn;
} split;

typedef enum piece_place { PLACE_ON, PLACE_FRONT, PLACE_BEHIND, PLACE_ACROSS } piece_place;

// ---- Where a piece lies ----

static piece_place place_between(double low, double high, double slack)
{
    if (high <= slack) return low >= -slack ? PLACE_ON : PLACE_BEHIND;
    return low >= -slack ? PLACE_FRONT : PLACE_ACROSS;
}

static piece_place place_of_box(const cells_build *b, const cells_piece *p, const bsp_plane *by)
{
    const cull_box box = cull_box_at(&b->zone->boxes, b->tree->order[p->item]);
    const double least[3] = {(double)box.min.x, (double)box.min.y, (double)box.min.z}, most[3] = {(double)box.max.x, (double)box.max.y, (double)box.max.z};
    double low = by->offset, high = by->offset;
    for (int i = 0; i < 3; i++) {
        const double n = by->normal[i];
        low += n * (n > 0 ? least[i] : most[i]);
        high += n * (n > 0 ? most[i] : least[i]);
    }
    return high < -b->slack ? PLACE_BEHIND : low > b->slack ? PLACE_FRONT : PLACE_ACROSS; // touching is both
}

static piece_place place_of(const cells_build *b, const cells_piece *p, uint32_t by)
{
    const bsp_plane *plane = cells_plane(b, by);
    if (p->flags & PIECE_BOX) return place_of_box(b, p, plane);
    if (cells_exact(b, p->plane)->same == cells_exact(b, by)->same) return PLACE_ON;
    const cull_point *points = (const cull_point *)b->points.items + p->first_point;
    double low = cells_height(plane, points[0]), high = low;
    for (uint32_t i = 1; i < p->point_count; i++) {
        const double height = cells_height(plane, points[i]);
        if (height < low) low = height;
        if (height > high) high = height;
    }
    return place_between(low, high, b->slack);
}

// Of a piece in the plane: 1 its face looks to the front, -1 behind, 0 it is too thin to tell.
static int facing_of(const cells_build *b, uint32_t plane, uint32_t by)
{
    const exact_plane *own = cells_exact(b, plane), *other = cells_exact(b, by);
    if (own->same == other->same) return own->turned == other->turned ? 1 : -1;
    const double *u = cells_plane(b, plane)->normal, *v = cells_plane(b, by)->normal;
    const double along = (u[0] * v[0] + u[1] * v[1]) + u[2] * v[2];
    return along >= 0.5 ? 1 : along <= -0.5 ? -1 : 0;
}

int cells_lie_in(const cells_build *b, const cull_point *points, uint32_t count, uint32_t own, uint32_t by, int *facing)
{
    *facing = facing_of(b, own, by);
    if (cells_exact(b, own)->same == cells_exact(b, by)->same) return 1;
    for (uint32_t i = 0; i < count && *facing; i++) {
        const double height = cells_height(cells_plane(b, by), points[i]);
        if (height > b->slack || height < -b->slack) return 0;
    }
    return *facing != 0;
}

// ---- Which plane cuts a leaf ----

static int wants_node(const cells_piece *p)
{
    return !(p->flags & (PIECE_BOX | PIECE_BACK | PIECE_PLACED));
}

typedef struct price { int64_t cost; uint32_t cuts; } price;

// Per piece that it cuts CUT_COST, or 1 where a node holds the piece's plane already; each that it places is worth 1.
static price price_of(const split *s, const cells_piece *pieces, uint32_t count, uint32_t by)
{
    const uint32_t stride = count / SAMPLES_MOST + 1;
    price out = {0, 0};
    s->b->work += count / stride / 8; // in doubles
    for (uint32_t i = 0; i < count; i += stride) {
        if (pieces[i].flags & (PIECE_BOX | PIECE_BACK)) continue;
        const piece_place place = place_of(s->b, &pieces[i], by);
        if (place == PLACE_ON) out.cost--;
        if (place != PLACE_ACROSS) continue;
        out.cost += pieces[i].flags & PIECE_PLACED ? 1 : CUT_COST;
        out.cuts++;
    }
    return out;
}

// The first of the cheapest; BSP_NONE: nothing is left to place.
static uint32_t splitter_of(split *s, const split_task *t)
{
    const cells_piece *pieces = (const cells_piece *)s->stack.items + t->first;
    uint32_t *seen = s->seen.items, best = BSP_NONE, tried = 0, clean = 0;
    int64_t least = 0;
    s->turn++;
    for (uint32_t i = 0; i < t->count && tried < CANDIDATES_MOST && clean < CLEAN_MOST; i++) {
        if (!wants_node(&pieces[i])) continue;
        const uint32_t same = cells_exact(s->b, pieces[i].plane)->same;
        if (seen[same] == s->turn) continue;
        seen[same] = s->turn;
        tried++;
        const price own = price_of(s, pieces, t->count, pieces[i].plane);
        clean += own.cuts == 0;
        if (best != BSP_NONE && own.cost >= least) continue;
        best = pieces[i].plane;
        least = own.cost;
    }
    return best;
}

// ---- Nodes ----

static cells_status part_add(split *s, int side, const cells_piece *p)
{
    return vector_add(&s->parts[side], p) ? CELLS_FINE : CELLS_NO_MEMORY;
}

static cells_status part_on(split *s, const cells_piece *p, uint32_t by)
{
    const int facing = facing_of(s->b, p->plane, by), is_back = (p->flags & PIECE_BACK) != 0;
    cells_piece front = *p, back = *p;
    if (facing == 0) {
        const cells_status status = part_add(s, 0, p);
        return status == CELLS_FINE ? part_add(s, 1, p) : status;
    }
    const int ahead = facing > 0 ? 0 : 1; // the side that its face looks to
    if (is_back) return part_add(s, !ahead, p);
    front.flags |= PIECE_PLACED;
    back.flags |= PIECE_PLACED | PIECE_BACK;
    cells_status status = part_add(s, ahead, &front);
    if (status == CELLS_FINE && !(p->flags & PIECE_PORTAL)) status = part_add(s, !ahead, &back);
    return status;
}

static cells_status part_cut(split *s, const cells_piece *p, uint32_t by, int side)
{
    bsp_vector *points = &s->b->points;
    const uint32_t room = 2 * p->point_count; // see cull_polygon_clip
    cull_point *to = vector_reserve(points, room);
    if (!to) return CELLS_NO_MEMORY;
    const bsp_plane *plane = cells_plane(s->b, by);
    const double sign = side ? -1 : 1;
    const cull_cut cut = {sign * plane->normal[0], sign * plane->normal[1], sign * plane->normal[2], sign * plane->offset};
    cells_piece made = *p;
    made.first_point = points->count;
    made.point_count = cull_polygon_clip((const cull_point *)points->items + p->first_point, p->point_count, cut, to, room);
    if (made.point_count < 3) return CELLS_FINE;
    points->count += made.point_count;
    return part_add(s, side, &made);
}

static cells_status part_place(split *s, const cells_piece *p, uint32_t by)
{
    const piece_place place = place_of(s->b, p, by);
    if (place == PLACE_ON) return part_on(s, p, by);
    cells_status status = CELLS_FINE;
    for (int side = 0; side < 2 && status == CELLS_FINE; side++) {
        if (place == (side ? PLACE_FRONT : PLACE_BEHIND)) continue;
        status = place == PLACE_ACROSS && !(p->flags & PIECE_BOX) ? part_cut(s, p, by, side) : part_add(s, side, p);
    }
    return status;
}

static void child_set(cells_build *b, const split_task *t, uint32_t child)
{
    if (t->parent != BSP_NONE) ((bsp_node *)b->nodes.items)[t->parent].child[t->side] = child;
}

static cells_status tasks_add(split *s, const split_task *above, uint32_t number)
{
    for (uint32_t side = 2; side-- > 0;) {
        const split_task next = {s->stack.count, s->parts[side].count, number, side, above->depth + 1};
        if (next.count) {
            void *to = vector_push(&s->stack, next.count);
            if (!to) return CELLS_NO_MEMORY;
            memcpy(to, s->parts[side].items, s->parts[side].item_size * next.count);
        }
        if (!vector_add(&s->tasks, &next)) return CELLS_NO_MEMORY;
    }
    return CELLS_FINE;
}

static cells_status node_make(split *s, const split_task *t, uint32_t plane)
{
    cells_build *b = s->b;
    const uint32_t number = b->nodes.count;
    const bsp_node node = {.plane = plane, .child = {BSP_NONE, BSP_NONE}, .parent = t->parent};
    if (!vector_add(&b->nodes, &node)) return CELLS_NO_MEMORY;
    child_set(b, t, number);
    s->parts[0].count = s->parts[1].count = 0;
    cells_status status = CELLS_FINE;
    for (uint32_t i = 0; i < t->count && status == CELLS_FINE; i++) {
        const cells_piece piece = ((const cells_piece *)s->stack.items)[t->first + i];
        status = part_place(s, &piece, plane);
    }
    s->stack.count = t->first;
    return status == CELLS_FINE ? tasks_add(s, t, number) : status;
}

// ---- Cells ----

static cells_status entry_add(cells_build *b, const cells_piece *p)
{
    const bsp_entry entry = {p->item, b->entry_points.count, p->point_count, p->plane};
    if (p->point_count) {
        cull_point *to = vector_push(&b->entry_points, p->point_count);
        if (!to) return CELLS_NO_MEMORY;
        memcpy(to, (const cull_point *)b->points.items + p->first_point, p->point_count * sizeof *to);
    }
    return vector_add(&b->entries, &entry) ? CELLS_FINE : CELLS_NO_MEMORY;
}

static cells_status stand_add(cells_build *b, const cells_piece *p)
{
    const cells_stand stand = {p->item, b->cells.count, p->plane, p->first_point, p->point_count};
    return vector_add(&b->stands, &stand) ? CELLS_FINE : CELLS_NO_MEMORY;
}

static cells_status cell_make(split *s, const split_task *t)
{
    cells_build *b = s->b;
    const cells_piece *pieces = (const cells_piece *)s->stack.items + t->first;
    bsp_cell cell = {.parent = t->parent, .first_entry = b->entries.count};
    cells_made made = {b->stands.count, 0};
    cells_status status = CELLS_FINE;
    for (uint32_t i = 0; i < t->count && status == CELLS_FINE; i++) {
        if (pieces[i].flags & PIECE_BACK) continue;
        status = pieces[i].flags & PIECE_PORTAL ? stand_add(b, &pieces[i]) : entry_add(b, &pieces[i]);
    }
    cell.entry_count = b->entries.count - cell.first_entry;
    cell.first_back = b->entries.count;
    made.stand_count = b->stands.count - made.first_stand;
    for (uint32_t i = 0; i < t->count && status == CELLS_FINE; i++)
        if (pieces[i].flags & PIECE_BACK) status = entry_add(b, &pieces[i]);
    cell.back_count = b->entries.count - cell.first_back;
    s->stack.count = t->first;
    child_set(b, t, BSP_LEAF | b->cells.count);
    if (status == CELLS_FINE && !(vector_add(&b->cells, &cell) && vector_add(&b->made, &made))) status = CELLS_NO_MEMORY;
    return status;
}

static int is_too_many(const cells_build *b, const split *s)
{
    const uint64_t bytes = (uint64_t)(b->points.capacity + (uint64_t)b->entry_points.capacity) * sizeof(cull_point) +
                           (uint64_t)s->stack.capacity * sizeof(cells_piece) + (uint64_t)b->entries.capacity * sizeof(bsp_entry);
    return b->cells.count > CELLS_MOST || b->nodes.count > CELLS_MOST || b->work > CELLS_WORK_MOST || bytes > CELLS_BYTES_MOST;
}

static cells_status task_run(split *s, const split_task *t)
{
    s->b->work += t->count;
    if (is_too_many(s->b, s)) return CELLS_TOO_MANY;
    if (t->depth > s->b->depth) s->b->depth = t->depth;
    const uint32_t plane = splitter_of(s, t);
    return plane == BSP_NONE ? cell_make(s, t) : node_make(s, t, plane);
}

cells_status cells_split(cells_build *b, bsp_vector *pieces)
{
    split s = {.b = b, .stack = *pieces, .tasks = vector_make(b->host, sizeof(split_task))};
    for (int side = 0; side < 2; side++) s.parts[side] = vector_make(b->host, sizeof(cells_piece));
    *pieces = vector_make(b->host, sizeof(cells_piece));
    s.seen = vector_make(b->host, sizeof(uint32_t));
    const split_task root = {0, s.stack.count, BSP_NONE, 0, 0};
    uint32_t *seen = vector_push(&s.seen, b->planes.count);
    if (seen) memset(seen, 0, b->planes.count * sizeof *seen);
    const int is_ready = (seen || !b->planes.count) && vector_reserve(&s.stack, 1) && vector_add(&s.tasks, &root);
    cells_status status = is_ready ? CELLS_FINE : CELLS_NO_MEMORY;
    while (s.tasks.count > 0 && status == CELLS_FINE) {
        const split_task t = ((const split_task *)s.tasks.items)[--s.tasks.count];
        status = task_run(&s, &t);
    }
    vector_free(&s.stack);
    vector_free(&s.tasks);
    vector_free(&s.seen);
    for (int side = 0; side < 2; side++) vector_free(&s.parts[side]);
    return status;
}
