// Frames for people: target, passes, reading back. What is drawn comes through draw.c.
// SPDX-License-Identifier: MIT
// Invariant: nothing here allocates; the room was taken with the layouts.
#include "gl.h"

#include <assert.h>

static const float BACKGROUND[4] = {0.66f, 0.75f, 0.84f, 1}; // a hazy sky
static const float TRANSLUCENT_ALPHA = 0.5f;

void frame_state_pass(renderer *g, blend blend, depth_writes depth)
{
    const frame_request *q = &g->frame.request;
    const int culled = q->faces == FACES_FRONT && !g->scene.has_two_sided;
    const int added = q->mode == RENDER_OVERDRAW;
    if (q->mode == RENDER_IDS) { // as in id_picture.c, where back faces are dropped by fragments
        state_pass(g, &(pass_state){GL_GREATER, DEPTH_ON, COLOUR_ON, BLEND_NONE, BACK_DRAWN, OFFSET_NONE});
        return;
    }
    state_pass(g, &(pass_state){added ? GL_ALWAYS : GL_GREATER, added ? DEPTH_OFF : depth, COLOUR_ON, added ? BLEND_ADD : blend,
                                culled && depth == DEPTH_ON ? BACK_CULLED : BACK_DRAWN, OFFSET_FARTHER});
}

static uint32_t variant_of(const renderer *g, const draw_pass *p)
{
    const frame_request *q = &g->frame.request;
    const int by_fragment = q->faces == FACES_FRONT && (g->scene.has_two_sided || q->mode == RENDER_IDS);
    return g->scene.variant | (by_fragment ? VARIANT_SIDES : 0) | (p->planes ? VARIANT_CLIP : 0);
}

GLuint frame_pass(renderer *g, const draw_pass *p, uint32_t wanted)
{
    const render_mode mode = g->frame.request.mode;
    const program_kind kind = mode == RENDER_IDS ? PROGRAM_ID : PROGRAM_SHADED + (program_kind)mode;
    const GLuint program = program_find(g, kind, variant_of(g, p));
    if (!program) return 0;
    state_program(g, program);
    viewpoint_set(p->view, program, wanted);
    poses_use(g, p->view->eye);
    if (mode != RENDER_IDS) glProgramUniform1f(program, AT_ALPHA, wanted ? TRANSLUCENT_ALPHA : 1);
    if (mode == RENDER_DEPTH) {
        const double near_m = g->frame.view.near_m, far_m = 2 * scene_radius_m(g->scene.scene) + near_m * 2;
        glProgramUniform2f(program, AT_DEPTH_RANGE, (float)near_m, (float)far_m);
    }
    if (p->planes) glProgramUniform4fv(program, AT_CLIP_PLANES, 4, p->planes[0]);
    return program;
}

void frame_bind(renderer *g)
{
    const target *t = g->frame.request.mode == RENDER_OVERDRAW ? g->frame.layers : g->frame.target;
    state_framebuffer(g, t->framebuffer, t->width_px, t->height_px);
}

static void bind_blocks(renderer *g)
{
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BIND_MATERIALS, g->scene.materials);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BIND_ITEMS, g->scene.triangle_items);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BIND_ZONES, g->scene.item_zones);
}

static void clear(renderer *g)
{
    const GLfloat far = 0, none[4] = {0};
    state_pass(g, &(pass_state){GL_GREATER, DEPTH_ON, COLOUR_ON, BLEND_NONE, BACK_DRAWN, OFFSET_NONE});
    const GLuint nobody[4] = {0};
    if (g->frame.request.mode == RENDER_IDS) glClearBufferuiv(GL_COLOR, 0, nobody);
    else glClearBufferfv(GL_COLOR, 0, g->frame.request.mode == RENDER_SHADED ? BACKGROUND : none);
    glClearBufferfv(GL_DEPTH, 0, &far);
}

result renderer_begin(renderer *g, const frame_request *q, report *r)
{
    if (!g->scene.scene) return report_error(r, NULL, 0, "a frame without a scene; upload one first");
    frame_state *f = &g->frame;
    frame_flush(g); // of a frame that nobody ended
    const viewpoint_request from = {.camera = q->camera, .width_px = q->width_px, .height_px = q->height_px};
    const result seen = viewpoint_make(g, &from, r, &f->view);
    if (seen != RESULT_OK) return seen;
    f->layers = NULL;
    f->target = target_find(g, q->mode == RENDER_IDS ? TARGET_ID : TARGET_COLOUR, q->width_px, q->height_px, r);
    if (f->target && q->mode == RENDER_OVERDRAW) f->layers = target_find(g, TARGET_LAYERS, q->width_px, q->height_px, r);
    if (!f->target || (q->mode == RENDER_OVERDRAW && !f->layers)) return RESULT_NO_GL;
    f->request = *q;
    f->request.camera = NULL; // the caller's, and maybe gone before the frame is
    f->draw_calls = f->state_changes = f->translucent_count = f->shown_count = f->may_repeat = 0;
    f->open = 1;
    f->number++;
    bind_blocks(g);
    frame_bind(g);
    clear(g);
    return gl_check(g, r, "beginning a frame");
}

// Layers counted to colours.
static void draw_heat(renderer *g)
{
    const GLuint program = program_find(g, PROGRAM_HEAT, 0);
    if (!program) return;
    const target *t = g->frame.target;
    state_framebuffer(g, t->framebuffer, t->width_px, t->height_px);
    state_program(g, program);
    state_vertices(g, g->scene.vertices); // a core context draws nothing without one
    state_pass(g, &(pass_state){GL_ALWAYS, DEPTH_OFF, COLOUR_ON, BLEND_NONE, BACK_DRAWN, OFFSET_NONE});
    glBindTextureUnit(0, g->frame.layers->colour);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    g->frame.draw_calls++;
}

void renderer_end(renderer *g)
{
    assert(g->frame.open);
    frame_flush(g);
    shown_draw(g);
    translucent_draw(g);
    if (g->frame.request.mode == RENDER_OVERDRAW) draw_heat(g);
    if (g->frame.request.mode == RENDER_IDS) g->id_target = g->frame.target;
    g->frame.open = 0;
    glFinish();
    gl_check(g, NULL, "ending a frame");
}

uint32_t renderer_draw_calls(const renderer *g)
{
    return g->frame.draw_calls;
}

uint32_t renderer_state_changes(const renderer *g)
{
    return g->frame.state_changes;
}

static void flip_rows(uint8_t *rgba, uint32_t width_px, uint32_t height_px)
{
    const size_t row = (size_t)width_px * 4;
    for (uint32_t y = 0; y < height_px / 2; ++y) {
        uint8_t *a = rgba + y * row, *b = rgba + (height_px - 1 - y) * row;
        for (size_t i = 0; i < row; ++i) {
            const uint8_t kept = a[i];
            a[i] = b[i];
            b[i] = kept;
        }
    }
}

result renderer_read(renderer *g, uint8_t *rgba, report *r)
{
    const target *t = g->frame.target;
    if (!t || g->frame.open) return report_error(r, NULL, 0, "a picture read before renderer_end; end the frame first");
    if (t->kind != TARGET_COLOUR) return report_error(r, NULL, 0, "colours read from a picture of ids; use renderer_read_ids");
    state_framebuffer(g, t->framebuffer, t->width_px, t->height_px);
    glReadPixels(0, 0, (GLsizei)t->width_px, (GLsizei)t->height_px, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    flip_rows(rgba, t->width_px, t->height_px);
    for (size_t i = 0; i < (size_t)t->width_px * t->height_px; ++i) rgba[4 * i + 3] = 255;
    return gl_check(g, r, "reading a picture");
}
