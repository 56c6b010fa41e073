// Outlines of pictures: which rows of each strip of columns are covered, found on the GPU and read there by the vertices that show them.
// SPDX-License-Identifier: MIT
// Invariant: a slot without an outline is shown whole. Nothing is read back, and nothing is waited for but what the driver makes wait.
#include "gl.h"

enum { STRIP_TEXELS = 64 }; // at least: along the edges of narrower ones more pixels are shaded twice than are spared (measured: 16, 32, 128)

// ---- Places among the outlines ----

static int make_outlines(renderer *g)
{
    GLuint *const buffer = &g->pictures.outlines;
    if (*buffer) return 1;
    glCreateBuffers(1, buffer);
    glNamedBufferStorage(*buffer, (GLsizeiptr)OUTLINES_MOST * OUTLINE_STRIPS * 2 * (GLsizeiptr)sizeof(GLfloat), NULL, 0);
    return gl_check(g, NULL, "making outlines") == RESULT_OK;
}

static int find_place(picture_shared *p, picture_slot *s)
{
    if (s->outline) return 1;
    for (uint32_t i = 0; p->outline_count < OUTLINES_MOST && i < OUTLINES_MOST; ++i) {
        const uint32_t at = (p->outline_next + i) % OUTLINES_MOST;
        if (p->outline_is_taken[at]) continue;
        p->outline_is_taken[at] = 1;
        p->outline_next = at + 1;
        p->outline_count++;
        s->outline = at + 1;
        return 1;
    }
    return 0;
}

static void unlink_slot(picture_shared *p, picture_slot *s)
{
    for (picture_slot **at = &p->untraced; *at; at = &(*at)->next_untraced)
        if (*at == s) {
            *at = s->next_untraced;
            break;
        }
    s->next_untraced = NULL;
}

void outline_drop(renderer *g, picture_slot *s)
{
    picture_shared *p = &g->pictures;
    unlink_slot(p, s);
    if (s->outline) {
        p->outline_is_taken[s->outline - 1] = 0;
        p->outline_count--;
    }
    s->outline = s->strips = 0;
}

void outlines_close(renderer *g)
{
    glDeleteBuffers(1, &g->pictures.outlines);
}

// ---- Tracing ----

void outline_want(renderer *g, picture_slot *s)
{
    picture_shared *p = &g->pictures;
    unlink_slot(p, s);
    s->strips = 0;
    if (!make_outlines(g) || !find_place(p, s)) return;
    s->next_untraced = p->untraced;
    p->untraced = s;
}

static GLint first_strip(const picture_slot *s)
{
    return (GLint)((s->outline - 1) * OUTLINE_STRIPS);
}

static void trace(picture_slot *s, GLuint program)
{
    uint32_t texels = (s->width_px + OUTLINE_STRIPS - 1) / OUTLINE_STRIPS;
    if (texels < STRIP_TEXELS) texels = STRIP_TEXELS;
    s->strips = (s->width_px + texels - 1) / texels;
    s->strip_texels = texels;
    glProgramUniform2i(program, 0, first_strip(s), (GLint)texels);
    glBindTextureUnit(0, s->colour);
    glDrawArrays(GL_POINTS, 0, (GLsizei)s->strips);
}

void outlines_trace(renderer *g)
{
    picture_shared *p = &g->pictures;
    if (!p->untraced) return;
    const GLuint program = program_find(g, PROGRAM_OUTLINE, 0);
    if (program) {
        if (!p->vertices) glCreateVertexArrays(1, &p->vertices);
        state_program(g, program);
        state_vertices(g, p->vertices);
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BIND_OUTLINES, p->outlines);
    }
    while (p->untraced) {
        picture_slot *s = p->untraced;
        p->untraced = s->next_untraced;
        s->next_untraced = NULL;
        if (!program) continue;
        trace(s, program);
        g->frame.draw_calls++;
    }
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

uint32_t outline_set(const picture_slot *s, GLuint program)
{
    if (!s->strips) {
        glProgramUniform2i(program, 10, 0, 0);
        return 0;
    }
    glProgramUniform2i(program, 10, first_strip(s), (GLint)s->strips);
    glProgramUniform2f(program, 11, (GLfloat)s->strip_texels / (GLfloat)s->width_px, 1 / (GLfloat)s->height_px);
    return s->strips;
}
