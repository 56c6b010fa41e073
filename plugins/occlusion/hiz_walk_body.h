// Tree and pyramid walked together; included by each kernel behind hiz_test_body.h. Sixteen boxes are held against the volume's planes,
// projected and held against the pyramid at once.
// SPDX-License-Identifier: MIT
#include "hiz_walk.h"

enum { WALK_ALL_PLANES = -1, WALK_LEVEL_SHIFT = 28 };
#define WALK_NUMBER ((1u << WALK_LEVEL_SHIFT) - 1)
#define WALK_NEAREST 3e38f            // the depth of what is not tested: the eye is in or near it, or it is no number
#define WALK_SIZE_MOST 1e15f          // metres: a box that reaches farther from the eye counts as no number
#define WALK_ROUNDING (1.0f / 2097152) // of the coordinates from the eye, summed: eight times that of a float, for sums of three products

// ---- Sixteen boxes on the picture ----

typedef struct walk_rects { // by lane
    int32_t x0[HIZ_LANES], y0[HIZ_LANES], x1[HIZ_LANES], y1[HIZ_LANES];
    float depth[HIZ_LANES];
} walk_rects;

// From the eye: in two steps, as the renderer does.
static inline hiz_f from_eye(const hiz_view *v, const float *coordinates, int axis)
{
    return f_sub(f_sub(f_load(coordinates), f_set(v->eye[axis])), f_set(v->eye_rest[axis]));
}

static inline hiz_f f_size(hiz_f a)
{
    return f_max(a, f_sub(f_set(0), a));
}

// row . corner for the eight corners; bit 0: greater x, 1: y, 2: z.
static inline void corners_of(const float row[3], const hiz_f low[3], const hiz_f high[3], hiz_f out[8])
{
    const hiz_f x[2] = {f_mul(low[0], f_set(row[0])), f_mul(high[0], f_set(row[0]))};
    const hiz_f y[2] = {f_mul(low[1], f_set(row[1])), f_mul(high[1], f_set(row[1]))};
    const hiz_f z[2] = {f_mul(low[2], f_set(row[2])), f_mul(high[2], f_set(row[2]))};
    for (int i = 0; i < 4; i++) {
        const hiz_f xy = f_add(x[i & 1], y[i >> 1]);
        out[i] = f_add(xy, z[0]);
        out[i + 4] = f_add(xy, z[1]);
    }
}

static inline void pixels_between(hiz_f low, hiz_f high, hiz_f outset, int32_t begin, int32_t final, uint32_t near, int32_t first[], int32_t last[])
{
    const hiz_f from = f_ceil(f_sub(low, f_add(outset, f_set(0.5f)))), to = f_floor(f_add(high, f_sub(outset, f_set(0.5f))));
    const hiz_f most = f_set((float)final), least = f_set((float)begin);
    // of a NaN f_min and f_max give the second
    const hiz_f start = f_min(f_max(from, least), f_set((float)(final + 1))), end = f_max(f_min(to, most), f_set((float)(begin - 1)));
    i_store(first, f_to_i(f_pick(near, least, start)));
    i_store(last, f_to_i(f_pick(near, most, end)));
}

// within: the rectangle of the node that the boxes lie in, none nearer than its depth. It holds what the boxes' own rectangles hold, but
// rounds otherwise; in both of them a box is found hidden wherever its node is, so that bands find the same set.
// Returns the lanes that may leave a pixel on an empty picture.
static inline uint32_t block_project(const hiz_view *v, const float *block, uint32_t lanes, const hiz_rectangle *within, walk_rects *out)
{
    hiz_f low[3], high[3], w[8], x[8], y[8], size = f_set(0);
    for (int axis = 0; axis < 3; axis++) {
        low[axis] = from_eye(v, block + axis * HIZ_WIDTH, axis);
        high[axis] = from_eye(v, block + (axis + 3) * HIZ_WIDTH, axis);
        size = f_add(size, f_add(f_size(low[axis]), f_size(high[axis])));
    }
    corners_of(v->row_w, low, high, w);
    corners_of(v->row_x, low, high, x);
    corners_of(v->row_y, low, high, y);
    hiz_f least_w = w[0], inverse = f_div(f_set(1), w[0]);
    hiz_f low_x = f_mul(x[0], inverse), high_x = low_x, low_y = f_mul(y[0], inverse), high_y = low_y;
    for (int i = 1; i < 8; i++) {
        inverse = f_div(f_set(1), w[i]);
        const hiz_f px = f_mul(x[i], inverse), py = f_mul(y[i], inverse);
        least_w = f_min(least_w, w[i]);
        low_x = f_min(low_x, px);
        high_x = f_max(high_x, px);
        low_y = f_min(low_y, py);
        high_y = f_max(high_y, py);
    }
    least_w = f_sub(least_w, f_mul(size, f_set(WALK_ROUNDING)));
    const uint32_t near = ~(f_above(least_w, f_set(v->near_up)) & f_above(f_set(WALK_SIZE_MOST), size));
    const hiz_f outset = f_add(f_set(v->outset_px), f_div(f_mul(size, f_set((float)v->rounding_px * WALK_ROUNDING)), least_w));
    const hiz_f across = f_set((float)v->inset_cell[0]), up = f_set((float)v->inset_cell[1]);
    pixels_between(low_x, high_x, f_add(outset, across), within->x0, within->x1, near, out->x0, out->x1);
    pixels_between(low_y, high_y, f_add(outset, up), within->y0, within->y1, near, out->y0, out->y1);
    f_store(out->depth, f_min(f_pick(near, f_set(WALK_NEAREST), f_div(f_set(v->depth_up), least_w)), f_set(within->depth)));
    return lanes & ~i_above(i_load(out->x0), i_load(out->x1)) & ~i_above(i_load(out->y0), i_load(out->y1));
}

static inline hiz_rectangle lane_rect(const walk_rects *r, int lane)
{
    const hiz_rectangle q = {r->x0[lane], r->y0[lane], r->x1[lane], r->y1[lane], r->depth[lane]};
    return q;
}

static inline hiz_place first_place(const hiz_rectangle *q)
{
    const hiz_place p = {(int16_t)(q->x0 >> 3), (int16_t)(q->y0 >> 3)};
    return p;
}

// ---- Sixteen boxes and the volumes ----

static inline hiz_f plane_height(const cull_plane *p, const float *block, int x, int y, int z)
{
    const hiz_f sx = f_mul(f_load(block + x), f_set(p->normal.x)), sy = f_mul(f_load(block + y), f_set(p->normal.y));
    return f_add(f_add(f_add(sx, sy), f_mul(f_load(block + z), f_set(p->normal.z))), f_set(p->offset));
}

// cut: by lane, the planes that the box is not whole inside of.
static inline uint32_t block_touches(const cull_volume *v, const float *block, uint32_t lanes, uint32_t which, uint32_t cut[HIZ_LANES])
{
    const hiz_f zero = f_set(0);
    hiz_i cuts = i_set(0);
    for (uint32_t left = which; left && lanes; left &= left - 1) {
        const uint32_t k = (uint32_t)__builtin_ctz(left);
        const cull_plane *p = &v->planes[k];
        const int x = p->normal.x >= 0 ? 48 : 0, y = p->normal.y >= 0 ? 64 : 16, z = p->normal.z >= 0 ? 80 : 32;
        lanes &= f_not_below(plane_height(p, block, x, y, z), zero);
        const uint32_t inside = f_not_below(plane_height(p, block, 48 - x, 80 - y, 112 - z), zero);
        cuts = i_add(cuts, i_pick(inside, i_set(0), i_set((int32_t)(1u << k))));
    }
    i_store(cut, cuts);
    return lanes;
}

static inline uint32_t all_planes(const cull_volume *v)
{
    return v->plane_count >= 32 ? UINT32_MAX : (1u << v->plane_count) - 1;
}

static inline uint32_t block_inside(const hiz_walk *w, const float *block, uint32_t lanes, uint32_t planes, uint32_t cut[HIZ_LANES])
{
    if (w->volume_count == 1) return block_touches(w->volumes, block, lanes, planes, cut);
    uint32_t touching = 0;
    for (uint32_t i = 0; i < w->volume_count && touching != lanes; i++)
        touching |= block_touches(&w->volumes[i], block, lanes & ~touching, all_planes(&w->volumes[i]), cut);
    return touching;
}

// ---- The walk ----

static inline uint32_t active_lanes(const hiz_walk *w, uint32_t level, uint32_t block)
{
    const uint32_t left = w->index->tree.counts[level] - block * HIZ_WIDTH, lanes = hiz_low_lanes(left);
    return w->active[0] ? lanes & (uint32_t)(w->active[level][block / 4] >> (block % 4 * 16)) : lanes;
}

// Of rectangles of at most 2 x 2 tiles those that the tiles' far depths hide; the others are looked at one by one.
static inline uint32_t small_hidden(const hiz_buffer *b, const walk_rects *r, uint32_t lanes)
{
    const hiz_i own = i_set(b->first_row * b->pitch), pitch = i_set(b->pitch); // lanes that are off read there, not in another band
    const hiz_i x0 = i_shift_right(i_load(r->x0), 3), x1 = i_shift_right(i_load(r->x1), 3);
    const hiz_i y0 = i_shift_right(i_load(r->y0), 3), y1 = i_shift_right(i_load(r->y1), 3);
    lanes &= ~(i_above(i_sub(x1, x0), i_set(1)) | i_above(i_sub(y1, y0), i_set(1)));
    if (!lanes) return 0;
    const hiz_i top = i_mul(y0, pitch), bottom = i_mul(y1, pitch);
    const hiz_f first = f_min(f_gather(b->far, i_pick(lanes, i_add(top, x0), own)), f_gather(b->far, i_pick(lanes, i_add(top, x1), own)));
    const hiz_f second = f_min(f_gather(b->far, i_pick(lanes, i_add(bottom, x0), own)), f_gather(b->far, i_pick(lanes, i_add(bottom, x1), own)));
    return lanes & f_above(f_min(first, second), f_load(r->depth));
}

static inline hiz_rectangle picture_rect(const hiz_view *v)
{
    const hiz_rectangle all = {0, v->y_first, v->width_px - 1, v->y_end - 1, WALK_NEAREST};
    return all;
}

// planes, within: of the node itself
static inline void node_open(hiz_walk *w, uint32_t level, uint32_t block, uint32_t planes, const hiz_rectangle *within)
{
    const float *boxes = w->index->tree.blocks[level] + (size_t)block * HIZ_BLOCK_FLOATS;
    uint32_t cut[HIZ_LANES];
    walk_rects rects;
    uint32_t lanes = block_inside(w, boxes, active_lanes(w, level, block), planes, cut);
    w->nodes_visited++;
    if (!lanes) return;
    lanes = block_project(w->view, boxes, lanes, within, &rects);
    for (lanes &= ~small_hidden(w->buffer, &rects, lanes); lanes; lanes &= lanes - 1) {
        const int lane = __builtin_ctz(lanes);
        const hiz_rectangle q = lane_rect(&rects, lane);
        hiz_place open = first_place(&q);
        w->test_count++;
        if (q.depth < WALK_NEAREST && rectangle_hidden(w->buffer, &q, &open)) continue;
        const queue_entry e = {q.depth, level << WALK_LEVEL_SHIFT | (block * HIZ_WIDTH + (uint32_t)lane), cut[lane], w->polygon_count, 0,
                               (int16_t)q.x0, (int16_t)q.y0, (int16_t)q.x1, (int16_t)q.y1, open};
        queue_push(&w->queue, &e);
    }
}

static void item_box(const hiz_walk *w, uint32_t slot, cull_box *out)
{
    const float *b = w->index->tree.blocks[0] + (size_t)(slot / HIZ_WIDTH) * HIZ_BLOCK_FLOATS + slot % HIZ_WIDTH;
    *out = (cull_box){{b[0], b[16], b[32]}, {b[48], b[64], b[80]}};
}

static void loops_cover(hiz_walk *w, const hiz_shape *shape, const queue_entry *e, const int32_t within[4])
{
    const hiz_shapes *shapes = &w->index->shapes;
    for (uint32_t i = 0; i < shape->face_count; i++) {
        const hiz_face *face = &shapes->faces[shape->first_face + i];
        hiz_loop loop;
        hiz_polygon polygon;
        hiz_face_loop(shapes, face, w->view->eye_exact, &loop);
        if (shape->is_one_sided) {
            const double *p = loop.points[0], *n = loop.normal;
            if (!(p[0] * n[0] + p[1] * n[1] + p[2] * n[2] < 0)) continue; // its back: a chain may leave it out
        }
        if (!setup_loop(w->view, &loop, within, &polygon)) continue;
        polygon.nearest = e->depth;
        w->polygon_count++;
        polygon_cover(w->buffer, &polygon);
    }
}

static inline void item_cover(hiz_walk *w, uint32_t slot, const queue_entry *e)
{
    const hiz_shape *shape = &w->index->shapes.shapes[slot];
    // What reaches the picture's last column or row may go on to the end of its tiles.
    const int32_t within[4] = {e->x0, e->y0, e->x1 + 1 >= w->view->width_px ? w->buffer->width_px : e->x1 + 1,
                               e->y1 + 1 >= w->view->y_end ? w->buffer->end_row * HIZ_TILE_PX : e->y1 + 1};
    w->cover_count += shape->kind != HIZ_HIDES_NOTHING;
    if (shape->kind == HIZ_HIDES_AS_LOOPS) loops_cover(w, shape, e, within);
    if (shape->kind != HIZ_HIDES_AS_BOX) return;
    cull_box box;
    hiz_polygon polygon;
    item_box(w, slot, &box);
    if (!setup_box(w->view, &box, within, &polygon)) return;
    polygon.nearest = e->depth;
    w->polygon_count += polygon.planes.count;
    polygon_cover(w->buffer, &polygon);
}

static void walk_run(hiz_walk *w)
{
    const hiz_tree *tree = &w->index->tree;
    queue_entry e;
    const hiz_rectangle all = picture_rect(w->view);
    queue_begin(&w->queue);
    if (!tree->item_count) return;
    node_open(w, tree->level_count - 1, 0, w->volume_count ? all_planes(w->volumes) : 0, &all);
    while (queue_pop(&w->queue, &e)) {
        const uint32_t level = e.code >> WALK_LEVEL_SHIFT, number = e.code & WALK_NUMBER;
        const hiz_rectangle rect = {e.x0, e.y0, e.x1, e.y1, e.depth};
        w->test_count++;
        if (e.depth < WALK_NEAREST && e.polygon_count != w->polygon_count && rectangle_hidden(w->buffer, &rect, &e.open)) continue;
        if (level) {
            node_open(w, level - 1, number, e.planes, &rect);
            continue;
        }
        w->seen[w->seen_count++] = number;
        if (w->view->is_usable) item_cover(w, number, &e);
    }
}

static uint32_t walk_boxes_seen(const hiz_view *v, hiz_buffer *b, const float *block, uint32_t lanes)
{
    const hiz_rectangle all = picture_rect(v);
    walk_rects rects;
    uint32_t seen = block_project(v, block, lanes, &all, &rects);
    for (uint32_t left = seen; left; left &= left - 1) {
        const int lane = __builtin_ctz(left);
        const hiz_rectangle q = lane_rect(&rects, lane);
        hiz_place open = first_place(&q);
        if (q.depth < WALK_NEAREST && rectangle_hidden(b, &q, &open)) seen &= ~(1u << lane);
    }
    return seen;
}
