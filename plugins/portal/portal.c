// The culler `portal`: decides what is seen through a zone's portals (Luebke and Georges, Portals and Mirrors, 1995). It crosses
// only; which items a volume touches is the select's business. See narrow.h for the ways to narrow.
// SPDX-License-Identifier: MIT
#include "narrow.h"

#include <stdio.h>
#include <string.h>

typedef enum clip_way { CLIP_EXACT, CLIP_OCTAGON, CLIP_RECT, CLIP_PLANES, CLIP_FLOOD, CLIP_COUNT } clip_way;
static const char *const clip_names[CLIP_COUNT] = {"exact", "octagon", "rect", "planes", "flood"};

struct cull_culler {
    const cull_host *host;
    const cull_zone *zone;
    clip_way clip;
};
struct cull_query { const cull_culler *culler; };

// ---- Life of a culler ----

static cull_result create(const cull_host *host, const char *const *values, cull_culler **out)
{
    clip_way clip = CLIP_EXACT;
    while (clip < CLIP_COUNT && strcmp(clip_names[clip], values[0]) != 0) clip++;
    if (clip == CLIP_COUNT) {
        char line[200];
        snprintf(line, sizeof line, "portal: clip=%.32s: must be exact, octagon, rect, planes or flood", values[0]);
        host->log(host, CULL_LOG_ERROR, line);
        return CULL_ERR_OPTION;
    }
    cull_culler *c = host->alloc(host, sizeof *c, _Alignof(cull_culler));
    if (!c) return CULL_ERR_MEMORY;
    *c = (cull_culler){.host = host, .clip = clip};
    *out = c;
    return CULL_OK;
}

static void destroy(cull_culler *c)
{
    c->host->free(c->host, c, sizeof *c);
}

static cull_result build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    (void)lent; // it looks at portals only
    c->zone = zone;
    out->index_bytes = sizeof *c;
    out->promises = CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS;
    out->max_steps = 1;
    return CULL_OK;
}

static cull_result open(const cull_culler *c, cull_query **out)
{
    cull_query *q = c->host->alloc(c->host, sizeof *q, _Alignof(cull_query));
    if (!q) return CULL_ERR_MEMORY;
    q->culler = c;
    *out = q;
    return CULL_OK;
}

static void close(cull_query *q)
{
    q->culler->host->free(q->culler->host, q, sizeof *q);
}

// ---- A crossing ----

// More planes than a volume holds: the octagon around what is left needs few, and loses little.
static int narrow_by(narrowing *n, clip_way clip)
{
    switch (clip) {
    case CLIP_EXACT: return narrow_exact(n) || narrow_window(n, 8);
    case CLIP_OCTAGON: return narrow_window(n, 8) || narrow_exact(n);
    case CLIP_RECT: return narrow_window(n, 4) || narrow_exact(n);
    case CLIP_PLANES: return narrow_planes(n) || narrow_window(n, 4);
    default: return 0;
    }
}

static cull_crossing cross(cull_query *q, const cull_view *view, const cull_volume *in, uint32_t portal, cull_plane *planes, uint32_t *plane_count)
{
    const cull_culler *c = q->culler;
    if (c->clip == CLIP_FLOOD) return CULL_CROSS_SAME;
    narrowing n;
    n.view = view;
    n.in = in;
    n.portal = &c->zone->portals[portal];
    n.planes = planes;
    n.guard.radius = (double)c->zone->radius;
    const narrow_verdict verdict = narrow_start(&n, c->clip == CLIP_PLANES ? NARROW_UNCUT : NARROW_CUT);
    if (verdict == NARROW_GONE) return CULL_CROSS_NONE;
    if (verdict == NARROW_WHOLE || !narrow_by(&n, c->clip)) return CULL_CROSS_SAME;
    *plane_count = n.plane_count;
    return CULL_CROSS_NARROW;
}

// ---- Tables ----

static const void *get_extension(const cull_culler *c, const char *id)
{
    (void)c;
    (void)id;
    return NULL;
}

static const cull_option options[] = {
    {"clip", "exact", "exact octagon rect planes flood",
     "how a volume narrows: to what is left of the portal exactly, its octagon or rectangle on the picture, by all planes unclipped, not at all"},
};
static const cull_descriptor descriptor = {"portal", "1", "narrows what is seen to the portals that it is seen through", options,
                                           sizeof options / sizeof *options, CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS};
static const cull_plugin plugin = {.descriptor = &descriptor, .create = create, .destroy = destroy, .build = build, .open = open,
                                   .close = close, .cross = cross, .get_extension = get_extension};
static const cull_plugin *const plugins[] = {&plugin};
CULL_ENTRY = {CULL_ABI, 1, plugins};
