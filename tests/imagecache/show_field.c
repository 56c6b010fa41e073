// The field: see show_field.h.
// SPDX-License-Identifier: MIT
#include "show_field.h"

#include <math.h>
#include <stdlib.h>

// Some stand on many cells.
cull_box *field_make(void)
{
    uint64_t r = 6301;
    cull_box *boxes = calloc(FIELD_ITEMS, sizeof *boxes);
    assert_non_null(boxes);
    for (int i = 0; i < FIELD_ITEMS; i++) {
        const double x = random_between(&r, 0, FIELD_M), z = random_between(&r, 0, FIELD_M), wide = i % 50 == 0 ? 60 : random_between(&r, 1, 9);
        const double tall = wide > 50 ? 0.1 : random_between(&r, 1, 12);
        boxes[i] = (cull_box){{(float)x, 0, (float)z}, {(float)(x + wide), (float)tall, (float)(z + wide)}};
    }
    return boxes;
}

void field_open(field *f, const show_values *values, double polygon_ns)
{
    f->boxes = field_make();
    zone_of_boxes(f->boxes, FIELD_ITEMS, &f->zone);
    show_host_init(&f->host, polygon_ns, 0);
    assert_int_equal(show_open(&f->s, &f->host, &f->zone.zone, values), CULL_OK);
}

void field_close(field *f)
{
    show_close(&f->s);
    assert_true(failing_allocator_is_clean(&f->host.base.memory));
    hand_zone_free(&f->zone);
    free(f->boxes);
}

show_eye field_eye(uint32_t frame)
{
    const double t = frame * FIELD_STEP_M;
    const show_eye e = {{200 + t * 0.9, 1.7 + 20 * (frame / 200), 380 + 15 * sin(t / 30)}, 0.6 * sin(t / 20), -0.05};
    return e;
}

void field_look(field *f, show_eye eye, uint32_t frame, show_answers answers, cull_plane *planes, cull_view *view)
{
    show_look(eye, frame, view, planes);
    const cull_volume volume = {planes, 4, 0};
    show_frame(&f->s, view, &volume, answers);
}

void field_point(uint64_t *r, cull_box b, double out[3])
{
    const double low[3] = {(double)b.min.x, (double)b.min.y, (double)b.min.z}, high[3] = {(double)b.max.x, (double)b.max.y, (double)b.max.z};
    for (int k = 0; k < 3; k++) out[k] = low[k] + (high[k] - low[k]) * random_unit(r);
}

double field_off_most(field *f, const cull_view *view, const cull_plane *planes, uint64_t *r, uint64_t *samples)
{
    enum { POINTS = 12 };
    double most = 0;
    for (uint32_t i = 0; i < f->s.batch.picture_count; i++) {
        const cull_picture *shown = &f->s.batch.pictures[i];
        const cull_capture *c = &f->s.held[shown->slot];
        for (int k = 0; k < POINTS; k++) {
            const cull_run run = shown->runs[random_below(r, shown->run_count)];
            double p[3];
            field_point(r, show_item_box(&f->s, run.first + random_below(r, run.count)), p);
            if (!show_inside(c->clip_planes, c->clip_plane_count, p, 0)) continue;
            const double off = show_off_px(view, planes, c, shown, p);
            if (off > (double)shown->error_px) fail_msg("frame %u: %g px off, %g said", view->frame, off, (double)shown->error_px);
            if (off > most) most = off;
            *samples += off >= 0;
        }
    }
    return most;
}
