// Pictures: see images.h.
// SPDX-License-Identifier: MIT
#include "images.h"
#include "drawn.h"

#include <ctype.h>
#include <stdio.h>

enum { PATH_BYTES = 4096, NAME_BYTES = 96 };

static int is_in_set(const strategy *s, const truth *t, uint32_t triangle)
{
    if (triangle > t->triangle_count) return 1;
    const uint32_t item = t->polygon_item[t->triangle_polygon[triangle - 1]];
    return s->drawn_bits[item / 32] >> (item % 32) & 1;
}

// Something owns the pixel, and it is not in D, or what was drawn lies behind it: cut away, or drawn otherwise than said.
static void find_missed(const strategy *s, const truth *t, const float *true_depths, drawn_picture *drawn)
{
    for (size_t i = 0; i < drawn->pixels; ++i) {
        const uint32_t owner = t->picture.triangles[i];
        drawn->owners[i] = owner && (!is_in_set(s, t, owner) || drawn->depths[i] < true_depths[i]);
    }
}

static result mark_missed(strategy *s, truth *t, uint32_t view, report *r, uint8_t *rgba, uint64_t *out_missed)
{
    const uint32_t width = s->q->width_px, height = s->q->height_px;
    const id_request all = {.camera = &s->q->path->cameras[view]};
    drawn_picture drawn;
    result done = drawn_picture_open(s, r, &drawn);
    if (done != RESULT_OK) return done;
    float *true_depths = memory_alloc(s->q->services->memory, drawn.pixels, sizeof *true_depths);
    done = true_depths ? drawn_again(s, view, r, &drawn) : report_no_memory(r, NULL);
    if (done == RESULT_OK) done = strategy_judge(s, view, r, t);
    if (done == RESULT_OK) done = truth_draw(t, s->g, &all, r);
    if (done == RESULT_OK) done = renderer_read_ids(s->g, NULL, true_depths, r);
    if (done == RESULT_OK) find_missed(s, t, true_depths, &drawn);
    memory_free(s->q->services->memory, true_depths, drawn.pixels, sizeof *true_depths);
    for (uint32_t y = 0; y < height && done == RESULT_OK; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            uint8_t *pixel = rgba + ((size_t)(height - 1 - y) * width + x) * 4;
            if (drawn.owners[(size_t)y * width + x]) {
                pixel[0] = pixel[2] = 255;
                pixel[1] = 0;
                ++*out_missed;
            } else
                for (int k = 0; k < 3; ++k) pixel[k] = (uint8_t)(pixel[k] / 2 + 40);
        }
    drawn_picture_free(s, &drawn);
    return done;
}

// In letters, and as a note.
static void write_counts(strategy *s, const strategy_view *view, report *r)
{
    enum { DARK = (int)0xe0000000, LIGHT = (int)0xffffffff, TEXT_BYTES = 256, LETTERS_WIDE = 80 * 8 };
    const view_counts counts = strategy_count(s, &view->set);
    char text[TEXT_BYTES];
    snprintf(text, sizeof text, "%.100s\n%llu polygons of %u   zones %u of %u", s->chains->name, (unsigned long long)counts.polygons,
             s->q->scene->polygon_count, view->stats.zones, s->q->scene->zone_count);
    report_note(r, "%s: %llu polygons of %u, zones %u of %u", s->chains->name, (unsigned long long)counts.polygons, s->q->scene->polygon_count,
                view->stats.zones, s->q->scene->zone_count);
    const uint32_t scale = s->q->width_px / LETTERS_WIDE > 1 ? s->q->width_px / LETTERS_WIDE : 1;
    renderer_overlay_text(s->g, &(overlay_text){text, 8 + scale, 8 + scale, scale, (uint32_t)DARK});
    renderer_overlay_text(s->g, &(overlay_text){text, 8, 8, scale, (uint32_t)LIGHT});
}

result picture_of(strategy *s, truth *t, const picture_request *q, report *r, uint8_t *rgba, uint64_t *out_missed)
{
    strategy_view view;
    *out_missed = 0;
    const int is_error = q->kind == PICTURE_ERROR;
    const strategy_request request = {.view = q->view, .mode = is_error ? RENDER_SHADED : q->mode, .marks = MARK_DRAWN, .scissor = q->scissor,
                                      .records = is_error ? RECORD_DRAWS : RECORD_NOTHING};
    result done = strategy_restart(s, r);
    if (done == RESULT_OK) done = strategy_run_view(s, &request, r, &view);
    if (done == RESULT_OK && q->caption == CAPTION_COUNTS) write_counts(s, &view, r);
    if (done == RESULT_OK) done = renderer_read(s->g, rgba, r);
    if (done == RESULT_OK && q->kind == PICTURE_ERROR) done = mark_missed(s, t, q->view, r, rgba, out_missed);
    return done;
}

result image_write(const bench_request *q, const image_name *name, const uint8_t *rgba, report *r)
{
    char path[PATH_BYTES], file[NAME_BYTES];
    size_t used = 0;
    for (const char *c = name->strategy; *c && used + 1 < sizeof file; ++c, ++used) file[used] = isalnum((unsigned char)*c) || *c == '-' ? *c : '_';
    file[used] = 0;
    const int length = snprintf(path, sizeof path, "%s/%s-%s-%u.png", q->images, file, name->kind, name->view);
    if (length < 0 || (size_t)length >= sizeof path) return report_error(r, q->images, 0, "the folder's name is too long");
    return png_write(path, rgba, q->width_px, q->height_px, r);
}

static result write_picture(strategy *s, truth *t, const char *name, const picture_request *q, report *r)
{
    const image_name file = {name, q->kind == PICTURE_ERROR ? "missed" : "view", q->view};
    const size_t bytes = (size_t)s->q->width_px * s->q->height_px * 4;
    uint8_t *rgba = memory_alloc(s->q->services->memory, bytes, 1);
    if (!rgba) return report_no_memory(r, NULL);
    uint64_t missed;
    result done = picture_of(s, t, q, r, rgba, &missed);
    if (done == RESULT_OK) done = image_write(s->q, &file, rgba, r);
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
