// The id picture: who owns each pixel when everything is drawn, in ascending global id, equal depth to the lower id.
// SPDX-License-Identifier: MIT
// Invariant: a pixel's owner depends on the triangles that cover it alone, so drawing the owners' items alone gives the
// same picture.
#include "gl.h"

#include <string.h>

static const uint32_t ID_SIDE_MOST = 1u << 15; // pixels: width * height * 4 fits anywhere

result id_picture_open(const scene *s, uint32_t width_px, uint32_t height_px, const allocator *memory, id_picture *out)
{
    id_picture p = {.width_px = width_px, .height_px = height_px};
    if (width_px == 0 || height_px == 0 || width_px > ID_SIDE_MOST || height_px > ID_SIDE_MOST) return RESULT_BAD_INPUT;
    p.see_through_words = s->index_count / 3 / 32 + 1;
    p.triangles = memory_alloc_zeroed(memory, (size_t)width_px * height_px, sizeof *p.triangles);
    p.see_through = memory_alloc_zeroed(memory, p.see_through_words, sizeof *p.see_through);
    if (!p.triangles || !p.see_through) {
        id_picture_free(&p, memory);
        return RESULT_NO_MEMORY;
    }
    *out = p;
    return RESULT_OK;
}

void id_picture_free(id_picture *p, const allocator *memory)
{
    memory_free(memory, p->triangles, (size_t)p->width_px * p->height_px, sizeof *p->triangles);
    memory_free(memory, p->see_through, p->see_through_words, sizeof *p->see_through);
    *p = (id_picture){0};
}

static void add_item(scene_gpu *p, uint32_t item)
{
    ranges_add(&p->ranges, p->scene->items[item].first_index, p->scene->items[item].index_count); // item_total places: never full
}

static int has_bit(const uint32_t *bits, uint32_t i)
{
    return !bits || (bits[i >> 5] >> (i & 31) & 1);
}

static void add_wanted(scene_gpu *p, const uint32_t *bits)
{
    if (!bits) {
        ranges_add(&p->ranges, 0, p->scene->index_count); // items leave no gap between them
        return;
    }
    for (uint32_t i = 0; i < p->item_total; ++i) {
        if (!bits[i >> 5]) i |= 31;
        else if (has_bit(bits, i)) add_item(p, i);
    }
}

static void draw_opaque(renderer *g, const viewpoint *v, const id_request *q)
{
    scene_gpu *p = &g->scene;
    // Back faces are dropped by fragments, not by GL_CULL_FACE: llvmpipe culls a triangle by its sense before rounding to the
    // raster's grid when another one near it needs clipping, by its sense after rounding otherwise. Slivers came and went.
    const uint32_t sides = q->faces == FACES_FRONT ? VARIANT_SIDES : 0;
    const GLuint program = program_find(g, PROGRAM_ID, p->variant | sides);
    if (!program) return;
    state_program(g, program);
    viewpoint_set(v, program, 0);
    poses_use(g, v->eye);
    state_pass(g, &(pass_state){GL_GREATER, DEPTH_ON, COLOUR_ON, BLEND_NONE, BACK_DRAWN, OFFSET_NONE});
    add_wanted(p, q->item_bits);
    ranges_draw(g, &p->ranges);
}

static void draw_see_through(renderer *g, const viewpoint *v, const id_request *q)
{
    scene_gpu *p = &g->scene;
    const GLuint program = program_find(g, PROGRAM_SEE_THROUGH, p->variant);
    if (!program) return;
    glClearNamedBufferData(p->seen, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, NULL);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BIND_COUNTS, p->seen);
    state_program(g, program);
    viewpoint_set(v, program, WORD_TRANSLUCENT);
    state_pass(g, &(pass_state){GL_GREATER, DEPTH_OFF, COLOUR_OFF, BLEND_NONE, BACK_DRAWN, OFFSET_FARTHER});
    for (uint32_t i = 0; i < p->see_through_count; ++i)
        if (has_bit(q->item_bits, p->see_through[i])) add_item(p, p->see_through[i]);
    ranges_draw(g, &p->ranges);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
}

static void clear(renderer *g)
{
    const GLuint nothing[4] = {0};
    const GLfloat far = 0;
    state_pass(g, &(pass_state){GL_GREATER, DEPTH_ON, COLOUR_ON, BLEND_NONE, BACK_DRAWN, OFFSET_NONE});
    glClearBufferuiv(GL_COLOR, 0, nothing);
    glClearBufferfv(GL_DEPTH, 0, &far);
}

static void read_back(renderer *g, id_picture *out)
{
    scene_gpu *p = &g->scene;
    glReadPixels(0, 0, (GLsizei)out->width_px, (GLsizei)out->height_px, GL_RED_INTEGER, GL_UNSIGNED_INT, out->triangles);
    const size_t bytes = out->see_through_words * sizeof(uint32_t);
    if (p->see_through_count) glGetNamedBufferSubData(p->seen, 0, (GLsizeiptr)bytes, out->see_through);
    else memset(out->see_through, 0, bytes);
}

result renderer_id_picture(renderer *g, const id_request *q, report *r, id_picture *out)
{
    scene_gpu *p = &g->scene;
    if (!p->scene) return report_error(r, NULL, 0, "an id picture without a scene; upload one first");
    if (out->see_through_words != p->triangle_count / 32 + 1) return report_error(r, NULL, 0, "an id picture opened for another scene");
    frame_flush(g); // it shares the ranges
    viewpoint v;
    const viewpoint_request from = {q->camera, out->width_px, out->height_px, {q->jitter_px[0], q->jitter_px[1]}};
    const result seen = viewpoint_make(g, &from, r, &v);
    if (seen != RESULT_OK) return seen;
    target *t = target_find(g, TARGET_ID, out->width_px, out->height_px, r);
    if (!t) return RESULT_NO_GL;
    const uint32_t errors = g->errors;
    state_framebuffer(g, t->framebuffer, t->width_px, t->height_px);
    state_vertices(g, p->vertices);
    clear(g);
    draw_opaque(g, &v, q);
    if (p->see_through_count) draw_see_through(g, &v, q);
    read_back(g, out);
    g->id_target = t;
    gl_check(g, r, "drawing an id picture");
    return g->errors == errors ? RESULT_OK : RESULT_NO_GL;
}

result renderer_read_ids(renderer *g, uint32_t *triangles, float *depths, report *r)
{
    const target *t = g->id_target;
    if (!t || g->frame.open) return report_error(r, NULL, 0, "ids read without a picture of them; draw one first");
    state_framebuffer(g, t->framebuffer, t->width_px, t->height_px);
    const GLsizei width = (GLsizei)t->width_px, height = (GLsizei)t->height_px;
    if (triangles) glReadPixels(0, 0, width, height, GL_RED_INTEGER, GL_UNSIGNED_INT, triangles);
    if (depths) glReadPixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, depths);
    return gl_check(g, r, "reading ids");
}
