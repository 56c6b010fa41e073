// Why an item is kept or dropped: see explain.h.
// SPDX-License-Identifier: MIT
#include "explain.h"

#include <stdio.h>

typedef struct finding {
    clip_fate fate;
    uint32_t volume, plane;
} finding;

typedef struct explain_room {
    bsp_volume volume;
    cull_point points[];
} explain_room;

size_t explain_scratch(const bsp_shapes *shapes)
{
    return sizeof(explain_room) + 2 * clip_capacity(shapes->most_vertices) * sizeof(cull_point);
}

// Of the volumes the first that keeps it, else the last that comes nearest to it: only the planes together hold it off.
static finding judge_volumes(const explain_request *q, uint32_t item)
{
    explain_room *room = q->visit->scratch;
    const uint32_t capacity = clip_capacity(q->shapes->most_vertices);
    finding best = {CLIP_BEYOND, 0, 0};
    for (uint32_t v = 0; v < q->visit->volume_count && best.fate != CLIP_KEPT; v++) {
        volume_ready(&q->visit->volumes[v], &room->volume);
        const clip_request clip = {&room->volume, room->volume.all, {{room->points, room->points + capacity}, capacity}};
        uint32_t plane = 0;
        const clip_fate fate = clip_shape(&clip, shape_of_unit(q->shapes, q->shapes->firsts[item]), &plane);
        if (v == 0 || fate != CLIP_BEYOND) best = (finding){fate, v, plane};
    }
    return best;
}

static int say(const explain_request *q, const finding *f, uint32_t item, char *text, size_t size)
{
    const float *eye = q->visit->view->eye;
    const char *what = shape_of_unit(q->shapes, q->shapes->firsts[item])->head.kind == SHAPE_BOX ? "box" : "wall";
    if (!q->visit->volume_count) return snprintf(text, size, "dropped: nothing of the zone is seen");
    if (q->backface && shows_its_back(&q->shapes->faces[item], eye, eye_reach(eye)))
        return snprintf(text, size, "dropped: the wall shows only its back to the eye (backface=1)");
    if (f->fate == CLIP_BEYOND)
        return snprintf(text, size, "dropped: its %s lies outside plane %u of volume %u, and outside every other volume", what, (unsigned)f->plane,
                        (unsigned)f->volume);
    if (f->fate == CLIP_NOTHING)
        return snprintf(text, size, "dropped: the planes of volume %u together leave nothing of its wall; plane %u takes the last of it",
                        (unsigned)f->volume, (unsigned)f->plane);
    if (q->flow == EXPLAIN_UNREACHED)
        return snprintf(text, size, "dropped: its %s is inside volume %u, but is not seen through the openings between the zone's cells", what,
                        (unsigned)f->volume);
    if (q->flow == EXPLAIN_REACHED)
        return snprintf(text, size, "kept: its %s is inside volume %u and seen through openings between cells", what, (unsigned)f->volume);
    return snprintf(text, size, "kept: some of its %s is inside volume %u", what, (unsigned)f->volume);
}

size_t explain_item(const explain_request *q, uint32_t item, char *text, size_t size)
{
    int length;
    if (item >= q->shapes->item_count) {
        length = snprintf(text, size, "there is no item %u", (unsigned)item);
    } else {
        const finding f = judge_volumes(q, item);
        length = say(q, &f, item, text, size);
    }
    return length < 0 ? 0 : (size_t)length;
}
