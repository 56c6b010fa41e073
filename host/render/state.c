// GL state, set only where it changes, each change counted.
// SPDX-License-Identifier: MIT
#include "gl.h"

void state_forget(renderer *g)
{
    g->state = (gl_state){0};
}

void renderer_forget_state(renderer *g)
{
    state_forget(g);
}

void state_program(renderer *g, GLuint program)
{
    if (g->state.program == program && program) return;
    glUseProgram(program);
    g->state.program = program;
    g->frame.state_changes++;
}

void state_vertices(renderer *g, GLuint vertex_array)
{
    if (g->state.vertices == vertex_array && vertex_array) return;
    glBindVertexArray(vertex_array);
    g->state.vertices = vertex_array;
    g->frame.state_changes++;
}

void state_framebuffer(renderer *g, GLuint framebuffer, uint32_t width_px, uint32_t height_px)
{
    gl_state *s = &g->state;
    if (s->framebuffer == framebuffer && framebuffer && s->width_px == width_px && s->height_px == height_px) return;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, (GLsizei)width_px, (GLsizei)height_px);
    s->framebuffer = framebuffer;
    s->width_px = width_px;
    s->height_px = height_px;
    g->frame.state_changes++;
}

// Corners are rounded to 1/256 pixel, which tilts a surface: its depth is off by up to 1/256 of its slope a pixel. Four
// times that, so that it also holds the slope's own error and the rounding of planes evaluated 5,120 pixels away.
static const float OFFSET_SLOPE = 1.0f / 64;
static const float OFFSET_STEPS = 16; // of the float depth

static void set_offset(depth_offset how)
{
    const float sign = how == OFFSET_NEARER ? 1.0f : -1.0f; // nearer is larger
    glPolygonOffset(sign * OFFSET_SLOPE, sign * OFFSET_STEPS);
}

static void set_enabled(GLenum what, int on)
{
    if (on) glEnable(what);
    else glDisable(what);
}

static void set_blend(blend how)
{
    set_enabled(GL_BLEND, how != BLEND_NONE);
    if (how == BLEND_MIX) glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    if (how == BLEND_ADD) glBlendFunc(GL_ONE, GL_ONE);
}

// What geometry has is its near distance by its own, and at least an ulp of that where rounding took most of it: over
// 2^-60 m * 2^-31 / m * 2^-24 = 2^-115 for any camera of a near distance over 2^-60 m. Below that one number is enough for all
// pictures of a frame: the test is GREATER, so of two at one depth the first stays in front. Above 2^-126 they are normal floats.
static void set_range(depth_range range)
{
    static const double at[2] = {0, PICTURE_DEPTH};
    glDepthRange(at[range], range == RANGE_OWN ? 1 : at[range]);
}

void state_pass(renderer *g, const pass_state *p)
{
    state_pass_at(g, p, RANGE_OWN);
}

void state_pass_at(renderer *g, const pass_state *p, depth_range range)
{
    gl_state *s = &g->state;
    const uint32_t all = !s->known;
    uint32_t changes = 0;
    if (all || s->depth_test != p->depth_test) {
        set_enabled(GL_DEPTH_TEST, p->depth_test != GL_ALWAYS);
        if (p->depth_test != GL_ALWAYS) glDepthFunc(p->depth_test);
        changes++;
    }
    if (all || s->depth != p->depth) {
        glDepthMask(p->depth == DEPTH_ON);
        changes++;
    }
    if (all || s->colour != p->colour) {
        const GLboolean on = p->colour == COLOUR_ON;
        glColorMask(on, on, on, on);
        changes++;
    }
    if (all || s->blend != p->blend) {
        set_blend(p->blend);
        changes++;
    }
    if (all || s->back != p->back) {
        set_enabled(GL_CULL_FACE, p->back == BACK_CULLED);
        changes++;
    }
    if (all || s->offset != p->offset) {
        set_enabled(GL_POLYGON_OFFSET_FILL, p->offset != OFFSET_NONE);
        set_offset(p->offset);
        changes++;
    }
    if (all || s->range != range) {
        set_range(range);
        changes++;
    }
    s->range = range;
    s->depth_test = p->depth_test;
    s->depth = p->depth;
    s->colour = p->colour;
    s->blend = p->blend;
    s->back = p->back;
    s->offset = p->offset;
    s->known = 1;
    g->frame.state_changes += changes;
}
