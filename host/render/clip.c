// Clipped items: drawn as gl_ClipDistance has them, by up to four planes of their zone; for frames and captures.
// SPDX-License-Identifier: MIT
// Invariant: a clip distance is enabled only while something is drawn that it cuts.
#include "gl.h"

#include <assert.h>

void clip_make(const renderer *g, const clip_request *q, clip_pass *out)
{
    double origin[3];
    layout_zone_offset(g, q->zone, origin);
    out->count = q->count;
    for (uint32_t i = 0; i < 4; ++i) {
        const cull_plane none = {{0, 0, 0}, 1}, p = i < q->count ? q->planes[i] : none; // none holds everything
        const float normal[3] = {p.normal.x, p.normal.y, p.normal.z};
        double offset = (double)p.offset;
        for (int k = 0; k < 3; ++k) {
            offset += (double)normal[k] * (q->view->eye[k] - origin[k]);
            out->planes[i][k] = normal[k];
        }
        out->planes[i][3] = (float)offset;
    }
}

void clip_begin(const clip_pass *c)
{
    for (GLenum i = 0; i < c->count; ++i) glEnable(GL_CLIP_DISTANCE0 + i);
}

void clip_end(const clip_pass *c)
{
    for (GLenum i = 0; i < c->count; ++i) glDisable(GL_CLIP_DISTANCE0 + i);
}

void renderer_draw_clipped(renderer *g, const render_layout *l, uint32_t zone, const cull_clipped *clipped)
{
    assert(g->frame.open && zone < l->zone_count);
    if (clipped->run_count == 0) return;
    if (clipped->plane_count == 0) {
        renderer_draw(g, l, zone, clipped->runs, clipped->run_count);
        g->frame.may_repeat = 1;
        return;
    }
    clip_pass clip;
    const pixel_box cut = frame_cut(g, zone);
    const layout_runs runs = {l, zone, clipped->runs, clipped->run_count};
    frame_flush(g);
    frame_bind(g);
    clip_make(g, &(clip_request){clipped->planes, clipped->plane_count, zone, &g->frame.view}, &clip);
    cut_begin(g, &cut);
    clip_begin(&clip);
    frame_draw_runs(g, &(draw_pass){.view = &g->frame.view, .planes = (const GLfloat(*)[4])clip.planes}, &runs);
    clip_end(&clip);
    cut_end(g, &cut);
    g->frame.may_repeat = 1;
    translucent_note(g, &runs);
    gl_check(g, NULL, "drawing clipped items");
}
