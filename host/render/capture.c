// Pictures of items: taken from the frame's eye through a parallelogram, shown as that parallelogram.
// SPDX-License-Identifier: MIT
// Invariant: a capture that can't be taken leaves its slot empty, and showing an empty slot draws the items themselves.
#include "gl.h"

#include <assert.h>
#include <math.h>

static picture_slot *slot_find(const render_layout *l, uint32_t zone, uint32_t slot)
{
    if (zone >= l->zone_count || slot >= l->zones[zone].slot_count) return NULL;
    return &l->slots[l->zones[zone].first_slot + slot];
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
    picture_shared *p = &g->pictures;
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

static void set3(double out[3], cull_vec3 v, const double offset[3])
{
    const float from[3] = {v.x, v.y, v.z};
    for (int k = 0; k < 3; ++k) out[k] = (double)from[k] + offset[k];
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

// The capture's planes, relative to the eye; the rest holds everything.
static void clip_planes(const cull_capture *c, const double eye_in_zone[3], GLfloat out[4][4])
{
    for (uint32_t i = 0; i < 4; ++i) {
        const cull_plane none = {{0, 0, 0}, 1}, p = i < c->clip_plane_count ? c->clip_planes[i] : none;
        const float normal[3] = {p.normal.x, p.normal.y, p.normal.z};
        double offset = (double)p.offset;
        for (int k = 0; k < 3; ++k) {
            offset += (double)normal[k] * eye_in_zone[k];
            out[i][k] = normal[k];
        }
        out[i][3] = (float)offset;
    }
}

typedef struct capture_job {
    const render_layout *layout;
    const cull_capture *capture;
    const viewpoint *view;
    uint32_t zone;
} capture_job;

static void draw_geometry(renderer *g, const capture_job *j, const double offset[3])
{
    const cull_capture *c = j->capture;
    double eye[3];
    GLfloat planes[4][4];
    if (c->run_count == 0) return;
    for (int k = 0; k < 3; ++k) eye[k] = j->view->eye[k] - offset[k];
    clip_planes(c, eye, planes);
    const draw_pass pass = {.view = j->view, .planes = c->clip_plane_count ? (const GLfloat(*)[4])planes : NULL};
    for (GLenum i = 0; pass.planes && i < 4; ++i) glEnable(GL_CLIP_DISTANCE0 + i);
    frame_draw_runs(g, &pass, &(layout_runs){j->layout, j->zone, c->runs, c->run_count});
    for (GLenum i = 0; pass.planes && i < 4; ++i) glDisable(GL_CLIP_DISTANCE0 + i);
}

static void draw_capture(renderer *g, const capture_job *j, const picture_slot *s, const double offset[3])
{
    const GLfloat far = 0, none[4] = {0};
    state_framebuffer(g, s->framebuffer, s->width_px, s->height_px);
    frame_state_pass(g, BLEND_NONE, DEPTH_ON);
    glClearBufferfv(GL_COLOR, 0, none);
    glClearBufferfv(GL_DEPTH, 0, &far);
    draw_geometry(g, j, offset);
    for (uint32_t i = 0; i < j->capture->slot_count; ++i) {
        const picture_slot *part = slot_find(j->layout, j->zone, j->capture->slots[i]);
        if (part && part != s && part->filled) show_slot(g, part, j->view);
    }
}

// Layers are counted, and owners found, on geometry.
static int wants_geometry(const renderer *g)
{
    return g->frame.request.mode == RENDER_OVERDRAW || g->frame.request.mode == RENDER_IDS;
}

void renderer_capture(renderer *g, const render_layout *l, uint32_t zone, const cull_capture *capture)
{
    if (!g->frame.open || wants_geometry(g)) return;
    picture_slot *s = slot_find(l, zone, capture->slot);
    if (!s) return;
    frame_flush(g);
    s->filled = 0;
    viewpoint v = g->frame.view;
    double offset[3];
    const double nowhere[3] = {0, 0, 0};
    if (!slot_prepare(g, s, capture)) return;
    layout_zone_offset(g, zone, offset);
    set3(s->corner, capture->corner, offset);
    set3(s->right, capture->right, nowhere);
    set3(s->up, capture->up, nowhere);
    for (int k = 0; k < 3; ++k) s->eye[k] = v.eye[k];
    if (!parallelogram_view(s, &v)) return;
    draw_capture(g, &(capture_job){l, capture, &v, zone}, s, offset);
    s->filled = 1;
    frame_bind(g);
    gl_check(g, NULL, "taking a picture");
}

void renderer_show(renderer *g, const render_layout *l, uint32_t zone, const cull_picture *picture)
{
    assert(zone < l->zone_count);
    if (!g->frame.open) return;
    const picture_slot *s = slot_find(l, zone, picture->slot);
    if (!s || !s->filled || wants_geometry(g)) {
        renderer_draw(g, l, zone, picture->runs, picture->run_count);
        return;
    }
    const pixel_box cut = frame_cut(g, zone);
    frame_flush(g);
    frame_bind(g);
    cut_begin(g, &cut);
    show_slot(g, s, &g->frame.view);
    cut_end(g, &cut);
    translucent_note(g, &(layout_runs){l, zone, picture->runs, picture->run_count}); // what is translucent is in no picture
    gl_check(g, NULL, "showing a picture");
}

// ---- Room ----

void pictures_forget_zone(renderer *g, render_layout *l, uint32_t zone)
{
    const layout_zone *z = &l->zones[zone];
    for (uint32_t i = 0; i < z->slot_count; ++i) slot_empty(g, &l->slots[z->first_slot + i]);
}

void renderer_forget_pictures(renderer *g)
{
    for (render_layout *l = g->layouts; l; l = l->next)
        for (uint32_t i = 0; i < l->slot_count; ++i) slot_empty(g, &l->slots[i]);
}

void pictures_close_layout(renderer *g, render_layout *l)
{
    for (uint32_t i = 0; i < l->slot_count; ++i) slot_empty(g, &l->slots[i]);
    memory_free(g->memory, l->slots, l->slot_count, sizeof *l->slots);
    l->slots = NULL;
    l->slot_count = 0;
}

result render_layout_slots(render_layout *l, const uint32_t *slot_counts, report *r)
{
    renderer *g = l->g;
    uint64_t total = 0;
    for (uint32_t zone = 0; zone < l->zone_count; ++zone) total += slot_counts[zone];
    if (total > SLOTS_MOST) return report_error(r, NULL, 0, "cullers ask for %llu pictures; %u is the most", (unsigned long long)total, (unsigned)SLOTS_MOST);
    picture_slot *slots = total ? memory_alloc_zeroed(g->memory, (size_t)total, sizeof *slots) : NULL;
    if (total && !slots) return report_no_memory(r, NULL);
    pictures_close_layout(g, l);
    l->slots = slots;
    l->slot_count = (uint32_t)total;
    for (uint32_t zone = 0, first = 0; zone < l->zone_count; ++zone) {
        l->zones[zone].first_slot = first;
        l->zones[zone].slot_count = slot_counts[zone];
        first += slot_counts[zone];
    }
    return RESULT_OK;
}

void pictures_close(renderer *g)
{
    glDeleteVertexArrays(1, &g->pictures.vertices);
    glDeleteTextures(1, &g->pictures.spare_depth);
    g->pictures = (picture_shared){0};
}
