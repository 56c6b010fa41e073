// The scene file in: header, table and counts first, then a scene whose arrays lie in the file's bytes, then every check.
// SPDX-License-Identifier: MIT
// Invariant: no number of the file is used before it is checked: sizes and counts here, indices and values in pcs_check.c.
#include "pcs.h"

#include "../core/file.h"

#include <string.h>

typedef struct reading {
    const char *path;
    char *file; // size + 1 bytes, 64-byte aligned
    size_t size;
    const allocator *memory;
    report *report;
    uint64_t offsets[PCS_SECTION_COUNT];
    pcs_counts counts;
    scene *s;
    const char *fault; // of a record; the first one stays
    int failed;        // out of memory
} reading;

// ---- Header and table ----

static int is_little_endian(void)
{
    const uint16_t one = 1;
    uint8_t first;
    memcpy(&first, &one, 1);
    return first == 1;
}

static result check_header(const reading *d)
{
    pcs_header h;
    if (!is_little_endian()) return report_error(d->report, d->path, 0, "a compiled scene opens on little-endian machines only; open its source");
    if (d->size < sizeof h) return report_error(d->report, d->path, 0, "%zu bytes are too few for a compiled scene; compile it again", d->size);
    memcpy(&h, d->file, sizeof h);
    if (memcmp(h.magic, PCS_MAGIC, sizeof h.magic) != 0)
        return report_error(d->report, d->path, 0, "is no compiled scene: its first bytes are others; name a file that `portcullis compile` wrote");
    if (h.version != PCS_VERSION)
        return report_error(d->report, d->path, 0, "is of version %u, and version %d is read here; compile it again", (unsigned)h.version, PCS_VERSION);
    if (h.file_bytes != d->size)
        return report_error(d->report, d->path, 0, "has %zu bytes where its header says %llu; it was cut or added to, so copy or compile it again", d->size,
                            (unsigned long long)h.file_bytes);
    if (h.hash != pcs_hash(d->file, d->size))
        return report_error(d->report, d->path, 0, "is damaged: its bytes do not give the hash that they were written with; copy or compile it again");
    const uint64_t zeros[4] = {0};
    if (h.section_count != PCS_SECTION_COUNT || memcmp(h.reserved, zeros, sizeof zeros) != 0)
        return report_error(d->report, d->path, 0, "is damaged: a header that version %d does not have; compile it again", PCS_VERSION);
    return RESULT_OK;
}

static int gap_is_zero(const reading *d, uint64_t from, uint64_t to)
{
    char sum = 0;
    for (uint64_t i = from; i < to; ++i) sum = (char)(sum | d->file[i]);
    return sum == 0;
}

static result tell_section(const reading *d, int section, const char *what)
{
    return report_error(d->report, d->path, 0, "is damaged: section %s %s; compile it again", pcs_section_names[section], what);
}

static result check_table(reading *d)
{
    pcs_section table[PCS_SECTION_COUNT];
    const uint64_t table_end = sizeof(pcs_header) + sizeof table;
    if (d->size < table_end) return report_error(d->report, d->path, 0, "is damaged: it ends in its table of sections; compile it again");
    memcpy(table, d->file + sizeof(pcs_header), sizeof table);
    for (int i = 0; i < PCS_SECTION_COUNT; ++i) d->counts.of[i] = table[i].count;
    if (pcs_lay_out(&d->counts, d->offsets) != d->size)
        return report_error(d->report, d->path, 0, "is damaged: its sections do not fill it; compile it again");
    uint64_t end = table_end;
    for (int i = 0; i < PCS_SECTION_COUNT; ++i) {
        const pcs_section *t = &table[i];
        if (t->id != (uint32_t)i || t->item_bytes != pcs_item_bytes[i] || t->offset != d->offsets[i] || t->reserved)
            return tell_section(d, i, "stands elsewhere, or has items of another size");
        if (!gap_is_zero(d, end, t->offset)) return tell_section(d, i, "has bytes before it that are not 0");
        end = t->offset + t->count * t->item_bytes;
    }
    return gap_is_zero(d, end, d->size) ? RESULT_OK : tell_section(d, PCS_SECTION_COUNT - 1, "has bytes behind it that are not 0");
}

// How long each array is, told by the arrays that it goes with.
static result check_counts(const reading *d)
{
    const uint64_t *n = d->counts.of;
    const uint64_t items = n[PCS_ITEMS], positions = n[PCS_POSITIONS], fixed = items - n[PCS_MOVERS];
    for (int i = 0; i < PCS_SECTION_COUNT; ++i)
        if (n[i] > UINT32_MAX && i != PCS_BLOBS && i != PCS_TEXCOORDS) return tell_section(d, i, "has over 2^32 items");
    if (items == 0 || items > UINT32_MAX / 2 || n[PCS_MOVERS] > items) return tell_section(d, PCS_ITEMS, "has too few or too many items");
    const struct { int id; uint64_t count, or_count; } wanted[] = {
        {PCS_SCENE, 1, 1}, {PCS_NORMALS, positions, positions}, {PCS_TEXCOORDS, 2 * positions, 0}, {PCS_VERTEX_MATERIALS, positions, positions},
        {PCS_POLYGON_FIRST_TRIANGLE, n[PCS_POLYGON_FIRST_TRIANGLE] ? n[PCS_POLYGON_FIRST_TRIANGLE] : 1, 1},
        {PCS_MIN_X, items + CULL_PADDING, items + CULL_PADDING}, {PCS_MIN_Y, items + CULL_PADDING, items + CULL_PADDING},
        {PCS_MIN_Z, items + CULL_PADDING, items + CULL_PADDING}, {PCS_MAX_X, items + CULL_PADDING, items + CULL_PADDING},
        {PCS_MAX_Y, items + CULL_PADDING, items + CULL_PADDING}, {PCS_MAX_Z, items + CULL_PADDING, items + CULL_PADDING},
        {PCS_WALLS, fixed, 0}, {PCS_EXACT_PLANES, n[PCS_PLANES], 0}, {PCS_LISTINGS, fixed, fixed}, {PCS_ZONE_PORTALS, 2 * n[PCS_PORTALS], 2 * n[PCS_PORTALS]},
    };
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; ++i)
        if (n[wanted[i].id] != wanted[i].count && n[wanted[i].id] != wanted[i].or_count) return tell_section(d, wanted[i].id, "is longer or shorter than what it belongs to");
    if (n[PCS_ZONES] == 0) return tell_section(d, PCS_ZONES, "has no zone");
    if (n[PCS_WALLS] == 0 && (n[PCS_WALL_VERTICES] || n[PCS_PLANES])) return tell_section(d, PCS_WALLS, "is empty, and what belongs to it is not");
    if (n[PCS_TEXT] == 0 || d->file[d->offsets[PCS_TEXT] + n[PCS_TEXT] - 1] != 0) return tell_section(d, PCS_TEXT, "does not end in a zero");
    return RESULT_OK;
}

// ---- Records into the scene ----

static void *lies_at(const reading *d, pcs_id id)
{
    return d->file + d->offsets[id];
}

static uint32_t count_of(const reading *d, pcs_id id)
{
    return (uint32_t)d->counts.of[id];
}

static void *take(reading *d, pcs_id id, size_t item_size)
{
    void *memory = d->failed ? NULL : arena_push(&d->s->memory, count_of(d, id), item_size);
    if (!memory) d->failed = 1;
    return memory;
}

static void refuse(reading *d, const char *fault)
{
    if (!d->fault) d->fault = fault;
}

static const char *text_at(reading *d, uint32_t place)
{
    if (place < d->counts.of[PCS_TEXT]) return (const char *)lies_at(d, PCS_TEXT) + place;
    refuse(d, "a name that lies outside of the texts");
    return "";
}

static void expect_zero(reading *d, uint32_t reserved)
{
    if (reserved) refuse(d, "a record with bits that this version does not have");
}

static void read_scene(reading *d)
{
    const pcs_scene *from = lies_at(d, PCS_SCENE);
    scene *s = d->s;
    s->hash = from->hash;
    s->step = from->step;
    s->grid_steps_per_metre = from->grid_steps_per_metre;
    memcpy(s->whole.origin, from->origin, sizeof s->whole.origin);
    s->whole.box = (cull_box){{from->box[0], from->box[1], from->box[2]}, {from->box[3], from->box[4], from->box[5]}};
    s->whole.radius = from->radius;
    s->is_map = from->is_map;
    s->flat_triangles = from->flat_triangles;
    s->stray_items = from->stray_items;
}

static void set_counts(reading *d)
{
    const struct { uint32_t *to; pcs_id id; } all[] = {
        {&d->s->position_count, PCS_POSITIONS}, {&d->s->tangent_count, PCS_TANGENTS}, {&d->s->index_count, PCS_INDICES}, {&d->s->mover_count, PCS_MOVERS},
        {&d->s->wall_vertex_count, PCS_WALL_VERTICES}, {&d->s->plane_count, PCS_PLANES}, {&d->s->material_count, PCS_MATERIALS},
        {&d->s->object_count, PCS_OBJECTS}, {&d->s->place_count, PCS_PLACES}, {&d->s->solid_count, PCS_SOLIDS},
        {&d->s->solid_plane_count, PCS_SOLID_PLANES}, {&d->s->zone_count, PCS_ZONES}, {&d->s->hull_count, PCS_HULLS},
        {&d->s->hull_plane_count, PCS_HULL_PLANES}, {&d->s->zone_item_count, PCS_ZONE_ITEMS}, {&d->s->portal_count, PCS_PORTALS},
        {&d->s->portal_point_count, PCS_PORTAL_POINTS}, {&d->s->door_count, PCS_DOORS}, {&d->s->key_count, PCS_KEYS},
        {&d->s->light_count, PCS_LIGHTS}, {&d->s->path_count, PCS_PATHS}, {&d->s->camera_count, PCS_CAMERAS}, {&d->s->bake_count, PCS_BAKES},
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) *all[i].to = count_of(d, all[i].id);
    d->s->item_count = count_of(d, PCS_ITEMS) - d->s->mover_count;
    d->s->polygon_count = count_of(d, PCS_POLYGON_FIRST_TRIANGLE) - 1;
}

static void set_arrays(reading *d)
{
    scene *s = d->s;
    s->positions = lies_at(d, PCS_POSITIONS);
    s->normals = lies_at(d, PCS_NORMALS);
    if (count_of(d, PCS_TEXCOORDS)) s->texcoords = lies_at(d, PCS_TEXCOORDS);
    if (count_of(d, PCS_TANGENTS)) s->tangents = lies_at(d, PCS_TANGENTS);
    s->vertex_materials = lies_at(d, PCS_VERTEX_MATERIALS);
    s->indices = lies_at(d, PCS_INDICES);
    s->polygon_first_triangle = lies_at(d, PCS_POLYGON_FIRST_TRIANGLE);
    s->items = lies_at(d, PCS_ITEMS);
    s->boxes = (cull_boxes){lies_at(d, PCS_MIN_X), lies_at(d, PCS_MIN_Y), lies_at(d, PCS_MIN_Z),
                            lies_at(d, PCS_MAX_X), lies_at(d, PCS_MAX_Y), lies_at(d, PCS_MAX_Z)};
    if (count_of(d, PCS_WALLS)) {
        s->walls = lies_at(d, PCS_WALLS);
        s->wall_vertices = lies_at(d, PCS_WALL_VERTICES);
        s->planes = lies_at(d, PCS_PLANES);
    }
    if (count_of(d, PCS_EXACT_PLANES)) s->exact_planes = lies_at(d, PCS_EXACT_PLANES);
    s->solid_planes = lies_at(d, PCS_SOLID_PLANES);
    s->hull_planes = lies_at(d, PCS_HULL_PLANES);
    s->zone_items = lies_at(d, PCS_ZONE_ITEMS);
    s->listings = lies_at(d, PCS_LISTINGS);
    s->portal_points = lies_at(d, PCS_PORTAL_POINTS);
    s->zone_portals = lies_at(d, PCS_ZONE_PORTALS);
    s->keys = lies_at(d, PCS_KEYS);
    s->cameras = lies_at(d, PCS_CAMERAS);
}

static void read_names(reading *d)
{
    scene *s = d->s;
    const pcs_material *materials = lies_at(d, PCS_MATERIALS);
    const pcs_object *objects = lies_at(d, PCS_OBJECTS);
    const pcs_path *paths = lies_at(d, PCS_PATHS);
    s->materials = take(d, PCS_MATERIALS, sizeof *s->materials);
    s->objects = take(d, PCS_OBJECTS, sizeof *s->objects);
    s->paths = take(d, PCS_PATHS, sizeof *s->paths);
    if (d->failed) return;
    for (uint32_t i = 0; i < s->material_count; ++i) s->materials[i] = (scene_material){text_at(d, materials[i].name), materials[i].flags, materials[i].colour};
    for (uint32_t i = 0; i < s->object_count; ++i) s->objects[i] = (scene_object){text_at(d, objects[i].name), objects[i].first_item, objects[i].item_count};
    for (uint32_t i = 0; i < s->path_count; ++i) s->paths[i] = (scene_camera_path){text_at(d, paths[i].name), paths[i].first_camera, paths[i].camera_count};
}

static void read_movers(reading *d)
{
    scene *s = d->s;
    const pcs_mover *movers = lies_at(d, PCS_MOVERS);
    const pcs_door *doors = lies_at(d, PCS_DOORS);
    s->movers = take(d, PCS_MOVERS, sizeof *s->movers);
    s->doors = take(d, PCS_DOORS, sizeof *s->doors);
    if (d->failed) return;
    for (uint32_t i = 0; i < s->mover_count; ++i) {
        const pcs_mover *from = &movers[i];
        scene_mover *to = &s->movers[i];
        *to = (scene_mover){.name = text_at(d, from->name), .first_key = from->first_key, .key_count = from->key_count, .door = from->door, .loops = from->loops};
        memcpy(to->open_offset, from->open_offset, sizeof to->open_offset);
        memcpy(to->pivot, from->pivot, sizeof to->pivot);
        memcpy(to->axes, from->axes, sizeof to->axes);
        expect_zero(d, from->reserved);
    }
    for (uint32_t i = 0; i < s->door_count; ++i) {
        if (doors[i].at_rest > DOORS_SHUT) refuse(d, "a door that is neither open nor shut");
        s->doors[i] = (scene_door){text_at(d, doors[i].name), (door_state)doors[i].at_rest, doors[i].mover};
    }
}

static void read_surroundings(reading *d)
{
    scene *s = d->s;
    const pcs_place *places = lies_at(d, PCS_PLACES);
    const pcs_solid *solids = lies_at(d, PCS_SOLIDS);
    const pcs_light *lights = lies_at(d, PCS_LIGHTS);
    s->places = take(d, PCS_PLACES, sizeof *s->places);
    s->solids = take(d, PCS_SOLIDS, sizeof *s->solids);
    s->lights = take(d, PCS_LIGHTS, sizeof *s->lights);
    if (d->failed) return;
    for (uint32_t i = 0; i < s->place_count; ++i) {
        if (places[i].kind > PLACE_OTHER) refuse(d, "a place of no known kind");
        s->places[i] = (scene_place){{places[i].position[0], places[i].position[1], places[i].position[2]}, (place_kind)places[i].kind};
        expect_zero(d, places[i].reserved);
    }
    for (uint32_t i = 0; i < s->solid_count; ++i) {
        if (solids[i].kind > SOLID_LIQUID) refuse(d, "a solid of no known kind");
        s->solids[i] = (scene_solid){.first_plane = solids[i].first_plane, .plane_count = solids[i].plane_count, .kind = (solid_kind)solids[i].kind};
        memcpy(s->solids[i].min, solids[i].min, sizeof solids[i].min);
        memcpy(s->solids[i].max, solids[i].max, sizeof solids[i].max);
        expect_zero(d, solids[i].reserved);
    }
    for (uint32_t i = 0; i < s->light_count; ++i) {
        const pcs_light *from = &lights[i];
        if (from->kind > LIGHT_SUN) refuse(d, "a light of no known kind");
        s->lights[i] = (scene_light){.name = text_at(d, from->name), .kind = (light_kind)from->kind, .reach = from->reach};
        memcpy(s->lights[i].position, from->position, sizeof from->position);
        memcpy(s->lights[i].direction, from->direction, sizeof from->direction);
        memcpy(s->lights[i].colour, from->colour, sizeof from->colour);
        expect_zero(d, from->reserved);
    }
}

static void read_zones(reading *d)
{
    scene *s = d->s;
    const pcs_zone *zones = lies_at(d, PCS_ZONES);
    const pcs_hull *hulls = lies_at(d, PCS_HULLS);
    const pcs_portal *portals = lies_at(d, PCS_PORTALS);
    s->zones = take(d, PCS_ZONES, sizeof *s->zones);
    s->hulls = take(d, PCS_HULLS, sizeof *s->hulls);
    s->portals = take(d, PCS_PORTALS, sizeof *s->portals);
    if (d->failed) return;
    for (uint32_t i = 0; i < s->zone_count; ++i) {
        const pcs_zone *z = &zones[i];
        const char *chain = z->chain == PCS_NO_TEXT ? NULL : text_at(d, z->chain);
        s->zones[i] = (scene_zone){text_at(d, z->name), chain, {z->origin[0], z->origin[1], z->origin[2]}, z->flags, z->parent,
                                   z->first_hull, z->hull_count, z->first_item, z->item_count, z->first_portal, z->portal_count};
    }
    for (uint32_t i = 0; i < s->hull_count; ++i) {
        s->hulls[i] = (scene_hull){.zone = hulls[i].zone, .first_plane = hulls[i].first_plane, .plane_count = hulls[i].plane_count};
        memcpy(s->hulls[i].min, hulls[i].min, sizeof hulls[i].min);
        memcpy(s->hulls[i].max, hulls[i].max, sizeof hulls[i].max);
        expect_zero(d, hulls[i].reserved);
    }
    for (uint32_t i = 0; i < s->portal_count; ++i) {
        const pcs_portal *p = &portals[i];
        s->portals[i] = (scene_portal){text_at(d, p->name), {p->zones[0], p->zones[1]}, p->first_point, p->point_count, p->door,
                                       {p->plane[0], p->plane[1], p->plane[2], p->plane[3]}};
    }
}

static void read_bakes(reading *d)
{
    scene *s = d->s;
    const pcs_bake *bakes = lies_at(d, PCS_BAKES);
    uint64_t end = 0;
    s->bakes = take(d, PCS_BAKES, sizeof *s->bakes);
    for (uint32_t i = 0; i < s->bake_count && !d->failed; ++i) {
        const pcs_bake *b = &bakes[i];
        const uint64_t left = d->counts.of[PCS_BLOBS] - end; // blobs lie one behind the other, whole lines of 64 bytes
        const int fits = b->offset == end && b->size > 0 && b->size <= left && (b->size + PCS_ALIGN - 1) / PCS_ALIGN * PCS_ALIGN <= left;
        if (!fits || b->zone >= s->zone_count || (i && b->zone < bakes[i - 1].zone)) {
            refuse(d, "baked indices that do not follow each other, or are of no zone");
            return;
        }
        end += (b->size + PCS_ALIGN - 1) / PCS_ALIGN * PCS_ALIGN;
        if (!gap_is_zero(d, d->offsets[PCS_BLOBS] + b->offset + b->size, d->offsets[PCS_BLOBS] + end)) refuse(d, "bytes behind a baked index that are not 0");
        s->bakes[i] = (scene_bake){.id = text_at(d, b->id), .version = text_at(d, b->version), .options_hash = b->options_hash, .zone_hash = b->zone_hash,
                                   .bytes = (const char *)lies_at(d, PCS_BLOBS) + b->offset, .size = b->size, .zone = b->zone};
        expect_zero(d, b->reserved);
    }
    if (!d->failed && end != d->counts.of[PCS_BLOBS]) refuse(d, "baked indices that no record names");
}

static void check_padding(reading *d)
{
    for (int axis = 0; axis < 6; ++axis) {
        const uint64_t items = d->offsets[PCS_MIN_X + axis] + d->counts.of[PCS_ITEMS] * sizeof(float);
        if (!gap_is_zero(d, items, items + CULL_PADDING * sizeof(float))) refuse(d, "bytes behind the boxes that are not 0");
    }
}

static result read_records(reading *d)
{
    scene *s = d->s;
    set_counts(d);
    set_arrays(d);
    read_scene(d);
    read_names(d);
    read_movers(d);
    read_surroundings(d);
    read_zones(d);
    read_bakes(d);
    check_padding(d);
    s->path = d->failed ? NULL : arena_text(&s->memory, d->path, strlen(d->path));
    if (!s->path || (!d->fault && pcs_check(s, d->memory, &d->fault) != RESULT_OK)) return report_no_memory(d->report, d->path);
    return d->fault ? report_error(d->report, d->path, 0, "holds nonsense: %s; compile it again", d->fault) : RESULT_OK;
}

// ---- Open ----

// Takes the bytes, on failure too.
static result open_bytes(reading *d, scene **out)
{
    result done = check_header(d);
    if (done == RESULT_OK) done = check_table(d);
    if (done == RESULT_OK) done = check_counts(d);
    if (done == RESULT_OK) d->s = memory_alloc_zeroed(d->memory, 1, sizeof *d->s);
    if (!d->s) {
        memory_free(d->memory, d->file, d->size + 1, 1);
        return done == RESULT_OK ? report_no_memory(d->report, d->path) : done;
    }
    d->s->memory = arena_make(d->memory);
    d->s->file = d->file;
    d->s->file_bytes = d->size + 1;
    done = read_records(d);
    if (done == RESULT_OK) *out = d->s;
    else scene_free(d->s, d->memory);
    return done;
}

result pcs_open(const char *path, const void *bytes, size_t size, const allocator *memory, report *r, scene **out)
{
    reading d = {.path = path, .size = size, .memory = memory, .report = r};
    d.file = memory_alloc(memory, size + 1, 1);
    if (!d.file) return report_no_memory(r, path);
    if (size) memcpy(d.file, bytes, size);
    return open_bytes(&d, out);
}

result pcs_load(const char *path, const allocator *memory, report *r, scene **out)
{
    reading d = {.path = path, .memory = memory, .report = r};
    const result done = file_read_most(path, PCS_BYTES_MOST, memory, r, &d.file, &d.size);
    return done == RESULT_OK ? open_bytes(&d, out) : done;
}
