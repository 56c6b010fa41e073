// Pictures: see images.h.
// SPDX-License-Identifier: MIT
#include "images.h"

#include <ctype.h>
#include <stdio.h>

enum { PATH_BYTES = 4096, NAME_BYTES = 96 };

static int is_missed(const strategy *s, const truth *t, uint32_t triangle)
{
    if (triangle == 0 || triangle > t->triangle_count) return 0;
    const uint32_t item = t->polygon_item[t->triangle_polygon[triangle - 1]];
    return !(s->drawn_bits[item / 32] >> (item % 32) & 1);
}

static result mark_missed(strategy *s, truth *t, uint32_t view, report *r, uint8_t *rgba, uint64_t *out_missed)
{
    const uint32_t width = s->q->width_px, height = s->q->height_px;
    const id_request all = {.camera = &s->q->path->cameras[view]};
    const result done = truth_draw(t, s->g, &all, r);
    if (done != RESULT_OK) return done;
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            uint8_t *pixel = rgba + ((size_t)(height - 1 - y) * width + x) * 4;
            if (is_missed(s, t, t->picture.triangles[(size_t)y * width + x])) {
                pixel[0] = pixel[2] = 255;
                pixel[1] = 0;
                ++*out_missed;
            } else
                for (int k = 0; k < 3; ++k) pixel[k] = (uint8_t)(pixel[k] / 2 + 40);
        }
    return RESULT_OK;
}

result picture_of(strategy *s, truth *t, const picture_request *q, report *r, uint8_t *rgba, uint64_t *out_missed)
{
    strategy_view view;
    *out_missed = 0;
    const strategy_request request = {q->view, q->kind == PICTURE_ERROR ? RENDER_SHADED : q->mode, MARK_DRAWN, q->scissor};
    result done = strategy_restart(s, r);
    if (done == RESULT_OK) done = strategy_run_view(s, &request, r, &view);
    if (done == RESULT_OK) done = renderer_read(s->g, rgba, r);
    if (done == RESULT_OK && q->kind == PICTURE_ERROR) done = mark_missed(s, t, q->view, r, rgba, out_missed);
    return done;
}

static result write_picture(strategy *s, truth *t, const char *name, const picture_request *q, report *r)
{
    char path[PATH_BYTES], file[NAME_BYTES];
    size_t used = 0;
    for (; name[used] && used + 1 < sizeof file; ++used) file[used] = isalnum((unsigned char)name[used]) || name[used] == '-' ? name[used] : '_';
    file[used] = 0;
    const int length = snprintf(path, sizeof path, "%s/%s-%s-%u.png", s->q->images, file, q->kind == PICTURE_ERROR ? "missed" : "view", q->view);
    if (length < 0 || (size_t)length >= sizeof path) return report_error(r, s->q->images, 0, "the folder's name is too long");
    const size_t bytes = (size_t)s->q->width_px * s->q->height_px * 4;
    uint8_t *rgba = memory_alloc(s->q->services->memory, bytes, 1);
    if (!rgba) return report_no_memory(r, NULL);
    uint64_t missed;
    result done = picture_of(s, t, q, r, rgba, &missed);
    if (done == RESULT_OK) done = png_write(path, rgba, s->q->width_px, s->q->height_px, r);
    memory_free(s->q->services->memory, rgba, bytes, 1);
    return done;
}

result bench_images(strategy *s, truth *t, const bench_row *row, report *r)
{
    const picture_request drawn = {.view = s->q->path->count / 2, .mode = RENDER_SHADED, .kind = PICTURE_DRAWN};
    const picture_request missed = {.view = row->worst_view, .kind = PICTURE_ERROR};
    result done = write_picture(s, t, row->name, &drawn, r);
    if (done == RESULT_OK && row->missed_pixels) done = write_picture(s, t, row->name, &missed, r);
    return done;
}
