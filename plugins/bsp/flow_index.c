// See flow_index.h.
// SPDX-License-Identifier: MIT
#include "flow_index.h"
#include "loop_bent.h"

#include <portcullis/face.h>

#include <float.h>
#include <math.h>
#include <string.h>

static float float_above(double value)
{
    const float rounded = (float)value;
    return (double)rounded < value ? nextafterf(rounded, FLT_MAX) : rounded;
}

typedef struct face_source {
    const bsp_plane *plane;
    const cull_point *points;
    uint32_t count, who, bits;
    int is_behind; // seen from behind the plane
    int is_turned; // the points run clockwise from where it is seen
} face_source;

static flow_word *plane_write(const face_source *s, flow_word *to)
{
    const double sign = s->is_behind ? -1 : 1;
    for (int k = 0; k < 3; k++) to[k].f = (float)(sign * s->plane->normal[k]);
    to[3].f = (float)(sign * s->plane->offset);
    return to + 4;
}

static flow_word *ball_write(const flow_word *points, uint32_t count, flow_word *to)
{
    double middle[3], most = 0;
    for (uint32_t k = 0; k < 3; k++) {
        double low = DBL_MAX, high = -DBL_MAX;
        for (uint32_t i = 0; i < count; i++) {
            const double p = (double)points[k * count + i].f;
            low = p < low ? p : low;
            high = p > high ? p : high;
        }
        to[k].f = (float)((low + high) / 2);
        middle[k] = (double)to[k].f;
    }
    for (uint32_t i = 0; i < count; i++) {
        double square = 0;
        for (uint32_t k = 0; k < 3; k++) {
            const double d = (double)points[k * count + i].f - middle[k];
            square += d * d;
        }
        most = square > most ? square : most;
    }
    to[3].f = float_above(sqrt(most) * (1 + 0x1p-40));
    return to + 4;
}

static cull_vec3 corner_at(const flow_word *points, uint32_t count, uint32_t i)
{
    return (cull_vec3){points[i].f, points[count + i].f, points[2 * count + i].f};
}

// One of more corners than the flow takes is seen whole anyhow.
static uint32_t bent_bit(const flow_word *points, uint32_t count, const flow_word *plane, double bent_m)
{
    cull_vec3 loop[FLOW_POINTS];
    const double normal[3] = {(double)plane[0].f, (double)plane[1].f, (double)plane[2].f};
    if (count > FLOW_POINTS) return 0;
    for (uint32_t i = 0; i < count; i++) loop[i] = corner_at(points, count, i);
    return loop_is_bent(loop, count, normal, bent_m) ? FACE_BENT : 0;
}

static flow_word *face_write(const face_source *s, double bent_m, flow_word *to)
{
    flow_word *points = to + FACE_HEAD;
    for (uint32_t i = 0; i < s->count; i++) {
        const cull_point p = s->points[s->is_turned ? s->count - 1 - i : i];
        points[i].f = (float)p.x;
        points[s->count + i].f = (float)p.y;
        points[2 * s->count + i].f = (float)p.z;
    }
    plane_write(s, to);
    ball_write(points, s->count, to + FACE_BALL);
    to[FACE_WHO].u = s->who;
    to[FACE_BITS].u = s->count | s->bits | bent_bit(points, s->count, to, bent_m);
    return points + 3 * (size_t)s->count;
}

static flow_word *box_write(cull_box box, uint32_t item, flow_word *to)
{
    const float rows[2][4] = {{box.min.x, box.min.y, box.min.z, 0}, {box.max.x, box.max.y, box.max.z, 0}};
    for (int k = 0; k < 4; k++) {
        to[FACE_PLANE + k].f = rows[0][k];
        to[FACE_BALL + k].f = rows[1][k];
    }
    to[FACE_WHO].u = item;
    to[FACE_BITS].u = 0;
    return to + FACE_HEAD;
}

typedef struct packing {
    const cull_zone *zone;
    const uint32_t *order;
    const bsp_cells_data *cells;
    double graze;   // metres, see flow.h: an eye that far behind a wall's plane sees no front
    double bent_m;  // that corners may stand outside of an edge's line
} packing;

static uint32_t zone_item(const packing *p, uint32_t place)
{
    return p->order ? p->order[place] : place;
}

// 1: no eye that stands more than `graze` behind the wall's plane sees the front of a triangle that is drawn for it. Rounding turns a
// sliver's front by so much that eyes centimetres behind see it: such a wall counts as two-sided here, and the walk drops what it can.
static int is_one_sided(const packing *p, uint32_t item)
{
    const cull_zone *zone = p->zone;
    if (zone->items[item].flags & CULL_ITEM_TWO_SIDED) return 0;
    if (!zone->walls || zone->walls[item].vertex_count == 0) return 1; // pieces of none
    const cull_plane *plane = &zone->planes[zone->walls[item].plane];
    const double sizes = (fabs((double)plane->normal.x) + fabs((double)plane->normal.y)) + fabs((double)plane->normal.z);
    double offset, turn;
    cull_wall_doubt(zone, &zone->items[item], plane, &offset, &turn);
    offset -= CULL_FACE_ROUNDING * fabs((double)plane->offset); // this and the next are for tests in float, which the flow makes in double
    turn -= CULL_FACE_ROUNDING * sizes;
    return turn * (double)zone->radius + offset <= p->graze;
}

static flow_word *entry_write(const packing *p, const bsp_entry *e, int is_behind, flow_word *to)
{
    const uint32_t item = zone_item(p, e->item);
    if (e->point_count == 0) return box_write(cull_box_at(&p->zone->boxes, item), e->item, to);
    face_source s = {.plane = &p->cells->planes[e->plane], .points = p->cells->entry_points + e->first_point, .count = e->point_count, .who = e->item};
    s.is_behind = s.is_turned = is_behind;
    s.bits = (is_behind ? FACE_BACK : 0) | (is_one_sided(p, item) ? FACE_ONE_SIDED : 0);
    return face_write(&s, p->bent_m, to);
}

static flow_word *opening_write(const packing *p, const bsp_opening *o, flow_word *to)
{
    face_source s = {.plane = &p->cells->planes[o->plane], .points = p->cells->opening_points + o->first_point, .count = o->point_count, .who = o->to};
    s.is_behind = o->side == 1;
    return face_write(&s, p->bent_m, to);
}

static size_t words_of(const bsp_cells_data *c)
{
    const size_t faces = (size_t)c->opening_count + c->entry_count;
    size_t points = c->opening_point_count;
    for (uint32_t i = 0; i < c->entry_count; i++) points += c->entries[i].point_count; // of touching ones, again
    return FACE_HEAD * faces + 3 * points;
}

static void nodes_write(const bsp_cells_data *c, flow_node *to)
{
    for (uint32_t i = 0; i < c->node_count; i++) {
        const bsp_node *n = &c->nodes[i];
        flow_word plane[4];
        const face_source s = {.plane = &c->planes[n->plane]};
        plane_write(&s, plane);
        to[i] = (flow_node){{plane[0].f, plane[1].f, plane[2].f}, plane[3].f, {n->child[0], n->child[1]}, n->parent, 0};
    }
}

static void cells_write(const packing *p, bsp_flow_index *out)
{
    const bsp_cells_data *c = p->cells;
    flow_word *to = out->words;
    for (uint32_t i = 0; i < c->cell_count; i++) {
        const bsp_cell *cell = &c->cells[i];
        uint32_t fronts = 0;
        out->cells[i] = (flow_cell){(size_t)(to - out->words), cell->parent, cell->opening_count, cell->entry_count + cell->back_count + cell->apart_count, 0,
                                    cell->touching_count - cell->apart_count, 0};
        for (uint32_t k = 0; k < cell->opening_count; k++) to = opening_write(p, &c->openings[cell->first_opening + k], to);
        for (uint32_t k = 0; k < cell->entry_count; k++) {
            to = entry_write(p, &c->entries[cell->first_entry + k], 0, to);
            fronts += c->entries[cell->first_entry + k].point_count > 0;
        }
        for (uint32_t k = 0; k < cell->back_count; k++) to = entry_write(p, &c->entries[cell->first_back + k], 1, to);
        for (uint32_t k = 0; k < cell->touching_count; k++) to = entry_write(p, &c->entries[cell->first_touching + k], 0, to);
        out->cells[i].front_count = fronts;
    }
}

cull_result bsp_flow_build(const cull_host *host, const cull_zone *zone, const uint32_t *order, const bsp_cells_data *cells, bsp_flow_index *out)
{
    bsp_flow_index made = {.word_count = words_of(cells), .node_count = cells->node_count, .cell_count = cells->cell_count};
    *out = (bsp_flow_index){.slack = 0};
    if (cells->cell_count == 0) return CULL_OK;
    const double rounding = 0x1p-22 * (double)zone->radius; // points: sqrt(3) 2^-24, planes: (sqrt(3) + 1) 2^-24 of it
    made.slack = cells->slack + 2 * rounding;
    made.nodes = host->alloc(host, (made.node_count + (size_t)1) * sizeof *made.nodes, 64);
    made.cells = host->alloc(host, made.cell_count * sizeof *made.cells, 64);
    made.words = host->alloc(host, (made.word_count + 1) * sizeof *made.words, 64);
    if (!made.nodes || !made.cells || !made.words) {
        bsp_flow_free(host, &made);
        return CULL_ERR_MEMORY;
    }
    const packing p = {zone, order, cells, 2 * made.slack, rounding};
    nodes_write(cells, made.nodes);
    cells_write(&p, &made);
    *out = made;
    return CULL_OK;
}

void bsp_flow_free(const cull_host *host, bsp_flow_index *index)
{
    if (index->nodes) host->free(host, index->nodes, (index->node_count + (size_t)1) * sizeof *index->nodes);
    if (index->cells) host->free(host, index->cells, index->cell_count * sizeof *index->cells);
    if (index->words) host->free(host, index->words, (index->word_count + 1) * sizeof *index->words);
    *index = (bsp_flow_index){.slack = 0};
}

size_t bsp_flow_bytes(const bsp_flow_index *index)
{
    return index->node_count * sizeof *index->nodes + index->cell_count * sizeof *index->cells + index->word_count * sizeof *index->words;
}
