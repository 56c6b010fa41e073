// The floor of occlusion culling: items whose widened box passes anywhere against the finished depth.
// SPDX-License-Identifier: MIT
#include "gl.h"

#include <string.h>

static void set_bit(uint32_t *bits, uint32_t i)
{
    bits[i >> 5] |= 1u << (i & 31);
}

result renderer_floor(renderer *g, const camera *c, report *r, uint32_t *item_bits)
{
    scene_gpu *p = &g->scene;
    const target *t = g->id_target;
    if (!p->scene || !t) return report_error(r, NULL, 0, "a floor without an id picture before it; draw one first");
    frame_flush(g); // it stages boxes too
    viewpoint v;
    const viewpoint_request from = {.camera = c, .width_px = t->width_px, .height_px = t->height_px};
    const result seen = viewpoint_make(g, &from, r, &v);
    if (seen != RESULT_OK) return seen;
    const uint32_t errors = g->errors;
    uint32_t tested = 0;
    memset(item_bits, 0, (size_t)(p->item_total + 31) / 32 * sizeof *item_bits);
    state_framebuffer(g, t->framebuffer, t->width_px, t->height_px);
    glClearNamedBufferData(p->counts, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, NULL);
    boxes_begin(g, &v, p->counts);
    for (uint32_t i = 0; i < p->item_total; ++i) {
        eye_box widened;
        mover_box box;
        item_box(g, i, &box);
        const box_fate fate = box_place(&v, &box, &widened);
        if (fate == BOX_NEAR) set_bit(item_bits, i);
        if (fate != BOX_TESTED) continue;
        p->box_items[tested++] = i;
        boxes_add(g, &widened);
    }
    boxes_end(g);
    glGetNamedBufferSubData(p->counts, 0, (GLsizeiptr)(tested * sizeof(uint32_t)), p->box_counts);
    for (uint32_t k = 0; k < tested; ++k)
        if (p->box_counts[k]) set_bit(item_bits, p->box_items[k]);
    gl_check(g, r, "testing boxes");
    return g->errors == errors ? RESULT_OK : RESULT_NO_GL;
}
