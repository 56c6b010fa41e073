// Coverage: which pixels of a frame something was drawn on, from its depths.
// SPDX-License-Identifier: MIT
#include "gl.h"

result renderer_read_depths(renderer *g, float *depths, report *r)
{
    const target *t = g->frame.target;
    if (!t || g->frame.open) return report_error(r, NULL, 0, "depths read before renderer_end; end the frame first");
    state_framebuffer(g, t->framebuffer, t->width_px, t->height_px);
    glReadPixels(0, 0, (GLsizei)t->width_px, (GLsizei)t->height_px, GL_DEPTH_COMPONENT, GL_FLOAT, depths);
    return gl_check(g, r, "reading depths");
}
