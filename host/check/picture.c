// A small depth picture: see picture.h.
// SPDX-License-Identifier: MIT
#include "picture.h"

#include <portcullis/plane.h>

#include <math.h>
#include <stdlib.h>

enum { PIXELS = VIEW_WIDTH_PX * VIEW_HEIGHT_PX };

void sample_picture_open(sample_picture *p, const made_scene *s, const made_view *v, sight_backs backs)
{
    *p = (sample_picture){s, v, backs, calloc(PIXELS, sizeof(double)), calloc(3 * PIXELS, sizeof(double))};
    if (!p->depth || !p->rays) abort();
    for (uint32_t i = 0; i < PIXELS; ++i) {
        const double x = ((i % VIEW_WIDTH_PX + 0.5) * 2 / VIEW_WIDTH_PX - 1) * v->wide, y = ((i / VIEW_WIDTH_PX + 0.5) * 2 / VIEW_HEIGHT_PX - 1) * v->tall;
        p->depth[i] = INFINITY;
        for (int k = 0; k < 3; ++k) p->rays[3 * i + (uint32_t)k] = v->axes[2][k] + x * v->axes[0][k] + y * v->axes[1][k];
    }
}

void sample_picture_close(sample_picture *p)
{
    free(p->depth);
    free(p->rays);
    *p = (sample_picture){0};
}

// Depths at which the ray is in the box. 0: never.
static int span_of(const double from[3], const double along[3], const cull_box *b, double wide, double *low, double *high)
{
    *low = 0;
    *high = INFINITY;
    for (int i = 0; i < 3; ++i) {
        const double a = (double)(&b->min.x)[i] - wide - from[i], c = (double)(&b->max.x)[i] + wide - from[i];
        if (along[i] == 0) {
            if (a > 0 || c < 0) return 0;
            continue;
        }
        *low = fmax(*low, fmin(a / along[i], c / along[i]));
        *high = fmin(*high, fmax(a / along[i], c / along[i]));
    }
    return *low <= *high;
}

// Pixels whose middle may lie in the rectangle.
typedef struct pixel_rect { uint32_t first[2], end[2]; } pixel_rect;
static pixel_rect pixels_of(const made_view *v, const cull_box *box)
{
    static const uint32_t sizes[2] = {VIEW_WIDTH_PX, VIEW_HEIGHT_PX};
    const view_rect at = view_rect_of(v, box);
    pixel_rect to = {{0, 0}, {0, 0}};
    for (int i = 0; i < 2; ++i) {
        if (!(at.low[i] <= at.high[i])) return (pixel_rect){{0, 0}, {0, 0}};
        to.first[i] = (uint32_t)((at.low[i] + 1) / 2 * sizes[i]);
        to.end[i] = (uint32_t)((at.high[i] + 1) / 2 * sizes[i]) + 1;
        if (to.end[i] > sizes[i]) to.end[i] = sizes[i];
    }
    return to;
}

static void draw_pixel(sample_picture *p, uint32_t item, uint32_t i)
{
    double low, high;
    const made_scene *s = p->scene;
    const double *from = p->view->camera.eye, *along = p->rays + 3 * i;
    if (!span_of(from, along, &s->boxes[item], 1e-3, &low, &high) || low >= p->depth[i]) return;
    sight_ray ray = {.near_m = p->view->camera.near_m, .far_m = p->view->camera.far_m, .backs = p->backs};
    for (int k = 0; k < 3; ++k) ray.from[k] = from[k], ray.along[k] = along[k];
    const double at = sight_depth_of(s, &ray, item);
    if (at < p->depth[i]) p->depth[i] = at;
}

void sample_picture_draw(sample_picture *p, uint32_t item)
{
    const made_scene *s = p->scene;
    if (item >= s->zone.item_count || s->flags[item] & (CULL_ITEM_SEE_THROUGH | CULL_ITEM_CUT_OUT)) return;
    const pixel_rect at = pixels_of(p->view, &s->boxes[item]);
    for (uint32_t y = at.first[1]; y < at.end[1]; ++y)
        for (uint32_t x = at.first[0]; x < at.end[0]; ++x) draw_pixel(p, item, y * VIEW_WIDTH_PX + x);
}

uint32_t sample_picture_test(const sample_picture *p, const cull_box *box)
{
    const double *eye = p->view->camera.eye;
    double far = 0, nearest = 0; // of its corners, of it
    for (int k = 0; k < 3; ++k) {
        const double low = (double)(&box->min.x)[k] - eye[k], high = (double)(&box->max.x)[k] - eye[k];
        far += fmax(low * low, high * high);
        nearest += low > 0 ? low * low : high < 0 ? high * high : 0;
    }
    const double wide = CULL_GUARD_DISTANCE * sqrt(far) + 1e-9;
    if (sqrt(nearest) <= p->view->camera.near_m * p->view->view.reach * 2) return 1; // it may reach the near plane
    uint32_t count = 0;
    const pixel_rect at = pixels_of(p->view, box);
    for (uint32_t y = at.first[1]; y < at.end[1]; ++y)
        for (uint32_t x = at.first[0]; x < at.end[0]; ++x) {
            const uint32_t i = y * VIEW_WIDTH_PX + x;
            double low, high;
            count += span_of(eye, p->rays + 3 * i, box, wide, &low, &high) && low <= p->depth[i] * (1 + 1e-6);
        }
    return count;
}
