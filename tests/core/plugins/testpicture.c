// The test culler `testpicture`: takes a picture of the first items once, and shows it instead of them while the eye
// stays near the place that it was taken from. All other items, and these when the picture is lost, are drawn.
// SPDX-License-Identifier: MIT
#define OPTION_COUNT 5
#define QUERY_FIELDS                                      \
    float taken_from[3]; /* eye of the capture */         \
    uint32_t is_taken;                                    \
    cull_run group, clipped;
#include "shell.h"

#include <math.h>
#include <portcullis/box.h>

static uint32_t group_size(const cull_culler *c)
{
    const uint32_t wanted = (uint32_t)strtoul(c->values[1], NULL, 10);
    return wanted && wanted < c->zone->item_count ? wanted : c->zone->item_count / 2;
}

typedef struct root { cull_hierarchy hierarchy; cull_node node; } root;

static cull_box box_of_group(const cull_zone *zone, uint32_t count);

// One node with all items.
static cull_result lend_root(cull_culler *c)
{
    const uint32_t count = c->zone->item_count;
    root *r = c->host->alloc(c->host, sizeof *r, _Alignof(root));
    if (!r) return CULL_ERR_MEMORY;
    memset(r, 0, sizeof *r);
    r->node = (cull_node){.box = box_of_group(c->zone, count), .item_count = count, .subtree = {0, count}};
    r->hierarchy = (cull_hierarchy){.nodes = &r->node, .node_count = 1, .item_count = count, .depth = 1};
    c->lent = &r->hierarchy; // a select is lent none: its own stands there
    return CULL_OK;
}

static void destroy(cull_culler *c)
{
    if (c->lent) c->host->free(c->host, (root *)c->lent, sizeof(root));
    shell_destroy(c);
}

static cull_result build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    (void)lent;
    c->zone = zone;
    out->index_bytes = sizeof *c;
    out->max_runs = 2;
    out->max_steps = 1;
    out->max_captures = 1;
    out->max_pictures = 1;
    out->slot_count = 1;
    out->max_clipped = 2;
    return c->values[3][0] == '1' ? lend_root(c) : CULL_OK;
}

static cull_box box_of_group(const cull_zone *zone, uint32_t count)
{
    cull_box box = cull_box_none();
    for (uint32_t i = 0; i < count; ++i) box = cull_box_union(box, cull_box_at(&zone->boxes, i));
    return box;
}

static float dot3(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static int axes_towards(const cull_box *b, const float eye[3], float axes[3][3])
{
    const float to[3] = {(b->min.x + b->max.x) / 2 - eye[0], (b->min.y + b->max.y) / 2 - eye[1], (b->min.z + b->max.z) / 2 - eye[2]};
    const float length = sqrtf(dot3(to, to)), level = sqrtf(to[0] * to[0] + to[2] * to[2]);
    if (!(level > 0)) return 0;
    const float right[3] = {-to[2] / level, 0, to[0] / level};
    for (int k = 0; k < 3; ++k) {
        axes[0][k] = right[k];
        axes[2][k] = to[k] / length;
    }
    axes[1][0] = right[1] * axes[2][2] - right[2] * axes[2][1];
    axes[1][1] = right[2] * axes[2][0] - right[0] * axes[2][2];
    axes[1][2] = right[0] * axes[2][1] - right[1] * axes[2][0];
    return 1;
}

// The parallelogram at distance 1 that the box fills, seen from the eye. 0: the box is not wholly in front.
static int capture_frame(const cull_box *b, const float eye[3], cull_capture *out)
{
    float axes[3][3], low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    if (!axes_towards(b, eye, axes)) return 0;
    for (uint32_t i = 0; i < 8; ++i) {
        const float p[3] = {(i & 1 ? b->max.x : b->min.x) - eye[0], (i & 2 ? b->max.y : b->min.y) - eye[1], (i & 4 ? b->max.z : b->min.z) - eye[2]};
        const float depth = dot3(p, axes[2]);
        if (!(depth > 0.01f)) return 0;
        for (int k = 0; k < 2; ++k) {
            low[k] = fminf(low[k], dot3(p, axes[k]) / depth);
            high[k] = fmaxf(high[k], dot3(p, axes[k]) / depth);
        }
    }
    float corner[3];
    for (int k = 0; k < 3; ++k) corner[k] = eye[k] + axes[2][k] + low[0] * axes[0][k] + low[1] * axes[1][k];
    const float width = high[0] - low[0], height = high[1] - low[1];
    out->corner = (cull_vec3){corner[0], corner[1], corner[2]};
    out->right = (cull_vec3){width * axes[0][0], width * axes[0][1], width * axes[0][2]};
    out->up = (cull_vec3){height * axes[1][0], height * axes[1][1], height * axes[1][2]};
    return 1;
}

static void try_capture(cull_query *q, const cull_visit *visit, const cull_box *box, cull_batch *batch)
{
    const uint32_t size = (uint32_t)strtoul(q->culler->values[2], NULL, 10);
    cull_capture c = {.runs = &q->group, .run_count = 1, .box = *box, .slot = 0, .width_px = size, .height_px = size, .keep_depth = 1};
    if (!capture_frame(box, visit->view->eye, &c)) return;
    batch->captures[batch->capture_count++] = c;
    memcpy(q->taken_from, visit->view->eye, sizeof q->taken_from);
    q->is_taken = 1;
}

static float moved_since(const cull_query *q, const cull_visit *visit)
{
    const float *eye = visit->view->eye, by[3] = {eye[0] - q->taken_from[0], eye[1] - q->taken_from[1], eye[2] - q->taken_from[2]};
    return sqrtf(dot3(by, by));
}

// The last items on this side of a plane, and on that; all that are left over are a run.
static uint32_t clip_last(cull_query *q, cull_batch *batch)
{
    const cull_zone *zone = q->culler->zone;
    const uint32_t wanted = (uint32_t)strtoul(q->culler->values[4], NULL, 10), group = group_size(q->culler);
    const uint32_t count = wanted < zone->item_count - group ? wanted : zone->item_count - group;
    q->clipped = (cull_run){zone->item_count - count, count};
    for (int side = 0; count && side < 2; ++side)
        batch->clipped[batch->clipped_count++] = (cull_clipped){
            .runs = &q->clipped, .box = zone->box, .planes = {{{side ? -1.0f : 1.0f, 0, 0}, 0}}, .run_count = 1, .plane_count = 1};
    return count;
}

static cull_progress select_items(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    const cull_zone *zone = q->culler->zone;
    const uint32_t group = group_size(q->culler), whole = zone->item_count - group - clip_last(q, batch);
    if (whole) batch->runs[batch->run_count++] = (cull_run){group, whole};
    if (group == 0) return CULL_DONE;
    q->group = (cull_run){0, group};
    const cull_box box = box_of_group(zone, group);
    if (!q->is_taken) try_capture(q, visit, &box, batch);
    const float moved = moved_since(q, visit);
    if ((batch->capture_count || (q->is_taken && visit->slots[0])) && moved < strtof(q->culler->values[0], NULL))
        batch->pictures[batch->picture_count++] =
            (cull_picture){.runs = &q->group, .run_count = 1, .box = box, .slot = 0, .error_px = moved * visit->view->pixels_per_tangent};
    else batch->runs[batch->run_count++] = q->group;
    return CULL_DONE;
}

static const void *get_extension(const cull_culler *c, const char *id)
{
    return strcmp(id, CULL_EXT_HIERARCHY) == 0 ? c->lent : NULL;
}

static const cull_option options[OPTION_COUNT] = {
    {"distance", "0.5", NULL, "metres that the eye may move from where the picture was taken"},
    {"items", "0", NULL, "how many items stand in the picture, 0: half of them"},
    {"pixels", "256", NULL, "width and height of the picture"},
    {"hierarchy", "0", NULL, "1 lends one of a single node"},
    {"clip", "0", NULL, "how many of the last items are given in two parts, clipped"},
};
static const cull_descriptor descriptor = {"testpicture", "1", "shows a picture instead of the first items", options, OPTION_COUNT, 0};
static const cull_plugin plugin = {.descriptor = &descriptor,
                                   .create = shell_create,
                                   .destroy = destroy,
                                   .build = build,
                                   .open = shell_open,
                                   .close = shell_close,
                                   .select = select_items,
                                   .get_extension = get_extension};
static const cull_plugin *const plugins[] = {&plugin};
CULL_ENTRY = {CULL_ABI, 1, plugins};
