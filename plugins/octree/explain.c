// Why an item is kept or dropped: see explain.h.
// SPDX-License-Identifier: MIT
#include "explain.h"

#include <portcullis/face.h>
#include <portcullis/plane.h>

#include <stdio.h>

static int shows_only_its_back(const explain_source *from, const cull_view *view, uint32_t place)
{
    if (from->backs == EXPLAIN_BACKS_KEPT || !from->zone->walls) return 0;
    const cull_face f = cull_face_of(from->zone, from->cells->order[place]);
    float reach = 0;
    for (int i = 0; i < 3; i++) reach = fmaxf(reach, fabsf(view->eye[i]));
    const float height = (f.normal[0] * view->eye[0] + f.normal[1] * view->eye[1]) + f.normal[2] * view->eye[2];
    return height + (f.offset * view->eye[3] + f.doubt * reach) < 0;
}

// The node that lists the item, and how far down it stands.
static uint32_t node_of(const octree_cells *cells, uint32_t place, uint32_t *depth)
{
    uint32_t n = 0;
    *depth = 0;
    for (;;) {
        const cull_node *node = &cells->nodes[n];
        if (place - node->first_item < node->item_count) return n;
        n = node->first_child;
        while (place - cells->nodes[n].subtree.first >= cells->nodes[n].subtree.count) n++;
        ++*depth;
    }
}

size_t explain_item(const explain_source *from, const cull_visit *visit, uint32_t place, char *text, size_t size)
{
    int length;
    if (place >= from->zone->item_count) {
        length = snprintf(text, size, "there is no item %u", (unsigned)place);
        return length < 0 ? 0 : (size_t)length;
    }
    uint32_t depth;
    const uint32_t node = node_of(from->cells, place, &depth);
    const cull_standing f = cull_standing_of(visit->volumes, visit->volume_count, cull_box_at(&from->zone->boxes, from->cells->order[place]));
    if (!visit->volume_count)
        length = snprintf(text, size, "dropped: nothing of the zone is seen");
    else if (!(f.height >= 0))
        length = snprintf(text, size, "dropped: its box lies %g m outside plane %u of volume %u, and outside every other volume", (double)-f.height,
                          (unsigned)f.plane, (unsigned)f.volume);
    else if (shows_only_its_back(from, visit->view, place))
        length = snprintf(text, size, "dropped: the wall shows only its back to the eye (backface=1)");
    else
        length = snprintf(text, size, "kept: no plane of volume %u has its box outside; it stands in node %u, %u below the root", (unsigned)f.volume,
                          (unsigned)node, (unsigned)depth);
    return length < 0 ? 0 : (size_t)length;
}
