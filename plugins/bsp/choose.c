// Choosing the dividing plane: see choose.h. balance: CHOOSE-DIVIDING-POLYGON of the BSP tutorial. sah: MacDonald and Booth,
// Heuristics for Ray Tracing Using Space Subdivision, 1990, over the polygons' planes.
// SPDX-License-Identifier: MIT
#include "choose.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum {
    TRIED_MOST = 64,     // planes of a large set that are tried: half the largest in area, half spread evenly
    TRIED_LARGEST = 32,
    TRIED_WEARY = 4,     // behind effort_most
    EFFORT_A_PIECE = 4096 // piece-plane tests before that: 64 planes on 64 levels
};
static const double RATIO_FIRST = 0.8;               // smaller over larger side, halved until a plane has it
static const double SPLIT_COST = 4;                  // polygons that a cut counts for: its parts are cut again; flat from 2 to 8 on real maps
static const double COST_MARGIN = 1.0 / (1 << 30);   // costs closer than this are one: rounding, which moves with the scene
static const uint64_t CONVEX_TESTS_MOST = 1u << 26;  // tests to learn that a set with more planes than are tried is convex

cull_result chooser_make(const cull_host *host, const piece_set *set, bsp_wish wish, chooser *out)
{
    int failed = 0;
    chooser c = {.set = set, .wish = wish, .candidates = vector_make(host, sizeof(plane_candidate)), .plane_count = set->table->planes.count};
    c.effort_most = (uint64_t)EFFORT_A_PIECE * set->pieces.count;
    c.places = array_alloc(host, c.plane_count, sizeof *c.places, &failed);
    if (failed) return CULL_ERR_MEMORY;
    if (c.places) memset(c.places, 0, c.plane_count * sizeof *c.places);
    *out = c;
    return CULL_OK;
}

void chooser_free(const cull_host *host, chooser *c)
{
    vector_free(&c->candidates);
    array_free(host, c->places, c->plane_count, sizeof *c->places);
    c->places = NULL;
}

// ---- Candidates: each plane of the set once ----

static plane_candidate *candidate_at(const chooser *c, uint32_t i)
{
    return (plane_candidate *)c->candidates.items + i;
}

static uint32_t plane_undirected(const chooser *c, uint32_t plane)
{
    const uint32_t twin = plane_twin(c->set->table, plane);
    return twin < plane ? twin : plane;
}

// The candidate of the plane, made where it is new; NULL without memory.
static plane_candidate *candidate_of(chooser *c, uint32_t plane, uint32_t order)
{
    uint32_t *place = &c->places[plane_undirected(c, plane)];
    if (*place) return candidate_at(c, *place - 1);
    plane_candidate *made = vector_push(&c->candidates, 1);
    if (!made) return NULL;
    *made = (plane_candidate){.plane = plane, .order = order};
    *place = c->candidates.count;
    return made;
}

static int candidates_collect(chooser *c, const uint32_t *pieces, uint32_t count)
{
    int is_whole = 1;
    c->candidates.count = 0;
    for (uint32_t i = 0; i < count && is_whole; i++) {
        const bsp_piece *piece = piece_at(c->set, pieces[i]);
        plane_candidate *of = candidate_of(c, piece->plane, i);
        if (of) of->area += piece->area;
        is_whole = of != NULL;
    }
    for (uint32_t i = 0; i < c->candidates.count; i++) c->places[plane_undirected(c, candidate_at(c, i)->plane)] = 0;
    return is_whole;
}

static int is_larger(const plane_candidate *a, const plane_candidate *b)
{
    const uint64_t one = area_class(a->area), two = area_class(b->area);
    return one != two ? one > two : a->order < b->order;
}

// The largest candidates come first, the most at the front; what is pushed out takes the free place.
static void largest_to_front(chooser *c, uint32_t wanted)
{
    for (uint32_t i = 0; i < c->candidates.count; i++) {
        uint32_t at = i < wanted ? i : wanted;
        if (i >= wanted && !is_larger(candidate_at(c, i), candidate_at(c, wanted - 1))) continue;
        if (i >= wanted) {
            const plane_candidate out = *candidate_at(c, wanted - 1);
            *candidate_at(c, wanted - 1) = *candidate_at(c, i);
            *candidate_at(c, i) = out;
            at = wanted - 1;
        }
        for (; at > 0 && is_larger(candidate_at(c, at), candidate_at(c, at - 1)); at--) {
            const plane_candidate swap = *candidate_at(c, at);
            *candidate_at(c, at) = *candidate_at(c, at - 1);
            *candidate_at(c, at - 1) = swap;
        }
    }
}

// Leaves `tried` candidates at the front, all where there are no more.
static uint32_t candidates_sample(chooser *c)
{
    const uint32_t count = c->candidates.count;
    const uint32_t most = c->classified > c->effort_most ? TRIED_WEARY : TRIED_MOST, largest = most * TRIED_LARGEST / TRIED_MOST;
    if (count <= most) return count;
    largest_to_front(c, largest);
    for (uint32_t i = largest; i < most; i++) { // places only rise, so none is taken twice
        const uint32_t from = largest + (uint32_t)((uint64_t)(i - largest) * (count - largest) / (most - largest));
        const plane_candidate swap = *candidate_at(c, i);
        *candidate_at(c, i) = *candidate_at(c, from);
        *candidate_at(c, from) = swap;
    }
    return most;
}

// ---- Counting ----

static void count_sides(chooser *c, const uint32_t *pieces, uint32_t count, plane_candidate *of)
{
    for (uint32_t i = 0; i < count; i++) {
        const piece_side side = piece_side_of(c->set, pieces[i], of->plane);
        of->front += side != PIECE_BACK && side != PIECE_ON_BACK;
        of->back += side != PIECE_FRONT && side != PIECE_ON_FRONT;
        of->spanning += side == PIECE_SPANS;
    }
    c->classified += count;
}

static int has_behind(chooser *c, const uint32_t *pieces, uint32_t count, uint32_t plane)
{
    for (uint32_t i = 0; i < count; i++) {
        const piece_side side = piece_side_of(c->set, pieces[i], plane);
        c->classified++;
        if (side != PIECE_FRONT && side != PIECE_ON_FRONT) return 1;
    }
    return 0;
}

// ---- Boxes of both sides, for sah ----

typedef struct side_box { double low[3], high[3]; } side_box;

static void side_box_add(side_box *box, const double low[3], const double high[3])
{
    for (int k = 0; k < 3; k++) {
        if (low[k] < box->low[k]) box->low[k] = low[k];
        if (high[k] > box->high[k]) box->high[k] = high[k];
    }
}

static double side_box_area(const side_box *box)
{
    const double x = box->high[0] - box->low[0], y = box->high[1] - box->low[1], z = box->high[2] - box->low[2];
    return x >= 0 ? 2 * ((x * y + y * z) + z * x) : 0;
}

static void side_boxes_add_cut(side_box boxes[2], const piece_set *set, const bsp_piece *piece, const bsp_plane *plane)
{
    const cull_point *points = piece_points(set, piece);
    const cull_cut cut = {plane->normal[0], plane->normal[1], plane->normal[2], plane->offset};
    for (uint32_t i = 0; i < piece->point_count; i++) {
        const cull_point a = points[i], b = points[i + 1 < piece->point_count ? i + 1 : 0];
        const double ha = cull_cut_height(cut, a), hb = cull_cut_height(cut, b), p[3] = {a.x, a.y, a.z};
        side_box_add(&boxes[ha < 0], p, p);
        if ((ha > 0 && hb < 0) || (ha < 0 && hb > 0)) {
            const cull_point m = ha > 0 ? cull_cut_between(a, ha, b, hb) : cull_cut_between(b, hb, a, ha);
            const double q[3] = {m.x, m.y, m.z};
            side_box_add(&boxes[0], q, q);
            side_box_add(&boxes[1], q, q);
        }
    }
}

// Polygons of each side times the area of its box: what a random line that hits the whole meets. Split ones count on both sides,
// and for what they bring further down.
static void count_cost(chooser *c, const uint32_t *pieces, uint32_t count, plane_candidate *of)
{
    const side_box none = {{DBL_MAX, DBL_MAX, DBL_MAX}, {-DBL_MAX, -DBL_MAX, -DBL_MAX}};
    side_box boxes[2] = {none, none};
    for (uint32_t i = 0; i < count; i++) {
        const bsp_piece *piece = piece_at(c->set, pieces[i]);
        const piece_side side = piece_side_of(c->set, pieces[i], of->plane);
        double low[3], high[3];
        for (int k = 0; k < 3; k++) {
            low[k] = piece->middle[k] - piece->half[k];
            high[k] = piece->middle[k] + piece->half[k];
        }
        const int is_front = side != PIECE_BACK && side != PIECE_ON_BACK, is_back = side != PIECE_FRONT && side != PIECE_ON_FRONT;
        of->front += (uint32_t)is_front;
        of->back += (uint32_t)is_back;
        of->spanning += side == PIECE_SPANS;
        if (side == PIECE_SPANS) side_boxes_add_cut(boxes, c->set, piece, plane_at(c->set->table, of->plane));
        else side_box_add(&boxes[is_back], low, high);
    }
    c->classified += count;
    side_box whole = boxes[0];
    side_box_add(&whole, boxes[1].low, boxes[1].high);
    of->cost = side_box_area(&boxes[0]) * of->front + side_box_area(&boxes[1]) * of->back + SPLIT_COST * side_box_area(&whole) * of->spanning;
}

// ---- Choosing among those counted ----

static int is_better_balanced(const plane_candidate *a, const plane_candidate *b)
{
    if (a->spanning != b->spanning) return a->spanning < b->spanning;
    const uint64_t small_a = a->front < a->back ? a->front : a->back, large_a = (uint64_t)a->front + a->back - small_a;
    const uint64_t small_b = b->front < b->back ? b->front : b->back, large_b = (uint64_t)b->front + b->back - small_b;
    const uint64_t ratio_a = small_a * large_b, ratio_b = small_b * large_a;
    return ratio_a != ratio_b ? ratio_a > ratio_b : is_larger(a, b);
}

static int is_cheaper(const plane_candidate *a, const plane_candidate *b)
{
    if (a->cost < b->cost * (1 - COST_MARGIN)) return 1;
    if (b->cost < a->cost * (1 - COST_MARGIN)) return 0;
    return is_better_balanced(a, b);
}

static double ratio_of(const plane_candidate *a)
{
    return a->front < a->back ? (double)a->front / a->back : (double)a->back / a->front;
}

// Of the first `tried` candidates, those with something behind; NULL: none has.
static const plane_candidate *best_of(const chooser *c, uint32_t tried)
{
    const plane_candidate *best = NULL;
    int is_useful = 0;
    for (uint32_t i = 0; i < tried; i++) is_useful |= candidate_at(c, i)->back > 0;
    for (double least = RATIO_FIRST; is_useful && !best; least *= 0.5) {
        for (uint32_t i = 0; i < tried; i++) {
            const plane_candidate *a = candidate_at(c, i);
            if (a->back == 0) continue;
            if (c->wish.choose == BSP_SAH ? !best || is_cheaper(a, best) : ratio_of(a) >= least && (!best || is_better_balanced(a, best))) best = a;
        }
    }
    return best;
}

// The first of the candidates from `from` on that has something behind.
static choice first_dividing(chooser *c, const uint32_t *pieces, uint32_t count, uint32_t from, uint32_t *plane)
{
    const uint64_t tests_most = c->classified + CONVEX_TESTS_MOST;
    for (uint32_t i = from; i < c->candidates.count; i++) {
        *plane = candidate_at(c, i)->plane;
        if (has_behind(c, pieces, count, *plane)) return CHOICE_PLANE;
        if (c->classified > tests_most) return CHOICE_GAVE_UP;
    }
    return CHOICE_CONVEX;
}

choice chooser_choose(chooser *c, const uint32_t *pieces, uint32_t count, uint32_t *plane)
{
    if (!candidates_collect(c, pieces, count)) return CHOICE_MEMORY;
    if (c->wish.choose == BSP_FIRST) {
        const choice made = first_dividing(c, pieces, count, 0, plane);
        if (made == CHOICE_PLANE && c->wish.split == BSP_SPLIT_NODES) *plane = candidate_at(c, 0)->plane; // it takes its own pieces out
        return made;
    }
    const uint32_t tried = candidates_sample(c);
    for (uint32_t i = 0; i < tried; i++) {
        if (c->wish.choose == BSP_SAH) count_cost(c, pieces, count, candidate_at(c, i));
        else count_sides(c, pieces, count, candidate_at(c, i));
    }
    const plane_candidate *best = best_of(c, tried);
    if (!best) return first_dividing(c, pieces, count, tried, plane);
    *plane = best->plane;
    return CHOICE_PLANE;
}

