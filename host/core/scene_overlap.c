// Scene builder, the end: warns of zones side by side that overlap, where both draw what is there, and of zones apart from their outer one.
// SPDX-License-Identifier: MIT
#include "box_tree.h"
#include "hull.h"
#include "scene_finish.h"

#include <math.h>
#include <string.h>

static const double DEPTH_LEAST = 0.01; // metres: walls that meet by hand-written numbers are no overlap
enum {
    WARNINGS_MOST = 8,
    WORK_MOST = 20000000, // planes squared, over all pairs: a second or two
};

typedef struct overlap {
    const scene *s;
    tree_box *bounds;
    box_tree tree;
    const char *path;
    report *report;
    uint32_t warned[WARNINGS_MOST][2];
    uint32_t warning_count;
    uint64_t work;
} overlap;

static int are_siblings(const scene *s, uint32_t a, uint32_t b)
{
    return a != b && s->zones[a].parent == s->zones[b].parent;
}

// A plane of `a` with the box of `b` beyond it, or nearly.
static int plane_divides(const scene *s, const scene_hull *a, const scene_hull *b)
{
    for (uint32_t p = a->first_plane; p < a->first_plane + a->plane_count; ++p) {
        const scene_solid_plane *plane = &s->hull_planes[p];
        double least = -plane->distance;
        for (int k = 0; k < 3; ++k) least += plane->normal[k] * (plane->normal[k] > 0 ? b->min[k] : b->max[k]);
        if (least > -DEPTH_LEAST) return 1;
    }
    return 0;
}

// What lies in both, both made thinner by half the depth on all sides, is a body.
static int is_deep(const scene *s, const scene_hull *a, const scene_hull *b)
{
    const scene_hull *const both[2] = {a, b};
    scene_solid_plane planes[2 * HULL_PLANES_MOST];
    uint32_t count = 0;
    double min[3], max[3];
    for (int h = 0; h < 2; ++h)
        for (uint32_t p = 0; p < both[h]->plane_count; ++p) {
            planes[count] = s->hull_planes[both[h]->first_plane + p];
            planes[count++].distance -= DEPTH_LEAST / 2;
        }
    return !hull_fault(planes, count, min, max);
}

static int is_new(const overlap *o, uint32_t a, uint32_t b)
{
    for (uint32_t i = 0; i < o->warning_count; ++i)
        if (o->warned[i][0] == a && o->warned[i][1] == b) return 0;
    return 1;
}

static void look_at_pair(overlap *o, const scene_hull *a, const scene_hull *b)
{
    const scene *s = o->s;
    const uint64_t planes = (uint64_t)a->plane_count + b->plane_count;
    if (!are_siblings(s, a->zone, b->zone) || plane_divides(s, a, b) || plane_divides(s, b, a)) return;
    o->work += planes * planes;
    if (o->work > WORK_MOST || !is_deep(s, a, b) || !is_new(o, a->zone, b->zone)) return;
    report_warning(o->report, o->path, 0, "the zones \"%s\" and \"%s\" overlap by over 1 cm; give each its own space, or put one in the other",
                   s->zones[a->zone].name, s->zones[b->zone].name);
    o->warned[o->warning_count][0] = a->zone;
    o->warned[o->warning_count++][1] = b->zone;
}

static void look_at_all(overlap *o)
{
    const scene *s = o->s;
    uint64_t pairs = 0;
    for (uint32_t h = 0; h < s->hull_count; ++h) {
        tree_box inner = o->bounds[h];
        for (int k = 0; k < 3; ++k) {
            inner.min[k] += DEPTH_LEAST;
            inner.max[k] -= DEPTH_LEAST;
        }
        box_walk walk;
        uint32_t other;
        box_walk_start(&walk, &o->tree, &inner);
        while (box_walk_next(&walk, &other)) {
            if (o->warning_count == WARNINGS_MOST || o->work > WORK_MOST || ++pairs > WORK_MOST) return;
            if (other > h) look_at_pair(o, &s->hulls[h], &s->hulls[other]);
        }
    }
}

static void tell_end(const overlap *o)
{
    if (o->warning_count == WARNINGS_MOST)
        report_warning(o->report, o->path, 0, "more zones may overlap; they are not looked for after %d", WARNINGS_MOST);
    else if (o->work > WORK_MOST)
        report_warning(o->report, o->path, 0, "not all zones were looked at for overlaps: too many lie near each other");
}

// ---- Zones in others ----

static void bounds_of(const scene *s, uint32_t zone, tree_box *out)
{
    const scene_zone *z = &s->zones[zone];
    for (int k = 0; k < 3; ++k) {
        out->min[k] = INFINITY;
        out->max[k] = -INFINITY;
        for (uint32_t h = z->first_hull; h < z->first_hull + z->hull_count; ++h) {
            out->min[k] = fmin(out->min[k], s->hulls[h].min[k]);
            out->max[k] = fmax(out->max[k], s->hulls[h].max[k]);
        }
    }
}

// By bounds: what is told is so, not all that is so is told.
static result tell_apart(const scene *s, const char *path, const allocator *memory, report *r)
{
    tree_box *bounds = memory_alloc(memory, s->zone_count, sizeof *bounds);
    if (!bounds) return RESULT_NO_MEMORY;
    for (uint32_t z = 0; z < s->zone_count; ++z) bounds_of(s, z, &bounds[z]);
    for (uint32_t z = 0; z < s->zone_count; ++z) {
        const uint32_t outer = s->zones[z].parent;
        if (outer == SCENE_NONE || !s->zones[outer].hull_count) continue;
        int apart = 0;
        for (int k = 0; k < 3; ++k)
            apart |= bounds[z].min[k] > bounds[outer].max[k] + DEPTH_LEAST || bounds[z].max[k] < bounds[outer].min[k] - DEPTH_LEAST;
        if (apart)
            report_warning(r, path, 0, "the zone \"%s\" is said to lie in \"%s\" but does not touch it; move it there, or take \"in\" out",
                           s->zones[z].name, s->zones[outer].name);
    }
    memory_free(memory, bounds, s->zone_count, sizeof *bounds);
    return RESULT_OK;
}

result finish_overlaps(finish *f, const char *path, report *r)
{
    const scene *s = f->s;
    if (s->hull_count < 2) return RESULT_OK;
    if (tell_apart(s, path, f->b->memory, r) != RESULT_OK) return report_no_memory(r, path);
    overlap o = {.s = s, .path = path, .report = r};
    o.bounds = memory_alloc(f->b->memory, s->hull_count, sizeof *o.bounds);
    if (!o.bounds) return report_no_memory(r, path);
    for (uint32_t h = 0; h < s->hull_count; ++h) {
        memcpy(o.bounds[h].min, s->hulls[h].min, sizeof s->hulls[h].min);
        memcpy(o.bounds[h].max, s->hulls[h].max, sizeof s->hulls[h].max);
    }
    const result done = box_tree_open(o.bounds, s->hull_count, f->b->memory, &o.tree);
    if (done == RESULT_OK) {
        look_at_all(&o);
        tell_end(&o);
        box_tree_close(&o.tree, f->b->memory);
    }
    memory_free(f->b->memory, o.bounds, s->hull_count, sizeof *o.bounds);
    return done == RESULT_OK ? RESULT_OK : report_no_memory(r, path);
}
