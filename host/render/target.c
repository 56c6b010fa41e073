// Targets: framebuffers by kind and size, made on demand; the least used goes when all places are taken.
// SPDX-License-Identifier: MIT
#include "gl.h"

static void release(renderer *g, target *t)
{
    if (g->id_target == t) g->id_target = NULL;
    if (g->frame.target == t) g->frame.target = NULL;
    if (g->frame.layers == t) g->frame.layers = NULL;
    if (g->state.framebuffer == t->framebuffer) g->state.framebuffer = 0;
    glDeleteFramebuffers(1, &t->framebuffer);
    glDeleteTextures(1, &t->colour);
    glDeleteTextures(1, &t->depth);
    *t = (target){0};
}

static GLenum format_of(target_kind kind)
{
    switch (kind) {
    case TARGET_ID: return GL_R32UI;
    case TARGET_LAYERS: return GL_R16F; // counts exactly up to 2,048 layers
    default: return GL_RGBA8;
    }
}

static GLuint texture(GLenum format, uint32_t width_px, uint32_t height_px)
{
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    glTextureStorage2D(name, 1, format, (GLsizei)width_px, (GLsizei)height_px);
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return name;
}

static result make(renderer *g, target *t, report *r)
{
    t->colour = texture(format_of(t->kind), t->width_px, t->height_px);
    t->depth = texture(GL_DEPTH_COMPONENT32F, t->width_px, t->height_px);
    glCreateFramebuffers(1, &t->framebuffer);
    glNamedFramebufferTexture(t->framebuffer, GL_COLOR_ATTACHMENT0, t->colour, 0);
    glNamedFramebufferTexture(t->framebuffer, GL_DEPTH_ATTACHMENT, t->depth, 0);
    if (gl_check(g, r, "making a picture to draw into") != RESULT_OK) return RESULT_NO_GL;
    if (glCheckNamedFramebufferStatus(t->framebuffer, GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return RESULT_OK;
    g->errors++;
    report_error(r, NULL, 0, "the driver can't draw into a picture of %ux%u; try another driver", t->width_px, t->height_px);
    return RESULT_NO_GL;
}

target *target_find(renderer *g, target_kind kind, uint32_t width_px, uint32_t height_px, report *r)
{
    target *oldest = &g->targets[0];
    for (int i = 0; i < TARGETS; ++i) {
        target *t = &g->targets[i];
        if (t->used && t->kind == kind && t->width_px == width_px && t->height_px == height_px) {
            t->used = ++g->clock;
            return t;
        }
        if (t->used < oldest->used) oldest = t;
    }
    if (width_px == 0 || height_px == 0 || width_px > g->size_most_px || height_px > g->size_most_px) {
        report_error(r, NULL, 0, "a picture of %ux%u pixels; this driver draws 1x1 to %ux%u", width_px, height_px, g->size_most_px, g->size_most_px);
        return NULL;
    }
    release(g, oldest);
    *oldest = (target){.width_px = width_px, .height_px = height_px, .kind = kind, .used = ++g->clock};
    if (make(g, oldest, r) == RESULT_OK) return oldest;
    release(g, oldest);
    return NULL;
}

void targets_close(renderer *g)
{
    for (int i = 0; i < TARGETS; ++i) release(g, &g->targets[i]);
}
