// Baked indices: keys, and looking for them.
// SPDX-License-Identifier: MIT
#include "bake.h"

#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

static uint64_t add(uint64_t hash, const void *bytes, size_t size)
{
    return size ? XXH3_64bits_withSeed(bytes, size, hash) : hash;
}

uint64_t bake_options_hash(const cull_descriptor *d, const char *const *values)
{
    uint64_t hash = d->option_count;
    for (uint32_t i = 0; i < d->option_count; ++i) { // with their closing zeros, so that no two lists run together
        hash = add(hash, d->options[i].key, strlen(d->options[i].key) + 1);
        hash = add(hash, values[i], strlen(values[i]) + 1);
    }
    return hash;
}

static uint64_t add_portal(uint64_t hash, const cull_portal *p)
{
    hash = add(hash, &p->plane, sizeof p->plane);
    hash = add(hash, &p->point_count, sizeof p->point_count);
    return add(hash, p->points, p->point_count * sizeof *p->points);
}

static uint64_t add_hierarchy(uint64_t hash, const cull_hierarchy *h)
{
    const uint32_t numbers[] = {h->node_count, h->item_count, h->depth, h->items != NULL};
    hash = add(hash, numbers, sizeof numbers);
    hash = add(hash, h->nodes, h->node_count * sizeof *h->nodes);
    return h->items ? add(hash, h->items, h->item_count * sizeof *h->items) : hash;
}

uint64_t bake_zone_hash(const cull_zone *z, const cull_hierarchy *lent)
{
    const uint32_t numbers[] = {z->item_count, z->position_count, z->index_count, z->wall_vertex_count, z->plane_count, z->portal_count,
                                z->walls != NULL, z->exact_planes != NULL};
    const float *const axes[6] = {z->boxes.min_x, z->boxes.min_y, z->boxes.min_z, z->boxes.max_x, z->boxes.max_y, z->boxes.max_z};
    uint64_t hash = XXH3_64bits(numbers, sizeof numbers);
    hash = add(hash, &z->box, sizeof z->box);
    hash = add(hash, &z->radius, sizeof z->radius);
    hash = add(hash, &z->grid_steps_per_metre, sizeof z->grid_steps_per_metre);
    hash = add(hash, z->items, z->item_count * sizeof *z->items);
    for (int k = 0; k < 6; ++k) hash = add(hash, axes[k], z->item_count * sizeof(float));
    hash = add(hash, z->positions, z->position_count * sizeof *z->positions);
    hash = add(hash, z->indices, z->index_count * sizeof *z->indices);
    if (z->walls) hash = add(hash, z->walls, z->item_count * sizeof *z->walls);
    hash = add(hash, z->wall_vertices, z->wall_vertex_count * sizeof *z->wall_vertices);
    hash = add(hash, z->planes, z->plane_count * sizeof *z->planes);
    if (z->exact_planes) hash = add(hash, z->exact_planes, z->plane_count * sizeof *z->exact_planes);
    for (uint32_t p = 0; p < z->portal_count; ++p) hash = add_portal(hash, &z->portals[p]);
    return lent ? add_hierarchy(hash, lent) : hash;
}

static uint32_t first_of_zone(const scene *s, uint32_t zone)
{
    uint32_t low = 0, high = s->bake_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (s->bakes[middle].zone < zone) low = middle + 1;
        else high = middle;
    }
    return low;
}

const scene_bake *bake_find(const scene *s, const bake_key *key)
{
    for (uint32_t i = first_of_zone(s, key->zone); i < s->bake_count && s->bakes[i].zone == key->zone; ++i) {
        const scene_bake *b = &s->bakes[i];
        if (b->options_hash != key->options_hash || b->zone_hash != key->zone_hash) continue;
        if (strcmp(b->id, key->descriptor->id) == 0 && strcmp(b->version, key->descriptor->version) == 0) return b;
    }
    return NULL;
}

const char *bake_fault(const scene *s, const bake_key *key)
{
    for (uint32_t i = first_of_zone(s, key->zone); i < s->bake_count && s->bakes[i].zone == key->zone; ++i) {
        const scene_bake *b = &s->bakes[i];
        if (b->options_hash != key->options_hash || strcmp(b->id, key->descriptor->id) != 0) continue;
        return strcmp(b->version, key->descriptor->version) != 0 ? "another version of it made it" : "it is of other geometry, or of another chain";
    }
    return NULL;
}
