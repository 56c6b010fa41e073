// What showing a picture costs and loses by its filter and format: measure_pictures SCENE VIEWS [TEXELS_A_PIXEL]
// SPDX-License-Identifier: MIT
// Each view is captured whole, the eye then turned (which alone moves nothing on a parallelogram), and the picture shown beside the
// geometry: what differs is sampling, and nothing else. PSNR of the mean squared error over all views.
#define _POSIX_C_SOURCE 200809L
#include "host/import/import.h"
#include "host/import/views.h"
#include "host/render/costs.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { WIDTH = 1280, HEIGHT = 720 };

typedef struct stand {
    scene *s;
    renderer *g;
    render_layout *l;
    report r;
    double texels;
    uint8_t *plain, *shown;
} stand;

typedef struct sums { double squares, values; uint64_t open, over; } sums; // open: geometry there, no picture; over: the other way round

static void cross3(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    const double length = sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    for (int k = 0; k < 3; ++k) out[k] /= length;
}

// Through the square to the view at 10 m, a fifth wider than the view.
static cull_capture whole_view(const stand *s, const camera *c, const cull_run *all)
{
    const double distance = 10, high = 1.2 * distance * tan(c->fovy_deg * 3.14159265358979 / 360), wide = high * c->aspect;
    double forward[3], right[3], up[3], corner[3];
    const double length = sqrt(c->forward[0] * c->forward[0] + c->forward[1] * c->forward[1] + c->forward[2] * c->forward[2]);
    for (int k = 0; k < 3; ++k) forward[k] = c->forward[k] / length;
    cross3(forward, c->up, right);
    cross3(right, forward, up);
    for (int k = 0; k < 3; ++k) corner[k] = c->eye[k] - s->s->zones[0].origin[k] + distance * forward[k] - wide * right[k] - high * up[k];
    return (cull_capture){.runs = all, .run_count = 1, .corner = {(float)corner[0], (float)corner[1], (float)corner[2]},
                          .right = {(float)(2 * wide * right[0]), (float)(2 * wide * right[1]), (float)(2 * wide * right[2])},
                          .up = {(float)(2 * high * up[0]), (float)(2 * high * up[1]), (float)(2 * high * up[2])},
                          .width_px = (uint32_t)(1.2 * WIDTH * s->texels), .height_px = (uint32_t)(1.2 * HEIGHT * s->texels)};
}

static int draw_view(stand *s, const camera *c, const cull_capture *capture, const cull_run *all, uint8_t *rgba)
{
    const frame_request q = {.camera = c, .width_px = WIDTH, .height_px = HEIGHT, .mode = RENDER_SHADED};
    if (renderer_begin(s->g, &q, &s->r) != RESULT_OK) return 0;
    if (capture) renderer_capture(s->g, s->l, 0, capture);
    else if (all) renderer_draw(s->g, s->l, 0, all, 1);
    else renderer_show(s->g, s->l, 0, &(cull_picture){0});
    renderer_end(s->g);
    return !rgba || renderer_read(s->g, rgba, &s->r) == RESULT_OK;
}

static void compare(const stand *s, sums *out)
{
    static const uint8_t background[3] = {168, 191, 214};
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; ++i) {
        const int geometry = memcmp(s->plain + 4 * i, background, 3) != 0, picture = memcmp(s->shown + 4 * i, background, 3) != 0;
        out->open += geometry && !picture;
        out->over += picture && !geometry;
        for (int k = 0; k < 3; ++k) {
            const double d = (double)s->plain[4 * i + (size_t)k] - s->shown[4 * i + (size_t)k];
            out->squares += d * d;
        }
    }
    out->values += 3.0 * WIDTH * HEIGHT;
}

static int measure_view(stand *s, const camera *c, sums *out)
{
    const cull_run all = {0, s->s->item_count};
    const cull_capture capture = whole_view(s, c, &all);
    camera turned = *c;
    turned.forward[0] += 0.013 * c->forward[2];
    turned.forward[2] -= 0.013 * c->forward[0];
    turned.forward[1] += 0.007;
    turned.fovy_deg *= 0.97;
    if (!draw_view(s, c, &capture, NULL, NULL) || !draw_view(s, &turned, NULL, &all, s->plain) || !draw_view(s, &turned, NULL, NULL, s->shown)) return 0;
    compare(s, out);
    return 1;
}

// A pixel of a picture that stands behind others: early z should spare all but the look at its depth.
static double covered_pixel_ns(stand *s, const camera *c)
{
    enum { SHOWN = 21 };
    double ns[2] = {0, 0};
    for (uint32_t k = 0; k < 6; ++k) {
        const frame_request q = {.camera = c, .width_px = WIDTH, .height_px = HEIGHT, .mode = RENDER_SHADED};
        struct timespec start, end;
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &start);
        if (renderer_begin(s->g, &q, &s->r) != RESULT_OK) return 0;
        for (uint32_t i = 0; i < (k % 2 ? SHOWN : 1); ++i) renderer_show(s->g, s->l, 0, &(cull_picture){0});
        renderer_end(s->g);
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &end);
        ns[k % 2] = (double)(end.tv_sec - start.tv_sec) * 1e9 + (double)(end.tv_nsec - start.tv_nsec); // the last of three: all is compiled
    }
    return (ns[1] - ns[0]) / (SHOWN - 1) / WIDTH / HEIGHT;
}

static int measure(stand *s, const camera_path *path)
{
    static const char *const filters[] = {"linear", "nearest"}, *const formats[] = {"8 bits", "5 bits"};
    for (int i = 0; i < 4; ++i) {
        sums sum = {0};
        cull_costs costs;
        renderer_picture_options(s->g, &(picture_options){(picture_filter)(i / 2), (picture_format)(i % 2), 1u << 30});
        for (uint32_t v = 0; v < path->count; ++v)
            if (!measure_view(s, &path->cameras[v], &sum)) return 0;
        if (renderer_costs(s->g, &s->r, &costs) != RESULT_OK) return 0;
        if (i == 0) {
            const cull_run all = {0, s->s->item_count};
            const cull_capture capture = whole_view(s, &path->cameras[0], &all);
            draw_view(s, &path->cameras[0], &capture, NULL, NULL);
            printf("a pixel of a picture behind another: %.2f ns\n", covered_pixel_ns(s, &path->cameras[0]));
        }
        printf("%-8s %s: PSNR %.2f dB, open %.0f and over %.0f pixels a view; ", filters[i / 2], formats[i % 2],
               10 * log10(255.0 * 255.0 * sum.values / sum.squares), (double)sum.open / path->count, (double)sum.over / path->count);
        printf("ns: polygon %.0f, pixel %.1f, picture %.0f, its pixel %.1f, with depth %.1f, ", costs.polygon_ns, costs.pixel_ns, costs.picture_ns,
               costs.picture_pixel_ns, costs.picture_depth_pixel_ns);
        printf("capture %.0f, its pixel %.1f\n", costs.capture_ns, costs.capture_pixel_ns);
    }
    return 1;
}

int main(int argc, char **argv)
{
    stand s = {.r = report_to_stderr(), .texels = argc > 3 ? atof(argv[3]) : 1};
    camera_path path = {0};
    const allocator *memory = allocator_heap();
    const import_options import = {0};
    if (argc < 3) return 2;
    if (import_scene(argv[1], &import, memory, &s.r, &s.s) != RESULT_OK) return 1;
    if (camera_path_load(argv[2], s.s, (double)WIDTH / HEIGHT, memory, &s.r, &path) != RESULT_OK) return 1;
    if (renderer_open(NULL, memory, &s.r, &s.g) != RESULT_OK || renderer_upload(s.g, s.s, &s.r) != RESULT_OK) return 1;
    const uint32_t count = s.s->zones[0].item_count, slots = 1;
    if (s.s->zone_count != 1) return 2;
    if (render_layout_open(s.g, &(render_layout_zone){s.s->zone_items, count}, 1, &s.r, &s.l) != RESULT_OK) return 1;
    if (render_layout_slots(s.l, &slots, &s.r) != RESULT_OK) return 1;
    s.plain = malloc((size_t)WIDTH * HEIGHT * 4);
    s.shown = malloc((size_t)WIDTH * HEIGHT * 4);
    const int good = s.plain && s.shown && measure(&s, &path);
    free(s.plain);
    free(s.shown);
    render_layout_close(s.l);
    renderer_close(s.g);
    camera_path_free(&path, memory);
    scene_free(s.s, memory);
    return good ? 0 : 1;
}
