// Whole order: see whole_order.h. After Newell, Newell and Sancha, A Solution to the Hidden Surface Problem (1972), whose tests by
// planes say who can hide whom; knots are strongly connected groups (Tarjan, Depth-First Search and Linear Graph Algorithms, 1972).
// SPDX-License-Identifier: MIT
// Invariant: A hides nothing of B when B has no point beyond A's plane, seen from the eye, or A has none on this side of B's: on a
// ray that meets both, A is then the farther one. Else B must come first. Groups follow these demands, so between groups whole
// items are right; within a group the demands go round.
#include "whole_order.h"

#include <math.h>
#include <string.h>

enum { SIDE_FRONT = 1, SIDE_BACK = 2, SIDE_BOTH = 3 };
// Points within this share of the radius lie in a plane: corners are floats (2^-24 each), planes go through such corners.
static const double PLANE_SHARE = 1.0 / 4194304; // 2^-22

// ---- Making ----

static double height_of(const double plane[4], cull_vec3 p)
{
    return ((plane[0] * (double)p.x + plane[1] * (double)p.y) + plane[2] * (double)p.z) + plane[3];
}

// SIDE_* of the item's points.
static uint8_t sides_of(const scene *s, const double plane[4], uint32_t item, double slack)
{
    const scene_item *of = &s->items[item];
    uint8_t sides = 0;
    for (uint32_t i = of->first_index; i < of->first_index + of->index_count && sides != SIDE_BOTH; ++i) {
        const double height = height_of(plane, s->positions[s->indices[i]]);
        sides |= height > slack ? SIDE_FRONT : height < -slack ? SIDE_BACK : 0;
    }
    return sides;
}

static double triangle_plane(const scene *s, uint32_t first_index, double out[4])
{
    const cull_vec3 a = s->positions[s->indices[first_index]], b = s->positions[s->indices[first_index + 1]], c = s->positions[s->indices[first_index + 2]];
    const double u[3] = {(double)b.x - a.x, (double)b.y - a.y, (double)b.z - a.z}, v[3] = {(double)c.x - a.x, (double)c.y - a.y, (double)c.z - a.z};
    const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double size = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; ++k) out[k] = size > 0 ? n[k] / size : 0;
    out[3] = -((out[0] * (double)a.x + out[1] * (double)a.y) + out[2] * (double)a.z);
    return size;
}

// Of its largest triangle; of zeros where another triangle leaves it.
static void plane_of(const scene *s, uint32_t item, double slack, double out[4])
{
    const scene_item *of = &s->items[item];
    double largest = 0;
    memset(out, 0, 4 * sizeof *out);
    for (uint32_t i = of->first_index; i < of->first_index + of->index_count; i += 3) {
        double plane[4];
        const double size = triangle_plane(s, i, plane);
        if (!(size > largest)) continue;
        largest = size;
        memcpy(out, plane, sizeof plane);
    }
    if (sides_of(s, out, item, slack)) memset(out, 0, 4 * sizeof *out);
}

static int is_flat(const double plane[4])
{
    return plane[0] != 0 || plane[1] != 0 || plane[2] != 0;
}

result whole_order_open(const whole_request *q, const allocator *memory, whole_order *out)
{
    const double slack = PLANE_SHARE * (double)q->scene->whole.radius;
    const uint32_t rows = q->count <= WHOLE_ROWS_MOST ? q->count : 0;
    whole_order w = {.rows = rows};
    uint32_t **arrays[] = {&w.numbers, &w.lows, &w.stack, &w.calls, &w.next};
    w.planes = memory_alloc(memory, rows, sizeof *w.planes);
    w.sides = memory_alloc(memory, (size_t)rows * rows, 1);
    w.eye_sides = memory_alloc(memory, rows, 1);
    int has_all = w.planes && w.sides && w.eye_sides;
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; ++i) has_all &= (*arrays[i] = memory_alloc(memory, rows, sizeof(uint32_t))) != NULL;
    if (!has_all) {
        whole_order_close(&w, memory);
        return RESULT_NO_MEMORY;
    }
    for (uint32_t a = 0; a < rows; ++a) plane_of(q->scene, q->items[a], slack, w.planes[a]);
    for (uint32_t a = 0; a < rows; ++a)
        for (uint32_t b = 0; b < rows; ++b)
            w.sides[(size_t)a * rows + b] = is_flat(w.planes[a]) ? sides_of(q->scene, w.planes[a], q->items[b], slack) : SIDE_BOTH;
    *out = w;
    return RESULT_OK;
}

void whole_order_close(whole_order *w, const allocator *memory)
{
    uint32_t *const arrays[] = {w->numbers, w->lows, w->stack, w->calls, w->next};
    memory_free(memory, w->planes, w->rows, sizeof *w->planes);
    memory_free(memory, w->sides, (size_t)w->rows * w->rows, 1);
    memory_free(memory, w->eye_sides, w->rows, 1);
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; ++i) memory_free(memory, arrays[i], w->rows, sizeof(uint32_t));
    *w = (whole_order){0};
}

// ---- The order ----

// Where the eye is in a plane, that item is seen by no ray of any width, and demands nothing.
static void look(whole_order *w, const whole_picture *q)
{
    for (uint32_t i = 0; i < q->count; ++i) {
        const double *plane = w->planes[q->rows[i]];
        const double height = ((plane[0] * q->eye[0] + plane[1] * q->eye[1]) + plane[2] * q->eye[2]) + plane[3];
        w->eye_sides[q->rows[i]] = !is_flat(plane) ? SIDE_BOTH : height > 0 ? SIDE_FRONT : height < 0 ? SIDE_BACK : 0;
    }
}

// a may hide something of b: b must come first.
static int may_hide(const whole_order *w, uint32_t a, uint32_t b)
{
    const uint8_t eye_a = w->eye_sides[a], eye_b = w->eye_sides[b];
    if (!eye_a || !eye_b) return 0;
    const uint8_t beyond_a = eye_a == SIDE_BOTH ? SIDE_BOTH : SIDE_BOTH ^ eye_a;
    return (w->sides[(size_t)a * w->rows + b] & beyond_a) && (w->sides[(size_t)b * w->rows + a] & eye_b);
}

// A depth-first search without recursion, along "may hide": what is hidden is done first, so groups come out farthest first.
typedef struct search {
    whole_order *w;
    const whole_picture *q;
    uint32_t *out, *ends;
    uint32_t number, stacked, called, written, groups;
} search;

static const uint32_t UNSEEN = 0, DONE = UINT32_MAX; // in numbers

static void enter(search *s, uint32_t row)
{
    whole_order *w = s->w;
    w->numbers[row] = w->lows[row] = ++s->number;
    w->next[row] = 0;
    w->stack[s->stacked++] = row;
    w->calls[s->called++] = row;
}

static void leave(search *s, uint32_t row)
{
    whole_order *w = s->w;
    s->called--;
    if (s->called && w->lows[row] < w->lows[w->calls[s->called - 1]]) w->lows[w->calls[s->called - 1]] = w->lows[row];
    if (w->lows[row] != w->numbers[row]) return;
    uint32_t taken;
    do { // a group: all that lie on the stack from here on
        taken = w->stack[--s->stacked];
        w->numbers[taken] = DONE;
        s->out[s->written++] = taken;
    } while (taken != row);
    s->ends[s->groups++] = s->written;
}

static void step(search *s)
{
    whole_order *w = s->w;
    const uint32_t row = w->calls[s->called - 1];
    while (w->next[row] < s->q->count) {
        const uint32_t other = s->q->rows[w->next[row]++];
        if (other == row || w->numbers[other] == DONE || !may_hide(w, row, other)) continue;
        if (w->numbers[other] == UNSEEN) {
            enter(s, other);
            return;
        }
        if (w->numbers[other] < w->lows[row]) w->lows[row] = w->numbers[other];
    }
    leave(s, row);
}

uint32_t whole_order_run(whole_order *w, const whole_picture *q, uint32_t *out, uint32_t *ends)
{
    search s = {.w = w, .q = q, .out = out, .ends = ends};
    look(w, q);
    for (uint32_t i = 0; i < q->count; ++i) w->numbers[q->rows[i]] = UNSEEN;
    for (uint32_t i = 0; i < q->count; ++i) {
        if (w->numbers[q->rows[i]] == UNSEEN) enter(&s, q->rows[i]);
        while (s.called) step(&s);
    }
    return s.groups;
}
