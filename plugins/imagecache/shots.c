// Pictures taken and shown: see shots.h.
// SPDX-License-Identifier: MIT
#include "shots.h"

#include <portcullis/box.h>

#include <string.h>

enum { TEXELS_MOST = 2048, HALVINGS = 10 };
#define AHEAD_MOST 64.0  // frames: until then the eye has turned
#define TAKEN_AT 0.9     // of the tolerance, where a picture is taken ahead of the eye: it is shown at once
#define NEARER_MOST 0.85 // of the distance it was taken at: nearer, texels are magnified too much
#define FARTHER_MOST 1.4
#define TEXEL_PX 0.6        // side of a texel where it is shown: needles against the sky, thinner than a pixel, want more than one a pixel (2.5 dB in all)
#define STRETCH_MOST 2.0    // that texels are made finer for: 45 degrees off; wide views have coarser ones beyond, or they would take a hundred times the memory
#define ROOM 0.05          // of the distance: how much nearer texels are made for
#define STALE_MOST 8.0     // tolerances that a stale picture may be off
#define UNKNOWN -1.0f      // frames left of what was hidden before: looked at when it is seen
#define FRAMES_MOST 1000.0 // that one is said to last
#define URGENT 0.4         // of its life, left: sooner it is not taken anew
enum { URGENCIES = 32 };   // frames that are told apart
#define EVEN_KEPT 0.9      // of what captures are taken to take, a frame

// A cell each, and for each of them another that gives way.
uint32_t shots_captures_most(const cells *c)
{
    return 2 * c->cell_count;
}

int shots_open(const cull_host *host, const cells *c, const lists *l, shots_way way, shots *out)
{
    memset(out, 0, sizeof *out);
    out->cells = c;
    out->lists = l;
    out->captures_most = shots_captures_most(c);
    out->bytes = l->node_count * sizeof(shot) + c->cell_count * sizeof(shot_state);
    out->all = host->alloc(host, out->bytes, _Alignof(shot));
    if (!out->all || !store_open(host, l->node_count, &out->store)) return 0;
    memset(out->all, 0, out->bytes);
    out->states = (shot_state *)(out->all + l->node_count);
    if (way == SHOTS_QUADS) return 1;
    out->aligned_bytes = l->node_count * sizeof *out->aligned;
    out->aligned = host->alloc(host, out->aligned_bytes, _Alignof(shot_aligned));
    if (!out->aligned) return 0;
    memset(out->aligned, 0, out->aligned_bytes);
    return 1;
}

void shots_close(const cull_host *host, shots *s)
{
    store_close(host, &s->store);
    if (s->aligned) host->free(host, s->aligned, s->aligned_bytes);
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
static bound_capture take_from(const shots_request *q, const bound_optics *optics, const shot *h, double eye[3])
{
    const cull_box *box = &h->box;
    const double room = q->view->tolerance_px - detail_px((double)h->away_m, q->view->eye, box, optics);
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
        if (tried.nearest_depth > NEARER_MOST * best.nearest_depth && bound_turned_px(&tried, q->view->eye, optics) <= TAKEN_AT * room) {
            low = middle;
            memcpy(eye, at, sizeof at);
            if (i == 0) return tried;
        } else high = middle;
    }
    place_ahead(q->view, low, eye);
    return bound_capture_of(eye, box);
}

// ---- How one stands ----

typedef struct frame_view { bound_view now, next; } frame_view; // next: as the eye goes on

static frame_view views_of(const shots_request *q)
{
    frame_view v = {.now = bound_view_of(q->visit->view)};
    v.next = v.now;
    place_ahead(q->view, 1, v.next.eye);
    return v;
}

typedef struct stand { double error_px, frames_left; } stand;

static double error_of(const shot *h, const bound_capture *c, const shot_aligned *a, const bound_view *view)
{
    const double shown = a ? bound_centre_px(c, &a->view, view) : bound_turned_px(c, view->eye, &view->optics);
    return shown + detail_px((double)h->away_m, view->eye, &h->box, &view->optics);
}

static stand stand_of(const shots_request *q, const shot *h, const shot_aligned *a, const frame_view *v)
{
    const bound_capture c = bound_capture_of(h->eye, &h->box);
    const double tolerance = q->view->tolerance_px;
    double from_eye[3];
    stand s = {INFINITY, 0};
    bound_subtract(c.centre, q->view->eye, from_eye);
    const double distance = bound_dot(c.normal, from_eye);
    if (!(distance > NEARER_MOST * c.distance && distance < FARTHER_MOST * c.distance)) return s;
    const double error = error_of(h, &c, a, &v->now);
    if (!(error <= tolerance)) return s;
    s.error_px = error;
    const double rise = error_of(h, &c, a, &v->next) - error;
    // Where it falls the eye is before the place it was taken from, and the error rises as fast behind it.
    const double left = rise > 0 ? (tolerance - error) / rise : rise < 0 ? (error + tolerance) / -rise : FRAMES_MOST;
    s.frames_left = left < FRAMES_MOST ? left : FRAMES_MOST;
    return s;
}

static const shot_aligned *aligned_of(const shots *s, uint32_t node)
{
    return s->aligned ? &s->aligned[node] : NULL;
}

static int is_right(const shots_request *q, uint32_t node, const shot *h, const bound_optics *optics)
{
    const double f = optics->pixels_per_tangent;
    return q->visit->slots[node] && h->keep_depth >= q->keep_depth && (double)h->pixels_per_tangent > 0.99 * f && (double)h->pixels_per_tangent < 1.01 * f;
}

static void check(shots *s, const shots_request *q, uint32_t i, const frame_view *v)
{
    const uint32_t node = q->cut->taken[i];
    const shot *h = &s->all[node];
    const stand at = is_right(q, node, h, &v->now.optics) ? stand_of(q, h, aligned_of(s, node), v) : (stand){INFINITY, 0};
    s->states[i] = (shot_state){(float)at.error_px, (float)at.frames_left, 0};
}

void shots_check(shots *s, const shots_request *q)
{
    const frame_view v = views_of(q);
    store_begin(&s->store, q->visit, q->frame, q->bytes_most);
    for (uint32_t i = 0; i < q->cut->taken_count; i++) {
        const uint32_t node = q->cut->taken[i];
        store_keep(&s->store, node);
        s->states[i] = (shot_state){INFINITY, UNKNOWN, 0};
        if (!q->view->looks || !looks_was_hidden(q->view->looks, node)) check(s, q, i, &v);
    }
}

static int is_hidden(const shots_request *q, uint32_t i)
{
    return q->view->looks && looks_is_hidden(q->view->looks, q->cut->taken[i]);
}

// ---- Taking one ----

static double delta_of(const shots *s, const shots_request *q, uint32_t node)
{
    const cull_box *box = &s->lists->nodes[node].box;
    double from_eye[3];
    for (int k = 0; k < 3; k++) from_eye[k] = ((double)(&box->min.x)[k] + (double)(&box->max.x)[k]) / 2 - q->view->eye[k];
    return cut_delta(1.2 * sqrt(bound_dot(from_eye, from_eye)), q->view->optics.pixels_per_tangent, q->view->tolerance_px);
}

static void put_capture(const shots *s, const shots_request *q, uint32_t node, const column *c, const quad *made, cull_batch *batch)
{
    const lists_node *n = &s->lists->nodes[node];
    const shot *h = &s->all[node];
    cull_capture *to = &batch->captures[batch->capture_count++];
    *to = (cull_capture){.runs = s->lists->runs + n->first_run, .box = h->box, .corner = made->corner, .right = made->right, .up = made->up,
                         .run_count = n->run_count, .clip_plane_count = 4, .slot = node, .width_px = made->width_px, .height_px = made->height_px,
                         .keep_depth = q->keep_depth, .eye = {(float)h->eye[0], (float)h->eye[1], (float)h->eye[2]}, .eye_is_said = 1, .detail_m = h->away_m};
    planes_of(c, to->clip_planes);
}

static uint32_t bytes_of(const shots_request *q, const quad *shape)
{
    const cull_costs *c = q->view->costs;
    return shape->width_px * shape->height_px * (q->keep_depth ? c->depth_pixel_bytes : c->pixel_bytes);
}

// How much wider a pixel is in the middle of the view than where the box stands now: 1 over the square of the cosine.
static double stretch_of(const bound_view *v, const cull_box *box)
{
    double way[3];
    for (int k = 0; k < 3; k++) way[k] = ((double)(&box->min.x)[k] + (double)(&box->max.x)[k]) / 2 - v->eye[k];
    const double cosine = bound_dot(way, v->forward) / sqrt(bound_dot(way, way));
    return cosine > 0 && 1 / (cosine * cosine) < STRETCH_MOST ? 1 / (cosine * cosine) : STRETCH_MOST;
}

// Where from and through which parallelogram; 0: it can't be taken.
static int place(const shots *s, const shots_request *q, const frame_view *v, shot *made, quad *out)
{
    quad_request ask = {.box = made->box, .optics = v->now.optics, .magnification = TEXEL_PX / stretch_of(&v->now, &made->box), .place = QUAD_PLACE_MIDDLE, .most_texels = TEXELS_MOST};
    double distance;
    if (s->aligned) {
        place_ahead(q->view, 0, made->eye);
        distance = bound_capture_of(made->eye, &made->box).distance;
    } else distance = take_from(q, &v->now.optics, made, made->eye).distance;
    memcpy(ask.eye, made->eye, sizeof ask.eye);
    ask.near_distance = q->view->optics.near_distance;
    ask.room = ROOM * distance;
    quad_result made_it = s->aligned ? quad_aligned_of(&ask, &v->now, out) : quad_of(&ask, out);
    if (made_it == QUAD_TOO_LARGE) { // with texels of a pixel, then
        ask.magnification = 1;
        made_it = s->aligned ? quad_aligned_of(&ask, &v->now, out) : quad_of(&ask, out);
    }
    return made_it == QUAD_OK;
}

static detail_choice detail_of(const shots_request *q, uint32_t polygon_count, const bound_optics *optics, const cull_box *box)
{
    const detail_choice all = {0, 0, polygon_count};
    const detail_request ask = {q->view->costs, optics, q->view->eye, box, q->view->tolerance_px, polygon_count, 0};
    return q->detail == SHOTS_FULL ? all : detail_choose(&ask);
}

static int take(shots *s, const shots_request *q, uint32_t i, const frame_view *v, cull_batch *batch)
{
    const uint32_t node = q->cut->taken[i];
    const lists_node *n = &s->lists->nodes[node];
    const cull_costs *costs = q->view->costs;
    const column c = column_of(&s->cells->ground, node, delta_of(s, q, node));
    shot made = {.box = box_of(s, node, &c), .pixels_per_tangent = (float)v->now.optics.pixels_per_tangent, .keep_depth = q->keep_depth, .frame = q->frame};
    shot_aligned aligned = {.view = v->now};
    const detail_choice detail = detail_of(q, n->polygon_count, &v->now.optics, &made.box);
    made.away_m = detail.away_m;
    made.box = detail_box(&made.box, (double)detail.away_m);
    if (!place(s, q, v, &made, &aligned.taken)) return 0;
    const quad *shape = &aligned.taken;
    const stand at = stand_of(q, &made, s->aligned ? &aligned : NULL, v);
    if (!(at.error_px <= q->view->tolerance_px)) return 0;
    if (!store_take(&s->store, &(store_request){q->visit, node, bytes_of(q, shape), s->captures_most}, batch)) return 0;
    made.ns = (float)(costs->capture_ns + detail.polygons * costs->polygon_ns + (double)shape->width_px * shape->height_px * costs->capture_pixel_ns);
    s->all[node] = made;
    if (s->aligned) s->aligned[node] = aligned;
    s->states[i] = (shot_state){(float)at.error_px, (float)at.frames_left, 0};
    put_capture(s, q, node, &c, shape, batch);
    s->taken_count++;
    s->polygons += detail.polygons;
    s->spared += n->polygon_count - detail.polygons;
    return 1;
}

// ---- What to take ----

// What has to be, near first; with SHOTS_STEADY what was never taken, and the rest while there is something to spare. Returns what it takes, below 0 where
// one can't be.
static double take_due(shots *s, const shots_request *q, const frame_view *v, cull_batch *batch)
{
    double spent = 0;
    for (uint32_t i = 0; i < q->cut->taken_count; i++) {
        const uint32_t node = q->cut->taken[i];
        const shot *h = &s->all[node];
        if (s->states[i].error_px < INFINITY || is_hidden(q, i)) continue;
        if (q->budget == SHOTS_STEADY && spent + (double)h->ns > q->spare_ns && is_right(q, node, h, &v->now.optics)) {
            const bound_capture c = bound_capture_of(h->eye, &h->box);
            const double error = error_of(h, &c, aligned_of(s, node), &v->now);
            if (error < STALE_MOST * q->view->tolerance_px) {
                s->states[i].error_px = (float)error;
                s->stale_count++;
                continue;
            }
        }
        if (!take(s, q, i, v, batch)) return -1;
        spent += (double)s->all[node].ns;
    }
    return spent;
}

// What captures take a frame when each picture is taken once in its life: what this frame's are expected to come to.
static double even_share(const shots *s, const shots_request *q)
{
    double sum = 0;
    for (uint32_t i = 0; i < q->cut->taken_count; i++) {
        const shot *h = &s->all[q->cut->taken[i]];
        if (!(s->states[i].error_px < INFINITY)) continue;
        sum += (double)h->ns / (1 + (double)(q->frame - h->frame) + (double)s->states[i].frames_left);
    }
    return sum;
}

// Of those that stay within the tolerance for a while, the most urgent, until the frame takes as much as any.
static void take_early(shots *s, const shots_request *q, const frame_view *v, double spent, cull_batch *batch)
{
    uint32_t firsts[URGENCIES] = {0};
    const double room = s->even_ns < q->spare_ns ? s->even_ns : q->spare_ns;
    if (!(bound_dot(q->view->step, q->view->step) > 0)) return;
    for (uint32_t i = q->cut->taken_count; i-- > 0;) {
        const shot *h = &s->all[q->cut->taken[i]];
        const double left = (double)s->states[i].frames_left, life = left + (double)(q->frame - h->frame);
        if (h->frame == q->frame || left >= URGENCIES || left > URGENT * life || !(s->states[i].error_px < INFINITY)) continue;
        if (is_hidden(q, i)) continue;
        s->states[i].next = firsts[(int)left];
        firsts[(int)left] = i + 1;
    }
    for (int urgency = 0; urgency < URGENCIES; urgency++)
        for (uint32_t at = firsts[urgency]; at && spent < room; ) {
            const uint32_t i = at - 1;
            at = s->states[i].next;
            if (spent + (double)s->all[q->cut->taken[i]].ns > 1.25 * room || !take(s, q, i, v, batch)) continue;
            spent += (double)s->all[q->cut->taken[i]].ns;
            s->early_count++;
        }
}

// ---- A frame ----

static void align(const shot_aligned *a, const bound_view *view, cull_picture *to)
{
    const quad shown = quad_aligned_shown(&a->taken, view);
    to->corner = shown.corner;
    to->right = shown.right;
    to->up = shown.up;
    to->place_is_said = 1;
}

static void show_all(shots *s, const shots_request *q, const bound_view *view, cull_batch *batch)
{
    for (uint32_t i = 0; i < q->cut->taken_count; i++) {
        const uint32_t node = q->cut->taken[i];
        const lists_node *n = &s->lists->nodes[node];
        if (is_hidden(q, i)) continue;
        const float error = s->states[i].error_px;
        cull_picture *to = &batch->pictures[batch->picture_count++];
        *to = (cull_picture){.runs = s->lists->runs + n->first_run, .box = s->all[node].box, .run_count = n->run_count, .slot = node, .error_px = error};
        if (s->aligned) align(&s->aligned[node], view, to);
        if ((double)error > s->error_px) s->error_px = (double)error;
        s->shown_count++;
    }
}

// The captures given stand, their slots are filled.
static void clip_all(const shots *s, const shots_request *q, cull_batch *batch)
{
    for (uint32_t i = 0; i < q->cut->taken_count; i++) {
        const uint32_t node = q->cut->taken[i];
        const lists_node *n = &s->lists->nodes[node];
        const column c = column_of(&s->cells->ground, node, delta_of(s, q, node));
        cull_clipped *to = &batch->clipped[batch->clipped_count++];
        *to = (cull_clipped){.runs = s->lists->runs + n->first_run, .box = n->box, .run_count = n->run_count, .plane_count = 4};
        planes_of(&c, to->planes);
    }
}

int shots_show(shots *s, const shots_request *q, cull_batch *batch)
{
    const frame_view v = views_of(q);
    for (uint32_t i = 0; i < q->cut->taken_count; i++)
        if (s->states[i].frames_left < 0 && !is_hidden(q, i)) check(s, q, i, &v);
    s->shown_count = s->taken_count = s->early_count = s->stale_count = 0;
    s->error_px = s->polygons = s->spared = 0;
    const double spent = take_due(s, q, &v, batch);
    if (spent < 0) {
        clip_all(s, q, batch);
        return 0;
    }
    s->even_ns = EVEN_KEPT * s->even_ns + (1 - EVEN_KEPT) * even_share(s, q);
    // Even frames cost life: only where somebody counts a frame's time.
    if (q->budget == SHOTS_STEADY || q->spare_ns < INFINITY) take_early(s, q, &v, spent, batch);
    show_all(s, q, &v.now, batch);
    return 1;
}
