// Popping: see popping.h.
// SPDX-License-Identifier: MIT
// Invariant: the nearest pixel is taken, never a mean of several, which would smooth errors away.
#include "popping.h"

#include <math.h>
#include <string.h>

// Of the distance: the nearest pixel is up to half a pixel off, and ground seen at a slant goes on by as much within that.
static const double SAME_SURFACE = 1.0 / 16;

typedef struct lens { // of a camera: the window's depth is across + over / distance
    double right[3], up[3], back[3], wide, tall, across, over;
} lens;

static lens lens_of(const camera *c)
{
    lens l = {.tall = tan(c->fovy_deg * (3.14159265358979323846 / 360)), .over = c->near_m};
    camera_axes(c, l.right, l.up, l.back);
    l.wide = l.tall * c->aspect;
    if (isfinite(c->far_m)) {
        l.across = -c->near_m / (c->far_m - c->near_m);
        l.over = -l.across * c->far_m;
    }
    return l;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// From this frame's camera to the one before: column k of `turn` is where its axis k (right, up, ahead) points, in tangents of that picture.
typedef struct passage { double turn[3][3], way[3]; } passage;

static passage passage_of(const popping_views *q, const lens *now, const lens *before)
{
    passage p;
    double moved[3], ahead[3];
    for (int k = 0; k < 3; ++k) {
        moved[k] = q->now.camera->eye[k] - q->before.camera->eye[k];
        ahead[k] = -now->back[k];
    }
    const double *const from[3] = {now->right, now->up, ahead}, scale[3] = {now->wide, now->tall, 1};
    for (int k = 0; k < 3; ++k) {
        p.turn[k][0] = scale[k] * dot(from[k], before->right) / before->wide;
        p.turn[k][1] = scale[k] * dot(from[k], before->up) / before->tall;
        p.turn[k][2] = -scale[k] * dot(from[k], before->back);
    }
    p.way[0] = dot(moved, before->right) / before->wide;
    p.way[1] = dot(moved, before->up) / before->tall;
    p.way[2] = -dot(moved, before->back);
    return p;
}

static int is_mover(const popping_view *v, size_t at)
{
    return v->movers && v->movers[at] > 0 && v->movers[at] == v->depths[at];
}

// Pixel `at`, whose middle is at (x, y) in -1 .. 1. Numbers of pixels count from the bottom row here.
static uint32_t trace(const popping_views *q, const lens lenses[2], const passage *p, size_t at, const double place[2])
{
    const lens *now = &lenses[0], *before = &lenses[1];
    const double depth = (double)q->now.depths[at];
    const double distance = depth > 0 ? now->over / (depth - now->across) : 1;
    double there[3];
    if (is_mover(&q->now, at)) return POPPING_NEW;
    for (int k = 0; k < 3; ++k) {
        there[k] = distance * (place[0] * p->turn[0][k] + place[1] * p->turn[1][k] + p->turn[2][k]);
        if (depth > 0) there[k] += p->way[k]; // what is endlessly far only turns
    }
    if (!(there[2] > 0)) return POPPING_NEW;
    const double x = (there[0] / there[2] + 1) / 2 * q->width_px, y = (there[1] / there[2] + 1) / 2 * q->height_px;
    if (!(x >= 0 && x < q->width_px && y >= 0 && y < q->height_px)) return POPPING_NEW;
    const uint32_t column = (uint32_t)x, row = (uint32_t)y;
    const size_t from = (size_t)row * q->width_px + column;
    const double found = (double)q->before.depths[from];
    if (is_mover(&q->before, from) || (depth > 0) != (found > 0)) return POPPING_NEW;
    if (depth > 0 && !(fabs(before->over - there[2] * (found - before->across)) <= SAME_SURFACE * before->over)) return POPPING_NEW;
    return (uint32_t)((size_t)(q->height_px - 1 - row) * q->width_px + column);
}

void popping_trace(const popping_views *q, uint32_t *from)
{
    const lens lenses[2] = {lens_of(q->now.camera), lens_of(q->before.camera)};
    const passage p = passage_of(q, &lenses[0], &lenses[1]);
    for (uint32_t row = 0; row < q->height_px; ++row) {
        uint32_t *out = from + (size_t)(q->height_px - 1 - row) * q->width_px;
        for (uint32_t column = 0; column < q->width_px; ++column) {
            const double place[2] = {(column + 0.5) / q->width_px * 2 - 1, (row + 0.5) / q->height_px * 2 - 1};
            out[column] = trace(q, lenses, &p, (size_t)row * q->width_px + column, place);
        }
    }
}

static uint8_t byte_of(int value)
{
    return (uint8_t)(value < 0 ? 0 : value > 255 ? 255 : value);
}

void popping_expect(const popping_pictures *q, uint8_t *expected)
{
    for (size_t i = 0; i < q->pixels; ++i) {
        const uint8_t *known = q->shown + 4 * i;
        memcpy(expected + 4 * i, known, 4);
        if (q->from[i] == POPPING_NEW) continue;
        const uint8_t *before = q->shown_before + 4 * (size_t)q->from[i], *truth_before = q->truth_before + 4 * (size_t)q->from[i];
        for (size_t k = 0; k < 3; ++k) expected[4 * i + k] = byte_of(q->truth[4 * i + k] + before[k] - truth_before[k]);
    }
}
