// Where movers are: a block for each in a storage buffer, composed in double for the eye that looks, rounded to float once.
// SPDX-License-Identifier: MIT
// Invariant: a mover at rest is drawn by the very arithmetic of what never moves, so its bits are the same.
#include "gl.h"

#include <string.h>

// from the eye = (p - high) - low, where the mover only moved: high and low are the eye, moved back as far.
// from the eye = rows * ((p - high) - low) + (rows[0][3], rows[1][3], rows[2][3]), where it turned (low[3] is 1): high and
// low are the middle of its box at rest, so that floats round the mover's own size, not the way to its pivot.
struct pose_block { float high[4], low[4], rows[3][4]; };

static const double AT_REST[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

static int is_turned(const scene_pose *p)
{
    for (int i = 0; i < 9; ++i)
        if (p->rotation[i] != AT_REST[i]) return 1;
    return 0;
}

static int is_at_rest(const scene_pose *p)
{
    return !is_turned(p) && p->offset[0] == 0 && p->offset[1] == 0 && p->offset[2] == 0;
}

static void box_at_rest(const scene *s, uint32_t item, mover_box *out)
{
    const cull_boxes *b = &s->boxes;
    *out = (mover_box){{(double)b->min_x[item], (double)b->min_y[item], (double)b->min_z[item]},
                       {(double)b->max_x[item], (double)b->max_y[item], (double)b->max_z[item]}};
}

void item_box(const renderer *g, uint32_t item, mover_box *out)
{
    const scene *s = g->scene.scene;
    if (item < s->item_count) box_at_rest(s, item, out);
    else *out = g->scene.poses.boxes[item - s->item_count];
}

result poses_open(posed_movers *m, const scene *s, const allocator *memory)
{
    *m = (posed_movers){.count = s->mover_count};
    if (m->count == 0) return RESULT_OK;
    m->poses = memory_alloc(memory, m->count, sizeof *m->poses);
    m->boxes = memory_alloc(memory, m->count, sizeof *m->boxes);
    m->blocks = memory_alloc_zeroed(memory, m->count, sizeof *m->blocks);
    if (!m->poses || !m->boxes || !m->blocks) return RESULT_NO_MEMORY; // scene_release frees
    for (uint32_t i = 0; i < m->count; ++i) {
        m->poses[i] = (scene_pose){.rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
        box_at_rest(s, s->item_count + i, &m->boxes[i]);
    }
    glCreateBuffers(1, &m->buffer);
    glNamedBufferStorage(m->buffer, (GLsizeiptr)(m->count * sizeof *m->blocks), NULL, GL_DYNAMIC_STORAGE_BIT);
    return RESULT_OK;
}

void poses_close(posed_movers *m, const allocator *memory)
{
    glDeleteBuffers(1, &m->buffer);
    memory_free(memory, m->poses, m->count, sizeof *m->poses);
    memory_free(memory, m->boxes, m->count, sizeof *m->boxes);
    memory_free(memory, m->blocks, m->count, sizeof *m->blocks);
    *m = (posed_movers){0};
}

static void box_posed(const scene *s, uint32_t mover, const scene_pose *pose, mover_box *out)
{
    double low[3], high[3];
    if (is_at_rest(pose)) {
        box_at_rest(s, s->item_count + mover, out);
        return;
    }
    scene_pose_box(s, mover, pose, low, high);
    for (int k = 0; k < 3; ++k) {
        out->low[k] = low[k] - s->whole.origin[k];
        out->high[k] = high[k] - s->whole.origin[k];
    }
}

void renderer_poses(renderer *g, const scene_pose *poses)
{
    posed_movers *m = &g->scene.poses;
    frame_flush(g); // drawn where movers were
    for (uint32_t i = 0; i < m->count; ++i) {
        if (memcmp(&m->poses[i], &poses[i], sizeof poses[i]) == 0) continue;
        m->poses[i] = poses[i];
        box_posed(g->scene.scene, i, &poses[i], &m->boxes[i]);
        m->is_made = 0;
    }
}

static void split(const double from[3], float high[4], float low[4])
{
    for (int k = 0; k < 3; ++k) {
        high[k] = (float)from[k];
        low[k] = (float)(from[k] - (double)high[k]);
    }
}

static void make_moved(const scene_pose *p, const double eye[3], pose_block *out)
{
    double back[3];
    for (int k = 0; k < 3; ++k) back[k] = eye[k] - p->offset[k];
    *out = (pose_block){0};
    split(back, out->high, out->low);
}

static void make_turned(const scene *s, uint32_t mover, const scene_pose *p, const double eye[3], pose_block *out)
{
    mover_box rest;
    double middle[3], from_pivot[3];
    box_at_rest(s, s->item_count + mover, &rest);
    for (int k = 0; k < 3; ++k) {
        middle[k] = (rest.low[k] + rest.high[k]) / 2;
        from_pivot[k] = middle[k] - (p->pivot[k] - s->whole.origin[k]);
    }
    *out = (pose_block){.low = {0, 0, 0, 1}};
    split(middle, out->high, out->low);
    for (int row = 0; row < 3; ++row) {
        const double *r = p->rotation + 3 * row;
        const double turned = r[0] * from_pivot[0] + r[1] * from_pivot[1] + r[2] * from_pivot[2];
        for (int k = 0; k < 3; ++k) out->rows[row][k] = (float)r[k];
        out->rows[row][3] = (float)(turned + (p->pivot[row] - s->whole.origin[row]) + p->offset[row] - eye[row]);
    }
}

void poses_use(renderer *g, const double eye[3])
{
    posed_movers *m = &g->scene.poses;
    if (m->count == 0) return;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BIND_POSES, m->buffer);
    if (m->is_made && memcmp(m->eye, eye, sizeof m->eye) == 0) return;
    for (uint32_t i = 0; i < m->count; ++i) {
        if (is_turned(&m->poses[i])) make_turned(g->scene.scene, i, &m->poses[i], eye, &m->blocks[i]);
        else make_moved(&m->poses[i], eye, &m->blocks[i]);
    }
    glNamedBufferSubData(m->buffer, 0, (GLsizeiptr)(m->count * sizeof *m->blocks), m->blocks);
    memcpy(m->eye, eye, sizeof m->eye);
    m->is_made = 1;
}
