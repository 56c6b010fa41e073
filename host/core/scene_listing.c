// Scene builder, the end: which zones list which item.
// SPDX-License-Identifier: MIT
// Invariant: an item is listed in every zone that its box touches, but in none with a zone in it that holds the box wholly:
// of a chain of such zones the innermost lists it. What touches no zone goes to the stray one, so nothing is ever lost.
// An item that was given its zones is listed there alone.
#include "box_tree.h"
#include "scene_finish.h"
#include "zone_seam.h"

#include <portcullis/box.h>

#include <math.h>
#include <string.h>

static const double BOUNDS_ERROR = 1e-8; // of a hull's size: hull_fault's bounds are good to a tenth of it

typedef enum fit { FIT_OUTSIDE, FIT_TOUCHES, FIT_HELD } fit;
typedef struct listing_pair { uint32_t zone, item; } listing_pair;

typedef struct listing {
    scene *s;
    const allocator *memory;
    tree_box *bounds;          // of hulls, relative to the scene's origin
    scene_solid_plane *planes; // the same
    uint32_t *touched, *taken; // by zone: 1 + the item last seen so
    uint32_t *found;           // zones that the item touches
    zone_seam *seams;          // by zone
    const builder_own_zone *own, *own_end; // of the next item that was given its zones, from there on
    uint32_t everywhere, found_count;
    box_tree tree;
    buffer pairs; // listing_pair, by item
} listing;

static tree_box box_of_item(const scene *s, uint32_t item)
{
    const cull_box b = cull_box_at(&s->boxes, item);
    return (tree_box){{(double)b.min.x, (double)b.min.y, (double)b.min.z}, {(double)b.max.x, (double)b.max.y, (double)b.max.z}};
}

static fit fit_of(const listing *l, uint32_t hull, const tree_box *box)
{
    const scene_hull *h = &l->s->hulls[hull];
    const double touch = l->seams[h->zone].touch, hold = l->seams[h->zone].hold;
    fit best = FIT_HELD;
    for (uint32_t p = h->first_plane; p < h->first_plane + h->plane_count; ++p) {
        const double *n = l->planes[p].normal;
        double least = -l->planes[p].distance, most = least;
        for (int k = 0; k < 3; ++k) {
            const double a = n[k] * box->min[k], b = n[k] * box->max[k];
            least += a < b ? a : b;
            most += a < b ? b : a;
        }
        if (least > touch) return FIT_OUTSIDE;
        if (most >= -hold) best = FIT_TOUCHES;
    }
    return best;
}

static void find_zones(listing *l, uint32_t item)
{
    const tree_box box = box_of_item(l->s, item);
    const uint32_t stamp = item + 1;
    box_walk walk;
    uint32_t hull;
    box_walk_start(&walk, &l->tree, &box);
    while (box_walk_next(&walk, &hull)) {
        const fit how = fit_of(l, hull, &box);
        if (how == FIT_OUTSIDE) continue;
        const uint32_t zone = l->s->hulls[hull].zone, parent = l->s->zones[zone].parent;
        if (l->touched[zone] != stamp) l->found[l->found_count++] = zone;
        l->touched[zone] = stamp;
        if (how == FIT_HELD && parent != SCENE_NONE) l->taken[parent] = stamp;
    }
    if (l->everywhere != SCENE_NONE) l->found[l->found_count++] = l->everywhere;
}

static result list_item(listing *l, uint32_t item)
{
    scene *s = l->s;
    uint32_t kept = 0;
    l->found_count = 0;
    for (; l->own < l->own_end && l->own->item == item; ++l->own) l->found[l->found_count++] = l->own->zone;
    if (l->found_count == 0) find_zones(l, item);
    if (l->found_count == 0) {
        l->found[l->found_count++] = s->zone_count; // the stray one
        s->stray_items++;
    }
    for (uint32_t i = 0; i < l->found_count; ++i) {
        const uint32_t zone = l->found[i];
        if (l->taken[zone] == item + 1) continue;
        const listing_pair pair = {zone, item};
        if (!buffer_append(&l->pairs, &pair, 1)) return RESULT_NO_MEMORY;
        s->zones[zone].item_count++;
        ++kept;
    }
    s->listings[item] = (uint8_t)(kept < 255 ? kept : 255);
    return RESULT_OK;
}

static result listing_open(listing *l)
{
    const scene *s = l->s;
    const size_t zones = (size_t)s->zone_count + 1;
    l->bounds = memory_alloc(l->memory, s->hull_count, sizeof *l->bounds);
    l->planes = memory_alloc(l->memory, s->hull_plane_count, sizeof *l->planes);
    l->touched = memory_alloc_zeroed(l->memory, zones, sizeof *l->touched);
    l->taken = memory_alloc_zeroed(l->memory, zones, sizeof *l->taken);
    l->found = memory_alloc(l->memory, zones, sizeof *l->found);
    l->seams = memory_alloc(l->memory, zones, sizeof *l->seams);
    if (!l->bounds || !l->planes || !l->touched || !l->taken || !l->found || !l->seams) return RESULT_NO_MEMORY;
    zone_seams_find(s, l->seams);
    const double *origin = s->whole.origin;
    for (uint32_t p = 0; p < s->hull_plane_count; ++p) {
        const double *n = s->hull_planes[p].normal;
        l->planes[p] = s->hull_planes[p];
        l->planes[p].distance -= (n[0] * origin[0] + n[1] * origin[1]) + n[2] * origin[2];
    }
    for (uint32_t h = 0; h < s->hull_count; ++h)
        for (int k = 0; k < 3; ++k) {
            const double slack = l->seams[s->hulls[h].zone].touch + BOUNDS_ERROR * (s->hulls[h].max[k] - s->hulls[h].min[k]);
            l->bounds[h].min[k] = s->hulls[h].min[k] - origin[k] - slack;
            l->bounds[h].max[k] = s->hulls[h].max[k] - origin[k] + slack;
        }
    return box_tree_open(l->bounds, s->hull_count, l->memory, &l->tree);
}

static void listing_close(listing *l)
{
    const size_t zones = (size_t)l->s->zone_count + 1;
    box_tree_close(&l->tree, l->memory);
    memory_free(l->memory, l->bounds, l->s->hull_count, sizeof *l->bounds);
    memory_free(l->memory, l->planes, l->s->hull_plane_count, sizeof *l->planes);
    memory_free(l->memory, l->touched, zones, sizeof *l->touched);
    memory_free(l->memory, l->taken, zones, sizeof *l->taken);
    memory_free(l->memory, l->found, zones, sizeof *l->found);
    memory_free(l->memory, l->seams, zones, sizeof *l->seams);
    buffer_free(&l->pairs);
}

// The pairs come by item, so each zone's items stand in ascending order.
static void sort_pairs(finish *f, const listing *l)
{
    scene *s = f->s;
    const listing_pair *pairs = l->pairs.items;
    uint32_t first = 0;
    s->zone_item_count = (uint32_t)l->pairs.count;
    s->zone_items = finish_take(f, s->zone_item_count, sizeof *s->zone_items);
    if (f->failed) return;
    for (uint32_t z = 0; z <= s->zone_count; ++z) {
        s->zones[z].first_item = first;
        first += s->zones[z].item_count;
        s->zones[z].item_count = 0;
    }
    for (size_t i = 0; i < l->pairs.count; ++i) {
        scene_zone *zone = &s->zones[pairs[i].zone];
        s->zone_items[zone->first_item + zone->item_count++] = pairs[i].item;
    }
}

static result list_all(finish *f, listing *l)
{
    if (listing_open(l) != RESULT_OK) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < f->s->item_count; ++i) {
        const result done = list_item(l, i);
        if (done != RESULT_OK) return done;
        if (l->pairs.count > UINT32_MAX) return RESULT_BAD_INPUT;
    }
    sort_pairs(f, l);
    return f->failed ? RESULT_NO_MEMORY : RESULT_OK;
}

// One zone takes all, as most scenes have it.
static result list_plain(finish *f)
{
    scene *s = f->s;
    s->zone_items = finish_take(f, s->item_count, sizeof *s->zone_items);
    if (f->failed) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < s->item_count; ++i) s->zone_items[i] = i;
    memset(s->listings, 1, s->item_count);
    s->zone_item_count = s->zones[0].item_count = s->item_count;
    return RESULT_OK;
}

result finish_listings(finish *f, const char *path, report *r)
{
    scene *s = f->s;
    result done = RESULT_NO_MEMORY;
    s->listings = finish_take(f, s->item_count, sizeof *s->listings);
    if (f->failed) return report_no_memory(r, path);
    s->zones[s->zone_count] = (scene_zone){.name = "(stray)", .flags = ZONE_STRAY, .parent = SCENE_NONE};
    s->zones[s->zone_count].first_hull = s->hull_count;
    s->zones[s->zone_count].first_portal = 2 * s->portal_count;
    if (s->zone_count == 1 && s->zones[0].flags & ZONE_EVERYWHERE) {
        done = list_plain(f);
    } else {
        const buffer *own = &f->b->own_zones;
        listing l = {.s = s, .memory = f->b->memory, .everywhere = f->b->everywhere, .pairs = buffer_make(f->b->memory, sizeof(listing_pair))};
        l.own = own->items;
        l.own_end = l.own ? l.own + own->count : NULL;
        done = list_all(f, &l);
        listing_close(&l);
    }
    if (done == RESULT_BAD_INPUT) return report_error(r, path, 0, "over 2^32 items in all zones together; make the zones overlap less");
    if (done != RESULT_OK) return report_no_memory(r, path);
    s->zone_count += s->stray_items != 0;
    return RESULT_OK;
}
