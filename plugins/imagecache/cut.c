// Geometry up to a ring, pictures beyond it: see cut.h.
// SPDX-License-Identifier: MIT
#include "cut.h"

#include "quad.h"

#include <string.h>

#define HYSTERESIS 1.3       // a choice that stands is kept while it costs no more than this times the other
#define RING_WORTH 0.05      // of what all costs: less is not worth a square of another size
#define FRAMES_MOST 1000.0   // that a picture is foretold to last: until then something else happens
#define SEAM_SINE 0.25       // surfaces that cross a seam are guarded down to 14 degrees from the line of sight
#define SINE_LEAST 0.2       // between step and line of sight: the step turns before less comes to count
#define FLOATS_PER_TEXEL (72.0 / 16777216) // of the largest coordinate, see QUAD_TOO_FINE
#define COVERED 0.5          // of a node's rectangle that geometry covers and nothing nearer hides, about

int cut_open(const cull_host *host, const cells *c, const lists *l, cut *out)
{
    const uint32_t nodes = l->node_count, most_rings = (c->ground.columns > c->ground.rows ? c->ground.columns : c->ground.rows) + 2;
    const size_t numbers = 2 * most_rings * sizeof(double) + nodes * (sizeof(float) + 3 * sizeof(uint32_t) + 2);
    memset(out, 0, sizeof *out);
    out->bytes = numbers;
    out->by_ring = host->alloc(host, out->bytes, _Alignof(double));
    if (!out->by_ring) return 0;
    memset(out->by_ring, 0, out->bytes);
    out->cells = c;
    out->lists = l;
    out->ring_count = most_rings;
    out->drawn_ring = out->by_ring + most_rings;
    out->prices = (float *)(out->drawn_ring + most_rings);
    out->stamps = (uint32_t *)(out->prices + nodes);
    out->seen = out->stamps + nodes;
    out->taken = out->seen + nodes;
    out->choices = (uint8_t *)(out->taken + nodes);
    out->marks = out->choices + nodes;
    return 1;
}

void cut_close(const cull_host *host, cut *c)
{
    if (c->by_ring) host->free(host, c->by_ring, c->bytes);
}

double cut_delta(double distance, double pixels_per_tangent, double tolerance_px)
{
    const quad_seam seam = {2 * tolerance_px, distance, pixels_per_tangent, distance / pixels_per_tangent, SEAM_SINE};
    return quad_seam_delta(&seam);
}

// ---- What a picture costs a frame ----

typedef struct spot {
    double from_eye[3], distance, half[3], radius; // of a box
} spot;

static spot spot_of(const double eye[3], const cull_box *box)
{
    const double low[3] = {box->min.x, box->min.y, box->min.z}, high[3] = {box->max.x, box->max.y, box->max.z};
    spot s;
    for (int k = 0; k < 3; k++) {
        s.from_eye[k] = (low[k] + high[k]) / 2 - eye[k];
        s.half[k] = (high[k] - low[k]) / 2;
    }
    s.distance = sqrt(bound_dot(s.from_eye, s.from_eye));
    s.radius = sqrt(bound_dot(s.half, s.half));
    return s;
}

// Across the view's direction a sphere beside it is drawn out, seen from its middle: with its radius r and its way off the axis t, in depths of the middle,
// to r (1 + t) / (1 - r), which QUAD_WIDEST bounds.
static int can_be_aligned(const cut_request *q, const spot *s, double around)
{
    const double depth = bound_dot(s->from_eye, q->forward), square = s->distance * s->distance - depth * depth;
    const double aside = square > 0 ? sqrt(square) : 0;
    return depth - around > 2 * q->optics.near_distance && around * (2 * depth + aside) < depth * depth;
}

// A sphere around it is seen within 40 degrees of its middle, and its texels are far coarser than floats.
static int can_be_taken(const cut_request *q, const spot *s)
{
    const double around = s->radius + 1.5 * cut_delta(s->distance, q->optics.pixels_per_tangent, q->tolerance_px);
    if (q->planes == CUT_ALIGNED && !can_be_aligned(q, s, around)) return 0;
    return s->distance > 1.6 * around && s->distance - around > 2 * q->optics.near_distance &&
           s->distance - around > FLOATS_PER_TEXEL * 1.5 * (q->radius + s->distance) * q->optics.pixels_per_tangent;
}

int cut_can_be_taken(const cut_request *q, const cull_box *box)
{
    const spot s = spot_of(q->eye, box);
    return can_be_taken(q, &s);
}

// The bound of bound.h for a point at the height of the box's half, f b sin(t) h / (D (D - h)) = tolerance, solved for the way b; taken from
// where the eye will be, it holds twice that way.
static double frames_of(const cut_request *q, const spot *s)
{
    const double speed = q->speed, length = sqrt(bound_dot(q->step, q->step));
    double height = 0, along = 0;
    for (int k = 0; k < 3; k++) {
        height += fabs(s->from_eye[k]) * s->half[k];
        along += s->from_eye[k] * q->step[k];
    }
    height /= s->distance;
    const double cosine = length > 0 ? along / (length * s->distance) : 0, square = 1 - cosine * cosine;
    const double sine = square > SINE_LEAST * SINE_LEAST ? sqrt(square) : SINE_LEAST;
    const double way = q->tolerance_px * s->distance * (s->distance - height) / (q->optics.pixels_per_tangent * height);
    const double frames = 1 + 2 * way / (speed * sine);
    return frames < FRAMES_MOST ? frames : FRAMES_MOST;
}

static double pixels_of(const cut_request *q, const spot *s)
{
    const double scale = q->optics.pixels_per_tangent / s->distance;
    const double wide = 2 * scale * (fabs(s->from_eye[0]) * s->half[2] + fabs(s->from_eye[2]) * s->half[0]) / s->distance;
    return wide * 2 * scale * (s->half[1] + 0.2 * (s->half[0] + s->half[2]));
}

// Each pixel of the rectangle is looked up, what is transparent there too.
static double showing_price(const cut_request *q, const spot *s)
{
    const double pixels = pixels_of(q, s), shown = pixels < q->optics.pixels ? pixels : q->optics.pixels;
    return q->costs->picture_ns + shown * q->picture_pixel_ns;
}

static double taking_price(const cut_request *q, const lists_node *node, const spot *s)
{
    const cull_costs *c = q->costs;
    return c->capture_ns + node->polygon_count * c->polygon_ns + pixels_of(q, s) * (c->capture_pixel_ns + COVERED * c->pixel_ns);
}

static double picture_price(const cut_request *q, const lists_node *node, const spot *s)
{
    const double frames = q->wear > 0 ? frames_of(q, s) / q->wear : frames_of(q, s);
    return showing_price(q, s) + taking_price(q, node, s) / (frames > 1 ? frames : 1);
}

cut_price cut_price_of(const cut_request *q, const lists_node *node)
{
    const spot s = spot_of(q->eye, &node->box);
    return (cut_price){showing_price(q, &s), taking_price(q, node, &s), frames_of(q, &s)};
}

static double geometry_price(const cut_request *q, const lists_node *node, const spot *s)
{
    const double pixels = pixels_of(q, s), shown = pixels < q->optics.pixels ? pixels : q->optics.pixels;
    return (double)node->polygon_share * q->costs->polygon_ns + COVERED * shown * q->costs->pixel_ns;
}

double cut_geometry_ns(const cut_request *q, const lists_node *cell)
{
    const spot s = spot_of(q->eye, &cell->box);
    return geometry_price(q, cell, &s);
}

// ---- The tree, from the cells up ----

static void see(cut *c, uint32_t node)
{
    if (c->stamps[node] == c->stamp) return;
    c->stamps[node] = c->stamp;
    c->seen[c->seen_count++] = node;
}

static void see_cells(cut *c, const inview *v)
{
    const ground *g = &c->cells->ground;
    c->seen_count = 0;
    c->stamp++;
    for (uint32_t k = 0; k < v->count; k++) {
        const ground_cell at = {(int32_t)(v->list[k] % g->columns), (int32_t)(v->list[k] / g->columns)};
        see(c, nodes_of_cell(g, at));
    }
}

static double children_price(const cut *c, uint32_t node)
{
    double sum = 0;
    for (uint32_t k = 0; k < 4; k++) {
        const uint32_t child = nodes_child(node, k);
        if (c->stamps[child] == c->stamp) sum += (double)c->prices[child];
    }
    return sum;
}

static void weigh_node(cut *c, const cut_request *q, uint32_t node, uint32_t first_cell)
{
    const lists_node *n = &c->lists->nodes[node];
    const spot s = spot_of(q->eye, &n->box);
    double one = can_be_taken(q, &s) ? picture_price(q, n, &s) : INFINITY;
    const int stood = c->choices[node] == NODES_TAKE;
    if (node >= first_cell) {
        c->prices[node] = (float)one;
        c->choices[node] = one < INFINITY ? NODES_TAKE : NODES_OPEN;
        return;
    }
    const double parts = children_price(c, node);
    if (q->nodes == CUT_CELLS) one = INFINITY;
    const int takes = q->history == CUT_ANEW ? one <= parts : stood ? one <= parts * HYSTERESIS : one * HYSTERESIS <= parts;
    c->choices[node] = takes && one < INFINITY ? NODES_TAKE : NODES_OPEN;
    c->prices[node] = (float)(takes ? one : parts);
}

// ---- The ring ----

static int32_t ring_of(const cut *c, const cut_request *q, uint32_t cell)
{
    const ground *g = &c->cells->ground;
    return cut_ring(q->eye_cell, (int32_t)(cell % g->columns), (int32_t)(cell / g->columns));
}

// A cell's share of the picture that it is in: the highest node above it that is taken.
static double share_of(const cut *c, uint32_t node)
{
    uint32_t shown = node;
    for (uint32_t at = node; at > 0;) {
        at = nodes_parent(at);
        if (c->choices[at] == NODES_TAKE) shown = at;
    }
    if (shown == node) return (double)c->prices[node];
    const double all = c->lists->nodes[shown].polygon_count, own = c->lists->nodes[node].polygon_count;
    return (double)c->prices[shown] * (own < all ? own / all : 1);
}

// Sums by rings; returns the last one in view. *least: the last one with a cell of which no picture can be taken.
static int32_t sum_rings(cut *c, const cut_request *q, int32_t *least)
{
    const ground *g = &c->cells->ground;
    const inview *v = q->inview;
    int32_t last = -1;
    *least = -1;
    c->geometry_ns = c->picture_ns = 0;
    for (uint32_t k = 0; k < v->count; k++) {
        const uint32_t node = nodes_of_cell(g, (ground_cell){(int32_t)(v->list[k] % g->columns), (int32_t)(v->list[k] / g->columns)});
        const int32_t ring = ring_of(c, q, v->list[k]);
        const spot s = spot_of(q->eye, &c->lists->nodes[node].box);
        const double drawn = geometry_price(q, &c->lists->nodes[node], &s);
        const int is_taken = (double)c->prices[node] < INFINITY;
        const double share = is_taken ? share_of(c, node) : drawn;
        if (!is_taken && ring > *least) *least = ring;
        if (ring > last) last = ring;
        c->geometry_ns += drawn;
        c->picture_ns += share;
        c->by_ring[ring] += drawn - share;
        c->drawn_ring[ring] += drawn;
    }
    return last;
}

// The one up to which geometry instead of pictures costs least in all.
static void settle_ring(cut *c, const cut_request *q)
{
    int32_t least;
    const int32_t last = sum_rings(c, q, &least);
    int32_t best = least;
    double sum = 0, lowest = least < 0 ? 0 : INFINITY, at_old = INFINITY;
    for (int32_t ring = 0; ring <= last; ring++) {
        sum += c->by_ring[ring];
        if (ring < least) continue;
        if (ring == c->ring) at_old = sum;
        if (sum < lowest) lowest = sum, best = ring;
    }
    if (c->ring < 0 && least < 0) at_old = 0;
    const int stays = q->history == CUT_GOES_ON && at_old - lowest < RING_WORTH * (c->picture_ns + lowest);
    if (!stays) c->ring = best;
    c->ring_ns = 0;
    for (int32_t ring = 0; ring <= last; ring++) {
        if (ring <= c->ring) c->ring_ns += c->drawn_ring[ring];
        c->by_ring[ring] = c->drawn_ring[ring] = 0;
    }
}

// ---- The nodes beyond it ----

typedef struct descent { uint32_t node; nodes_square square; } descent;

static int32_t least_ring(ground_cell eye, nodes_square s)
{
    const int32_t end_i = s.first.i + s.side - 1, end_j = s.first.j + s.side - 1;
    const int32_t i = eye.i < s.first.i ? s.first.i : eye.i > end_i ? end_i : eye.i, j = eye.j < s.first.j ? s.first.j : eye.j > end_j ? end_j : eye.j;
    return cut_ring(eye, i, j);
}

static void take_nodes(cut *c, const cut_request *q)
{
    const ground *g = &c->cells->ground;
    descent stack[NODES_STACK] = {{0, {{0, 0}, (int32_t)1 << g->level}}};
    uint32_t depth = c->seen_count > 0;
    memset(c->marks, NODES_SKIP, c->lists->node_count);
    while (depth > 0) {
        const descent at = stack[--depth];
        const int is_beyond = least_ring(q->eye_cell, at.square) > c->ring, is_cell = at.square.side == 1;
        if (is_beyond && c->choices[at.node] == NODES_TAKE) {
            c->marks[at.node] = NODES_TAKE;
            continue;
        }
        if (is_cell) continue;
        c->marks[at.node] = NODES_OPEN;
        const int32_t half = at.square.side / 2;
        for (uint32_t k = 0; k < 4; k++) {
            const uint32_t child = nodes_child(at.node, k);
            if (c->stamps[child] != c->stamp) continue;
            const nodes_square s = {{at.square.first.i + (k & 1 ? half : 0), at.square.first.j + (k & 2 ? half : 0)}, half};
            stack[depth++] = (descent){child, s};
        }
    }
    c->taken_count = nodes_in_order(g, c->marks, q->eye_cell, c->taken);
    c->taken_ns = 0;
    for (uint32_t k = 0; k < c->taken_count; k++) {
        const spot s = spot_of(q->eye, &c->lists->nodes[c->taken[k]].box);
        c->taken_ns += showing_price(q, &s);
    }
}

void cut_make(cut *c, const cut_request *q)
{
    const uint32_t first_cell = nodes_first(c->cells->ground.level);
    see_cells(c, q->inview);
    for (uint32_t k = 0; k < c->seen_count; k++) { // grows by parents: level after level
        weigh_node(c, q, c->seen[k], first_cell);
        if (c->seen[k] > 0) see(c, nodes_parent(c->seen[k]));
    }
    settle_ring(c, q);
    take_nodes(c, q);
}
