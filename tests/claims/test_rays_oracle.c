// Rays: see test_rays_oracle.h. A tree of boxes split at the middle triangle, nearest child first.
// SPDX-License-Identifier: MIT
#include "test_rays_oracle.h"

#include "tests/common/test.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LEAF = 4, DEPTH = 64 };

typedef struct face {
    double corner[3][3], normal[3], inward[3][3]; // inward: of each edge, in the plane; unit vectors
    double middle[3], key;                        // key: of the middle along the axis that is being sorted by
    uint32_t item, is_veil, is_one_sided, moves;
} face;

typedef struct box_node {
    double min[3], max[3];
    uint32_t first, count; // faces; count 0: children are the next node and `first`
} box_node;

struct ray_oracle {
    double origin[3], rounding_m;
    face *faces;
    box_node *nodes;
    uint32_t face_count, node_count;
};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static double normalize(double v[3])
{
    const double length = sqrt(dot(v, v));
    for (int k = 0; k < 3 && length > 0; ++k) v[k] /= length;
    return length;
}

// ---- Faces ----

// Of no area: an edge of others, which know it.
static int face_make(face *f)
{
    double edge[3][3];
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            edge[i][k] = f->corner[(i + 1) % 3][k] - f->corner[i][k];
            if (i == 0) f->middle[k] = (f->corner[0][k] + f->corner[1][k] + f->corner[2][k]) / 3;
        }
    cross(edge[0], edge[1], f->normal);
    if (!(normalize(f->normal) > 0)) return 0;
    for (int i = 0; i < 3; ++i) {
        cross(f->normal, edge[i], f->inward[i]);
        normalize(f->inward[i]);
    }
    return 1;
}

static void corner_of(const scene *s, const scene_pose *pose, uint32_t index, double out[3])
{
    const cull_vec3 p = s->positions[s->indices[index]];
    const double at[3] = {(double)p.x, (double)p.y, (double)p.z};
    memcpy(out, at, sizeof at);
    if (!pose) return;
    double from[3];
    for (int k = 0; k < 3; ++k) from[k] = at[k] + s->whole.origin[k] - pose->pivot[k];
    for (int k = 0; k < 3; ++k) out[k] = dot(pose->rotation + 3 * k, from) + pose->pivot[k] + pose->offset[k] - s->whole.origin[k];
}

static void add_item(ray_oracle *o, const scene *s, uint32_t id)
{
    const scene_item *item = &s->items[id];
    scene_pose pose;
    const int moves = id >= s->item_count;
    if (moves) scene_pose_at(s, id - s->item_count, 0, DOORS_OPEN, &pose);
    for (uint32_t i = 0; i + 2 < item->index_count; i += 3) {
        face *f = &o->faces[o->face_count];
        for (uint32_t c = 0; c < 3; ++c) corner_of(s, moves ? &pose : NULL, item->first_index + i + c, f->corner[c]);
        f->item = id;
        f->moves = (uint32_t)moves;
        f->is_veil = (item->flags & (CULL_ITEM_SEE_THROUGH | CULL_ITEM_CUT_OUT)) != 0;
        f->is_one_sided = (item->flags & (CULL_ITEM_WALL | CULL_ITEM_TWO_SIDED)) == CULL_ITEM_WALL;
        o->face_count += (uint32_t)face_make(f);
    }
}

// ---- Tree ----

static int by_key(const void *a, const void *b)
{
    const double x = ((const face *)a)->key, y = ((const face *)b)->key;
    return (x > y) - (x < y);
}

static void node_bound(const ray_oracle *o, box_node *n, uint32_t first, uint32_t count)
{
    for (int k = 0; k < 3; ++k) {
        n->min[k] = INFINITY;
        n->max[k] = -INFINITY;
        for (uint32_t i = 3 * first; i < 3 * (first + count); ++i) {
            const double at = o->faces[i / 3].corner[i % 3][k];
            n->min[k] = fmin(n->min[k], at);
            n->max[k] = fmax(n->max[k], at);
        }
    }
}

static void node_make(ray_oracle *o, uint32_t first, uint32_t count)
{
    box_node *n = &o->nodes[o->node_count++];
    node_bound(o, n, first, count);
    n->first = first;
    n->count = count;
    if (count <= LEAF) return;
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (n->max[k] - n->min[k] > n->max[axis] - n->min[axis]) axis = k;
    for (uint32_t i = first; i < first + count; ++i) o->faces[i].key = o->faces[i].middle[axis];
    qsort(o->faces + first, count, sizeof *o->faces, by_key);
    n->count = 0;
    node_make(o, first, count / 2);
    n->first = o->node_count;
    node_make(o, first + count / 2, count - count / 2);
}

ray_oracle *ray_oracle_open(const scene *s)
{
    ray_oracle *o = calloc(1, sizeof *o);
    assert_non_null(o);
    o->faces = calloc(s->index_count / 3 + 1, sizeof *o->faces);
    o->nodes = calloc(s->index_count / 3 * 2 + 2, sizeof *o->nodes);
    assert_true(o->faces && o->nodes);
    memcpy(o->origin, s->whole.origin, sizeof o->origin);
    o->rounding_m = RAYS_ROUNDING * (double)s->whole.radius;
    for (uint32_t i = 0; i < s->item_count + s->mover_count; ++i) add_item(o, s, i);
    assert_true(o->face_count > 0);
    node_make(o, 0, o->face_count);
    return o;
}

void ray_oracle_close(ray_oracle *o)
{
    free(o->faces);
    free(o->nodes);
    free(o);
}

// ---- A ray ----

typedef struct sighting {
    double hit, graze, veil;
    uint32_t item, veil_item, is_back;
} sighting;
typedef struct cast {
    const ray_oracle *oracle;
    double from[3], along[3], inverse[3];
    sighting seen[RAYS_SIDES];
    double grown;
    uint32_t enters;
} cast;

static double smaller(double a, double b)
{
    return a < b ? a : b;
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

// Of all that may still matter: what is nearer than this.
static double reach_of(const cast *c)
{
    double most = 0;
    for (int s = 0; s < RAYS_SIDES; ++s) most = larger(most, smaller(c->seen[s].hit, c->seen[s].graze));
    return most;
}

static double slack_at(const cast *c, double distance)
{
    return RAYS_GRAZING * distance + c->oracle->rounding_m;
}

static void note(sighting *s, const face *f, double distance, int is_sure, int is_back)
{
    if (!is_sure && !f->is_veil) s->graze = smaller(s->graze, distance);
    if (is_sure && f->is_veil && distance < s->veil) {
        s->veil = distance;
        s->veil_item = f->item;
    }
    if (is_sure && !f->is_veil && distance < s->hit) {
        s->hit = distance;
        s->item = f->item;
        s->is_back = (uint32_t)is_back;
    }
}

static void meet(cast *c, const face *f)
{
    double at[3];
    for (int k = 0; k < 3; ++k) at[k] = f->corner[0][k] - c->from[k];
    const double height = dot(f->normal, at), slope = dot(f->normal, c->along);
    const double distance = height / slope; // along its own plane: infinite or no number, and then nothing is met
    const double nearest = slack_at(c, 0) / fabs(slope);
    if (!(distance > -nearest) || !(distance < reach_of(c) + nearest)) return;
    double least = INFINITY;
    for (int i = 0; i < 3; ++i) {
        double from_corner[3];
        for (int k = 0; k < 3; ++k) from_corner[k] = c->from[k] + distance * c->along[k] - f->corner[i][k];
        least = smaller(least, dot(f->inward[i], from_corner));
    }
    const double slack = slack_at(c, fabs(distance)) / fabs(slope); // across the ray, so more along a plane that it meets flat
    if (least < -slack) return;
    const int is_sure = least > slack && distance > RAYS_START_M;
    const int is_back = slope > 0;
    if (distance <= RAYS_START_M && !is_back && !f->moves && !f->is_veil) c->enters = 1;
    if (distance <= RAYS_START_M - nearest) return;
    note(&c->seen[RAYS_BOTH_SIDES], f, distance, is_sure, is_back);
    if (!f->moves) note(&c->seen[RAYS_FIXED], f, distance, is_sure, is_back);
    if (!is_back || !f->is_one_sided) note(&c->seen[RAYS_FRONTS], f, distance, is_sure, is_back);
}

// Where the ray enters the box, grown by what grazing may need; INFINITY: it doesn't.
static double entry_of(const cast *c, const box_node *n)
{
    double near = 0, far = DBL_MAX;
    for (int k = 0; k < 3; ++k) {
        const double a = (n->min[k] - c->grown - c->from[k]) * c->inverse[k], b = (n->max[k] + c->grown - c->from[k]) * c->inverse[k];
        near = larger(near, smaller(a, b));
        far = smaller(far, larger(a, b));
    }
    return near <= far ? near : INFINITY;
}

static void walk(cast *c)
{
    struct {
        uint32_t node;
        double entry;
    } stack[DEPTH];
    uint32_t depth = 0;
    const box_node *nodes = c->oracle->nodes;
    stack[depth].node = 0;
    stack[depth++].entry = entry_of(c, nodes);
    while (depth > 0) {
        const uint32_t at = stack[--depth].node;
        if (!(stack[depth].entry <= reach_of(c) + c->grown) || isinf(stack[depth].entry)) continue;
        const box_node *n = &nodes[at];
        for (uint32_t i = n->first; n->count && i < n->first + n->count; ++i) meet(c, &c->oracle->faces[i]);
        if (n->count) continue;
        const double left = entry_of(c, &nodes[at + 1]), right = entry_of(c, &nodes[n->first]);
        const int left_first = left <= right;
        assert_true(depth + 2 <= DEPTH);
        stack[depth].node = left_first ? n->first : at + 1;
        stack[depth++].entry = left_first ? right : left;
        stack[depth].node = left_first ? at + 1 : n->first;
        stack[depth++].entry = left_first ? left : right;
    }
}

// Of all the scene from there: the farthest that grazing reaches.
static double growth_of(const cast *c)
{
    const box_node *all = c->oracle->nodes;
    double size = 0;
    for (int k = 0; k < 3; ++k) size += larger(fabs(all->min[k] - c->from[k]), fabs(all->max[k] - c->from[k]));
    return 2 * slack_at(c, size);
}

void ray_oracle_cast(const ray_oracle *o, const ray *r, ray_hit out[RAYS_SIDES])
{
    cast c = {.oracle = o};
    for (int k = 0; k < 3; ++k) {
        c.from[k] = r->from[k] - o->origin[k];
        c.along[k] = r->along[k];
        c.inverse[k] = 1 / (fabs(r->along[k]) > 1e-300 ? r->along[k] : 1e-300);
    }
    for (int s = 0; s < RAYS_SIDES; ++s) c.seen[s] = (sighting){INFINITY, INFINITY, INFINITY, SCENE_NONE, SCENE_NONE, 0};
    c.grown = growth_of(&c);
    walk(&c);
    for (int s = 0; s < RAYS_SIDES; ++s) {
        const sighting *x = &c.seen[s];
        const double slack = slack_at(&c, fmin(x->hit, x->graze));
        const double clear = fmin(x->hit, x->graze - slack); // two walls that meet where the ray ends graze each other
        out[s] = (ray_hit){.end = x->graze <= x->hit + slack ? RAY_GRAZES
                                  : isinf(x->hit)            ? RAY_ESCAPES
                                                             : RAY_HITS,
                           .item = x->item,
                           .is_back = x->is_back,
                           .distance = x->hit};
        out[s].enters = c.enters;
        out[s].veil = x->veil < clear - slack ? x->veil_item : SCENE_NONE;
        if (isinf(x->graze) && isinf(x->hit)) out[s].end = RAY_ESCAPES;
    }
}
