// A frame of pictures and geometry: see show.h.
// SPDX-License-Identifier: MIT
#include "show.h"

#include <string.h>

enum { REST_AFTER = 30, REST_LOOK = 15 }; // frames
#define SPEED_KEPT 0.9       // of the speed, a frame: who stops goes on
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
    out->max_captures = out->max_pictures = c->cell_count;
    out->max_clipped = 1;
    out->index_bytes += s->lists.node_bytes + s->lists.run_bytes + s->seams.bytes;
}

int show_open(const cull_host *host, const cells *c, const show_culler *s, show *out)
{
    memset(out, 0, sizeof *out);
    out->culler = s;
    if (!s->costs) return 1;
    if (cut_open(host, c, &s->lists, &out->cut) && shots_open(host, c, &s->lists, &out->shots) && seams_open(host, c, &s->seams, &out->seams)) return 1;
    show_close(host, out);
    return 0;
}

void show_close(const cull_host *host, show *s)
{
    cut_close(host, &s->cut);
    shots_close(host, &s->shots);
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
                     .picture_pixel_ns = c->keep_depth ? c->costs->picture_depth_pixel_ns : c->costs->picture_pixel_ns, .eye_cell = f->eye,
                     .nodes = c->options.nodes == SHOW_TREE ? CUT_TREE : CUT_CELLS,
                     .history = s->history == SHOW_GOES_ON ? CUT_GOES_ON : CUT_ANEW};
    q.optics = (cut_optics){(double)view->pixels_per_tangent, (double)view->near_distance, (double)view->width_px * view->height_px};
    memcpy(q.eye, s->eye, sizeof q.eye);
    memcpy(q.step, s->step, sizeof q.step);
    return q;
}

// Where pictures didn't pay for a while they are asked about more rarely: weighing them costs, too.
static int rests(const show *s)
{
    return s->geometry_frames > REST_AFTER && s->geometry_frames % REST_LOOK != 0;
}

static int plan(show *s, const show_frame *f, cull_batch *batch)
{
    s->view = request_of(s, f);
    cut_make(&s->cut, &s->view);
    s->history = SHOW_GOES_ON;
    if (s->cut.taken_count == 0) return 0;
    const shots_request pictures = {f->visit, &s->view, &s->cut, s->culler->keep_depth};
    if (shots_show(&s->shots, &pictures, batch)) return 1;
    batch->limits_hit++;
    return 0;
}

int show_pictures(show *s, const show_frame *f, cull_batch *batch)
{
    follow_eye(s, f->visit, f->inview->cells->ground.size);
    s->counts.frames++;
    if (rests(s) || !plan(s, f, batch)) {
        s->geometry_frames++;
        s->counts.geometry_frames++;
        return 0;
    }
    s->geometry_frames = 0;
    s->counts.pictures += s->shots.shown_count;
    s->counts.captures += s->shots.taken_count;
    if (s->shots.error_px > s->counts.error_px) s->counts.error_px = s->shots.error_px;
    return 1;
}

void show_geometry(show *s, const show_frame *f, cull_batch *batch)
{
    seams_request seam = {.inview = f->inview, .geometry = f->geometry, .eye = f->eye, .ring = s->cut.ring,
                          .pixels_per_tangent = s->view.optics.pixels_per_tangent, .tolerance_px = s->view.tolerance_px};
    memcpy(seam.at, s->eye, sizeof seam.at);
    seams_draw(&s->seams, &seam, batch);
}
