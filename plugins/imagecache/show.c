// A frame of pictures and geometry: see show.h.
// SPDX-License-Identifier: MIT
#include "show.h"

#include <stdio.h>
#include <string.h>

enum { REST_AFTER = 30, REST_LOOK = 15 }; // frames
#define SPEED_KEPT 0.9       // of the speed, a frame: who stops goes on
#define TEST_SHARE 0.3       // of a small picture's cost that a box tested takes, about
#define FIRST_SPEED 0.0025   // of a cell's side, a frame: before two eyes are known

cull_result show_build(const cull_host *host, const cull_zone *zone, const cells *c, const show_options *options, show_culler *out)
{
    out->options = *options;
    out->costs = host->get_extension ? host->get_extension(host, NULL, CULL_EXT_COSTS) : NULL;
    out->radius = (double)zone->radius;
    out->keep_depth = zone->mover_capacity > 0 || zone->portal_count > 0;
    if (options->show == SHOW_GEOMETRY || !out->costs || c->item_count == 0) {
        out->costs = NULL;
        return CULL_OK;
    }
    const cull_result result = lists_build(host, zone, c, &out->lists);
    if (result != CULL_OK) return result;
    return seams_build(host, c, &out->seams) ? CULL_OK : CULL_ERR_MEMORY;
}

void show_free(const cull_host *host, show_culler *s)
{
    lists_free(host, &s->lists);
    seams_free(host, &s->seams);
}

void show_tell(const show_culler *s, const cells *c, cull_built *out)
{
    if (!s->costs) return;
    out->slot_count = s->lists.node_count;
    out->max_captures = shots_captures_most(c);
    out->max_pictures = c->cell_count;
    out->max_clipped = 2 + c->cell_count;
    if (s->options.hidden == SHOW_HIDDEN_TOO) return;
    out->max_tests = c->cell_count;
    out->max_steps = 2;
    out->promises &= ~(cull_promises)CULL_CONSERVATIVE; // tests are about this view's pixels
    out->index_bytes += s->lists.node_bytes + s->lists.run_bytes + s->seams.bytes;
}

int show_open(const cull_host *host, const cells *c, const show_culler *s, show *out)
{
    memset(out, 0, sizeof *out);
    out->culler = s;
    account_open(&out->account);
    if (!s->costs) return 1;
    return cut_open(host, c, &s->lists, &out->cut) &&
           shots_open(host, c, &s->lists, s->options.show == SHOW_CENTRED ? SHOTS_CENTRED : SHOTS_QUADS, &out->shots) && looks_open(host, &s->lists, &out->looks) &&
           seams_open(host, c, &s->seams, &out->seams);
}

void show_close(const cull_host *host, show *s)
{
    cut_close(host, &s->cut);
    shots_close(host, &s->shots);
    looks_close(host, &s->looks);
    seams_close(host, &s->seams);
}

int show_takes(const show *s, const cull_visit *visit)
{
    return s->culler->costs && visit->view->purpose == CULL_VIEW_MAIN && visit->view->eye[3] > 0 && visit->volume_count <= INVIEW_VOLUMES;
}

static void follow_eye(show *s, const cull_visit *visit, double size)
{
    const cull_view *view = visit->view;
    double way = 0, step[3];
    for (int k = 0; k < 3; k++) {
        step[k] = view->eye_exact[k] - s->eye[k];
        way += step[k] * step[k];
        s->eye[k] = view->eye_exact[k];
    }
    const int goes_on = s->history == SHOW_GOES_ON && view->frame == s->frame + 1 && !(view->flags & CULL_VIEW_CUT);
    for (int k = 0; k < 3; k++) s->step[k] = goes_on ? step[k] : 0;
    way = goes_on ? sqrt(way) : size * FIRST_SPEED;
    s->speed = goes_on && s->speed * SPEED_KEPT > way ? s->speed * SPEED_KEPT : way;
    s->frame = view->frame;
}

static cut_request request_of(const show *s, const show_frame *f)
{
    const show_culler *c = s->culler;
    const cull_view *view = f->visit->view;
    cut_request q = {.inview = f->inview, .costs = c->costs, .speed = s->speed, .radius = c->radius, .tolerance_px = c->options.tolerance_px,
                     .picture_pixel_ns = c->keep_depth ? c->costs->picture_depth_pixel_ns : c->costs->picture_pixel_ns, .wear = s->account.wear, .eye_cell = f->eye,
                     .nodes = c->options.nodes == SHOW_TREE ? CUT_TREE : CUT_CELLS,
                     .history = s->history == SHOW_GOES_ON ? CUT_GOES_ON : CUT_ANEW,
                     .looks = c->options.hidden == SHOW_HIDDEN_TESTED && f->visit->may_step ? &s->looks : NULL};
    q.optics = (cut_optics){(double)view->pixels_per_tangent, (double)view->near_distance, (double)view->width_px * view->height_px};
    q.planes = c->options.show == SHOW_CENTRED ? CUT_ALIGNED : CUT_FACING;
    for (int k = 0; k < 3; k++) q.forward[k] = view->forward[k];
    memcpy(q.eye, s->eye, sizeof q.eye);
    memcpy(q.step, s->step, sizeof q.step);
    return q;
}

// Where pictures didn't pay for a while they are asked about more rarely: weighing them costs, too.
static int rests(const show *s)
{
    return s->geometry_frames > REST_AFTER && s->geometry_frames % REST_LOOK != 0;
}

int show_plan(show *s, const show_frame *f)
{
    follow_eye(s, f->visit, f->inview->cells->ground.size);
    looks_begin(&s->looks);
    s->counts.frames++;
    s->last = SHOW_ALL_GEOMETRY;
    if (account_rests(&s->account)) s->counts.handed_back++;
    else if (!rests(s)) {
        s->view = request_of(s, f);
        cut_make(&s->cut, &s->view);
        s->history = SHOW_GOES_ON;
        if (s->cut.taken_count > 0) {
            s->geometry_frames = 0;
            s->last = SHOW_HAS_PICTURES;
            return 1;
        }
    }
    account_skip(&s->account);
    s->geometry_frames++;
    s->counts.geometry_frames++;
    return 0;
}

// Captures: what is left of a frame's time when geometry is drawn and pictures are shown, all as foretold.
static double spare_ns(const show *s)
{
    const double frame = s->culler->costs->frame_ns, shown = s->cut.ring_ns + s->cut.taken_ns;
    return frame > 0 ? (frame > shown ? frame - shown : 0) : INFINITY;
}

static uint64_t bytes_most(const show_culler *c)
{
    return c->options.bytes_most < c->costs->picture_bytes ? c->options.bytes_most : c->costs->picture_bytes;
}

static shots_request shots_of(const show *s, const cull_visit *visit)
{
    const shots_request q = {.visit = visit, .view = &s->view, .cut = &s->cut, .keep_depth = s->culler->keep_depth, .frame = s->looks.frame,
                             .bytes_most = bytes_most(s->culler), .spare_ns = spare_ns(s), .budget = s->culler->options.budget == SHOW_STEADY ? SHOTS_STEADY : SHOTS_BOUNDED,
                             .detail = s->culler->options.detail == SHOW_FULL ? SHOTS_FULL : SHOTS_COARSER};
    return q;
}

static seams_request seam_of(show *s, const show_frame *f)
{
    seams_request q = {.inview = f->inview, .geometry = f->geometry, .eye = f->eye, .ring = s->cut.ring, .tolerance_px = s->view.tolerance_px,
                       .pixels_per_tangent = s->view.optics.pixels_per_tangent, .looks = s->view.looks ? &s->looks : NULL};
    memcpy(q.at, s->eye, sizeof q.at);
    return q;
}

cull_progress show_geometry(show *s, const show_frame *f, cull_batch *batch)
{
    const seams_request seam = seam_of(s, f);
    const shots_request q = shots_of(s, f->visit);
    seams_draw(&s->seams, &seam, batch);
    shots_check(&s->shots, &q);
    for (uint32_t i = 0; s->view.looks && i < s->cut.taken_count; i++)
        looks_ask(&s->looks, s->cut.taken[i], s->shots.states[i].error_px < INFINITY ? LOOKS_CHEAP : LOOKS_DEAR, batch);
    s->counts.tests += s->looks.asked;
    return s->looks.asked ? CULL_WAIT : CULL_DONE;
}

// What geometry beside the pictures took: cells that were hidden were not drawn.
static double near_ns(const show *s)
{
    const inview *v = s->view.inview;
    const ground *g = &v->cells->ground;
    double ns = s->cut.ring_ns;
    for (uint32_t k = 0; s->looks.found && k < v->count; k++) {
        const ground_cell at = {(int32_t)(v->list[k] % g->columns), (int32_t)(v->list[k] / g->columns)};
        const uint32_t node = nodes_of_cell(g, at);
        if (cut_ring(s->view.eye_cell, at.i, at.j) > s->cut.ring || !looks_is_hidden(&s->looks, node)) continue;
        ns -= cut_geometry_ns(&s->view, &s->culler->lists.nodes[node]);
    }
    return ns;
}

static void keep_account(show *s)
{
    account_frame a = {.geometry_ns = s->cut.geometry_ns, .near_ns = near_ns(s), .shown_ns = TEST_SHARE * s->looks.asked * s->culler->costs->picture_ns};
    for (uint32_t i = 0; i < s->cut.taken_count; i++) {
        const uint32_t node = s->cut.taken[i];
        if (looks_is_hidden(&s->looks, node)) continue;
        const cut_price p = cut_price_of(&s->view, &s->culler->lists.nodes[node]);
        a.shown_ns += p.showing_ns;
        a.foretold_ns += p.taking_ns / p.frames;
        if (s->shots.all[node].frame == s->looks.frame) a.taken_ns += p.taking_ns;
    }
    account_add(&s->account, &a);
}

void show_pictures(show *s, const show_frame *f, cull_batch *batch)
{
    const shots_request q = shots_of(s, f->visit);
    if (s->looks.asked) {
        const seams_request seam = seam_of(s, f);
        looks_learn(&s->looks, f->visit);
        seams_draw_rest(&s->seams, &seam, batch);
    }
    if (shots_show(&s->shots, &q, batch)) keep_account(s);
    else batch->limits_hit++;
    show_counts *const n = &s->counts;
    n->hidden += s->looks.found;
    n->pictures += s->shots.shown_count;
    n->captures += s->shots.taken_count;
    n->early += s->shots.early_count;
    n->stale += s->shots.stale_count;
    n->evicted += s->shots.store.evicted;
    n->polygons += s->shots.polygons;
    n->spared += s->shots.spared;
    if (s->shots.error_px > n->error_px) n->error_px = s->shots.error_px;
}

// ---- For a person ----

static int lists_item(const show *s, uint32_t node, uint32_t place)
{
    const lists_node *n = &s->culler->lists.nodes[node];
    for (uint32_t r = n->first_run; r < n->first_run + n->run_count; r++)
        if (place - s->culler->lists.runs[r].first < s->culler->lists.runs[r].count) return 1;
    return 0;
}

static int hides(const show *s, uint32_t node)
{
    return s->view.looks && looks_is_hidden(s->view.looks, node);
}

typedef enum nearness { NEAR_NONE, NEAR_HIDDEN, NEAR_DRAWN } nearness;

// What the item's cells in the square of geometry do.
static nearness nearness_of(const show *s, uint32_t place)
{
    const seams_span p = s->culler->seams.spans[place];
    const ground *g = &s->shots.cells->ground;
    nearness found = NEAR_NONE;
    for (int32_t j = p.first_j; j <= p.last_j; j++)
        for (int32_t i = p.first_i; i <= p.last_i; i++) {
            const ground_cell at = {i, j};
            const uint32_t node = nodes_of_cell(g, at);
            if (cut_ring(s->view.eye_cell, i, j) > s->cut.ring || !s->view.inview->masks[ground_number(g, at)] || !lists_item(s, node, place)) continue;
            if (!hides(s, node)) return NEAR_DRAWN;
            found = NEAR_HIDDEN;
        }
    return found;
}

size_t show_explain(const show *s, uint32_t place, char *text, size_t size)
{
    int length = 0;
    if (!s->culler->costs || s->last != SHOW_HAS_PICTURES) return 0;
    const nearness near = nearness_of(s, place);
    int is_hidden = near == NEAR_HIDDEN;
    if (near == NEAR_DRAWN) return 0;
    for (uint32_t i = 0; i < s->cut.taken_count; i++) {
        const uint32_t node = s->cut.taken[i];
        if (!lists_item(s, node, place)) continue;
        if (hides(s, node)) {
            is_hidden = 1;
            continue;
        }
        length = snprintf(text, size, "kept: in the picture of a square of %g m, %u frames old, of which no point is off by more than %g px",
                          s->shots.cells->ground.size * nodes_square_of(&s->shots.cells->ground, node).side,
                          (unsigned)(s->looks.frame - s->shots.all[node].frame), (double)s->shots.states[i].error_px);
        return length < 0 ? 0 : (size_t)length;
    }
    if (is_hidden) length = snprintf(text, size, "dropped: geometry in front hides the box of its part of the ground, as a test of this frame said");
    return length < 0 ? 0 : (size_t)length;
}
