// A stage for tests of method=hiz: see hiz_stage.h.
// SPDX-License-Identifier: MIT
#include "hiz_stage.h"

#include <stdlib.h>
#include <string.h>

#define SNAP_PX (1.0 / 512) // half a step of the 8 bits below the pixel that renderers keep

static void *room(size_t count, size_t size)
{
    void *p = calloc(count + !count, size);
    if (!p) abort();
    return p;
}

void stage_open(hiz_stage *s, const cull_zone *zone, const char *prune, const char *threads, const char *isa)
{
    stage_open_pixels(s, zone, prune, threads, isa, "auto");
}

void stage_open_pixels(hiz_stage *s, const cull_zone *zone, const char *prune, const char *threads, const char *isa, const char *pixels)
{
    const char *const values[] = {prune, threads, isa, pixels};
    hiz_options options;
    memset(s, 0, sizeof *s);
    culler_host_init(&s->host, 0);
    if (hiz_options_read(&s->host.host, values, &options) != CULL_OK || hiz_make(&s->host.host, zone, &options, &s->h) != CULL_OK) abort();
    s->scratch_size = (hiz_scratch_bytes(&s->h) + 63) / 64 * 64;
    s->scratch = aligned_alloc(64, s->scratch_size);
    if (!s->scratch) abort();
    s->item_count = zone->item_count;
}

void stage_close(hiz_stage *s)
{
    hiz_free(&s->h);
    free(s->scratch);
    free(s->runs);
}

void scene_view_make(const camera *c, uint32_t width_px, uint32_t height_px, const cull_zone *zone, hiz_scene_view *out)
{
    const view_frame frame = {.width_px = width_px, .height_px = height_px, .purpose = CULL_VIEW_MAIN, .frame = 1};
    const double origin[3] = {0, 0, 0}, tall = tan(c->fovy_deg * 3.14159265358979323846 / 360);
    double right[3], up[3], back[3];
    memset(out, 0, sizeof *out);
    view_derive(c, &frame, origin, &zone->box, &out->view, &out->sides);
    camera_axes(c, right, up, back);
    for (int k = 0; k < 3; k++) {
        out->eye[k] = c->eye[k];
        out->forward[k] = -back[k];
        out->right[k] = right[k] * tall * c->aspect;
        out->up[k] = up[k] * tall;
    }
    out->near_m = c->near_m;
    out->volume = (cull_volume){out->sides.planes, out->sides.plane_count, 0};
}

void stage_run(hiz_stage *s, const hiz_scene_view *v, const cull_mover *movers, uint32_t mover_count)
{
    cull_volume volume = v->volume;
    volume.planes = v->sides.planes; // the struct may have been copied
    const cull_visit visit = {.view = &v->view, .volumes = &volume, .volume_count = 1, .movers = movers, .mover_count = mover_count, .scratch = s->scratch};
    free(s->runs);
    s->runs = room(s->item_count + mover_count, sizeof *s->runs);
    cull_batch batch = {.runs = s->runs};
    hiz_counters counters = {.rectangles = 0};
    if (hiz_step(&s->h, NULL, &visit, &batch, &counters) != CULL_DONE) abort();
    s->run_count = batch.run_count;
    s->limits_hit = batch.limits_hit;
}

void stage_set(const hiz_stage *s, uint8_t *seen, uint32_t count)
{
    memset(seen, 0, count);
    for (uint32_t i = 0; i < s->run_count; i++)
        for (uint32_t k = 0; k < s->runs[i].count; k++) {
            const uint32_t id = s->runs[i].first + k;
            if (id >= count || seen[id]) abort(); // out of range, or twice
            seen[id] = 1;
        }
}

// ---- The oracle ----

static void ray_of(const hiz_scene_view *v, double x, double y, double out[3])
{
    const double across = 2 * x / v->view.width_px - 1, upwards = 2 * y / v->view.height_px - 1;
    for (int k = 0; k < 3; k++) out[k] = v->forward[k] + across * v->right[k] + upwards * v->up[k];
}

double oracle_box(const hiz_scene_view *v, const cull_box *box, double x, double y)
{
    const double low[3] = {(double)box->min.x, (double)box->min.y, (double)box->min.z}, high[3] = {(double)box->max.x, (double)box->max.y, (double)box->max.z};
    double ray[3], from = -HUGE_VAL, to = HUGE_VAL;
    ray_of(v, x, y, ray);
    for (int k = 0; k < 3; k++) {
        const double a = low[k] - v->eye[k], b = high[k] - v->eye[k];
        if (ray[k] == 0) {
            if (a > 0 || b < 0) return HUGE_VAL;
            continue;
        }
        const double p = a / ray[k], q = b / ray[k];
        from = fmax(from, fmin(p, q));
        to = fmin(to, fmax(p, q));
    }
    if (!(from <= to) || to < v->near_m) return HUGE_VAL;
    return from >= v->near_m ? from : to;
}

int oracle_bounds(const hiz_scene_view *v, const cull_box *box, int out[4], double *least)
{
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    const double size[2] = {v->view.width_px, v->view.height_px};
    *least = HUGE_VAL;
    for (int i = 0; i < 8; i++) {
        const double p[3] = {(double)(i & 1 ? box->max.x : box->min.x) - v->eye[0], (double)(i & 2 ? box->max.y : box->min.y) - v->eye[1],
                             (double)(i & 4 ? box->max.z : box->min.z) - v->eye[2]};
        double w = 0, at[2] = {0, 0}, lengths[2] = {0, 0};
        for (int k = 0; k < 3; k++) {
            w += p[k] * v->forward[k];
            at[0] += p[k] * v->right[k];
            at[1] += p[k] * v->up[k];
            lengths[0] += v->right[k] * v->right[k];
            lengths[1] += v->up[k] * v->up[k];
        }
        if (!(w > v->near_m * 1.0005)) return 0; // hiz has 1/1024
        *least = fmin(*least, w);
        for (int k = 0; k < 2; k++) {
            const double pixel = (at[k] / (w * lengths[k]) + 1) / 2 * size[k];
            low[k] = fmin(low[k], pixel);
            high[k] = fmax(high[k], pixel);
        }
    }
    for (int k = 0; k < 2; k++) {
        out[k] = (int)fmax(0, fmin(size[k], ceil(low[k] - 0.5)));
        out[2 + k] = (int)fmin(size[k] - 1, fmax(-1, floor(high[k] - 0.5)));
    }
    return 1;
}

// The centre, and where a sample may stand against a vertex that was snapped.
static const double snaps[5][2] = {{0, 0}, {-SNAP_PX, -SNAP_PX}, {SNAP_PX, -SNAP_PX}, {-SNAP_PX, SNAP_PX}, {SNAP_PX, SNAP_PX}};

static void oracle_draw(oracle_picture *p, double *samples[5], int sample_count, const cull_box *box, uint32_t item)
{
    int r[4] = {0, 0, (int)p->width_px - 1, (int)p->height_px - 1}, within[4];
    double least;
    if (oracle_bounds(p->v, box, within, &least)) {
        r[0] = within[0] > 0 ? within[0] - 1 : 0;
        r[1] = within[1] > 0 ? within[1] - 1 : 0;
        r[2] = within[2] < r[2] ? within[2] + 1 : r[2];
        r[3] = within[3] < r[3] ? within[3] + 1 : r[3];
    }
    for (int y = r[1]; y <= r[3]; y++)
        for (int x = r[0]; x <= r[2]; x++)
            for (int s = 0; s < sample_count; s++) {
                const size_t at = (size_t)y * p->width_px + (size_t)x;
                const double w = oracle_box(p->v, box, x + 0.5 + snaps[s][0], y + 0.5 + snaps[s][1]);
                if (!(w < samples[s][at])) continue;
                samples[s][at] = w;
                if (s == 0) p->owner[at] = item;
            }
}

void oracle_open(oracle_picture *p, const hiz_scene_view *v, const cull_box *boxes, uint32_t count, oracle_samples kind)
{
    const int sample_count = (int)kind;
    const size_t pixels = (size_t)v->view.width_px * v->view.height_px;
    double *samples[5];
    *p = (oracle_picture){.v = v, .width_px = v->view.width_px, .height_px = v->view.height_px};
    p->owner = room(pixels, sizeof *p->owner);
    memset(p->owner, 0xff, pixels * sizeof *p->owner);
    for (int s = 0; s < 5; s++) {
        samples[s] = room(pixels, sizeof *samples[s]);
        for (size_t i = 0; i < pixels; i++) samples[s][i] = HUGE_VAL;
    }
    for (uint32_t i = 0; i < count; i++) oracle_draw(p, samples, sample_count, &boxes[i], i);
    p->nearest = samples[0];
    p->farthest = room(pixels, sizeof *p->farthest);
    for (size_t i = 0; i < pixels; i++) {
        p->farthest[i] = samples[0][i];
        for (int s = 1; s < sample_count; s++) p->farthest[i] = fmax(p->farthest[i], samples[s][i]);
    }
    for (int s = 1; s < 5; s++) free(samples[s]);
}

void oracle_close(oracle_picture *p)
{
    free(p->nearest);
    free(p->farthest);
    free(p->owner);
}

int oracle_shows(const oracle_picture *p, const cull_box *box)
{
    int r[4];
    double least;
    if (!oracle_bounds(p->v, box, r, &least)) return 1;
    for (int y = r[1] > 0 ? r[1] - 1 : 0; y <= r[3] + 1 && y < (int)p->height_px; y++)
        for (int x = r[0] > 0 ? r[0] - 1 : 0; x <= r[2] + 1 && x < (int)p->width_px; x++)
            for (int s = 0; s < 5; s++)
                if (oracle_box(p->v, box, x + 0.5 + snaps[s][0], y + 0.5 + snaps[s][1]) <= p->farthest[(size_t)y * p->width_px + (size_t)x] &&
                    oracle_box(p->v, box, x + 0.5 + snaps[s][0], y + 0.5 + snaps[s][1]) < HUGE_VAL)
                    return 1;
    return 0;
}
