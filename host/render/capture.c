// Pictures of items taken: from the frame's eye or another through a parallelogram, as which they are shown (picture_show.c).
// SPDX-License-Identifier: MIT
// Invariant: a capture that can't be taken leaves its slot empty, and showing an empty slot draws the items themselves.
#include "levels.h"

#include <math.h>
#include <string.h>

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// p = w * (corner + u * right + v * up), all relative to the eye: (w u, w v, w) are linear in p. 0: the eye lies in the plane.
static int parallelogram_view(picture_slot *s, viewpoint *v)
{
    double corner[3], rows[3][3];
    for (int k = 0; k < 3; ++k) corner[k] = s->corner[k] - s->eye[k];
    cross(s->up, corner, rows[0]);
    cross(corner, s->right, rows[1]);
    cross(s->right, s->up, rows[2]);
    const double volume = dot(corner, rows[2]);
    const double size = sqrt(dot(rows[2], rows[2]) * dot(corner, corner));
    if (!(fabs(volume) > size * 0x1p-30)) return 0; // of the size that it could have: below, doubles hold no direction
    for (int row = 0; row < 3; ++row)
        for (int k = 0; k < 3; ++k) rows[row][k] /= volume;
    s->near_fraction = v->near_m * sqrt(dot(rows[2], rows[2]));
    for (int i = 0; i < 16; ++i) v->clip_from_eye[i] = 0;
    for (int k = 0; k < 3; ++k) {
        v->clip_from_eye[4 * k + 0] = 2 * rows[0][k] - rows[2][k];
        v->clip_from_eye[4 * k + 1] = 2 * rows[1][k] - rows[2][k];
        v->clip_from_eye[4 * k + 3] = rows[2][k];
    }
    v->clip_from_eye[14] = s->near_fraction;
    viewpoint_finish(v);
    return 1;
}

void picture_set3(double out[3], cull_vec3 v, const double offset[3])
{
    const float from[3] = {v.x, v.y, v.z};
    for (int k = 0; k < 3; ++k) out[k] = (double)from[k] + offset[k];
}

typedef struct capture_job {
    const render_layout *layout;
    const cull_capture *capture;
    const viewpoint *view;
    uint32_t zone;
} capture_job;

static void draw_geometry(renderer *g, const capture_job *j)
{
    const cull_capture *c = j->capture;
    clip_pass clip;
    if (c->run_count == 0) return;
    clip_make(g, &(clip_request){c->clip_planes, c->clip_plane_count, j->zone, j->view}, &clip);
    clip_begin(&clip);
    const draw_pass pass = {.view = j->view, .planes = clip.count ? (const GLfloat(*)[4])clip.planes : NULL, .level = levels_find(j->layout, (double)c->detail_m)};
    frame_draw_runs(g, &pass, &(layout_runs){j->layout, j->zone, c->runs, c->run_count});
    clip_end(&clip);
}

// The barrier waits for nothing on a GPU. Mesa's llvmpipe finishes what is drawn: captures of which several were under way at once stay marked
// as being drawn until so many are again, and each draw that samples one of them would end the pass (8 us).
void capture_begin(renderer *g, const picture_slot *s)
{
    const GLfloat far = 0, none[4] = {0};
    glTextureBarrier();
    state_framebuffer(g, s->framebuffer, s->width_px, s->height_px);
    frame_state_pass(g, BLEND_NONE, DEPTH_ON);
    glClearBufferfv(GL_COLOR, 0, none);
    glClearBufferfv(GL_DEPTH, 0, &far);
}

static void draw_capture(renderer *g, const capture_job *j, const picture_slot *s)
{
    capture_begin(g, s);
    draw_geometry(g, j);
    for (uint32_t i = 0; i < j->capture->slot_count; ++i) {
        const picture_slot *part = slot_find(j->layout, j->zone, j->capture->slots[i]);
        if (part && part != s && slot_holds(g, part)) picture_draw(g, part, j->view);
    }
}

// Colours mean something in the modes for people only; layers are counted, and owners found, on geometry.
static int takes_pictures(const renderer *g)
{
    return g->frame.open && g->frame.request.mode != RENDER_OVERDRAW && g->frame.request.mode != RENDER_IDS;
}

void picture_as_taken(picture_slot *s)
{
    memcpy(s->shown[0], s->corner, sizeof s->corner);
    memcpy(s->shown[1], s->right, sizeof s->right);
    memcpy(s->shown[2], s->up, sizeof s->up);
}

static void set_place(const renderer *g, uint32_t zone, const cull_capture *c, picture_slot *s)
{
    const double nowhere[3] = {0, 0, 0};
    double offset[3];
    layout_zone_offset(g, zone, offset);
    picture_set3(s->corner, c->corner, offset);
    picture_set3(s->right, c->right, nowhere);
    picture_set3(s->up, c->up, nowhere);
    if (c->eye_is_said) picture_set3(s->eye, c->eye, offset);
    else memcpy(s->eye, g->frame.view.eye, sizeof s->eye);
    picture_as_taken(s);
    s->mode = g->frame.request.mode;
    s->faces = g->frame.request.faces;
    s->used = g->frame.number;
}

void renderer_capture(renderer *g, render_layout *l, uint32_t zone, const cull_capture *capture)
{
    if (!takes_pictures(g)) return;
    picture_slot *s = slot_find(l, zone, capture->slot);
    if (!s) return;
    frame_flush(g);
    if (s->waits_in == g->frame.number) shown_draw(g); // as it was when it was shown
    s->filled = 0;
    for (uint32_t i = 0; i < capture->slot_count; ++i) { // what it is composed of is not what it takes the place of
        picture_slot *part = slot_find(l, zone, capture->slots[i]);
        if (!part || part == s) continue;
        part->used = g->frame.number;
        picture_as_taken(part);
    }
    viewpoint v = g->frame.view;
    if (!slot_prepare(g, l, s, capture)) return;
    set_place(g, zone, capture, s);
    memcpy(v.eye, s->eye, sizeof v.eye);
    if (!parallelogram_view(s, &v)) return;
    draw_capture(g, &(capture_job){l, capture, &v, zone}, s);
    outline_want(g, s);
    s->filled = 1;
    l->pictures.captures++;
    l->pictures.pixels_captured += (uint64_t)s->width_px * s->height_px;
    frame_bind(g);
    gl_check(g, NULL, "taking a picture");
}
