// Pictures shown: the parallelogram that a slot was taken through, or one that is said, from where the frame's eye is now.
// SPDX-License-Identifier: MIT
// Invariant: a picture without depth stands behind all that has depth, and in front of those shown after it; a slot that holds nothing
// draws the items. All wait for the frame's end: a picture is right to its tolerance only, and a box test that saw one's depth could call
// hidden what shows a pixel.
#include "gl.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// ---- Drawing ----

static void set_taken_uniforms(const picture_slot *s, const viewpoint *v, GLuint program)
{
    const double *const vectors[] = {s->corner, s->right, s->up}, *m = v->clip_from_eye;
    double zw[2] = {m[14], m[15]};
    for (int i = 0; i < 3; ++i) {
        GLfloat out[3];
        for (int k = 0; k < 3; ++k) out[k] = (GLfloat)(vectors[i][k] - (i == 0 ? s->eye[k] : 0));
        glProgramUniform3fv(program, 4 + i, 1, out);
    }
    for (int row = 0; row < 2; ++row)
        for (int k = 0; k < 3; ++k) zw[row] += m[4 * k + 2 + row] * (s->eye[k] - v->eye[k]);
    glProgramUniform1f(program, 7, (GLfloat)s->near_fraction);
    glProgramUniform2f(program, 8, (GLfloat)zw[0], (GLfloat)zw[1]);
    glProgramUniform1f(program, 9, (GLfloat)PICTURE_DEPTH);
}

static void set_uniforms(const picture_slot *s, const viewpoint *v, GLuint program)
{
    GLfloat corner[3], right[3], up[3];
    for (int k = 0; k < 3; ++k) {
        corner[k] = (GLfloat)(s->shown[0][k] - v->eye[k]);
        right[k] = (GLfloat)s->shown[1][k];
        up[k] = (GLfloat)s->shown[2][k];
    }
    glProgramUniformMatrix4fv(program, AT_CLIP_FROM_EYE, 1, GL_FALSE, v->clip);
    glProgramUniform3fv(program, 1, 1, corner);
    glProgramUniform3fv(program, 2, 1, right);
    glProgramUniform3fv(program, 3, 1, up);
}

void picture_draw(renderer *g, const picture_slot *s, const viewpoint *v)
{
    const uint32_t variant = (g->pictures.options.filter == PICTURE_LINEAR ? VARIANT_LINEAR : 0) | (s->keep_depth ? VARIANT_KEEP_DEPTH : 0);
    const GLuint program = program_find(g, PROGRAM_PICTURE, variant);
    if (!program) return;
    if (!g->pictures.vertices) glCreateVertexArrays(1, &g->pictures.vertices);
    state_program(g, program);
    state_vertices(g, g->pictures.vertices);
    state_pass_at(g, &(pass_state){GL_GREATER, DEPTH_ON, COLOUR_ON, BLEND_NONE, BACK_DRAWN, OFFSET_NONE}, s->keep_depth ? RANGE_OWN : RANGE_BEHIND);
    set_uniforms(s, v, program);
    if (s->keep_depth) set_taken_uniforms(s, v, program);
    glBindTextureUnit(0, s->colour);
    if (s->keep_depth) glBindTextureUnit(1, s->depth);
    const uint32_t strips = outline_set(s, program);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, strips ? 2 * ((GLsizei)strips + 1) : 4);
    g->frame.draw_calls++;
}

// ---- Its area in the frame ----

enum { CORNERS_MOST = 9 }; // a quad, and one more for each of five planes
typedef struct clip_corner { double x, y, w; } clip_corner;

static double inside(const clip_corner *c, int plane, double near_m)
{
    switch (plane) {
    case 0: return c->w - near_m;
    case 1: return c->w + c->x;
    case 2: return c->w - c->x;
    case 3: return c->w + c->y;
    default: return c->w - c->y;
    }
}

// Sutherland and Hodgman 1974.
static int cut(const clip_corner *in, int count, int plane, double near_m, clip_corner *out)
{
    int kept = 0;
    for (int i = 0; i < count; ++i) {
        const clip_corner *a = &in[i], *b = &in[(i + 1) % count];
        const double at_a = inside(a, plane, near_m), at_b = inside(b, plane, near_m);
        if (at_a >= 0) out[kept++] = *a;
        if ((at_a >= 0) == (at_b >= 0)) continue;
        const double t = at_a / (at_a - at_b);
        out[kept++] = (clip_corner){a->x + t * (b->x - a->x), a->y + t * (b->y - a->y), a->w + t * (b->w - a->w)};
    }
    return kept;
}

static clip_corner corner_of(const picture_slot *s, const viewpoint *v, int i)
{
    static const double places[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const double *m = v->clip_from_eye;
    double out[4];
    for (int row = 0; row < 4; ++row) {
        out[row] = m[12 + row];
        for (int k = 0; k < 3; ++k) out[row] += m[4 * k + row] * (s->shown[0][k] + places[i][0] * s->shown[1][k] + places[i][1] * s->shown[2][k] - v->eye[k]);
    }
    return (clip_corner){out[0], out[1], out[3]};
}

static double area_px(const renderer *g, const picture_slot *s)
{
    clip_corner a[CORNERS_MOST], b[CORNERS_MOST];
    int count = 4;
    double twice = 0;
    for (int i = 0; i < 4; ++i) a[i] = corner_of(s, &g->frame.view, i);
    for (int plane = 0; plane < 5 && count; ++plane) {
        count = cut(a, count, plane, g->frame.view.near_m, b);
        for (int i = 0; i < count; ++i) a[i] = b[i];
    }
    for (int i = 0; i < count; ++i) {
        const clip_corner *p = &a[i], *q = &a[(i + 1) % count];
        twice += p->x / p->w * (q->y / q->w) - q->x / q->w * (p->y / p->w);
    }
    return fabs(twice) / 8 * g->frame.request.width_px * g->frame.request.height_px; // -1 .. 1 is the whole width
}

// ---- In a frame ----

static void place(const renderer *g, uint32_t zone, const cull_picture *p, picture_slot *s)
{
    static const double nowhere[3] = {0, 0, 0};
    double offset[3];
    picture_as_taken(s);
    if (!p->place_is_said) return;
    layout_zone_offset(g, zone, offset);
    picture_set3(s->shown[0], p->corner, offset);
    picture_set3(s->shown[1], p->right, nowhere);
    picture_set3(s->shown[2], p->up, nowhere);
}

// Layers are counted, and owners found, on geometry.
static int wants_geometry(const renderer *g)
{
    return g->frame.request.mode == RENDER_OVERDRAW || g->frame.request.mode == RENDER_IDS;
}

result shown_reserve(renderer *g, uint32_t slots)
{
    frame_state *f = &g->frame;
    if (slots <= f->shown_capacity) return RESULT_OK;
    shown_picture *shown = memory_alloc(g->memory, slots, sizeof *shown);
    if (!shown) return RESULT_NO_MEMORY;
    shown_release(g);
    f->shown = shown;
    f->shown_capacity = slots;
    return RESULT_OK;
}

void shown_release(renderer *g)
{
    frame_state *f = &g->frame;
    memory_free(g->memory, f->shown, f->shown_capacity, sizeof *f->shown);
    f->shown = NULL;
    f->shown_count = f->shown_capacity = 0;
}

void shown_draw(renderer *g)
{
    frame_state *f = &g->frame;
    if (f->shown_count == 0) return;
    frame_flush(g);
    frame_bind(g);
    outlines_trace(g);
    for (uint32_t i = 0; i < f->shown_count; ++i) {
        const shown_picture *p = &f->shown[i];
        memcpy(p->slot->shown, p->place, sizeof p->place);
        cut_begin(g, &p->cut);
        picture_draw(g, p->slot, &f->view);
        cut_end(g, &p->cut);
    }
    f->shown_count = 0;
    gl_check(g, NULL, "showing pictures");
}

// Of a frame that shows more than there are slots, some twice, what waits is drawn early.
static void put_shown(renderer *g, uint32_t zone, picture_slot *s)
{
    frame_state *f = &g->frame;
    if (f->shown_count == f->shown_capacity) shown_draw(g);
    shown_picture *p = &f->shown[f->shown_count++];
    *p = (shown_picture){.slot = s, .cut = frame_cut(g, zone)};
    memcpy(p->place, s->shown, sizeof p->place);
    s->waits_in = s->used = f->number;
}

void renderer_show(renderer *g, render_layout *l, uint32_t zone, const cull_picture *picture)
{
    assert(zone < l->zone_count);
    if (!g->frame.open) return;
    picture_slot *s = slot_find(l, zone, picture->slot);
    g->frame.may_repeat = 1;
    if (!s || !slot_holds(g, s) || wants_geometry(g)) {
        renderer_draw(g, l, zone, picture->runs, picture->run_count);
        return;
    }
    place(g, zone, picture, s);
    put_shown(g, zone, s);
    l->pictures.shown++;
    l->pictures.pixels_shown += area_px(g, s);
    translucent_note(g, &(layout_runs){l, zone, picture->runs, picture->run_count}); // what is translucent is in no picture
}
