// Slots of pictures: their textures, and the memory that those of a layout take together.
// SPDX-License-Identifier: MIT
// Invariant: a layout's pictures never take more than its limit; what this frame took or showed is never given up for another.
#include "gl.h"

#include <assert.h>

picture_slot *slot_find(const render_layout *l, uint32_t zone, uint32_t slot)
{
    if (zone >= l->zone_count || slot >= l->zones[zone].slot_count) return NULL;
    return &l->slots[l->zones[zone].first_slot + slot];
}

int slot_holds(const renderer *g, const picture_slot *s)
{
    return s->filled && s->mode == g->frame.request.mode && s->faces == g->frame.request.faces;
}

void slot_empty(renderer *g, picture_slot *s)
{
    if (g->state.framebuffer == s->framebuffer) g->state.framebuffer = 0;
    glDeleteFramebuffers(1, &s->framebuffer);
    glDeleteTextures(1, &s->colour);
    glDeleteTextures(1, &s->depth);
    outline_drop(g, s);
    *s = (picture_slot){0};
}

// ---- Memory ----

static uint64_t bytes_most(const renderer *g)
{
    return g->pictures.options.bytes_most;
}

static uint32_t texel_bytes(const renderer *g, uint32_t keep_depth)
{
    return (g->pictures.options.format == PICTURE_8_BITS ? 4u : 2u) + (keep_depth ? 4u : 0u);
}

static void give_back(renderer *g, render_layout *l, picture_slot *s)
{
    l->pictures.bytes -= s->bytes;
    slot_empty(g, s);
}

// Of those that this frame has not used, the one that was used longest ago.
static picture_slot *slot_to_spare(const renderer *g, const render_layout *l)
{
    picture_slot *oldest = NULL;
    for (uint32_t i = 0; i < l->slot_count; ++i) {
        picture_slot *s = &l->slots[i];
        if (!s->bytes || s->used == g->frame.number) continue;
        const uint32_t age = g->frame.number - s->used; // numbers may wrap
        if (!oldest || age > g->frame.number - oldest->used) oldest = s;
    }
    return oldest;
}

static int take_bytes(renderer *g, render_layout *l, uint64_t bytes)
{
    while (bytes_most(g) < bytes || l->pictures.bytes > bytes_most(g) - bytes) {
        picture_slot *spared = bytes <= bytes_most(g) ? slot_to_spare(g, l) : NULL;
        if (!spared) {
            l->pictures.refused++;
            return 0;
        }
        give_back(g, l, spared);
        l->pictures.emptied++;
    }
    l->pictures.bytes += bytes;
    if (l->pictures.bytes > l->pictures.bytes_peak) l->pictures.bytes_peak = l->pictures.bytes;
    return 1;
}

// ---- Textures ----

static GLuint texture(GLenum format, uint32_t width_px, uint32_t height_px)
{
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    glTextureStorage2D(name, 1, format, (GLsizei)width_px, (GLsizei)height_px);
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, format == GL_DEPTH_COMPONENT32F ? GL_NEAREST : GL_LINEAR);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, format == GL_DEPTH_COMPONENT32F ? GL_NEAREST : GL_LINEAR);
    glTextureParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return name;
}

static GLenum colour_format(const renderer *g)
{
    return g->pictures.options.format == PICTURE_8_BITS ? GL_RGBA8 : GL_RGB5_A1;
}

// What captures need while they are taken, as large as was ever needed.
static void prepare_spare(renderer *g, uint32_t width_px, uint32_t height_px)
{
    picture_shared *p = &g->pictures;
    if (p->spare_depth && p->spare_width_px >= width_px && p->spare_height_px >= height_px) return;
    glDeleteTextures(1, &p->spare_depth);
    if (width_px > p->spare_width_px) p->spare_width_px = width_px;
    if (height_px > p->spare_height_px) p->spare_height_px = height_px;
    p->spare_depth = texture(GL_DEPTH_COMPONENT32F, p->spare_width_px, p->spare_height_px);
}

int slot_textures(renderer *g, picture_slot *s, const cull_capture *c)
{
    prepare_spare(g, c->width_px, c->height_px);
    s->bytes = (uint64_t)c->width_px * c->height_px * texel_bytes(g, c->keep_depth);
    s->width_px = c->width_px;
    s->height_px = c->height_px;
    s->keep_depth = c->keep_depth;
    s->colour = texture(colour_format(g), c->width_px, c->height_px);
    if (c->keep_depth) s->depth = texture(GL_DEPTH_COMPONENT32F, c->width_px, c->height_px);
    glCreateFramebuffers(1, &s->framebuffer);
    glNamedFramebufferTexture(s->framebuffer, GL_COLOR_ATTACHMENT0, s->colour, 0);
    glNamedFramebufferTexture(s->framebuffer, GL_DEPTH_ATTACHMENT, c->keep_depth ? s->depth : g->pictures.spare_depth, 0);
    return gl_check(g, NULL, "making a picture") == RESULT_OK;
}

int slot_prepare(renderer *g, render_layout *l, picture_slot *s, const cull_capture *c)
{
    if (c->width_px == 0 || c->height_px == 0 || c->width_px > g->size_most_px || c->height_px > g->size_most_px) return 0;
    if (s->bytes && s->width_px == c->width_px && s->height_px == c->height_px && s->keep_depth == c->keep_depth) {
        if (!c->keep_depth) glNamedFramebufferTexture(s->framebuffer, GL_DEPTH_ATTACHMENT, g->pictures.spare_depth, 0); // another may have come
        return 1;
    }
    const uint64_t bytes = (uint64_t)c->width_px * c->height_px * texel_bytes(g, c->keep_depth);
    give_back(g, l, s);
    if (!take_bytes(g, l, bytes)) return 0;
    if (slot_textures(g, s, c)) return 1;
    give_back(g, l, s);
    return 0;
}

// ---- Room ----

void pictures_forget_zone(renderer *g, render_layout *l, uint32_t zone)
{
    const layout_zone *z = &l->zones[zone];
    for (uint32_t i = 0; i < z->slot_count; ++i) give_back(g, l, &l->slots[z->first_slot + i]);
}

void renderer_forget_pictures(renderer *g)
{
    for (render_layout *l = g->layouts; l; l = l->next)
        for (uint32_t i = 0; i < l->slot_count; ++i) give_back(g, l, &l->slots[i]);
}

void pictures_close_layout(renderer *g, render_layout *l)
{
    for (uint32_t i = 0; i < l->slot_count; ++i) give_back(g, l, &l->slots[i]);
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
    if (total && (!slots || shown_reserve(g, (uint32_t)total) != RESULT_OK)) {
        memory_free(g->memory, slots, (size_t)total, sizeof *slots);
        return report_no_memory(r, NULL);
    }
    pictures_close_layout(g, l);
    l->slots = slots;
    l->slot_count = (uint32_t)total;
    l->pictures = (render_picture_counts){0};
    for (uint32_t zone = 0, first = 0; zone < l->zone_count; ++zone) {
        l->zones[zone].first_slot = first;
        l->zones[zone].slot_count = slot_counts[zone];
        first += slot_counts[zone];
    }
    return RESULT_OK;
}

void renderer_picture_options(renderer *g, const picture_options *o)
{
    assert(!g->frame.open);
    renderer_forget_pictures(g);
    glDeleteTextures(1, &g->pictures.spare_depth);
    g->pictures.spare_depth = 0;
    g->pictures.spare_width_px = g->pictures.spare_height_px = 0;
    g->pictures.options = *o;
    g->costs_of = NULL; // they are others now
}

render_picture_counts render_layout_picture_counts(const render_layout *l)
{
    return l->pictures;
}

void renderer_check_slots(renderer *g, const render_layout *l, uint32_t zone, uint8_t *slots, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        if (!slots[i]) continue;
        const picture_slot *s = slot_find(l, zone, i);
        slots[i] = s && slot_holds(g, s);
    }
}

void pictures_close(renderer *g)
{
    glDeleteVertexArrays(1, &g->pictures.vertices);
    glDeleteTextures(1, &g->pictures.spare_depth);
    outlines_close(g);
    shown_release(g);
    g->pictures = (picture_shared){0};
}
