// Pictures taken and shown: see shots.h.
// SPDX-License-Identifier: MIT
#include "shots.h"

#include "quad.h"

#include <portcullis/box.h>

#include <string.h>

enum { TEXELS_MOST = 2048, HALVINGS = 6 };
#define AHEAD_MOST 64.0  // frames: until then the eye has turned
#define TAKEN_AT 0.9     // of the tolerance, where a picture is taken ahead of the eye: it is shown at once
#define NEARER_MOST 0.85 // of the distance it was taken at: nearer, texels are magnified too much
#define FARTHER_MOST 1.4

int shots_open(const cull_host *host, const cells *c, const lists *l, shots *out)
{
    memset(out, 0, sizeof *out);
    out->bytes = l->node_count * sizeof(shot);
    out->all = host->alloc(host, out->bytes, _Alignof(shot));
    if (!out->all) return 0;
    memset(out->all, 0, out->bytes);
    out->cells = c;
    out->lists = l;
    return 1;
}

void shots_close(const cull_host *host, shots *s)
{
    if (s->all) host->free(host, s->all, s->bytes);
}

// ---- What a picture is of ----

typedef struct column { double low_x, high_x, low_z, high_z; } column;

static column column_of(const ground *g, uint32_t node, double delta)
{
    const nodes_square s = nodes_square_of(g, node);
    const column c = {g->x + s.first.i * g->size - delta, g->x + (s.first.i + s.side) * g->size + delta, g->z + s.first.j * g->size - delta,
                      g->z + (s.first.j + s.side) * g->size + delta};
    return c;
}

static void planes_of(const column *c, cull_plane *out)
{
    out[0] = (cull_plane){{1, 0, 0}, (float)-c->low_x};
    out[1] = (cull_plane){{-1, 0, 0}, (float)c->high_x};
    out[2] = (cull_plane){{0, 0, 1}, (float)-c->low_z};
    out[3] = (cull_plane){{0, 0, -1}, (float)c->high_z};
}

// Of what the node's items show within its planes.
static cull_box box_of(const shots *s, uint32_t node, const column *c)
{
    const lists_node *n = &s->lists->nodes[node];
    cull_box all = cull_box_none();
    for (uint32_t r = n->first_run; r < n->first_run + n->run_count; r++) {
        const cull_run run = s->lists->runs[r];
        for (uint32_t p = run.first; p < run.first + run.count; p++) {
            cull_box b = s->cells->items[p];
            if (b.min.x < (float)c->low_x) b.min.x = (float)c->low_x;
            if (b.max.x > (float)c->high_x) b.max.x = (float)c->high_x;
            if (b.min.z < (float)c->low_z) b.min.z = (float)c->low_z;
            if (b.max.z > (float)c->high_z) b.max.z = (float)c->high_z;
            all = cull_box_union(all, b);
        }
    }
    return all;
}

// ---- Where it is taken from ----

static void place_ahead(const cut_request *v, double frames, double out[3])
{
    for (int k = 0; k < 3; k++) out[k] = (double)(float)(v->eye[k] + frames * v->step[k]); // as a capture has it
}

// As far ahead as the eye here still allows: then it lasts about twice as long.
static bound_capture take_from(const shots_request *q, const bound_optics *optics, const cull_box *box, double eye[3])
{
    bound_capture best, tried;
    double low = 0, high = AHEAD_MOST;
    place_ahead(q->view, 0, eye);
    best = bound_capture_of(eye, box);
    if (!(bound_dot(q->view->step, q->view->step) > 0)) return best;
    for (int i = 0; i < HALVINGS; i++) {
        double at[3];
        const double middle = i == 0 ? high : (low + high) / 2;
        place_ahead(q->view, middle, at);
        tried = bound_capture_of(at, box);
        if (tried.nearest_depth > NEARER_MOST * best.nearest_depth && bound_turned_px(&tried, q->view->eye, optics) <= TAKEN_AT * q->view->tolerance_px) {
            low = middle;
            memcpy(eye, at, sizeof at);
            if (i == 0) return tried;
        } else high = middle;
    }
    place_ahead(q->view, low, eye);
    return bound_capture_of(eye, box);
}

// ---- One node ----

static double error_of(const shots_request *q, const shot *h, const bound_optics *optics)
{
    const bound_capture c = bound_capture_of(h->eye, &h->box);
    double from_eye[3];
    bound_subtract(c.centre, q->view->eye, from_eye);
    const double distance = bound_dot(c.normal, from_eye);
    if (!(distance > NEARER_MOST * c.distance && distance < FARTHER_MOST * c.distance)) return INFINITY;
    return bound_turned_px(&c, q->view->eye, optics);
}

static int is_right(const shots_request *q, uint32_t node, const shot *h, const bound_optics *optics)
{
    const double f = optics->pixels_per_tangent;
    return q->visit->slots[node] && h->keep_depth >= q->keep_depth && (double)h->pixels_per_tangent > 0.99 * f && (double)h->pixels_per_tangent < 1.01 * f;
}

static int take(shots *s, const shots_request *q, uint32_t node, const bound_optics *optics, cull_batch *batch)
{
    const lists_node *n = &s->lists->nodes[node];
    shot *h = &s->all[node];
    const double f = optics->pixels_per_tangent;
    double from_eye[3], eye[3];
    for (int k = 0; k < 3; k++) from_eye[k] = ((double)(&n->box.min.x)[k] + (double)(&n->box.max.x)[k]) / 2 - q->view->eye[k];
    const double delta = cut_delta(1.2 * sqrt(bound_dot(from_eye, from_eye)), f, q->view->tolerance_px);
    const column c = column_of(&s->cells->ground, node, delta);
    const cull_box box = box_of(s, node, &c);
    const bound_capture taken = take_from(q, optics, &box, eye);
    quad_request ask = {.box = box, .optics = *optics, .magnification = 1, .place = QUAD_PLACE_MIDDLE, .most_texels = TEXELS_MOST};
    quad made;
    memcpy(ask.eye, eye, sizeof eye);
    ask.near_distance = q->view->optics.near_distance;
    ask.room = 0.05 * taken.distance;
    if (quad_of(&ask, &made) != QUAD_OK) return 0;
    cull_capture *to = &batch->captures[batch->capture_count++];
    *to = (cull_capture){.runs = s->lists->runs + n->first_run, .box = box, .corner = made.corner, .right = made.right, .up = made.up,
                         .run_count = n->run_count, .clip_plane_count = 4, .slot = node, .width_px = made.width_px, .height_px = made.height_px,
                         .keep_depth = q->keep_depth, .eye = {(float)eye[0], (float)eye[1], (float)eye[2]}, .eye_is_said = 1};
    planes_of(&c, to->clip_planes);
    memcpy(h->eye, eye, sizeof eye);
    h->box = box;
    h->pixels_per_tangent = (float)f;
    h->keep_depth = q->keep_depth;
    s->taken_count++;
    return 1;
}

// The error it is shown with; above the tolerance: it can't be taken.
static double picture_of(shots *s, const shots_request *q, uint32_t node, const bound_optics *optics, cull_batch *batch)
{
    const shot *h = &s->all[node];
    const double error = is_right(q, node, h, optics) ? error_of(q, h, optics) : INFINITY;
    if (error <= q->view->tolerance_px) return error;
    return take(s, q, node, optics, batch) ? error_of(q, h, optics) : INFINITY;
}

int shots_show(shots *s, const shots_request *q, cull_batch *batch)
{
    const bound_optics optics = bound_view_of(q->visit->view).optics;
    const uint32_t first = batch->picture_count;
    s->shown_count = s->taken_count = 0;
    s->error_px = 0;
    for (uint32_t i = 0; i < q->cut->taken_count; i++) {
        const uint32_t node = q->cut->taken[i];
        const lists_node *n = &s->lists->nodes[node];
        const double error = picture_of(s, q, node, &optics, batch);
        if (!(error <= q->view->tolerance_px)) {
            batch->picture_count = first;
            return 0;
        }
        batch->pictures[batch->picture_count++] = (cull_picture){.runs = s->lists->runs + n->first_run, .box = s->all[node].box, .run_count = n->run_count,
                                                                 .slot = node, .error_px = (float)error};
        if (error > s->error_px) s->error_px = error;
        s->shown_count++;
    }
    return 1;
}
