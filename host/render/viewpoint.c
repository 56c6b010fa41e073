// Viewpoints: a camera as the shaders take it. All in double from the camera on, rounded to float once.
// SPDX-License-Identifier: MIT
// Reversed z (1 at the near plane, 0 at infinity) in 32-bit float: the steps of the depth shrink with it, so 1 cm at 1 km
// still differ. Nearer is larger, so the depth test is GREATER where DESIGN.md, speaking of distance, says LESS.
#include "gl.h"

#include <math.h>

void viewpoint_finish(viewpoint *v)
{
    for (int i = 0; i < 16; ++i) v->clip[i] = (float)v->clip_from_eye[i];
    for (int k = 0; k < 3; ++k) {
        v->eye_high[k] = (float)v->eye[k];
        v->eye_low[k] = (float)(v->eye[k] - (double)v->eye_high[k]);
    }
}

result viewpoint_make(const renderer *g, const viewpoint_request *q, report *r, viewpoint *out)
{
    const camera *c = q->camera;
    const char *fault = camera_fault(c);
    if (fault) return report_error(r, NULL, 0, "a camera that can't be used: %s", fault);
    viewpoint v = {.near_m = c->near_m};
    camera_clip_from_eye(c, v.clip_from_eye);
    const double shift[2] = {2 * q->jitter_px[0] / q->width_px, 2 * q->jitter_px[1] / q->height_px};
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 2; ++row) v.clip_from_eye[4 * column + row] += shift[row] * v.clip_from_eye[4 * column + 3];
    for (int k = 0; k < 3; ++k) v.eye[k] = c->eye[k] - g->scene.scene->whole.origin[k];
    v.pixels_per_tangent = 0.5 * q->height_px / tan(c->fovy_deg * (3.14159265358979323846 / 360));
    viewpoint_finish(&v);
    *out = v;
    return RESULT_OK;
}

void viewpoint_set(const viewpoint *v, GLuint program, uint32_t wanted)
{
    glProgramUniformMatrix4fv(program, AT_CLIP_FROM_EYE, 1, GL_FALSE, v->clip);
    glProgramUniform3fv(program, AT_EYE_HIGH, 1, v->eye_high);
    glProgramUniform3fv(program, AT_EYE_LOW, 1, v->eye_low);
    glProgramUniform1ui(program, AT_WANTED, wanted);
}
