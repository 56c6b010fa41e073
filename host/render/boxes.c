// Boxes against a finished depth: counts the fragments of each that pass, many boxes a draw.
// SPDX-License-Identifier: MIT
// Counts in a storage buffer instead of GL's occlusion queries: one draw for 2,048 boxes, not one each; 1.2 us a box
// against 7 us on llvmpipe, where each query's begin and end visits every tile.
// Invariant: an item that owns a pixel of the id picture passes, whatever the driver rounds: the box covers every pixel
// centre that the item covers, its depth errs towards the eye, and that of what is drawn errs away from it (state.c, id.frag).
#include "gl.h"

#include <math.h>

static const double BOX_WIDEN = 0x1p-20;      // of the distance to the eye: the guard band
static const double BOX_WIDEN_PX = 1.0 / 256; // pixels: item and box corners are each moved up to 1/512 to the raster's grid
static const double NEAR_MARGIN = 0x1p-10; // of the near distance: the raster's own clipping is that exact by far

static const uint8_t BOX_FACES[6][6] = { // least x, most x, least y ...; corner bits: x 1, y 2, z 4; counterclockwise from outside
    {0, 4, 6, 0, 6, 2}, {1, 3, 7, 1, 7, 5}, {0, 1, 5, 0, 5, 4}, {2, 6, 7, 2, 7, 3}, {0, 2, 3, 0, 3, 1}, {4, 5, 7, 4, 7, 6},
};
enum { CORNER_FLOATS = 8 * 3, FACES_SEEN = 3, ELEMENTS_MOST = BOX_CHUNK * FACES_SEEN * 6 };

result boxes_open(renderer *g, report *r)
{
    box_pass *b = &g->boxes;
    b->staged = memory_alloc(g->memory, (size_t)BOX_CHUNK * CORNER_FLOATS, sizeof *b->staged);
    b->staged_elements = memory_alloc(g->memory, ELEMENTS_MOST, sizeof *b->staged_elements);
    if (!b->staged || !b->staged_elements) return report_no_memory(r, NULL);
    glCreateBuffers(1, &b->elements);
    glNamedBufferStorage(b->elements, (GLsizeiptr)(ELEMENTS_MOST * sizeof(uint32_t)), NULL, GL_DYNAMIC_STORAGE_BIT);
    glCreateBuffers(1, &b->corners);
    glNamedBufferStorage(b->corners, (GLsizeiptr)(BOX_CHUNK * CORNER_FLOATS * sizeof(float)), NULL, GL_DYNAMIC_STORAGE_BIT);
    glCreateVertexArrays(1, &b->vertices);
    glVertexArrayVertexBuffer(b->vertices, 0, b->corners, 0, 12);
    glVertexArrayAttribFormat(b->vertices, 0, 3, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(b->vertices, 0, 0);
    glEnableVertexArrayAttrib(b->vertices, 0);
    glVertexArrayElementBuffer(b->vertices, b->elements);
    return gl_check(g, r, "preparing box tests");
}

void boxes_close(renderer *g)
{
    box_pass *b = &g->boxes;
    glDeleteVertexArrays(1, &b->vertices);
    glDeleteBuffers(1, &b->corners);
    glDeleteBuffers(1, &b->elements);
    memory_free(g->memory, b->staged, (size_t)BOX_CHUNK * CORNER_FLOATS, sizeof *b->staged);
    memory_free(g->memory, b->staged_elements, ELEMENTS_MOST, sizeof *b->staged_elements);
    *b = (box_pass){0};
}

// The most and least that row . (p, 1) reaches on the box.
static double reach(const double row[4], const double low[3], const double high[3], double sign)
{
    double sum = row[3];
    for (int k = 0; k < 3; ++k) sum += row[k] * sign > 0 ? row[k] * high[k] : row[k] * low[k];
    return sum;
}

static void row_of(const viewpoint *v, int row, double sign, double out[4]) // the clip row w + sign * row; row 3: w itself
{
    for (int k = 0; k < 4; ++k) out[k] = v->clip_from_eye[4 * k + 3] + (row == 3 ? 0 : sign * v->clip_from_eye[4 * k + row]);
}

static int is_outside(const viewpoint *v, const double low[3], const double high[3])
{
    double row[4];
    for (int side = 0; side < 4; ++side) {
        row_of(v, side / 2, side & 1 ? -1 : 1, row);
        if (reach(row, low, high, 1) < 0) return 1;
    }
    row_of(v, 3, 0, row);
    return reach(row, low, high, 1) < v->near_m * (1 - NEAR_MARGIN);
}

box_fate box_place(const viewpoint *v, const mover_box *box, eye_box *out)
{
    double low[3], high[3], distance2 = 0;
    for (int k = 0; k < 3; ++k) {
        low[k] = box->low[k] - v->eye[k];
        high[k] = box->high[k] - v->eye[k];
        const double far = fmax(fabs(low[k]), fabs(high[k]));
        distance2 += far * far;
    }
    const double wide = sqrt(distance2) * (BOX_WIDEN + BOX_WIDEN_PX / v->pixels_per_tangent);
    for (int k = 0; k < 3; ++k) {
        low[k] -= wide;
        high[k] += wide;
        out->low[k] = (float)low[k]; // rounding is 2^-24 of the distance: the widening holds it
        out->high[k] = (float)high[k];
    }
    if (is_outside(v, low, high)) return BOX_OUTSIDE;
    double depth[4];
    row_of(v, 3, 0, depth);
    return reach(depth, low, high, -1) < v->near_m * (1 + NEAR_MARGIN) ? BOX_NEAR : BOX_TESTED;
}

void boxes_begin(renderer *g, const viewpoint *v, GLuint counts)
{
    box_pass *b = &g->boxes;
    b->view = v;
    b->counts = counts;
    b->staged_count = b->element_count = b->first_slot = 0;
}

static void draw_staged(renderer *g)
{
    box_pass *b = &g->boxes;
    const GLuint program = b->staged_count ? program_find(g, PROGRAM_BOXES, 0) : 0;
    if (program) {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BIND_COUNTS, b->counts);
        state_program(g, program);
        state_vertices(g, b->vertices);
        state_pass(g, &(pass_state){GL_GEQUAL, DEPTH_OFF, COLOUR_OFF, BLEND_NONE, BACK_DRAWN, OFFSET_NEARER});
        glProgramUniformMatrix4fv(program, AT_CLIP_FROM_EYE, 1, GL_FALSE, b->view->clip);
        glProgramUniform1ui(program, 1, b->first_slot);
        glNamedBufferSubData(b->corners, 0, (GLsizeiptr)(b->staged_count * CORNER_FLOATS * sizeof(float)), b->staged);
        glNamedBufferSubData(b->elements, 0, (GLsizeiptr)(b->element_count * sizeof(uint32_t)), b->staged_elements);
        glDrawElements(GL_TRIANGLES, (GLsizei)b->element_count, GL_UNSIGNED_INT, NULL);
        g->frame.draw_calls++;
    }
    b->first_slot += b->staged_count;
    b->staged_count = b->element_count = 0;
}

// The faces that the eye, at 0 and outside, sees: their edge is that of the whole box, from the same corners, so rounded they cover each pixel
// that lies within the box by more than the rounding, and the box was widened by more. Half the triangles of a box, and no back to be rasterized.
static void faces_add(box_pass *b, const eye_box *box)
{
    for (uint32_t k = 0; k < 3; ++k) {
        if (!(box->low[k] > 0) && !(box->high[k] < 0)) continue;
        const uint8_t *face = BOX_FACES[2 * k + (box->low[k] > 0 ? 0 : 1)];
        for (uint32_t i = 0; i < 6; ++i) b->staged_elements[b->element_count++] = b->staged_count * 8 + face[i];
    }
}

void boxes_add(renderer *g, const eye_box *box)
{
    box_pass *b = &g->boxes;
    float *corner = b->staged + (size_t)b->staged_count * CORNER_FLOATS;
    for (uint32_t i = 0; i < 8; ++i)
        for (uint32_t k = 0; k < 3; ++k) *corner++ = i >> k & 1 ? box->high[k] : box->low[k];
    faces_add(b, box);
    if (++b->staged_count == BOX_CHUNK) draw_staged(g);
}

void boxes_end(renderer *g)
{
    draw_staged(g);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
}
