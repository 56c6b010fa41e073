// The overlay: lines, triangles and letters over a finished picture, for people.
// SPDX-License-Identifier: MIT
// Invariant: positions become relative to the eye in double, so lines stand as still as the geometry 1e7 m from the origin.
#include "gl.h"

static const GLfloat IDENTITY[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

result overlay_open(renderer *g, report *r)
{
    overlay_pass *o = &g->overlay;
    o->staged = memory_alloc(g->memory, OVERLAY_CHUNK, sizeof *o->staged);
    if (!o->staged) return report_no_memory(r, NULL);
    glCreateBuffers(1, &o->points);
    glNamedBufferStorage(o->points, OVERLAY_CHUNK * sizeof *o->staged, NULL, GL_DYNAMIC_STORAGE_BIT);
    glCreateVertexArrays(1, &o->vertices);
    glVertexArrayVertexBuffer(o->vertices, 0, o->points, 0, sizeof *o->staged);
    glVertexArrayAttribFormat(o->vertices, 0, 3, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribFormat(o->vertices, 1, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(overlay_point, colour));
    for (GLuint i = 0; i < 2; ++i) {
        glVertexArrayAttribBinding(o->vertices, i, 0);
        glEnableVertexArrayAttrib(o->vertices, i);
    }
    return gl_check(g, r, "preparing the overlay");
}

void overlay_close(renderer *g)
{
    overlay_pass *o = &g->overlay;
    glDeleteVertexArrays(1, &o->vertices);
    glDeleteBuffers(1, &o->points);
    memory_free(g->memory, o->staged, OVERLAY_CHUNK, sizeof *o->staged);
    *o = (overlay_pass){0};
}

typedef struct overlay_style {
    GLenum shape; // GL_LINES, GL_TRIANGLES
    overlay_depth depth;
    const GLfloat *clip_from_point;
} overlay_style;

// 1: what is put from now on is drawn that way.
static int style_begin(renderer *g, const overlay_style *s)
{
    const target *t = g->frame.target;
    if (!t || g->frame.open) return 0;
    const GLuint program = program_find(g, PROGRAM_OVERLAY, 0);
    if (!program) return 0;
    const int tested = s->depth == OVERLAY_TESTED && g->frame.request.mode != RENDER_OVERDRAW; // layers leave no depth
    state_framebuffer(g, t->framebuffer, t->width_px, t->height_px);
    state_program(g, program);
    state_vertices(g, g->overlay.vertices);
    state_pass(g, &(pass_state){tested ? GL_GEQUAL : GL_ALWAYS, DEPTH_OFF, COLOUR_ON, BLEND_MIX, BACK_DRAWN, OFFSET_NONE});
    glProgramUniformMatrix4fv(program, 0, 1, GL_FALSE, s->clip_from_point);
    g->overlay.count = 0;
    return 1;
}

static void draw_staged(renderer *g, GLenum shape)
{
    overlay_pass *o = &g->overlay;
    if (o->count == 0) return;
    glNamedBufferSubData(o->points, 0, (GLsizeiptr)(o->count * sizeof *o->staged), o->staged);
    glDrawArrays(shape, 0, (GLsizei)o->count);
    g->frame.draw_calls++;
    o->count = 0;
}

static void draw_vertices(renderer *g, const overlay_style *s, const overlay_vertex *vertices, uint32_t count)
{
    overlay_pass *o = &g->overlay;
    if (count == 0 || !style_begin(g, s)) return;
    const double *origin = g->scene.scene ? g->scene.scene->whole.origin : (const double[3]){0, 0, 0};
    for (uint32_t i = 0; i < count; ++i) {
        overlay_point *p = &o->staged[o->count++];
        p->colour = vertices[i].colour;
        for (int k = 0; k < 3; ++k) p->position[k] = (float)((vertices[i].position[k] - origin[k]) - g->frame.view.eye[k]);
        if (o->count == OVERLAY_CHUNK) draw_staged(g, s->shape);
    }
    draw_staged(g, s->shape);
    gl_check(g, NULL, "drawing over the picture");
}

void renderer_overlay_lines(renderer *g, const overlay_vertex *vertices, uint32_t count, overlay_depth depth)
{
    draw_vertices(g, &(overlay_style){GL_LINES, depth, g->frame.view.clip}, vertices, count - count % 2);
}

void renderer_overlay_triangles(renderer *g, const overlay_vertex *vertices, uint32_t count, overlay_depth depth)
{
    draw_vertices(g, &(overlay_style){GL_TRIANGLES, depth, g->frame.view.clip}, vertices, count - count % 3);
}

// ---- Letters: a rectangle for each stretch of points that rows share ----

typedef struct letter_place { double left, top, scale; uint32_t colour; } letter_place; // pixels from the top left
typedef struct letter_part { uint32_t left, top, right, bottom; } letter_part;         // points of the cell

static void put_part(renderer *g, const letter_place *at, const letter_part *q)
{
    static const uint8_t CORNERS[6] = {0, 2, 3, 0, 3, 1}; // bit 0: right, bit 1: bottom
    overlay_pass *o = &g->overlay;
    const target *t = g->frame.target;
    const double x_px[2] = {at->left + q->left * at->scale, at->left + q->right * at->scale};
    const double y_px[2] = {at->top + q->top * at->scale, at->top + q->bottom * at->scale};
    for (int i = 0; i < 6; ++i) {
        const double x = 2 * x_px[CORNERS[i] & 1] / t->width_px - 1, y = 1 - 2 * y_px[CORNERS[i] >> 1] / t->height_px;
        o->staged[o->count++] = (overlay_point){{(float)x, (float)y, 0.5f}, at->colour};
    }
    if (o->count == OVERLAY_CHUNK) draw_staged(g, GL_TRIANGLES);
}

static void put_rows(renderer *g, const letter_place *at, uint32_t bits, uint32_t top, uint32_t bottom)
{
    for (uint32_t x = 0; x < FONT_WIDE; ++x) {
        if (!(bits >> x & 1)) continue;
        uint32_t end = x;
        while (bits >> end & 1) ++end; // bit FONT_WIDE is never set
        put_part(g, at, &(letter_part){x, top, end, bottom});
        x = end;
    }
}

static void put_letter(renderer *g, const letter_place *at, char letter)
{
    for (uint32_t row = 0; row < FONT_HIGH;) {
        const uint32_t bits = font_row(letter, row), top = row;
        while (row < FONT_HIGH && font_row(letter, row) == bits) ++row;
        put_rows(g, at, bits, top, row);
    }
}

void renderer_overlay_text(renderer *g, const overlay_text *t)
{
    const uint32_t scale = t->scale ? t->scale : 1;
    letter_place at = {t->x_px, t->y_px, scale, t->colour};
    if (!style_begin(g, &(overlay_style){GL_TRIANGLES, OVERLAY_ON_TOP, IDENTITY})) return;
    for (const char *letter = t->text; *letter; ++letter) {
        if (*letter == '\n') {
            at.left = t->x_px;
            at.top += FONT_HIGH * at.scale;
            continue;
        }
        put_letter(g, &at, *letter);
        at.left += FONT_WIDE * at.scale;
    }
    draw_staged(g, GL_TRIANGLES);
    gl_check(g, NULL, "writing over the picture");
}
