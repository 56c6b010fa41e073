// compare_pictures A B DX DY DZ [VIEWS]: id pictures of A, and of B (the same scene moved) with the eyes moved alike, must
// be equal in 99.99% of pixels at 1280x720, over views of A (auto:10), every sixth of over ten.
// SPDX-License-Identifier: MIT
#include "host/import/import.h"
#include "host/import/views.h"
#include "host/render/render.h"

#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 1280, HEIGHT = 720, VIEWS = 10, STRIDE = 6, SKIPPED = 77 };

typedef struct side {
    scene *scene;
    renderer *g;
    id_picture picture;
} side;

static result side_open(side *s, const char *path, report *r)
{
    const allocator *memory = allocator_heap();
    const import_options import = {.doors = DOORS_OPEN};
    const renderer_options options = {.target = RENDERER_HEADLESS, .width_px = WIDTH, .height_px = HEIGHT};
    result done = import_scene(path, &import, memory, r, &s->scene);
    if (done == RESULT_OK) done = id_picture_open(s->scene, WIDTH, HEIGHT, memory, &s->picture);
    if (done == RESULT_OK) done = renderer_open(&options, memory, r, &s->g);
    if (done == RESULT_OK) done = renderer_upload(s->g, s->scene, r);
    return done;
}

static result side_draw(side *s, camera c, const double move[3], report *r)
{
    for (int k = 0; k < 3; ++k) c.eye[k] += move[k];
    const id_request q = {.camera = &c};
    return renderer_id_picture(s->g, &q, r, &s->picture);
}

static uint32_t view_at(const camera_path *path, uint32_t i)
{
    return path->count > VIEWS ? i * STRIDE % path->count : i % path->count;
}

// One renderer after the other: each holds its own current context.
static result draw_all(side *s, const camera_path *path, const double move[3], uint32_t *pictures, report *r)
{
    result done = RESULT_OK;
    for (uint32_t v = 0; v < VIEWS && done == RESULT_OK; ++v) {
        done = side_draw(s, path->cameras[view_at(path, v)], move, r);
        for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; ++i) pictures[(size_t)v * WIDTH * HEIGHT + i] = s->picture.triangles[i];
    }
    return done;
}

int main(int argc, char **argv)
{
    if (argc != 6 && argc != 7) return 2;
    report r = report_to_stderr();
    const allocator *memory = allocator_heap();
    const double home[3] = {0, 0, 0}, move[3] = {strtod(argv[3], NULL), strtod(argv[4], NULL), strtod(argv[5], NULL)};
    const size_t pixels = (size_t)WIDTH * HEIGHT * VIEWS;
    uint32_t *a = malloc(pixels * sizeof *a), *b = malloc(pixels * sizeof *b);
    camera_path path = {0};
    side one = {0}, two = {0};
    result done = a && b ? side_open(&one, argv[1], &r) : RESULT_NO_MEMORY;
    if (done == RESULT_NO_GL) return SKIPPED;
    if (done == RESULT_OK) done = camera_path_load(argc == 7 ? argv[6] : "auto:10", one.scene, (double)WIDTH / HEIGHT, memory, &r, &path);
    if (done == RESULT_OK) done = draw_all(&one, &path, home, a, &r);
    renderer_close(one.g);
    if (done == RESULT_OK) done = side_open(&two, argv[2], &r);
    if (done == RESULT_OK) done = draw_all(&two, &path, move, b, &r);
    renderer_close(two.g);
    if (done != RESULT_OK) return 2;
    size_t different = 0, seen = 0;
    for (size_t i = 0; i < pixels; ++i) {
        different += a[i] != b[i];
        seen += a[i] != 0;
    }
    printf("%zu of %zu pixels differ, %zu show something\n", different, pixels, seen);
    id_picture_free(&one.picture, memory);
    id_picture_free(&two.picture, memory);
    scene_free(one.scene, memory);
    scene_free(two.scene, memory);
    camera_path_free(&path, memory);
    free(a);
    free(b);
    return different * 10000 <= pixels && seen * 4 > pixels ? 0 : 1;
}
