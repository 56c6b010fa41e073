// The application's API, questions: what is in a scene, and where. See api/portcullis/scene.h.
// SPDX-License-Identifier: MIT
#include "library.h"

#include <portcullis/box.h>

#include <string.h>

cull_result cull_scene_describe(const cull_scene *s, cull_scene_info *out)
{
    if (out->struct_size != sizeof *out)
        return library_refuse(s, CULL_ERR_OPTION, "cull_scene_info: struct_size %u is not %zu; build against this library's scene.h",
                              out->struct_size, sizeof *out);
    const scene *sc = s->scene;
    const cull_box b = sc->whole.box;
    const float low[3] = {b.min.x, b.min.y, b.min.z}, high[3] = {b.max.x, b.max.y, b.max.z};
    out->zone_count = sc->zone_count;
    out->portal_count = sc->portal_count;
    out->door_count = sc->door_count;
    out->item_count = sc->item_count;
    out->mover_count = sc->mover_count;
    out->mover_capacity = sc->mover_count + s->options.more_movers;
    for (int k = 0; k < 3; ++k) {
        out->min[k] = sc->whole.origin[k] + (double)low[k];
        out->max[k] = sc->whole.origin[k] + (double)high[k];
    }
    return CULL_OK;
}

const char *cull_scene_zone_name(const cull_scene *s, uint32_t zone)
{
    return zone < s->scene->zone_count ? s->scene->zones[zone].name : NULL;
}

const char *cull_scene_door_name(const cull_scene *s, uint32_t door)
{
    return door < s->scene->door_count ? s->scene->doors[door].name : NULL;
}

uint32_t cull_scene_find_zone(const cull_scene *s, const char *name)
{
    for (uint32_t z = 0; z < s->scene->zone_count; ++z)
        if (strcmp(s->scene->zones[z].name, name) == 0) return z;
    return UINT32_MAX;
}

uint32_t cull_scene_find_door(const cull_scene *s, const char *name)
{
    for (uint32_t d = 0; d < s->scene->door_count; ++d)
        if (strcmp(s->scene->doors[d].name, name) == 0) return d;
    return UINT32_MAX;
}

uint32_t cull_scene_zones_at(const cull_scene *s, const double point[3], uint32_t *zones, uint32_t capacity)
{
    return graph_zones_at(world_graph(s->world), point, 0, zones, capacity);
}

uint32_t cull_scene_zones_of_box(const cull_scene *s, const double min[3], const double max[3], uint32_t *zones, uint32_t capacity)
{
    return graph_zones_of_box(world_graph(s->world), min, max, zones, capacity);
}

uint32_t cull_scene_zone_item_count(const cull_scene *s, uint32_t zone)
{
    return zone < s->scene->zone_count ? s->scene->zones[zone].item_count : 0;
}

void cull_scene_order(const cull_scene *s, uint32_t zone, uint32_t *items)
{
    if (zone < s->scene->zone_count) world_order(s->world, zone, items);
}

cull_result cull_scene_item_get(const cull_scene *s, uint32_t item, cull_scene_item *out)
{
    const scene *sc = s->scene;
    if (out->struct_size != sizeof *out || out->reserved)
        return library_refuse(s, CULL_ERR_OPTION,
                              "cull_scene_item: struct_size %u is not %zu, or reserved is not 0; build against this library's scene.h",
                              out->struct_size, sizeof *out);
    if (item >= sc->item_count) return library_refuse(s, CULL_ERR_ZONE, "item %u: the scene has %u, counted from 0", item, sc->item_count);
    const cull_box b = cull_box_at(&sc->boxes, item);
    const float low[3] = {b.min.x, b.min.y, b.min.z}, high[3] = {b.max.x, b.max.y, b.max.z};
    *out = (cull_scene_item){.struct_size = sizeof *out,
                             .polygon_count = sc->items[item].polygon_count,
                             .triangle_count = sc->items[item].index_count / 3,
                             .flags = sc->items[item].flags,
                             .object = sc->items[item].object,
                             .material = sc->materials[sc->items[item].material].name};
    for (int k = 0; k < 3; ++k) {
        out->min[k] = sc->whole.origin[k] + (double)low[k];
        out->max[k] = sc->whole.origin[k] + (double)high[k];
    }
    return CULL_OK;
}
