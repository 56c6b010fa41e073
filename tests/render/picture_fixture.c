// See picture_fixture.h.
// SPDX-License-Identifier: MIT
#include "picture_fixture.h"

#include <stdlib.h>

void drop_pixels(uint8_t *rgba)
{
    memory_free(allocator_heap(), rgba, (size_t)SIDE * SIDE, 4);
}

frame_request request(const camera *c)
{
    return (frame_request){.camera = c, .width_px = SIDE, .height_px = SIDE, .mode = RENDER_ITEMS};
}

cull_vec3 in_zone(const bed *b, double x, double y, double z)
{
    const double *o = b->s->whole.origin;
    return (cull_vec3){(float)(x - o[0]), (float)(y - o[1]), (float)(z - o[2])};
}

cull_plane plane_in_zone(const bed *b, double x, double y, double z, double offset)
{
    const double *o = b->s->whole.origin;
    return (cull_plane){{(float)x, (float)y, (float)z}, (float)(offset + x * o[0] + y * o[1] + z * o[2])};
}

cull_capture whole_picture(const bed *b, const camera *c, double distance, const cull_run *runs, uint32_t run_count)
{
    const float side = (float)(2 * distance);
    return (cull_capture){.runs = runs, .run_count = run_count, .corner = in_zone(b, c->eye[0] - distance, c->eye[1] - distance, c->eye[2] - distance),
                          .right = {side, 0, 0}, .up = {0, side, 0}, .slot = 7, .width_px = SIDE, .height_px = SIDE};
}

uint32_t pixels_that_differ(const uint8_t *a, const uint8_t *b)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; ++i) {
        int most = 0;
        for (uint32_t k = 0; k < 3; ++k) {
            const int d = abs(a[4 * i + k] - b[4 * i + k]);
            most = d > most ? d : most;
        }
        count += most > 8;
    }
    return count;
}

void scene_with_slots(bed *b, const quad *quads, size_t count)
{
    bed_scene(b, quads, count, NULL);
    assert_int_equal(render_layout_slots(b->l, &(uint32_t){SLOTS}, &b->r), RESULT_OK);
}

void random_scene(bed *b, uint32_t seed)
{
    static quad quads[QUADS];
    for (int i = 0; i < QUADS; ++i) {
        const double x = 20 * random_unit(&seed) - 10, y = 20 * random_unit(&seed) - 10, z = -4 * random_unit(&seed) - 8;
        quads[i] = quad_at(z, x, y, x + 6 * random_unit(&seed) + 0.1, y + 6 * random_unit(&seed) + 0.1);
    }
    scene_with_slots(b, quads, QUADS);
}

uint8_t *frame_of(bed *b, const frame_request *q, void (*draw)(bed *b, void *what), void *what)
{
    uint8_t *rgba = memory_alloc(allocator_heap(), (size_t)SIDE * SIDE, 4);
    assert_int_equal(renderer_begin(b->g, q, &b->r), RESULT_OK);
    draw(b, what);
    renderer_end(b->g);
    assert_int_equal(renderer_read(b->g, rgba, &b->r), RESULT_OK);
    return rgba;
}

typedef struct picture_frame {
    const cull_capture *capture;
    const cull_picture *picture;
    const cull_run *more;
} picture_frame;

static void draw_picture_frame(bed *b, void *what)
{
    const picture_frame *f = what;
    if (f->capture) renderer_capture(b->g, b->l, 0, f->capture);
    if (f->picture) renderer_show(b->g, b->l, 0, f->picture);
    if (f->more) bed_draw(b, b->l, f->more, 1);
}

uint8_t *frame_with(bed *b, const frame_request *q, const cull_capture *capture, const cull_picture *picture, const cull_run *more)
{
    return frame_of(b, q, draw_picture_frame, &(picture_frame){capture, picture, more});
}
