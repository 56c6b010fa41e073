// What drawing takes on this machine, for cullers that weigh geometry against pictures (CULL_EXT_COSTS).
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_RENDER_COSTS_H
#define PORTCULLIS_HOST_RENDER_COSTS_H

#include "render.h"

// [main, not within a frame] Measured at the first call after an upload, with the scene's own programs, then remembered: CPU time of the
// process up to glFinish, as GL's timers mean nothing on a software renderer. Pixels of pictures are measured where they cover; what an outline
// (picture_outline.c) leaves out of a parallelogram costs nothing. Takes some tenths of a second. Memory is that of
// the picture options; frame_ns is 0: that is the caller's to say. RESULT_NO_GL, RESULT_NO_MEMORY: a line, and *out is untouched.
result renderer_costs(renderer *g, report *r, cull_costs *out);

#endif
