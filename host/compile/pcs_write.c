// The scene file out: records of what has names or padding, the arrays as they are, all laid out by their counts.
// SPDX-License-Identifier: MIT
// Invariant: every byte is written on purpose: the file starts as zeros, and no record has padding (import/pcs.c asserts it).
#include "pcs_write.h"

#include "../core/file.h"
#include "../import/pcs.h"

#include <string.h>

typedef struct writing {
    const scene *s;
    const pcs_request *q;
    arena records;
    buffer text;
    const void *items[PCS_SECTION_COUNT]; // what is copied; of those that are not, NULL
    uint64_t copied[PCS_SECTION_COUNT];   // items of it
    pcs_counts counts;
    int failed; // out of memory
} writing;

static void put(writing *w, pcs_id id, const void *items, uint64_t count)
{
    w->items[id] = items;
    w->copied[id] = w->counts.of[id] = items ? count : 0;
}

static void *put_records(writing *w, pcs_id id, uint64_t count)
{
    void *records = w->failed ? NULL : arena_push(&w->records, (size_t)count, pcs_item_bytes[id]);
    if (!records) {
        w->failed = 1;
        return NULL;
    }
    memset(records, 0, (size_t)count * pcs_item_bytes[id]);
    put(w, id, records, count);
    return records;
}

static uint32_t put_text(writing *w, const char *text)
{
    const size_t place = w->text.count;
    if (!text) return PCS_NO_TEXT;
    if (!buffer_append(&w->text, text, strlen(text) + 1)) w->failed = 1;
    return (uint32_t)place; // over 2^32 of them are refused before the file is made
}

// ---- Records ----

static void put_scene(writing *w)
{
    const scene *s = w->s;
    const cull_box *b = &s->whole.box;
    pcs_scene *to = put_records(w, PCS_SCENE, 1);
    if (!to) return;
    *to = (pcs_scene){.hash = s->hash,
                      .step = s->step,
                      .grid_steps_per_metre = s->grid_steps_per_metre,
                      .origin = {s->whole.origin[0], s->whole.origin[1], s->whole.origin[2]},
                      .box = {b->min.x, b->min.y, b->min.z, b->max.x, b->max.y, b->max.z},
                      .radius = s->whole.radius,
                      .is_map = s->is_map,
                      .flat_triangles = s->flat_triangles,
                      .stray_items = s->stray_items};
}

static void put_names(writing *w)
{
    const scene *s = w->s;
    pcs_material *materials = put_records(w, PCS_MATERIALS, s->material_count);
    pcs_object *objects = put_records(w, PCS_OBJECTS, s->object_count);
    pcs_path *paths = put_records(w, PCS_PATHS, s->path_count);
    if (w->failed) return;
    for (uint32_t i = 0; i < s->material_count; ++i) materials[i] = (pcs_material){put_text(w, s->materials[i].name), s->materials[i].flags, s->materials[i].colour};
    for (uint32_t i = 0; i < s->object_count; ++i) objects[i] = (pcs_object){put_text(w, s->objects[i].name), s->objects[i].first_item, s->objects[i].item_count};
    for (uint32_t i = 0; i < s->path_count; ++i) paths[i] = (pcs_path){put_text(w, s->paths[i].name), s->paths[i].first_camera, s->paths[i].camera_count};
}

static void put_movers(writing *w)
{
    const scene *s = w->s;
    pcs_mover *movers = put_records(w, PCS_MOVERS, s->mover_count);
    pcs_door *doors = put_records(w, PCS_DOORS, s->door_count);
    if (w->failed) return;
    for (uint32_t i = 0; i < s->mover_count; ++i) {
        const scene_mover *from = &s->movers[i];
        pcs_mover *to = &movers[i];
        memcpy(to->open_offset, from->open_offset, sizeof to->open_offset);
        memcpy(to->pivot, from->pivot, sizeof to->pivot);
        memcpy(to->axes, from->axes, sizeof to->axes);
        to->name = put_text(w, from->name);
        to->first_key = from->first_key;
        to->key_count = from->key_count;
        to->door = from->door;
        to->loops = from->loops;
    }
    for (uint32_t i = 0; i < s->door_count; ++i) doors[i] = (pcs_door){put_text(w, s->doors[i].name), (uint32_t)s->doors[i].at_rest, s->doors[i].mover};
}

static void put_surroundings(writing *w)
{
    const scene *s = w->s;
    pcs_place *places = put_records(w, PCS_PLACES, s->place_count);
    pcs_solid *solids = put_records(w, PCS_SOLIDS, s->solid_count);
    pcs_light *lights = put_records(w, PCS_LIGHTS, s->light_count);
    if (w->failed) return;
    for (uint32_t i = 0; i < s->place_count; ++i) {
        memcpy(places[i].position, s->places[i].position, sizeof places[i].position);
        places[i].kind = (uint32_t)s->places[i].kind;
    }
    for (uint32_t i = 0; i < s->solid_count; ++i) {
        const scene_solid *from = &s->solids[i];
        memcpy(solids[i].min, from->min, sizeof from->min);
        memcpy(solids[i].max, from->max, sizeof from->max);
        solids[i].first_plane = from->first_plane;
        solids[i].plane_count = from->plane_count;
        solids[i].kind = (uint32_t)from->kind;
    }
    for (uint32_t i = 0; i < s->light_count; ++i) {
        const scene_light *from = &s->lights[i];
        memcpy(lights[i].position, from->position, sizeof from->position);
        memcpy(lights[i].direction, from->direction, sizeof from->direction);
        memcpy(lights[i].colour, from->colour, sizeof from->colour);
        lights[i].reach = from->reach;
        lights[i].name = put_text(w, from->name);
        lights[i].kind = (uint32_t)from->kind;
    }
}

static void put_zones(writing *w)
{
    const scene *s = w->s;
    pcs_zone *zones = put_records(w, PCS_ZONES, s->zone_count);
    pcs_hull *hulls = put_records(w, PCS_HULLS, s->hull_count);
    pcs_portal *portals = put_records(w, PCS_PORTALS, s->portal_count);
    if (w->failed) return;
    for (uint32_t i = 0; i < s->zone_count; ++i) {
        const scene_zone *z = &s->zones[i];
        const uint32_t name = put_text(w, z->name), chain = put_text(w, z->chain);
        zones[i] = (pcs_zone){{z->origin[0], z->origin[1], z->origin[2]}, name, chain, z->flags, z->parent,
                              z->first_hull, z->hull_count, z->first_item, z->item_count, z->first_portal, z->portal_count};
    }
    for (uint32_t i = 0; i < s->hull_count; ++i) {
        const scene_hull *from = &s->hulls[i];
        memcpy(hulls[i].min, from->min, sizeof from->min);
        memcpy(hulls[i].max, from->max, sizeof from->max);
        hulls[i].zone = from->zone;
        hulls[i].first_plane = from->first_plane;
        hulls[i].plane_count = from->plane_count;
    }
    for (uint32_t i = 0; i < s->portal_count; ++i) {
        const scene_portal *p = &s->portals[i];
        const uint32_t name = put_text(w, p->name);
        portals[i] = (pcs_portal){{p->plane[0], p->plane[1], p->plane[2], p->plane[3]}, name, {p->zones[0], p->zones[1]}, p->first_point, p->point_count, p->door};
    }
}

static void put_bakes(writing *w)
{
    pcs_bake *bakes = put_records(w, PCS_BAKES, w->q->bake_count);
    uint64_t end = 0;
    for (uint32_t i = 0; i < w->q->bake_count && !w->failed; ++i) {
        const scene_bake *from = &w->q->bakes[i];
        const uint32_t id = put_text(w, from->id), version = put_text(w, from->version);
        bakes[i] = (pcs_bake){.offset = end, .size = from->size, .options_hash = from->options_hash, .zone_hash = from->zone_hash,
                              .zone = from->zone, .id = id, .version = version};
        if (from->size > PCS_BYTES_MOST - end) end = PCS_BYTES_MOST + 1; // too large, which the layout says
        else end += (from->size + PCS_ALIGN - 1) / PCS_ALIGN * PCS_ALIGN;
        if (end > PCS_BYTES_MOST) break;
    }
    w->counts.of[PCS_BLOBS] = end;
}

// ---- Arrays that are written as they are ----

static void put_arrays(writing *w)
{
    const scene *s = w->s;
    const uint64_t items = (uint64_t)s->item_count + s->mover_count;
    const float *const axes[6] = {s->boxes.min_x, s->boxes.min_y, s->boxes.min_z, s->boxes.max_x, s->boxes.max_y, s->boxes.max_z};
    put(w, PCS_POSITIONS, s->positions, s->position_count);
    put(w, PCS_NORMALS, s->normals, s->position_count);
    put(w, PCS_TEXCOORDS, s->texcoords, 2 * (uint64_t)s->position_count);
    put(w, PCS_TANGENTS, s->tangents, s->tangent_count);
    put(w, PCS_VERTEX_MATERIALS, s->vertex_materials, s->position_count);
    put(w, PCS_INDICES, s->indices, s->index_count);
    put(w, PCS_POLYGON_FIRST_TRIANGLE, s->polygon_first_triangle, (uint64_t)s->polygon_count + 1);
    put(w, PCS_ITEMS, s->items, items);
    for (int k = 0; k < 6; ++k) {
        put(w, (pcs_id)(PCS_MIN_X + k), axes[k], items);
        w->counts.of[PCS_MIN_X + k] += CULL_PADDING;
    }
    put(w, PCS_WALLS, s->walls, s->item_count);
    put(w, PCS_WALL_VERTICES, s->wall_vertices, s->wall_vertex_count);
    put(w, PCS_PLANES, s->planes, s->plane_count);
    put(w, PCS_EXACT_PLANES, s->exact_planes, s->plane_count);
    put(w, PCS_KEYS, s->keys, s->key_count);
    put(w, PCS_SOLID_PLANES, s->solid_planes, s->solid_plane_count);
    put(w, PCS_HULL_PLANES, s->hull_planes, s->hull_plane_count);
    put(w, PCS_ZONE_ITEMS, s->zone_items, s->zone_item_count);
    put(w, PCS_LISTINGS, s->listings, s->item_count);
    put(w, PCS_PORTAL_POINTS, s->portal_points, s->portal_point_count);
    put(w, PCS_ZONE_PORTALS, s->zone_portals, 2 * (uint64_t)s->portal_count);
    put(w, PCS_CAMERAS, s->cameras, s->camera_count);
}

// ---- The file ----

static void fill(const writing *w, const uint64_t offsets[PCS_SECTION_COUNT], char *file, uint64_t size)
{
    pcs_header head = {.magic = {0}, .version = PCS_VERSION, .section_count = PCS_SECTION_COUNT, .file_bytes = size};
    memcpy(head.magic, PCS_MAGIC, sizeof head.magic);
    memset(file, 0, (size_t)size);
    for (uint32_t i = 0; i < PCS_SECTION_COUNT; ++i) {
        const pcs_section row = {i, pcs_item_bytes[i], offsets[i], w->counts.of[i], 0};
        memcpy(file + sizeof head + i * sizeof row, &row, sizeof row);
        if (w->copied[i]) memcpy(file + offsets[i], w->items[i], (size_t)w->copied[i] * pcs_item_bytes[i]);
    }
    const pcs_bake *bakes = w->items[PCS_BAKES];
    for (uint32_t i = 0; i < w->q->bake_count; ++i) memcpy(file + offsets[PCS_BLOBS] + bakes[i].offset, w->q->bakes[i].bytes, (size_t)bakes[i].size);
    memcpy(file, &head, sizeof head);
    head.hash = pcs_hash(file, size);
    memcpy(file, &head, sizeof head);
}

static result encode(writing *w, const char *path, const allocator *memory, report *r, void **out_bytes, size_t *out_size)
{
    uint64_t offsets[PCS_SECTION_COUNT];
    if (!buffer_append(&w->text, "", 1)) w->failed = 1;
    put_scene(w);
    put_names(w);
    put_movers(w);
    put_surroundings(w);
    put_zones(w);
    put_bakes(w);
    put_arrays(w);
    put(w, PCS_TEXT, w->text.items, w->text.count);
    const uint64_t size = w->failed ? 0 : pcs_lay_out(&w->counts, offsets);
    if (w->failed) return report_no_memory(r, path);
    if (!size || w->text.count > UINT32_MAX) return report_error(r, path, 0, "the scene is larger than a scene file holds, 2^40 bytes and 2^32 of names; split it");
    char *file = memory_alloc(memory, (size_t)size, 1);
    if (!file) return report_no_memory(r, path);
    fill(w, offsets, file, size);
    *out_bytes = file;
    *out_size = (size_t)size;
    return RESULT_OK;
}

static const char *bakes_fault(const pcs_request *q)
{
    for (uint32_t i = 0; i < q->bake_count; ++i)
        if (q->bakes[i].zone >= q->scene->zone_count || !q->bakes[i].size || (i && q->bakes[i].zone < q->bakes[i - 1].zone))
            return "a baked index of no zone or of no bytes, or not in order of zones";
    return NULL;
}

result pcs_encode(const pcs_request *q, const char *path, const allocator *memory, report *r, void **out_bytes, size_t *out_size)
{
    const char *fault = bakes_fault(q);
    if (!fault && pcs_check(q->scene, memory, &fault) != RESULT_OK) return report_no_memory(r, path);
    if (fault) return report_error(r, path, 0, "this scene cannot be kept in a scene file: %s; mend its source", fault);
    writing w = {.s = q->scene, .q = q, .records = arena_make(memory), .text = buffer_make(memory, 1)};
    const result done = encode(&w, path, memory, r, out_bytes, out_size);
    arena_free(&w.records);
    buffer_free(&w.text);
    return done;
}

result pcs_write(const pcs_request *q, const char *path, const allocator *memory, report *r)
{
    void *bytes = NULL;
    size_t size = 0;
    result done = pcs_encode(q, path, memory, r, &bytes, &size);
    if (done != RESULT_OK) return done;
    done = file_write(path, bytes, size, r);
    memory_free(memory, bytes, size, 1);
    return done;
}
