// What a flow found, near to far; and why it did not cross a portal.
// SPDX-License-Identifier: MIT
// Invariant: a volume's parent is a living volume: where the one that it came from gave way, what took its place.
#include "flow_internal.h"

#include <math.h>
#include <string.h>

// Zones equally far stand by number: an order of its own, whatever the order they were found in.
static int is_after(const flow *f, uint64_t a, uint64_t b)
{
    const flow_zone *x = &f->found[a], *y = &f->found[b];
    return x->distance > y->distance || (x->distance == y->distance && x->zone > y->zone);
}

// Merge sort from short runs up, in memory that is there: the C library's may ask for some.
static const uint64_t *sort_near_to_far(flow *f)
{
    uint64_t *in = f->order[0], *out = f->order[1];
    const uint32_t count = f->found_count;
    for (uint32_t i = 0; i < count; i++) in[i] = i;
    for (uint64_t width = 1; width < count; width *= 2) {
        for (uint64_t first = 0; first < count; first += 2 * width) {
            const uint64_t middle = first + width < count ? first + width : count, end = middle + width < count ? middle + width : count;
            uint64_t a = first, b = middle;
            for (uint64_t i = first; i < end; i++) out[i] = a < middle && (b == end || !is_after(f, in[a], in[b])) ? in[a++] : in[b++];
        }
        uint64_t *swapped = in;
        in = out;
        out = swapped;
    }
    return in;
}

static float float_towards(float to, float f) // to: -1 or 1, the picture's border, which f is not beyond
{
    return f == to ? f : to * cull_float_above(to * f);
}

static void volume_write(flow *f, flow_node *n)
{
    n->place = f->result.volume_count++;
    f->by_zone[n->place] = n->place;
    flow_volume *v = &f->volumes[n->place];
    *v = (flow_volume){.volume = {n->planes, n->plane_count, n->entry}, .zone = n->zone, .way = n->way, .parent = n->parent,
                       .is_merged = (n->flags & NODE_MERGED) != 0};
    for (int k = 0; k < 2; k++) { // outward to float, and never beyond the picture
        v->rectangle[k] = float_towards(-1, (float)n->rectangle.low[k]);
        v->rectangle[2 + k] = float_towards(1, (float)n->rectangle.high[k]);
    }
}

static void zone_write(flow *f, flow_zone *z)
{
    const flow_state *s = &f->states[z->zone];
    z->first = f->result.volume_count;
    z->count = s->count;
    for (uint32_t i = 0; i < s->count; i++) volume_write(f, &f->nodes[s->nodes[i]]);
}

// One that gave way has no place: the zone's only volume took it.
static void parents_link(flow *f)
{
    for (uint32_t i = 0; i < f->result.volume_count; i++) {
        flow_volume *v = &f->volumes[i];
        if (v->parent == SCENE_NONE) continue;
        const flow_node *parent = &f->nodes[v->parent];
        v->parent = parent->flags & NODE_DEAD ? f->nodes[f->states[parent->zone].nodes[0]].place : parent->place;
    }
}

// Zones are mostly reached near to far: then they stay where they are.
static flow_zone *zones_sort(flow *f)
{
    uint32_t i = 1;
    while (i < f->found_count && is_after(f, i, i - 1)) i++;
    if (i >= f->found_count) return f->found;
    const uint64_t *order = sort_near_to_far(f);
    for (i = 0; i < f->found_count; i++) f->sorted[i] = f->found[order[i]];
    return f->sorted;
}

void flow_finish(flow *f, flow_result *out)
{
    for (uint32_t i = 0; i < f->found_count; i++) f->found[i].distance = f->states[f->found[i].zone].key;
    flow_zone *zones = zones_sort(f);
    for (uint32_t i = 0; i < f->found_count; i++) zone_write(f, &zones[i]);
    parents_link(f);
    f->result.zones = zones;
    f->result.volumes = f->volumes;
    f->result.by_zone = f->by_zone;
    f->result.zone_count = f->found_count;
    *out = f->result;
}

flow_fate flow_fate_of(const flow *f, const flow_request *q, uint32_t way)
{
    const scene_portal *p = &f->scene->portals[way / 2];
    const uint32_t zone = p->zones[way % 2];
    const flow_state *s = &f->states[zone];
    if (!(s->flags & STATE_REACHED)) return FLOW_UNREACHED;
    if (!q->open[way / 2]) return FLOW_SHUT;
    if (f->ways[way] != 0) return f->ways[way] == WAY_CROSSED ? FLOW_CROSSED : FLOW_OUTSIDE;
    if (flow_eye_height(f, way) < -flow_near_m(f, zone, way / 2)) return FLOW_BEHIND;
    for (uint32_t i = 0; i < s->count; i++)
        if (flow_touches(f, &f->nodes[s->nodes[i]], way)) return FLOW_CROSSED; // not needed: the zone behind had all
    return FLOW_OUTSIDE;
}
