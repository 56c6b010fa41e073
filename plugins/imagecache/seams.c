// Geometry up to its seam with pictures: see seams.h.
// SPDX-License-Identifier: MIT
#include "seams.h"

#include "cut.h"

#include <portcullis/plane.h>

#include <math.h>
#include <string.h>

enum { RING_DRAWN = 1 }; // up to this one cells are drawn whatever hides them: the eye is in them, or beside

int seams_build(const cull_host *host, const cells *c, seams_index *out)
{
    out->bytes = (c->item_count + (size_t)1) * sizeof *out->spans;
    out->spans = host->alloc(host, out->bytes, _Alignof(seams_span));
    if (!out->spans) return 0;
    for (uint32_t p = 0; p < c->item_count; p++) out->spans[p] = (seams_span){UINT16_MAX, 0, UINT16_MAX, 0};
    for (uint32_t cell = 0; cell < c->cell_count; cell++) {
        const uint16_t i = (uint16_t)(cell % c->ground.columns), j = (uint16_t)(cell / c->ground.columns);
        for (uint32_t r = c->firsts[cell]; r < c->firsts[cell + 1]; r++) {
            for (uint32_t p = c->runs[r].first; p < c->runs[r].first + c->runs[r].count; p++) {
                seams_span *s = &out->spans[p];
                if (i < s->first_i) s->first_i = i;
                if (i > s->last_i) s->last_i = i;
                if (j < s->first_j) s->first_j = j;
                if (j > s->last_j) s->last_j = j;
            }
        }
    }
    return 1;
}

void seams_free(const cull_host *host, seams_index *s)
{
    if (s->spans) host->free(host, s->spans, s->bytes);
    s->spans = NULL;
}

int seams_open(const cull_host *host, const cells *c, const seams_index *index, seams *out)
{
    memset(out, 0, sizeof *out);
    out->bytes = (size_t)(c->listing_count + 1) * sizeof *out->runs;
    out->runs = host->alloc(host, out->bytes, _Alignof(cull_run));
    out->cells = c;
    out->index = index;
    out->waiting_bytes = c->cell_count * sizeof *out->waiting;
    out->waiting = host->alloc(host, out->waiting_bytes, _Alignof(uint32_t));
    return out->runs && out->waiting;
}

void seams_close(const cull_host *host, seams *s)
{
    if (s->waiting) host->free(host, s->waiting, s->waiting_bytes);
    if (s->runs) host->free(host, s->runs, s->bytes);
}

static int32_t farther(int32_t eye, int32_t first, int32_t last)
{
    const int32_t a = first > eye ? first - eye : eye - first, b = last > eye ? last - eye : eye - last;
    return a > b ? a : b;
}

// Of its cells some may be beyond the square.
static int reaches_beyond(const seams_request *q, const seams_span *s)
{
    return farther(q->eye.i, s->first_i, s->last_i) > q->ring || farther(q->eye.j, s->first_j, s->last_j) > q->ring;
}

static int is_seen(const seams_request *q, uint32_t cell, cull_box box)
{
    for (uint32_t v = 0, left = q->inview->masks[cell]; left; v++, left >>= 1)
        if ((left & 1) && cull_volume_touches(&q->inview->volumes[v], box)) return 1;
    return 0;
}

// ---- The square and what it clips ----

typedef struct square { double low_x, high_x, low_z, high_z; } square;

static square square_of(const seams_request *q, const ground *g)
{
    const square s = {g->x + (q->eye.i - q->ring) * g->size, g->x + (q->eye.i + q->ring + 1) * g->size, g->z + (q->eye.j - q->ring) * g->size,
                      g->z + (q->eye.j + q->ring + 1) * g->size};
    return s;
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

// Of its farthest corner.
static double delta_of(const seams_request *q, const ground *g, const square *s)
{
    const double x = larger(q->at[0] - s->low_x, s->high_x - q->at[0]), z = larger(q->at[2] - s->low_z, s->high_z - q->at[2]);
    const double y = larger(fabs(g->low - q->at[1]), fabs(g->high - q->at[1]));
    return cut_delta(sqrt(x * x + y * y + z * z), q->pixels_per_tangent, q->tolerance_px);
}

static void clip(const seams *s, const seams_request *q, cull_clipped *out)
{
    const ground *g = &s->cells->ground;
    const square at = square_of(q, g);
    const double delta = delta_of(q, g, &at);
    out->runs = s->runs + s->first_run;
    out->run_count = s->run_count - s->first_run;
    out->plane_count = 4;
    out->planes[0] = (cull_plane){{1, 0, 0}, (float)(delta - at.low_x)};
    out->planes[1] = (cull_plane){{-1, 0, 0}, (float)(delta + at.high_x)};
    out->planes[2] = (cull_plane){{0, 0, 1}, (float)(delta - at.low_z)};
    out->planes[3] = (cull_plane){{0, 0, -1}, (float)(delta + at.high_z)};
    out->box = (cull_box){{(float)(at.low_x - delta), (float)g->low, (float)(at.low_z - delta)},
                          {(float)(at.high_x + delta), (float)g->high, (float)(at.high_z + delta)}};
}

// ---- Items ----

static void put(seams *s, uint32_t place)
{
    cull_run *const last = s->run_count > s->first_run ? &s->runs[s->run_count - 1] : NULL;
    if (last && last->first + last->count == place) last->count++;
    else s->runs[s->run_count++] = (cull_run){place, 1};
}

// Those that reach beyond count as drawn: geometry.h then leaves them out.
static void part_cell(seams *s, const seams_request *q, uint32_t cell)
{
    const cells *c = s->cells;
    uint32_t *const stamps = q->geometry->stamps;
    for (uint32_t r = c->firsts[cell]; r < c->firsts[cell + 1]; r++) {
        for (uint32_t p = c->runs[r].first; p < c->runs[r].first + c->runs[r].count; p++) {
            if (!reaches_beyond(q, &s->index->spans[p]) || stamps[p] == q->geometry->stamp) continue;
            if (!is_seen(q, cell, c->items[p])) continue;
            stamps[p] = q->geometry->stamp;
            put(s, p);
        }
    }
}

static void draw_cell(seams *s, const seams_request *q, uint32_t cell)
{
    const geometry_sight sight = {q->inview->volumes, q->inview->masks[cell]};
    part_cell(s, q, cell);
    geometry_show(q->geometry, cell, sight);
}

static void finish_step(seams *s, const seams_request *q, cull_batch *batch)
{
    if (s->run_count > s->first_run) clip(s, q, &batch->clipped[batch->clipped_count++]);
    s->first_run = s->run_count;
    geometry_draw(q->geometry);
}

static ground_cell place_of(const ground *g, uint32_t cell)
{
    const ground_cell c = {(int32_t)(cell % g->columns), (int32_t)(cell / g->columns)};
    return c;
}

void seams_draw(seams *s, const seams_request *q, cull_batch *batch)
{
    const inview *v = q->inview;
    const ground *g = &s->cells->ground;
    s->run_count = s->first_run = s->waiting_count = 0;
    geometry_settle(q->geometry);
    for (uint32_t k = 0; k < v->count; k++) {
        const ground_cell at = place_of(g, v->list[k]);
        const int32_t ring = cut_ring(q->eye, at.i, at.j);
        if (ring > q->ring) continue;
        const uint32_t node = nodes_of_cell(g, at);
        if (q->looks && ring > RING_DRAWN && looks_should_wait(q->looks, node)) {
            looks_ask_box(q->looks, node, batch);
            s->waiting[s->waiting_count++] = v->list[k];
        } else draw_cell(s, q, v->list[k]);
    }
    finish_step(s, q, batch);
}

void seams_draw_rest(seams *s, const seams_request *q, cull_batch *batch)
{
    const ground *g = &s->cells->ground;
    geometry_settle(q->geometry);
    for (uint32_t k = 0; k < s->waiting_count; k++)
        if (!looks_is_hidden(q->looks, nodes_of_cell(g, place_of(g, s->waiting[k])))) draw_cell(s, q, s->waiting[k]);
    finish_step(s, q, batch);
}
