// Scene builder, what moves and shines: doors, movers' paths, lights, cameras.
// SPDX-License-Identifier: MIT
#include "scene_builder.h"

#include <math.h>
#include <string.h>

static const double COORDINATE_MOST = 1e9; // metres: as for all coordinates of a scene

uint32_t scene_builder_mover_count(const scene_builder *b)
{
    return (uint32_t)b->mover_list.count;
}

static int are_finite(const double *v, int count)
{
    int finite = 1;
    for (int i = 0; i < count; ++i) finite &= isfinite(v[i]) != 0;
    return finite;
}

// ---- How far a mover gets ----

typedef struct mover_reach { double low[3], high[3], radius; } mover_reach; // at rest, world; radius: about its pivot

static mover_reach reach_of(const scene_builder *b, uint32_t mover, const double pivot[3])
{
    const scene_item *item = (const scene_item *)b->movers.items.items + mover;
    const uint32_t *indices = (const uint32_t *)b->movers.indices.items + item->first_index;
    const double(*positions)[3] = b->positions.items;
    mover_reach r = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, 0};
    double square = 0;
    for (uint32_t i = 0; i < item->index_count; ++i) {
        const double *p = positions[indices[i]], d[3] = {p[0] - pivot[0], p[1] - pivot[1], p[2] - pivot[2]};
        square = fmax(square, d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        for (int k = 0; k < 3; ++k) {
            r.low[k] = fmin(r.low[k], p[k]);
            r.high[k] = fmax(r.high[k], p[k]);
        }
    }
    r.radius = sqrt(square);
    return r;
}

static int stays_near(const mover_reach *r, const double offset[3])
{
    int near = 1;
    for (int k = 0; k < 3; ++k) near &= r->low[k] + offset[k] >= -COORDINATE_MOST && r->high[k] + offset[k] <= COORDINATE_MOST;
    return near;
}

// Between keys it is between their places. One that turns may get anywhere in the ball about its pivot.
static int path_stays_near(const scene_builder *b, uint32_t mover, const scene_key *keys, uint32_t count)
{
    const double *pivot = ((const scene_mover *)b->mover_list.items)[mover].pivot;
    mover_reach r = reach_of(b, mover, pivot);
    int turns = 0, near = 1;
    for (uint32_t i = 0; i < count; ++i) turns |= keys[i].turn_deg[0] != 0 || keys[i].turn_deg[1] != 0 || keys[i].turn_deg[2] != 0;
    for (int k = 0; turns && k < 3; ++k) {
        r.low[k] = pivot[k] - r.radius;
        r.high[k] = pivot[k] + r.radius;
    }
    for (uint32_t i = 0; i < count; ++i) near &= stays_near(&r, keys[i].offset);
    return near;
}

// Its leaf stands as the door does at rest; its other place is that far from there.
static int leaf_stays_near(const scene_builder *b, uint32_t mover, door_state at_rest)
{
    const scene_mover *m = (const scene_mover *)b->mover_list.items + mover;
    const double none[3] = {0, 0, 0};
    const mover_reach r = reach_of(b, mover, none);
    double offset[3];
    for (int k = 0; k < 3; ++k) offset[k] = at_rest == DOORS_OPEN ? -m->open_offset[k] : m->open_offset[k];
    return stays_near(&r, none) && stays_near(&r, offset);
}

// ---- Doors and paths ----

result scene_builder_door(scene_builder *b, const char *name, door_state at_rest, uint32_t mover, uint32_t *out)
{
    scene_mover *movers = b->mover_list.items;
    if (mover != SCENE_NONE && (mover >= b->mover_list.count || movers[mover].door != SCENE_NONE)) return RESULT_BAD_INPUT;
    if (mover != SCENE_NONE && !leaf_stays_near(b, mover, at_rest)) return RESULT_BAD_INPUT;
    scene_door door = {.at_rest = at_rest, .mover = mover};
    door.name = arena_text(&b->names, name, strlen(name));
    if (!door.name || !buffer_append(&b->doors, &door, 1)) return RESULT_NO_MEMORY;
    *out = (uint32_t)b->doors.count - 1;
    if (mover != SCENE_NONE) movers[mover].door = *out;
    return RESULT_OK;
}

static int path_is_sound(const builder_path *p)
{
    if (!p->key_count || (p->pivot && !are_finite(p->pivot, 3))) return 0;
    for (uint32_t i = 0; i < p->key_count; ++i) {
        const scene_key *k = &p->keys[i];
        if (!isfinite(k->time_s) || !are_finite(k->offset, 3) || !are_finite(k->turn_deg, 3)) return 0;
        if (i && !(k->time_s > p->keys[i - 1].time_s)) return 0;
    }
    return 1;
}

result scene_builder_mover_path(scene_builder *b, uint32_t mover, const builder_path *p)
{
    if (mover >= b->mover_list.count || !path_is_sound(p)) return RESULT_BAD_INPUT;
    scene_mover *m = (scene_mover *)b->mover_list.items + mover;
    const uint32_t first = (uint32_t)b->keys.count;
    scene_key *keys = buffer_push(&b->keys, p->key_count);
    if (!keys) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < p->key_count; ++i) {
        keys[i] = p->keys[i];
        builder_offset(b, p->keys[i].offset, keys[i].offset);
    }
    if (p->pivot) builder_point(b, p->pivot, m->pivot);
    if (!path_stays_near(b, mover, keys, p->key_count)) {
        b->keys.count = first;
        return RESULT_BAD_INPUT;
    }
    m->first_key = first;
    m->key_count = p->key_count;
    m->loops = p->loops != 0;
    if (b->map.is_on) memcpy(m->axes, b->map.turn, sizeof m->axes);
    return RESULT_OK;
}

result scene_builder_light(scene_builder *b, const scene_light *l)
{
    if (!isfinite(l->colour[0]) || !isfinite(l->colour[1]) || !isfinite(l->colour[2])) return RESULT_BAD_INPUT;
    scene_light light = *l;
    const char *name = l->name ? l->name : "";
    builder_point(b, l->position, light.position);
    builder_direction(b, l->direction, light.direction);
    light.reach = l->reach * builder_scale(b);
    if (!are_finite(light.position, 3) || !are_finite(light.direction, 3) || !isfinite(light.reach)) return RESULT_BAD_INPUT;
    light.name = arena_text(&b->names, name, strlen(name));
    return light.name && buffer_append(&b->lights, &light, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

static camera camera_taken(const scene_builder *b, const camera *from)
{
    camera to = *from;
    builder_point(b, from->eye, to.eye);
    builder_direction(b, from->forward, to.forward);
    builder_direction(b, from->up, to.up);
    to.near_m = from->near_m * builder_scale(b);
    to.far_m = from->far_m * builder_scale(b);
    return to;
}

result scene_builder_camera_path(scene_builder *b, const char *name, const camera *cameras, uint32_t count)
{
    scene_camera_path path = {.first_camera = (uint32_t)b->cameras.count, .camera_count = count};
    for (uint32_t i = 0; i < count; ++i) {
        const camera c = camera_taken(b, &cameras[i]);
        const int is_sound = !camera_fault(&c);
        if (is_sound && buffer_append(&b->cameras, &c, 1)) continue;
        b->cameras.count = path.first_camera;
        return is_sound ? RESULT_NO_MEMORY : RESULT_BAD_INPUT;
    }
    path.name = arena_text(&b->names, name, strlen(name));
    return path.name && buffer_append(&b->paths, &path, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}
