// One entry of a JSON scene's "brushes": its keys, and the primitive that they stand for.
// SPDX-License-Identifier: MIT
#include "input_json.h"

#include <math.h>

static const char *const brush_keys[] = {"name",     "operation", "material", "texture", "door", "plane", "box", "cylinder",
                                         "cone", "convex",    PLACEMENT_KEYS, NULL};
static const char *const shape_words[] = {"plane", "box", "cylinder", "cone", "convex"};
enum { SHAPE_PLANE, SHAPE_BOX, SHAPE_CYLINDER, SHAPE_CONE, SHAPE_CONVEX, SHAPE_COUNT };
enum { SEGMENTS = 16, TELL_BYTES = 256 };
static const double RADIUS_MOST = 1e6, SCALE_LEAST = 1e-3, SCALE_MOST = 1e6; // metres: the grid ends long before

// ---- What is wrong with it ----

static result tell(const json_node *n, const primitive *p, primitive_fault fault)
{
    switch (fault) {
    case PRIMITIVE_BEYOND:
        return node_fault(n, "a point beyond %g m, 2^24 steps of the grid; move it or take a coarser grid", CULL_GRID_MOST / p->steps_per_metre);
    case PRIMITIVE_FLAT:
        return node_fault(n, "no volume is left on the grid of %g m; make it thicker, take a finer grid, or take it out", 1 / p->steps_per_metre);
    case PRIMITIVE_NO_MEMORY: return report_no_memory(n->file->report, n->file->path);
    case PRIMITIVE_SOUND: break;
    }
    return RESULT_OK;
}

// ---- Shapes ----

static result read_point(const json_node *object, const char *key, double out[3])
{
    json_node n;
    const result done = node_need(object, key, &n);
    return done == RESULT_OK ? node_numbers(&n, 3, out) : done;
}

static result read_direction(const json_node *object, const char *key, double out[3])
{
    json_node n;
    result done = node_need(object, key, &n);
    if (done == RESULT_OK) done = node_numbers(&n, 3, out);
    if (done != RESULT_OK || out[0] != 0 || out[1] != 0 || out[2] != 0) return done;
    return node_fault(&n, "a direction of no length; write where the plane's outside is");
}

static result read_box(const json_node *n, primitive *p)
{
    static const char *const keys[] = {"min", "max", NULL};
    double min[3], max[3];
    result done = node_object(n, keys);
    if (done == RESULT_OK) done = read_point(n, "min", min);
    if (done == RESULT_OK) done = read_point(n, "max", max);
    for (int k = 0; k < 3 && done == RESULT_OK; ++k)
        if (min[k] > max[k]) done = node_fault(n, "min is above max in %c; write the three least coordinates as min", 'x' + k);
    return done == RESULT_OK ? tell(n, p, primitive_box(p, min, max)) : done;
}

static result read_round(const json_node *n, const char *top, round_body *out)
{
    const char *const keys[] = {"base", top, "radius", "segments", NULL};
    json_node radius, segments;
    *out = (round_body){.segments = SEGMENTS};
    result done = node_object(n, keys);
    if (done == RESULT_OK) done = read_point(n, "base", out->base);
    if (done == RESULT_OK) done = read_point(n, top, out->top);
    if (done == RESULT_OK) done = node_need(n, "radius", &radius);
    if (done == RESULT_OK) done = node_number(&radius, 0, RADIUS_MOST, &out->radius);
    if (done == RESULT_OK && node_find(n, "segments", &segments)) done = node_count(&segments, SEGMENTS_LEAST, SEGMENTS_MOST, &out->segments);
    return done;
}

static result read_half_space(const json_node *n, primitive *p)
{
    static const char *const keys[] = {"point", "normal", "points", NULL};
    json_node list;
    double point[3], normal[3], points[3][3];
    size_t count;
    result done = node_object(n, keys);
    if (done != RESULT_OK) return done;
    if (node_find(n, "points", &list)) {
        json_node other;
        if (node_find(n, "point", &other) || node_find(n, "normal", &other)) return node_fault(&other, "the plane is given by its \"points\"; take this out");
        done = entry_points(&list, 3, 3, points, &count);
        return done == RESULT_OK ? tell(n, p, primitive_half_space_of(p, (const double(*)[3])points)) : done;
    }
    done = read_point(n, "point", point);
    if (done == RESULT_OK) done = read_direction(n, "normal", normal);
    return done == RESULT_OK ? tell(n, p, primitive_half_space(p, point, normal)) : done;
}

static result read_planes(const json_node *list, primitive *p)
{
    size_t count = 0;
    result done = node_array(list, 4, BRUSH_PLANES_MOST, &count);
    for (size_t i = 0; i < count && done == RESULT_OK; ++i) {
        const json_node plane = node_item(list, i);
        done = read_half_space(&plane, p);
    }
    return done;
}

static result read_convex(const json_node *n, primitive *p)
{
    static const char *const keys[] = {"points", "planes", NULL};
    json_node points, planes;
    result done = node_object(n, keys);
    if (done != RESULT_OK) return done;
    const int has_points = node_find(n, "points", &points), has_planes = node_find(n, "planes", &planes);
    if (has_points == has_planes) return node_fault(n, "it needs either \"points\" or \"planes\"; write one of them");
    if (has_planes) return read_planes(&planes, p);
    double at[HULL_POINTS_MOST][3];
    size_t count;
    done = entry_points(&points, HULL_POINTS_LEAST, HULL_POINTS_MOST, at, &count);
    return done == RESULT_OK ? tell(n, p, primitive_hull(p, (const double(*)[3])at, (uint32_t)count)) : done;
}

static result read_shape(const json_node *n, int shape, primitive *p)
{
    round_body round;
    result done;
    switch (shape) {
    case SHAPE_PLANE: return read_half_space(n, p);
    case SHAPE_BOX: return read_box(n, p);
    case SHAPE_CONVEX: return read_convex(n, p);
    case SHAPE_CONE:
        done = read_round(n, "apex", &round);
        return done == RESULT_OK ? tell(n, p, primitive_cone(p, &round)) : done;
    default:
        done = read_round(n, "top", &round);
        return done == RESULT_OK ? tell(n, p, primitive_cylinder(p, &round)) : done;
    }
}

static result find_shape(const json_entry *e, json_node *out, int *shape)
{
    int count = 0;
    for (int s = 0; s < SHAPE_COUNT; ++s) {
        json_node n;
        if (!node_find(&e->node, shape_words[s], &n)) continue;
        *out = n;
        *shape = s;
        count++;
    }
    if (count == 1) return RESULT_OK;
    return node_fault(&e->node, "%s shape; write one of \"plane\", \"box\", \"cylinder\", \"cone\", \"convex\"", count ? "more than one" : "no");
}

// ---- The rest ----

static result read_texture(const json_entry *e, json_brush *out)
{
    static const char *const keys[] = {"scale", "offset", NULL};
    json_node n, offset;
    if (!node_find(&e->node, "texture", &n)) return RESULT_OK;
    result done = node_object(&n, keys);
    if (done == RESULT_OK) done = node_maybe_number(&n, "scale", SCALE_LEAST, SCALE_MOST, &out->texture_scale);
    if (done == RESULT_OK && node_find(&n, "offset", &offset)) done = node_numbers(&offset, 2, out->texture_offset);
    return done;
}

static result read_door(const json_entry *e, json_brush *out)
{
    json_node n;
    if (!node_find(&e->node, "door", &n)) return RESULT_OK;
    if (out->operation != OPERATION_PORTAL) return node_fault(&n, "only a portal has a door; add \"operation\": \"portal\", or take this out");
    return entry_refer(e, &n, &e->scene->doors, "door", &out->door);
}

static result read_name(const json_entry *e, json_brush *out)
{
    const result done = node_maybe_text(&e->node, "name", &out->name);
    if (done != RESULT_OK || !out->name) return done;
    return entry_name(e, out->name, &out->name);
}

result json_brush_read(const json_entry *e, double steps_per_metre, json_brush *out, primitive *solid)
{
    static const char *const operations[] = {"add", "subtract", "portal", NULL};
    json_node operation, shape_node = {0};
    size_t chosen = 0;
    int shape = 0;
    builder_transform place = placement_none();
    *out = (json_brush){.material = "default", .texture_scale = 1, .door = SCENE_NONE};
    *solid = primitive_make(e->scene->job->memory, steps_per_metre, &place);
    result done = node_object(&e->node, brush_keys);
    if (done == RESULT_OK) done = read_name(e, out);
    if (done == RESULT_OK && node_find(&e->node, "operation", &operation)) done = node_choice(&operation, operations, &chosen);
    out->operation = (brush_operation)chosen;
    if (done == RESULT_OK) done = node_maybe_text(&e->node, "material", &out->material);
    if (done == RESULT_OK) done = read_texture(e, out);
    if (done == RESULT_OK) done = read_door(e, out);
    if (done == RESULT_OK) done = find_shape(e, &shape_node, &shape);
    if (done == RESULT_OK) done = placement_read(&e->node, &place);
    if (done != RESULT_OK) return done;
    solid->place = placement_within(&e->document->place, &place);
    out->is_open = shape == SHAPE_PLANE;
    return read_shape(&shape_node, shape, solid);
}
