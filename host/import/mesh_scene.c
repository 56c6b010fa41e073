// From what a mesh file says to a scene: per object drop what has no area, repair, triangulate, cluster, hand over.
// SPDX-License-Identifier: MIT
// Invariant: every polygon with area stands in exactly one item, whole, with its orientation.
#include "../mesh/mesh.h"
#include "cluster.h"
#include "mesh_soup.h"
#include "mesh_triangulate.h"

#include <math.h>
#include <string.h>

// A height that rounding the file's decimals to doubles may make of none: some ulps of the largest coordinate.
static const double FLAT_SHARE = 1.0 / ((uint64_t)1 << 49);

typedef struct kept_polygon {
    uint32_t material; // the builder's
    uint32_t first_triangle, triangle_count;
    uint32_t group; // of the object's materials
} kept_polygon;

typedef struct emitted { // a vertex of the builder: one per mesh vertex and texture coordinate
    uint32_t texcoord, next;
} emitted;

typedef struct scene_maker {
    const mesh_soup *soup;
    const char *path;
    const allocator *memory;
    report *report;
    scene_builder *builder;
    double flat_m;
    triangulator triangulator;
    uint32_t *local_of; // a soup position: the object's vertex, or UINT32_MAX
    uint32_t *materials; // the soup's: the builder's, or UINT32_MAX

    // Of the object at hand; kept from object to object for their memory.
    buffer positions;     // 3 doubles
    buffer sources;       // uint32_t: the soup's position
    buffer corners;       // uint32_t: the object's vertex
    buffer texcoords;     // uint32_t: a corner's
    buffer polygon_first; // uint32_t
    buffer polygons;      // kept_polygon
    buffer triangles;     // uint32_t: the object's corners
    buffer points;        // 3 doubles: of one polygon
    buffer vertices;      // builder_vertex: of one material
    buffer emitted;       // the same
    buffer indices;       // uint32_t: of one material
    buffer counts;        // uint32_t: triangles of its polygons

    uint64_t dropped, cut_vertices, apart_polygons;
} scene_maker;

static void maker_open(scene_maker *m)
{
    m->triangulator = triangulator_make(m->memory);
    m->positions = buffer_make(m->memory, 3 * sizeof(double));
    m->points = buffer_make(m->memory, 3 * sizeof(double));
    m->polygons = buffer_make(m->memory, sizeof(kept_polygon));
    m->vertices = buffer_make(m->memory, sizeof(builder_vertex));
    m->emitted = buffer_make(m->memory, sizeof(emitted));
    buffer *const numbers[] = {&m->sources, &m->corners, &m->texcoords, &m->polygon_first, &m->triangles, &m->indices, &m->counts};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i) *numbers[i] = buffer_make(m->memory, sizeof(uint32_t));
}

static void maker_close(scene_maker *m)
{
    buffer *const all[] = {&m->positions,     &m->points,   &m->polygons,  &m->vertices, &m->emitted, &m->sources, &m->corners, &m->texcoords,
                           &m->polygon_first, &m->triangles, &m->indices, &m->counts};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) buffer_free(all[i]);
    triangulator_free(&m->triangulator);
    memory_free(m->memory, m->local_of, m->soup->positions.count, sizeof *m->local_of);
    memory_free(m->memory, m->materials, m->soup->materials.count, sizeof *m->materials);
}

static const double *soup_position(const mesh_soup *s, uint32_t position)
{
    return (const double *)s->positions.items + 3 * (size_t)position;
}

// ---- Gathering an object ----

static int same_place(const mesh_soup *s, uint32_t a, uint32_t b)
{
    const double *p = soup_position(s, a), *q = soup_position(s, b);
    return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
}

static result local_vertex(scene_maker *m, uint32_t position, uint32_t *out)
{
    if (m->local_of[position] == UINT32_MAX) {
        if (!buffer_append(&m->positions, soup_position(m->soup, position), 1) || !buffer_append(&m->sources, &position, 1)) return RESULT_NO_MEMORY;
        m->local_of[position] = (uint32_t)m->positions.count - 1;
    }
    *out = m->local_of[position];
    return RESULT_OK;
}

// Corners at the place of the one before are left out. The polygon's points are returned in m->points.
static result gather_corners(scene_maker *m, const soup_polygon *p)
{
    const soup_corner *corners = (const soup_corner *)m->soup->corners.items + p->first_corner;
    uint32_t last = p->corner_count - 1;
    m->points.count = 0;
    while (last > 0 && same_place(m->soup, corners[last].position, corners[0].position)) last--;
    for (uint32_t i = 0; i <= last; ++i) {
        uint32_t vertex;
        if (i > 0 && same_place(m->soup, corners[i].position, corners[i - 1].position)) continue;
        if (local_vertex(m, corners[i].position, &vertex) != RESULT_OK) return RESULT_NO_MEMORY;
        if (!buffer_append(&m->corners, &vertex, 1) || !buffer_append(&m->texcoords, &corners[i].texcoord, 1) ||
            !buffer_append(&m->points, soup_position(m->soup, corners[i].position), 1))
            return RESULT_NO_MEMORY;
    }
    return RESULT_OK;
}

// The same name may be used again and again: it is one material.
static result find_material(scene_maker *m, uint32_t of_soup)
{
    const soup_name *name = (const soup_name *)m->soup->materials.items + of_soup;
    if (m->materials[of_soup] != UINT32_MAX) return RESULT_OK;
    return scene_builder_material(m->builder, name->text, name->length, 0, &m->materials[of_soup]);
}

static result gather_polygon(scene_maker *m, const soup_polygon *p)
{
    const uint32_t first_corner = (uint32_t)m->corners.count;
    const size_t first_index = m->triangles.count;
    if (gather_corners(m, p) != RESULT_OK) return RESULT_NO_MEMORY;
    result done = polygon_triangulate(&m->triangulator, (const double(*)[3])m->points.items, (uint32_t)m->points.count, m->flat_m, &m->triangles);
    if (done != RESULT_OK) return done;
    if (m->triangles.count == first_index) {
        m->corners.count = m->texcoords.count = first_corner;
        m->dropped++;
        return RESULT_OK;
    }
    done = find_material(m, p->material);
    if (done != RESULT_OK) return done;
    uint32_t *indices = m->triangles.items;
    for (size_t i = first_index; i < m->triangles.count; ++i) indices[i] += first_corner;
    const kept_polygon kept = {m->materials[p->material], (uint32_t)(first_index / 3), (uint32_t)((m->triangles.count - first_index) / 3), 0};
    const uint32_t end = (uint32_t)m->corners.count;
    return buffer_append(&m->polygons, &kept, 1) && buffer_append(&m->polygon_first, &end, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

static result gather_object(scene_maker *m, uint32_t first, uint32_t count)
{
    const uint32_t zero = 0;
    m->positions.count = m->sources.count = m->corners.count = m->texcoords.count = 0;
    m->polygon_first.count = m->polygons.count = m->triangles.count = 0;
    if (!buffer_append(&m->polygon_first, &zero, 1)) return RESULT_NO_MEMORY;
    result done = RESULT_OK;
    const soup_polygon *polygons = m->soup->polygons.items;
    for (uint32_t i = 0; i < count && done == RESULT_OK; ++i) done = gather_polygon(m, &polygons[first + i]);
    const uint32_t *sources = m->sources.items;
    for (size_t i = 0; i < m->sources.count; ++i) m->local_of[sources[i]] = UINT32_MAX;
    return done;
}

// ---- Materials of an object ----

// Numbers the object's materials in order of appearance; `materials` lists them.
static result group_by_material(scene_maker *m, arena *scratch, uint32_t **materials, uint32_t *group_count)
{
    kept_polygon *polygons = m->polygons.items;
    const size_t count = m->polygons.count;
    size_t slot_count = 16; // open addressing; a file may switch materials before every face
    while (slot_count < count * 2) slot_count *= 2;
    uint32_t *slots = arena_push(scratch, slot_count, sizeof *slots), *found = arena_push(scratch, count, sizeof *found);
    if (!slots || !found) return RESULT_NO_MEMORY;
    memset(slots, 0, slot_count * sizeof *slots);
    *group_count = 0;
    for (size_t i = 0; i < count; ++i) {
        size_t at = (polygons[i].material * 2654435761u) & (slot_count - 1);
        while (slots[at] && found[slots[at] - 1] != polygons[i].material) at = (at + 1) & (slot_count - 1);
        if (!slots[at]) {
            found[*group_count] = polygons[i].material;
            slots[at] = ++*group_count;
        }
        polygons[i].group = slots[at] - 1;
    }
    *materials = found;
    return RESULT_OK;
}

// Stable counting sort: starts[k] .. starts[k + 1] in `order` are the elements whose key is k.
static result sort_by_key(arena *scratch, const uint32_t *keys, uint32_t count, uint32_t key_count, uint32_t **out_order, uint32_t **out_starts)
{
    uint32_t *order = arena_push(scratch, count, sizeof *order), *starts = arena_push(scratch, (size_t)key_count + 2, sizeof *starts);
    if (!order || !starts) return RESULT_NO_MEMORY;
    memset(starts, 0, ((size_t)key_count + 2) * sizeof *starts);
    for (uint32_t i = 0; i < count; ++i) starts[keys[i] + 2]++;
    for (uint32_t k = 2; k < key_count + 2; ++k) starts[k] += starts[k - 1];
    for (uint32_t i = 0; i < count; ++i) order[starts[keys[i] + 1]++] = i;
    *out_order = order;
    *out_starts = starts;
    return RESULT_OK;
}

// ---- Items ----

typedef struct item_group { // polygons of one object and material
    const mesh_output *mesh;
    const uint32_t *polygons; // of m->polygons
    uint32_t count, object, material, flags;
} item_group;

static void box_of_polygon(const scene_maker *m, const mesh_output *mesh, const kept_polygon *p, cluster_polygon *out)
{
    const uint32_t *corners = (const uint32_t *)m->triangles.items + 3 * (size_t)p->first_triangle;
    out->triangles = p->triangle_count;
    for (int k = 0; k < 3; ++k) {
        out->min[k] = INFINITY;
        out->max[k] = -INFINITY;
    }
    for (uint32_t i = 0; i < 3 * p->triangle_count; ++i)
        for (int k = 0; k < 3; ++k) {
            const double x = mesh->positions[3 * (size_t)mesh->corners[corners[i]] + (size_t)k];
            out->min[k] = fmin(out->min[k], x);
            out->max[k] = fmax(out->max[k], x);
        }
}

static result cluster_group(const scene_maker *m, const item_group *g, arena *scratch, uint32_t **order, uint32_t **starts, uint32_t *clusters)
{
    cluster_polygon *boxes = arena_push(scratch, g->count, sizeof *boxes);
    uint32_t *cluster_of = arena_push(scratch, g->count, sizeof *cluster_of);
    if (!boxes || !cluster_of) return RESULT_NO_MEMORY;
    const kept_polygon *polygons = m->polygons.items;
    for (uint32_t i = 0; i < g->count; ++i) box_of_polygon(m, g->mesh, &polygons[g->polygons[i]], &boxes[i]);
    const result done = cluster_split(boxes, g->count, scratch, cluster_of, clusters);
    return done == RESULT_OK ? sort_by_key(scratch, cluster_of, g->count, *clusters, order, starts) : done;
}

static result emit_vertex(scene_maker *m, const mesh_output *mesh, uint32_t *heads, uint32_t corner)
{
    const uint32_t vertex = mesh->corners[corner], texcoord = ((const uint32_t *)m->texcoords.items)[corner];
    const emitted *known = m->emitted.items;
    uint32_t at = heads[vertex];
    while (at != UINT32_MAX && known[at].texcoord != texcoord) at = known[at].next;
    if (at == UINT32_MAX) {
        const emitted fresh = {texcoord, heads[vertex]};
        builder_vertex *v = buffer_append(&m->emitted, &fresh, 1) ? buffer_push(&m->vertices, 1) : NULL;
        if (!v) return RESULT_NO_MEMORY;
        memset(v, 0, sizeof *v);
        memcpy(v->position, mesh->positions + 3 * (size_t)vertex, sizeof v->position);
        memcpy(v->normal, mesh->normals + 3 * (size_t)vertex, sizeof v->normal);
        if (texcoord != SOUP_NO_TEXCOORD) memcpy(v->texcoord, (const float *)m->soup->texcoords.items + 2 * (size_t)texcoord, sizeof v->texcoord);
        at = heads[vertex] = (uint32_t)m->vertices.count - 1;
    }
    return buffer_append(&m->indices, &at, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

// Vertices in the order of the clusters' use, so that a cluster's lie together.
static result emit_triangles(scene_maker *m, const item_group *g, const uint32_t *order, arena *scratch)
{
    uint32_t *heads = arena_push(scratch, g->mesh->position_count, sizeof *heads);
    if (!heads) return RESULT_NO_MEMORY;
    memset(heads, 0xff, g->mesh->position_count * sizeof *heads);
    m->vertices.count = m->emitted.count = m->indices.count = m->counts.count = 0;
    const kept_polygon *polygons = m->polygons.items;
    for (uint32_t i = 0; i < g->count; ++i) {
        const kept_polygon *p = &polygons[g->polygons[order[i]]];
        const uint32_t *corners = (const uint32_t *)m->triangles.items + 3 * (size_t)p->first_triangle;
        if (!buffer_append(&m->counts, &p->triangle_count, 1)) return RESULT_NO_MEMORY;
        for (uint32_t c = 0; c < 3 * p->triangle_count; ++c)
            if (emit_vertex(m, g->mesh, heads, corners[c]) != RESULT_OK) return RESULT_NO_MEMORY;
    }
    return RESULT_OK;
}

static result emit_items(scene_maker *m, const item_group *g, const uint32_t *starts, uint32_t clusters)
{
    uint32_t first_vertex;
    uint32_t *indices = m->indices.items;
    const uint32_t *counts = m->counts.items;
    result done = scene_builder_vertices(m->builder, m->vertices.items, m->vertices.count, g->material, &first_vertex);
    if (done != RESULT_OK) return done;
    for (size_t i = 0; i < m->indices.count; ++i) indices[i] += first_vertex;
    for (uint32_t k = 0; k < clusters && done == RESULT_OK; ++k) {
        builder_item item = {.indices = indices, .polygon_triangles = counts + starts[k], .polygon_count = starts[k + 1] - starts[k]};
        for (uint32_t i = 0; i < item.polygon_count; ++i) item.index_count += 3 * item.polygon_triangles[i];
        item.material = g->material;
        item.object = g->object;
        item.flags = g->flags;
        indices += item.index_count;
        done = scene_builder_item(m->builder, &item);
    }
    return done;
}

static result emit_group(scene_maker *m, const item_group *g)
{
    arena scratch = arena_make(m->memory);
    uint32_t *order, *starts, clusters;
    result done = cluster_group(m, g, &scratch, &order, &starts, &clusters);
    if (done == RESULT_OK) done = emit_triangles(m, g, order, &scratch);
    if (done == RESULT_OK) done = emit_items(m, g, starts, clusters);
    arena_free(&scratch);
    return done;
}

// ---- Objects ----

static result make_groups(scene_maker *m, uint32_t object, const mesh_output *mesh, arena *scratch)
{
    uint32_t *materials, *order, *starts, group_count;
    const uint32_t count = (uint32_t)m->polygons.count;
    result done = group_by_material(m, scratch, &materials, &group_count);
    uint32_t *groups = arena_push(scratch, count, sizeof *groups);
    if (done != RESULT_OK || !groups) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < count; ++i) groups[i] = ((const kept_polygon *)m->polygons.items)[i].group;
    done = sort_by_key(scratch, groups, count, group_count, &order, &starts);
    // A mesh with a boundary shows its back faces through the opening.
    const uint32_t flags = mesh->boundary_edges ? CULL_ITEM_TWO_SIDED : 0;
    for (uint32_t i = 0; i < group_count && done == RESULT_OK; ++i) {
        item_group g = {.mesh = mesh, .polygons = order + starts[i], .count = starts[i + 1] - starts[i], .object = object, .material = materials[i], .flags = flags};
        done = emit_group(m, &g);
    }
    return done;
}

static result make_object(scene_maker *m, const soup_object *o, uint32_t count)
{
    uint32_t object;
    result done = scene_builder_object(m->builder, o->name.text, o->name.length, &object);
    if (done == RESULT_OK) done = gather_object(m, o->first_polygon, count);
    if (done != RESULT_OK || m->polygons.count == 0) return done;
    arena scratch = arena_make(m->memory);
    mesh_output mesh;
    const mesh_input input = {m->positions.items, m->corners.items, m->polygon_first.items, (uint32_t)m->positions.count, (uint32_t)m->polygons.count};
    done = mesh_repair(&input, &scratch, &mesh);
    if (done == RESULT_OK) {
        m->cut_vertices += mesh.cut_vertices;
        m->apart_polygons += mesh.apart_polygons;
        done = make_groups(m, object, &mesh, &scratch);
    }
    arena_free(&scratch);
    return done;
}

static result make_objects(scene_maker *m)
{
    const soup_object *objects = m->soup->objects.items;
    for (size_t i = 0; i < m->soup->objects.count; ++i) {
        const size_t end = i + 1 < m->soup->objects.count ? objects[i + 1].first_polygon : m->soup->polygons.count;
        if (end == objects[i].first_polygon) continue; // a name without faces is no object
        const result done = make_object(m, &objects[i], (uint32_t)(end - objects[i].first_polygon));
        if (done != RESULT_OK) return done;
    }
    return RESULT_OK;
}

static double flat_height(const mesh_soup *s)
{
    double largest = 0;
    const soup_corner *corners = s->corners.items;
    for (size_t c = 0; c < s->corners.count; ++c)
        for (int k = 0; k < 3; ++k) largest = fmax(largest, fabs(soup_position(s, corners[c].position)[k]));
    return largest * FLAT_SHARE;
}

static void report_repairs(const scene_maker *m)
{
    const unsigned long long dropped = m->dropped, cut = m->cut_vertices, apart = m->apart_polygons;
    if (dropped) report_warning(m->report, m->path, 0, "%llu faces without area dropped", dropped);
    if (cut || apart) report_note(m->report, "%s: not a surface everywhere: %llu vertices doubled, %llu faces set apart", m->path, cut, apart);
}

static result add_scene(scene_maker *m)
{
    m->local_of = memory_alloc(m->memory, m->soup->positions.count, sizeof *m->local_of);
    m->materials = memory_alloc(m->memory, m->soup->materials.count, sizeof *m->materials);
    if (!m->local_of || !m->materials) return report_no_memory(m->report, m->path);
    memset(m->local_of, 0xff, m->soup->positions.count * sizeof *m->local_of);
    memset(m->materials, 0xff, m->soup->materials.count * sizeof *m->materials);
    m->flat_m = flat_height(m->soup);
    const result done = make_objects(m);
    if (done == RESULT_NO_MEMORY) return report_no_memory(m->report, m->path);
    if (done != RESULT_OK) return report_error(m->report, m->path, 0, "over 65,535 materials or 2^32 vertices or indices; split the file");
    if (m->dropped == m->soup->polygons.count) return report_error(m->report, m->path, 0, "none of its %zu faces has an area; correct them", m->soup->polygons.count);
    report_repairs(m);
    return RESULT_OK;
}

result mesh_scene_into(const mesh_soup *soup, const reader_job *j)
{
    scene_maker m = {.soup = soup, .path = j->path, .memory = j->memory, .report = j->report, .builder = j->builder};
    maker_open(&m);
    const result done = add_scene(&m);
    maker_close(&m);
    return done;
}
