// Automatic views auto:N: from a map's point entities that stand in air, else spread over the scene: among boxes, on
// and over ground, within and around a model, back from what leaves no room.
// SPDX-License-Identifier: MIT
#include "views_auto.h"

#include <math.h>

enum { SPREAD_TRIES = 400 };
static const double PI = 3.14159265358979323846;
static const double PITCH_MOST_DEG = 25, FOVY_DEG = 60;
static const double FAR_LEAST_M = 16;
static const double FIGURE_EYE_M = 0.7;       // a player's or monster's eye above its origin
static const double MESH_CLEARANCE_PART = 0.02; // of the diagonal: a model of 20 cm has no place 12 cm from itself
static const double SMALL_SCENE_M = 1;         // below, no place in it is any eye's
static const double PLANE_SCENE = 1e-3;        // least extent by largest, below which all lies in one plane: no room within
static const double BACK_LEAST = 1, BACK_MOST = 3; // of the largest extent, from a point of the scene to an eye set back
static const double BACK_LEAST_NEAR = 4;       // of near
static const double FLAT_SCENE = 0.25;        // height by width, below which a scene is ground to stand on, not a model
static const uint64_t SEED = 0x706f727463756c6c; // "portcull"

// ---- Cameras ----

static double far_for(const auto_views *a, const double at[3])
{
    double diagonal = 0, distance = 0;
    for (int k = 0; k < 3; ++k) {
        const double extent = a->high[k] - a->low[k], off = at[k] - (a->low[k] + a->high[k]) / 2;
        diagonal += extent * extent;
        distance += off * off;
    }
    int exponent;
    frexp(2 * sqrt(diagonal) + sqrt(distance), &exponent);
    return fmax(FAR_LEAST_M, ldexp(1, exponent));
}

static void direction_of(double yaw, double pitch, double out[3])
{
    out[0] = cos(pitch) * cos(yaw);
    out[1] = sin(pitch);
    out[2] = cos(pitch) * sin(yaw);
}

camera auto_camera(const auto_views *a, const double at[3], double yaw, double pitch)
{
    camera c = {.up = {0, 1, 0}, .fovy_deg = FOVY_DEG, .aspect = a->aspect, .near_m = AUTO_NEAR_M, .far_m = far_for(a, at)};
    direction_of(yaw, pitch, c.forward);
    for (int k = 0; k < 3; ++k) c.eye[k] = a->origin[k] + at[k];
    return c;
}

static double random_pitch(random_stream *r)
{
    return random_between(r, -PITCH_MOST_DEG, PITCH_MOST_DEG) * (PI / 180);
}

// ---- Places of a map ----

int auto_is_in_air(const auto_views *a, const double at[3])
{
    return free_space_clearance(a->space, at, AUTO_CLEARANCE_M, SPACE_SOLIDS | SPACE_TRIANGLES | SPACE_BOXES) >= AUTO_CLEARANCE_M &&
           free_space_clearance(a->space, at, AUTO_CLEARANCE_M, SPACE_LIQUIDS) > 0;
}

static result find_places(auto_views *a)
{
    const scene *s = a->scene;
    for (uint32_t i = 0; s->is_map && i < s->place_count; ++i) {
        eye e;
        for (int k = 0; k < 3; ++k) e.at[k] = s->places[i].position[k] - a->origin[k];
        if (s->places[i].kind != PLACE_OTHER) e.at[1] += FIGURE_EYE_M;
        int inside = 1; // a place outside of all geometry sees nothing of the level
        for (int k = 0; k < 3; ++k) inside &= e.at[k] >= a->low[k] && e.at[k] <= a->high[k];
        if (inside && auto_is_in_air(a, e.at) && !buffer_append(&a->places, &e, 1)) return report_no_memory(a->report, s->path);
    }
    eye *places = a->places.items;
    for (uint32_t i = (uint32_t)a->places.count; i > 1; --i) { // Fisher and Yates
        const uint32_t j = random_below(&a->random, i);
        const eye swap = places[i - 1];
        places[i - 1] = places[j];
        places[j] = swap;
    }
    if (s->is_map && a->places.count == 0) report_note(a->report, "%s: no point entity stands in air; the views are spread over the scene", s->path);
    return RESULT_OK;
}

static double extent_of(const auto_views *a) // the largest
{
    return fmax(a->high[0] - a->low[0], fmax(a->high[1] - a->low[1], a->high[2] - a->low[2]));
}

static void include(auto_views *a, const double min[3], const double max[3])
{
    for (int k = 0; k < 3; ++k) {
        a->low[k] = fmin(a->low[k], min[k]);
        a->high[k] = fmax(a->high[k], max[k]);
    }
}

static void include_item(auto_views *a, uint32_t i)
{
    const cull_boxes *b = &a->scene->boxes;
    const double *o = a->scene->whole.origin;
    const double min[3] = {o[0] + b->min_x[i], o[1] + b->min_y[i], o[2] + b->min_z[i]};
    const double max[3] = {o[0] + b->max_x[i], o[1] + b->max_y[i], o[2] + b->max_z[i]};
    include(a, min, max);
}

// The zone's box and origin follow the movers to where they are now; their solids stand wherever they may be.
static void find_bounds(auto_views *a)
{
    const scene *s = a->scene;
    for (int k = 0; k < 3; ++k) {
        a->low[k] = INFINITY;
        a->high[k] = -INFINITY;
    }
    for (uint32_t i = 0; i < s->item_count; ++i) include_item(a, i);
    for (uint32_t i = 0; s->mover_count && i < s->solid_count; ++i)
        if (s->solids[i].kind != SOLID_STRUCTURE) include(a, s->solids[i].min, s->solids[i].max);
    if (!(a->low[0] <= a->high[0])) // movers without a body alone
        for (uint32_t i = 0; i < s->mover_count; ++i) include_item(a, s->item_count + i);
    for (int k = 0; k < 3; ++k) {
        a->origin[k] = s->mover_count ? floor((a->low[k] + a->high[k]) / 2 + 0.5) : s->whole.origin[k];
        a->low[k] -= a->origin[k];
        a->high[k] -= a->origin[k];
    }
}

static int is_tiny_or_flat(const auto_views *a)
{
    const double extent = extent_of(a);
    if (extent < SMALL_SCENE_M) return 1;
    for (int k = 0; k < 3; ++k)
        if (a->high[k] - a->low[k] <= PLANE_SCENE * extent) return 1;
    return 0;
}

result auto_views_open(const scene *s, double aspect, const allocator *memory, report *r, auto_views *out)
{
    *out = (auto_views){.scene = s,
                        .memory = memory,
                        .report = r,
                        .aspect = aspect,
                        .random = {SEED},
                        .places = buffer_make(memory, sizeof(eye))};
    find_bounds(out);
    out->looks_from_afar = is_tiny_or_flat(out);
    for (uint32_t i = 0; i < s->item_count; ++i) *(s->items[i].flags & CULL_ITEM_BOX ? &out->has_boxes : &out->has_meshes) = 1;
    if (free_space_open(s, out->origin, memory, &out->space) != RESULT_OK) return report_no_memory(r, s->path);
    const result done = find_places(out);
    if (done != RESULT_OK) auto_views_close(out);
    return done;
}

void auto_views_close(auto_views *a)
{
    free_space_close(a->space);
    buffer_free(&a->places);
}

// ---- Spread over the scene ----

static double diagonal_of(const auto_views *a)
{
    const double x = a->high[0] - a->low[0], y = a->high[1] - a->low[1], z = a->high[2] - a->low[2];
    return sqrt(x * x + y * y + z * z);
}

int auto_is_ground(const auto_views *a)
{
    const double height = a->high[1] - a->low[1];
    return height > AUTO_EYE_HEIGHT_M && height < FLAT_SCENE * fmax(a->high[0] - a->low[0], a->high[2] - a->low[2]);
}

static int has_room(const auto_views *a, const double at[3])
{
    const double least = fmin(AUTO_CLEARANCE_M, MESH_CLEARANCE_PART * diagonal_of(a));
    return free_space_clearance(a->space, at, least, SPACE_ALL) >= least;
}

static int is_free(const auto_views *a, const double at[3])
{
    if (!has_room(a, at)) return 0;
    return a->scene->is_map || !a->has_meshes || !free_space_is_enclosed(a->space, at);
}

// Boxes alone stand on the lowest place of their scene; a mesh has ground where it says so, and none beyond its edge.
static int stand(const auto_views *a, double at[3], uint32_t i)
{
    const int on_ground = i % 2 == 0; // the other half of the eyes is anywhere over it
    if (!auto_is_ground(a)) return 1;
    const double height = !a->has_meshes || a->scene->is_map ? at[1] - a->low[1] : free_space_ground(a->space, at);
    if (on_ground) at[1] += AUTO_EYE_HEIGHT_M - height;
    return isfinite(height);
}

static int find_room(auto_views *a, uint32_t i, eye *e)
{
    for (int tries = 0; tries < SPREAD_TRIES; ++tries) {
        for (int k = 0; k < 3; ++k) e->at[k] = random_between(&a->random, a->low[k], a->high[k]);
        if (stand(a, e->at, i) && is_free(a, e->at)) return 1;
    }
    return 0;
}

eye auto_spread_eye(auto_views *a, uint32_t i)
{
    eye e = {{0}};
    if (find_room(a, i, &e)) return e;
    for (int k = 0; k < 3; ++k) e.at[k] = (a->low[k] + a->high[k]) / 2; // no room within: over it there is
    e.at[1] = a->high[1] + fmax(AUTO_EYE_HEIGHT_M, diagonal_of(a) / 4);
    return e;
}

// How far one may go from `at` along `way` within the bounds grown by `margin` of their size.
static double way_out(const auto_views *a, const double at[3], const double way[3], double margin)
{
    double least = INFINITY;
    for (int k = 0; k < 3; ++k) {
        const double grown = margin * (a->high[k] - a->low[k]);
        if (way[k] > 0) least = fmin(least, (a->high[k] + grown - at[k]) / way[k]);
        if (way[k] < 0) least = fmin(least, (a->low[k] - grown - at[k]) / way[k]);
    }
    return isfinite(least) ? least : 0;
}

typedef enum side { WITHIN_BOUNDS, OUT_OF_BOUNDS } side;

// Ground is a sheet: from beside it one may look under it, and into zones from behind their walls, where nobody can be.
static double lowest_eye(const auto_views *a, const double at[3])
{
    const int is_beside = at[0] < a->low[0] || at[0] > a->high[0] || at[2] < a->low[2] || at[2] > a->high[2];
    return is_beside && a->scene->zone_count > 1 ? INFINITY : a->low[1] + AUTO_EYE_HEIGHT_M;
}

// Of a mesh: back from a place in its middle half, to somewhere within its bounds, or out of them and within those half
// as large again. So the yaw is anyone's, and yet the view looks across the mesh.
static int mesh_camera(auto_views *a, double yaw, side where, camera *out)
{
    for (int tries = 0; tries < SPREAD_TRIES; ++tries) {
        const double pitch = random_pitch(&a->random);
        double at[3], back[3];
        direction_of(yaw, pitch, back);
        for (int k = 0; k < 3; ++k) {
            at[k] = random_between(&a->random, 0.75 * a->low[k] + 0.25 * a->high[k], 0.25 * a->low[k] + 0.75 * a->high[k]);
            back[k] = -back[k];
        }
        const double edge = way_out(a, at, back, 0), from = where == WITHIN_BOUNDS ? 0 : edge;
        const double way = random_between(&a->random, from, where == WITHIN_BOUNDS ? edge : way_out(a, at, back, 0.5));
        for (int k = 0; k < 3; ++k) at[k] += way * back[k];
        if ((auto_is_ground(a) && at[1] < lowest_eye(a, at)) || !is_free(a, at)) continue;
        *out = auto_camera(a, at, yaw, pitch);
        return 1;
    }
    return 0;
}

// ---- Set back ----

static void random_of_triangle(auto_views *a, const scene_item *item, double out[3])
{
    const scene *s = a->scene;
    const uint32_t *corners = s->indices + item->first_index + 3 * random_below(&a->random, item->index_count / 3);
    const cull_vec3 p = s->positions[corners[0]], q = s->positions[corners[1]], r = s->positions[corners[2]];
    double u = random_unit(&a->random), v = random_unit(&a->random);
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    out[0] = p.x + u * ((double)q.x - p.x) + v * ((double)r.x - p.x);
    out[1] = p.y + u * ((double)q.y - p.y) + v * ((double)r.y - p.y);
    out[2] = p.z + u * ((double)q.z - p.z) + v * ((double)r.z - p.z);
}

// On a triangle or within a box; of movers alone the middle of all their places.
static void random_point(auto_views *a, double out[3])
{
    const scene *s = a->scene;
    for (int k = 0; k < 3; ++k) out[k] = (a->low[k] + a->high[k]) / 2;
    if (s->item_count == 0) return;
    const uint32_t i = random_below(&a->random, s->item_count);
    const scene_item *item = &s->items[i];
    if (!(item->flags & CULL_ITEM_BOX) && item->index_count < 3) return;
    if (item->flags & CULL_ITEM_BOX) {
        out[0] = random_between(&a->random, s->boxes.min_x[i], s->boxes.max_x[i]);
        out[1] = random_between(&a->random, s->boxes.min_y[i], s->boxes.max_y[i]);
        out[2] = random_between(&a->random, s->boxes.min_z[i], s->boxes.max_z[i]);
    } else random_of_triangle(a, item, out);
    for (int k = 0; k < 3; ++k) out[k] += s->whole.origin[k] - a->origin[k];
}

static int is_outside(const auto_views *a, const double at[3])
{
    for (int k = 0; k < 3; ++k)
        if (at[k] < a->low[k] || at[k] > a->high[k]) return 1;
    return 0;
}

// From a point of the scene back along the view's direction, so that whatever the yaw the view looks at the scene.
static camera camera_from_afar(auto_views *a, double yaw)
{
    double at[3], ahead[3], pitch = 0;
    for (int tries = 0; tries <= SPREAD_TRIES; ++tries) {
        const double most = BACK_MOST * extent_of(a); // out of the bounds from any point in them: their diagonal is 1.74 at most
        const double way = tries < SPREAD_TRIES ? random_between(&a->random, BACK_LEAST * extent_of(a), most) : most;
        pitch = random_pitch(&a->random);
        direction_of(yaw, pitch, ahead);
        random_point(a, at);
        for (int k = 0; k < 3; ++k) at[k] -= fmax(way, BACK_LEAST_NEAR * AUTO_NEAR_M) * ahead[k];
        if (is_outside(a, at) && has_room(a, at)) break;
    }
    return auto_camera(a, at, yaw, pitch);
}

static int find_eye(auto_views *a, uint32_t i, eye *out)
{
    const eye *places = a->places.items;
    if (a->places.count) *out = places[i % a->places.count];
    else if (a->looks_from_afar) return 0;
    else if (!find_room(a, i, out)) {
        report_note(a->report, "%s: no place in it has room for an eye; the views look at it from outside", a->scene->path);
        a->looks_from_afar = 1;
        return 0;
    }
    return 1;
}

eye auto_place(auto_views *a, uint32_t i)
{
    const eye *places = a->places.items;
    return a->places.count ? places[i % a->places.count] : auto_spread_eye(a, i);
}

result auto_views_make(auto_views *a, uint32_t count, camera *cameras)
{
    const int is_mesh = !a->scene->is_map && !a->has_boxes && !a->looks_from_afar, is_ground = auto_is_ground(a);
    for (uint32_t i = 0; i < count; ++i) {
        const double yaw = random_between(&a->random, -PI, PI);
        if (is_mesh && i % 2 == 1 && mesh_camera(a, yaw, OUT_OF_BOUNDS, &cameras[i])) continue;
        if (is_mesh && i % 2 == 0 && !is_ground && mesh_camera(a, yaw, WITHIN_BOUNDS, &cameras[i])) continue;
        eye e;
        if (find_eye(a, is_mesh ? i / 2 : i, &e)) cameras[i] = auto_camera(a, e.at, yaw, random_pitch(&a->random));
        else cameras[i] = camera_from_afar(a, yaw);
    }
    return RESULT_OK;
}
