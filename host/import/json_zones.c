// Zones and portals of a JSON scene.
// SPDX-License-Identifier: MIT
// Invariant: a zone is given to the builder after the one that it lies in; otherwise zones keep the order of the files.
#include "json_polygon.h"
#include "json_scene.h"

#include "../core/chain.h"

#include <stdio.h>
#include <string.h>

enum { HULLS_MOST = 4096, LINE_BYTES = 512, PORTAL_POINTS = 64, JOINED_BYTES = 1024, NESTING_MOST = 64 };

static const uint64_t HULL_TRIPLES_MOST = (uint64_t)1600 * 41664; // of points: each may be a face. 1 to 4 s of work

// ---- Shapes ----

typedef struct zone_shape {
    buffer planes; // scene_solid_plane, of all hulls
    buffer counts; // uint32_t, planes of each hull
} zone_shape;

static result shape_add(const json_entry *e, zone_shape *s, const scene_solid_plane *planes, uint32_t count)
{
    return buffer_append(&s->planes, planes, count) && buffer_append(&s->counts, &count, 1) ? RESULT_OK : entry_no_memory(e);
}

static result add_box(const json_entry *e, const json_node *n, zone_shape *s)
{
    double corners[2][3];
    size_t count;
    scene_solid_plane planes[6];
    const result done = entry_points(n, 2, 2, corners, &count);
    if (done != RESULT_OK) return done;
    for (int k = 0; k < 3; ++k)
        if (!(corners[0][k] < corners[1][k])) return node_fault(n, "the zone is empty in %c; write [[least x, y, z], [greatest x, y, z]]", 'x' + k);
    hull_planes_of_box(corners[0], corners[1], planes);
    return shape_add(e, s, planes, 6);
}

static result add_hull(const json_entry *e, const json_node *n, zone_shape *s)
{
    double points[HULL_POINTS_MOST][3];
    size_t count;
    uint32_t plane_count = 0;
    scene_solid_plane planes[HULL_POINT_PLANES_MOST];
    const result done = entry_points(n, HULL_POINTS_LEAST, HULL_POINTS_MOST, points, &count);
    if (done != RESULT_OK) return done;
    e->scene->hull_triples += (uint64_t)count * (count - 1) * (count - 2) / 6;
    if (e->scene->hull_triples > HULL_TRIPLES_MOST)
        return node_fault(n, "over 1,600 hulls of 64 points, or their like, in one scene; use boxes, or fewer points a hull");
    const char *fault = hull_planes_of_points((const double(*)[3])points, count, planes, &plane_count);
    return fault ? node_fault(n, "the hull %s", fault) : shape_add(e, s, planes, plane_count);
}

typedef result (*shape_reader)(const json_entry *e, const json_node *n, zone_shape *s);

static result add_each(const json_entry *e, const json_node *list, shape_reader add, zone_shape *s)
{
    size_t count = 0;
    result done = node_array(list, 1, HULLS_MOST, &count);
    for (size_t i = 0; i < count && done == RESULT_OK; ++i) {
        const json_node one = node_item(list, i);
        done = add(e, &one, s);
    }
    return done;
}

static result read_shape(const json_entry *e, zone_shape *s)
{
    json_node n;
    result done = RESULT_OK;
    if (node_find(&e->node, "box", &n)) done = add_box(e, &n, s);
    if (done == RESULT_OK && node_find(&e->node, "boxes", &n)) done = add_each(e, &n, add_box, s);
    if (done == RESULT_OK && node_find(&e->node, "hull", &n)) done = add_hull(e, &n, s);
    if (done == RESULT_OK && node_find(&e->node, "hulls", &n)) done = add_each(e, &n, add_hull, s);
    return done;
}

// ---- Chains ----

static void keep_text(void *user, report_level level, const char *text)
{
    if (level == REPORT_ERROR) snprintf(user, LINE_BYTES, "%.*s", LINE_BYTES - 1, text);
}

// Its form only: what plugins there are is known when they are loaded.
result entry_chain(const json_entry *e, const char **out)
{
    static const char before[] = "portcullis: error: ";
    char line[LINE_BYTES] = "";
    report kept = {.line = keep_text, .user = line};
    chain_spec spec;
    json_node n;
    if (!node_find(&e->node, "chain", &n)) return RESULT_OK;
    result done = node_text(&n, out);
    if (done != RESULT_OK) return done;
    done = chain_parse(*out, &e->scene->memory, &kept, &spec);
    if (done == RESULT_NO_MEMORY) return entry_no_memory(e);
    if (done == RESULT_OK) return done;
    return node_fault(&n, "%s", strncmp(line, before, sizeof before - 1) == 0 ? line + sizeof before - 1 : line);
}

// ---- Zones ----

static result add_zone(const json_entry *e, const zone_shape *s, const char *name, uint32_t parent, uint32_t *out)
{
    builder_zone zone = {.name = name, .parent = parent, .hull_count = (uint32_t)s->counts.count};
    const uint32_t *counts = s->counts.items;
    const scene_solid_plane *planes = s->planes.items;
    result done = entry_chain(e, &zone.chain);
    if (done != RESULT_OK) return done;
    builder_hull *hulls = memory_alloc(e->scene->job->memory, s->counts.count, sizeof *hulls);
    if (!hulls) return entry_no_memory(e);
    for (size_t h = 0; h < s->counts.count; ++h) {
        hulls[h] = (builder_hull){planes, counts[h]};
        planes += counts[h];
    }
    zone.hulls = hulls;
    const char *fault = NULL;
    done = scene_builder_zone(e->scene->job->builder, &zone, out, &fault);
    memory_free(e->scene->job->memory, hulls, s->counts.count, sizeof *hulls);
    return entry_told(e, done, "zone", fault);
}

static result read_zone(const json_entry *e, const char *name, uint32_t parent, uint32_t *out)
{
    const allocator *memory = e->scene->job->memory;
    zone_shape shape = {buffer_make(memory, sizeof(scene_solid_plane)), buffer_make(memory, sizeof(uint32_t))};
    result done = read_shape(e, &shape);
    if (done == RESULT_OK) done = add_zone(e, &shape, name, parent, out);
    buffer_free(&shape.planes);
    buffer_free(&shape.counts);
    return done;
}

// First all names, so that "in" may name any; ZONE_WAITS until the builder has it.
static const uint32_t ZONE_WAITS = SCENE_NONE;

static result name_zone(const json_entry *e)
{
    static const char *const keys[] = {"name", "box", "boxes", "hull", "hulls", "in", "chain", NULL};
    const char *name;
    const result done = node_object(&e->node, keys);
    return done == RESULT_OK ? entry_new_name(e, &e->scene->zones, "zone", ZONE_WAITS, &name) : done;
}

// Adds it if it is not in yet and the zone that it lies in is.
static result try_zone(const json_entry *e)
{
    json_node in;
    named *own = NULL;
    uint32_t parent = SCENE_NONE;
    result done = entry_own(e, &e->scene->zones, &own);
    if (done != RESULT_OK || own->number != ZONE_WAITS) return done;
    const int lies_in = node_find(&e->node, "in", &in);
    if (lies_in) done = entry_refer(e, &in, &e->scene->zones, "zone", &parent);
    if (done != RESULT_OK || (lies_in && parent == ZONE_WAITS)) return done;
    done = read_zone(e, own->name, parent, &own->number);
    if (done == RESULT_OK) e->scene->zones_added++;
    return done;
}

static result refuse_waiting(const json_entry *e)
{
    json_node in;
    named *own = NULL;
    const result done = entry_own(e, &e->scene->zones, &own);
    if (done != RESULT_OK || own->number != ZONE_WAITS) return done;
    (void)node_find(&e->node, "in", &in);
    const char *outer;
    if (entry_name(e, json_string_value(in.value), &outer) == RESULT_OK && strcmp(outer, own->name) == 0)
        return node_fault(&in, "the zone '%s' lies in itself; name another zone, or take \"in\" out", own->name);
    return node_fault(&in, "the zone '%s' lies in itself by way of others, or over %d deep; take one \"in\" out", own->name, NESTING_MOST);
}

result zones_read(json_scene *s)
{
    result done = entries_read(s, "zones", name_zone);
    for (int pass = 0; done == RESULT_OK && s->zones_added < s->zones.entries.count; ++pass) {
        const size_t before = s->zones_added;
        done = entries_read(s, "zones", try_zone);
        if (done == RESULT_OK && (s->zones_added == before || pass == NESTING_MOST)) return entries_read(s, "zones", refuse_waiting);
    }
    return done;
}

// ---- Portals ----

static result read_sides(const json_entry *e, uint32_t zones[2])
{
    json_node list;
    size_t count = 0;
    result done = node_need(&e->node, "zones", &list);
    if (done == RESULT_OK) done = node_array(&list, 2, 2, &count);
    for (size_t i = 0; i < count && done == RESULT_OK; ++i) {
        const json_node side = node_item(&list, i);
        done = entry_refer(e, &side, &e->scene->zones, "zone", &zones[i]);
    }
    if (done != RESULT_OK || zones[0] != zones[1]) return done;
    return node_fault(&list, "the portal joins the zone '%s' to itself; name two zones", json_string_value(json_array_get(list.value, 0)));
}

// One without a name is called by its zones.
static result portal_name(const json_entry *e, const char **out)
{
    json_node n, list;
    char joined[JOINED_BYTES];
    const char *sides[2] = {"", ""};
    const uint32_t number = (uint32_t)e->scene->portals.entries.count;
    if (node_find(&e->node, "name", &n)) return entry_new_name(e, &e->scene->portals, "portal", number, out);
    result done = node_need(&e->node, "zones", &list);
    for (size_t k = 0; k < 2 && done == RESULT_OK; ++k) done = entry_name(e, json_string_value(json_array_get(list.value, k)), &sides[k]);
    if (done != RESULT_OK) return done;
    snprintf(joined, sizeof joined, "%.500s - %.500s", sides[0], sides[1]);
    *out = arena_text(&e->scene->memory, joined, strlen(joined));
    return *out ? RESULT_OK : entry_no_memory(e);
}

// The point that is farthest outside of the zone: where to look first when the portal does not touch it.
static result tell_outside(const json_entry *e, const builder_portal *p, size_t side)
{
    json_node list, zones;
    double most = 0;
    size_t farthest = 0;
    for (size_t i = 0; i < p->point_count; ++i) {
        const double outside = scene_builder_outside(e->scene->job->builder, p->zones[side], p->points[i]);
        if (outside <= most) continue;
        most = outside;
        farthest = i;
    }
    (void)node_find(&e->node, "points", &list);
    (void)node_find(&e->node, "zones", &zones);
    const json_node point = node_item(&list, farthest);
    return node_fault(&point, "the portal's point lies %.6g m outside of its zone '%s'; move it there, or widen the zone", most,
                      json_string_value(json_array_get(zones.value, side)));
}

static result add_portal(const json_entry *e, const builder_portal *portal)
{
    static const char *const outside[2] = {"has a point outside of its first zone", "has a point outside of its second zone"};
    uint32_t number;
    const char *fault = NULL;
    const result done = scene_builder_portal(e->scene->job->builder, portal, &number, &fault);
    for (size_t side = 0; done == RESULT_BAD_INPUT && fault && side < 2; ++side)
        if (strncmp(fault, outside[side], strlen(outside[side])) == 0) return tell_outside(e, portal, side);
    return entry_told(e, done, "portal", fault);
}

static result read_portal(const json_entry *e)
{
    static const char *const keys[] = {"name", "zones", "points", "normal", "door", NULL};
    json_node list, door, towards;
    double points[PORTAL_POINTS][3], normal[3];
    size_t count = 0;
    builder_portal portal = {.points = (const double(*)[3])points, .door = SCENE_NONE};
    result done = node_object(&e->node, keys);
    if (done == RESULT_OK) done = read_sides(e, portal.zones);
    if (done == RESULT_OK) done = node_need(&e->node, "points", &list);
    if (done == RESULT_OK) done = entry_points(&list, 3, PORTAL_POINTS, points, &count);
    if (done == RESULT_OK && node_find(&e->node, "normal", &towards)) {
        done = node_numbers(&towards, 3, normal);
        portal.normal = normal;
    }
    if (done == RESULT_OK && node_find(&e->node, "door", &door)) done = entry_refer(e, &door, &e->scene->doors, "door", &portal.door);
    if (done == RESULT_OK) done = portal_name(e, &portal.name);
    if (done != RESULT_OK) return done;
    portal.point_count = (uint32_t)count;
    return add_portal(e, &portal);
}

result portals_read(json_scene *s)
{
    return entries_read(s, "portals", read_portal);
}
