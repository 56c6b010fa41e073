// Pictures of items: taken from the frame's eye through a parallelogram, shown as that parallelogram.
// SPDX-License-Identifier: MIT
// Invariant: a capture that can't be taken leaves its slot empty, and showing an empty slot draws the items themselves.
#include "gl.h"

#include <math.h>

static picture_slot *slot_find(renderer *g, uint32_t slot)
{
    if (slot >= SLOT_PAGE * SLOT_PAGES) return NULL;
    picture_slot *page = g->pictures.pages[slot / SLOT_PAGE];
    return page ? &page[slot % SLOT_PAGE] : NULL;
}

static picture_slot *slot_make(renderer *g, uint32_t slot)
{
    if (slot >= SLOT_PAGE * SLOT_PAGES) return NULL;
    picture_slot **page = &g->pictures.pages[slot / SLOT_PAGE];
    if (!*page) *page = memory_alloc_zeroed(g->memory, SLOT_PAGE, sizeof **page);
    return *page ? &(*page)[slot % SLOT_PAGE] : NULL;
}

result pictures_reserve(renderer *g, uint32_t slots)
{
    for (uint32_t slot = 0; slot < slots && slot < SLOT_PAGE * SLOT_PAGES; slot += SLOT_PAGE)
        if (!slot_make(g, slot)) return RESULT_NO_MEMORY;
    return RESULT_OK;
}

static void slot_empty(renderer *g, picture_slot *s)
{
    if (g->state.framebuffer == s->framebuffer) g->state.framebuffer = 0;
    glDeleteFramebuffers(1, &s->framebuffer);
    glDeleteTextures(1, &s->colour);
    glDeleteTextures(1, &s->depth);
    *s = (picture_slot){0};
}

static GLuint texture(GLenum format, GLenum filter, uint32_t width_px, uint32_t height_px)
{
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    glTextureStorage2D(name, 1, format, (GLsizei)width_px, (GLsizei)height_px);
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, (GLint)filter);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, (GLint)filter);
    glTextureParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return name;
}

// Depth for a capture that keeps none: one texture, as large as was ever needed.
static GLuint spare_depth(renderer *g, uint32_t width_px, uint32_t height_px)
{
    slot_store *p = &g->pictures;
    if (p->spare_depth && p->spare_width_px >= width_px && p->spare_height_px >= height_px) return p->spare_depth;
    glDeleteTextures(1, &p->spare_depth);
    if (width_px > p->spare_width_px) p->spare_width_px = width_px;
    if (height_px > p->spare_height_px) p->spare_height_px = height_px;
    p->spare_depth = texture(GL_DEPTH_COMPONENT32F, GL_NEAREST, p->spare_width_px, p->spare_height_px);
    return p->spare_depth;
}

static int slot_prepare(renderer *g, picture_slot *s, const cull_capture *c)
{
    if (c->width_px == 0 || c->height_px == 0 || c->width_px > g->size_most_px || c->height_px > g->size_most_px) return 0;
    if (s->width_px != c->width_px || s->height_px != c->height_px || s->keep_depth != c->keep_depth) {
        slot_empty(g, s);
        s->width_px = c->width_px;
        s->height_px = c->height_px;
        s->keep_depth = c->keep_depth;
        s->colour = texture(GL_RGBA8, GL_LINEAR, c->width_px, c->height_px);
        if (c->keep_depth) s->depth = texture(GL_DEPTH_COMPONENT32F, GL_NEAREST, c->width_px, c->height_px);
        glCreateFramebuffers(1, &s->framebuffer);
        glNamedFramebufferTexture(s->framebuffer, GL_COLOR_ATTACHMENT0, s->colour, 0);
    }
    glNamedFramebufferTexture(s->framebuffer, GL_DEPTH_ATTACHMENT, c->keep_depth ? s->depth : spare_depth(g, c->width_px, c->height_px), 0);
    return gl_check(g, NULL, "preparing a picture") == RESULT_OK;
}

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

static void set3(double out[3], cull_vec3 v)
{
    out[0] = (double)v.x;
    out[1] = (double)v.y;
    out[2] = (double)v.z;
}

static void set_taken_uniforms(const picture_slot *s, const viewpoint *v, GLuint program)
{
    const double *const vectors[] = {s->corner, s->right, s->up, s->eye};
    for (int i = 0; i < 4; ++i) {
        GLfloat out[3];
        for (int k = 0; k < 3; ++k) {
            const double from = i == 0 ? s->eye[k] : i == 3 ? v->eye[k] : 0;
            out[k] = (GLfloat)(vectors[i][k] - from);
        }
        glProgramUniform3fv(program, 4 + i, 1, out);
    }
    glProgramUniform1f(program, 8, (GLfloat)s->near_fraction);
}

static void show_slot(renderer *g, const picture_slot *s, const viewpoint *v)
{
    const GLuint program = program_find(g, PROGRAM_PICTURE, s->keep_depth ? VARIANT_KEEP_DEPTH : 0);
    if (!program) return;
    if (!g->pictures.vertices) glCreateVertexArrays(1, &g->pictures.vertices);
    GLfloat corner[3], right[3], up[3];
    for (int k = 0; k < 3; ++k) {
        corner[k] = (GLfloat)(s->corner[k] - v->eye[k]);
        right[k] = (GLfloat)s->right[k];
        up[k] = (GLfloat)s->up[k];
    }
    state_program(g, program);
    state_vertices(g, g->pictures.vertices);
    state_pass(g, &(pass_state){GL_GREATER, DEPTH_ON, COLOUR_ON, BLEND_NONE, BACK_DRAWN, OFFSET_NONE});
    glProgramUniformMatrix4fv(program, AT_CLIP_FROM_EYE, 1, GL_FALSE, v->clip);
    glProgramUniform3fv(program, 1, 1, corner);
    glProgramUniform3fv(program, 2, 1, right);
    glProgramUniform3fv(program, 3, 1, up);
    if (s->keep_depth) set_taken_uniforms(s, v, program);
    glBindTextureUnit(0, s->colour);
    if (s->keep_depth) glBindTextureUnit(1, s->depth);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    g->frame.draw_calls++;
}

static void draw_capture(renderer *g, picture_slot *s, const viewpoint *v, const render_layout *l, const cull_capture *c)
{
    const GLfloat far = 0, none[4] = {0};
    const uint32_t planes = c->clip_plane_count < 4 ? c->clip_plane_count : 4;
    const draw_pass pass = {.view = v, .variant = planes ? VARIANT_CLIP : 0, .planes = c->clip_planes, .plane_count = planes};
    state_framebuffer(g, s->framebuffer, s->width_px, s->height_px);
    frame_state_pass(g, BLEND_NONE, DEPTH_ON);
    glClearBufferfv(GL_COLOR, 0, none);
    glClearBufferfv(GL_DEPTH, 0, &far);
    for (GLenum i = 0; planes && i < 4; ++i) glEnable(GL_CLIP_DISTANCE0 + i);
    if (c->run_count) frame_draw_runs(g, &pass, l, c->runs, c->run_count);
    for (GLenum i = 0; planes && i < 4; ++i) glDisable(GL_CLIP_DISTANCE0 + i);
    for (uint32_t i = 0; i < c->slot_count; ++i) {
        const picture_slot *part = slot_find(g, c->slots[i]);
        if (part && part != s && part->filled) show_slot(g, part, v);
    }
}

void renderer_capture(renderer *g, const render_layout *l, const cull_capture *capture)
{
    if (!g->frame.open || g->frame.request.mode == RENDER_OVERDRAW) return; // layers are counted on geometry
    picture_slot *s = slot_make(g, capture->slot);
    if (!s) return;
    s->filled = 0;
    s->layout = g->frame.last_layout = l;
    viewpoint v = g->frame.view;
    if (!slot_prepare(g, s, capture)) return;
    s->layout = l; // preparing may have emptied it
    set3(s->corner, capture->corner);
    set3(s->right, capture->right);
    set3(s->up, capture->up);
    for (int k = 0; k < 3; ++k) s->eye[k] = v.eye[k];
    if (!parallelogram_view(s, &v)) return;
    draw_capture(g, s, &v, l, capture);
    s->filled = 1;
    frame_bind(g);
    gl_check(g, NULL, "taking a picture");
}

void renderer_show(renderer *g, const cull_picture *picture)
{
    if (!g->frame.open) return;
    const picture_slot *s = slot_find(g, picture->slot);
    const render_layout *l = s && s->layout ? s->layout : g->frame.last_layout;
    if (!s || !s->filled || g->frame.request.mode == RENDER_OVERDRAW) {
        if (l) renderer_draw(g, l, picture->runs, picture->run_count);
        return;
    }
    show_slot(g, s, &g->frame.view);
    translucent_note(g, l, picture->runs, picture->run_count); // what is translucent is in no picture
    gl_check(g, NULL, "showing a picture");
}

void renderer_forget_pictures(renderer *g)
{
    for (uint32_t page = 0; page < SLOT_PAGES; ++page)
        for (uint32_t i = 0; g->pictures.pages[page] && i < SLOT_PAGE; ++i) slot_empty(g, &g->pictures.pages[page][i]);
}

void pictures_forget_layout(renderer *g, const render_layout *l)
{
    for (uint32_t page = 0; page < SLOT_PAGES; ++page)
        for (uint32_t i = 0; g->pictures.pages[page] && i < SLOT_PAGE; ++i)
            if (g->pictures.pages[page][i].layout == l) slot_empty(g, &g->pictures.pages[page][i]);
}

void pictures_close(renderer *g)
{
    renderer_forget_pictures(g);
    for (uint32_t page = 0; page < SLOT_PAGES; ++page) memory_free(g->memory, g->pictures.pages[page], SLOT_PAGE, sizeof **g->pictures.pages);
    glDeleteVertexArrays(1, &g->pictures.vertices);
    glDeleteTextures(1, &g->pictures.spare_depth);
    g->pictures = (slot_store){0};
}
