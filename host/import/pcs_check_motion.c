// Checks of a scene that no builder made: what moves, shines and stands in it.
// SPDX-License-Identifier: MIT
#include "pcs_check.h"

#include <math.h>

static const double WAY_MOST = 2e9; // metres: from one end of what coordinates may be to the other

static int is_orthonormal(const double rows[9])
{
    for (int i = 0; i < 3; ++i)
        if (!check_unit(rows + 3 * i)) return 0;
    for (int i = 0; i < 3; ++i) {
        const double *a = rows + 3 * i, *b = rows + 3 * ((i + 1) % 3);
        if (!(fabs((a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]) < CHECK_UNIT)) return 0;
    }
    return 1;
}

static const char *check_mover(const scene *s, uint32_t mover, uint32_t *keys_left)
{
    const scene_mover *m = &s->movers[mover];
    if (!check_finite(m->open_offset, 3) || !check_finite(m->pivot, 3)) return "a mover with a number that is not finite";
    if (!is_orthonormal(m->axes)) return "a mover whose axes are no turn";
    for (int k = 0; k < 3; ++k)
        if (m->door != SCENE_NONE && fabs(m->open_offset[k]) > WAY_MOST) return "a door's mover that opens beyond all coordinates";
    if (m->loops > 1) return "a mover that neither loops nor stays";
    if (m->door != SCENE_NONE && (m->door >= s->door_count || s->doors[m->door].mover != mover)) return "a mover whose door does not move it";
    if (m->first_key > s->key_count || m->key_count > s->key_count - m->first_key) return "a mover on a path that is not there";
    if (m->key_count > *keys_left) return "movers that share a path"; // so that all of them together are walked once
    *keys_left -= m->key_count;
    for (uint32_t k = m->first_key + 1; k < m->first_key + m->key_count; ++k)
        if (!(s->keys[k].time_s > s->keys[k - 1].time_s)) return "a path whose times do not rise";
    return NULL;
}

static const char *check_movers(const scene *s)
{
    uint32_t keys_left = s->key_count;
    for (uint32_t i = 0; i < s->key_count; ++i) {
        const scene_key *k = &s->keys[i];
        if (!isfinite(k->time_s) || !check_finite(k->offset, 3) || !check_finite(k->turn_deg, 3)) return "a path with a number that is not finite";
        for (int a = 0; a < 3; ++a)
            if (fabs(k->offset[a]) > WAY_MOST) return "a path that leads beyond all coordinates";
    }
    for (uint32_t i = 0; i < s->mover_count; ++i) {
        const char *fault = check_mover(s, i, &keys_left);
        if (fault) return fault;
    }
    for (uint32_t i = 0; i < s->door_count; ++i) {
        const uint32_t mover = s->doors[i].mover;
        if (mover != SCENE_NONE && (mover >= s->mover_count || s->movers[mover].door != i)) return "a door whose mover is another door's";
    }
    return NULL;
}

static const char *check_lights(const scene *s)
{
    for (uint32_t i = 0; i < s->light_count; ++i) {
        const scene_light *l = &s->lights[i];
        if (!check_finite(l->position, 3) || !check_finite(l->direction, 3) || !isfinite(l->reach)) return "a light with a number that is not finite";
        for (int k = 0; k < 3; ++k)
            if (!isfinite(l->colour[k])) return "a light with a number that is not finite";
    }
    for (uint32_t i = 0; i < s->place_count; ++i)
        if (!check_finite(s->places[i].position, 3)) return "a place that is nowhere";
    return NULL;
}

static const char *check_paths(const scene *s)
{
    uint32_t cameras = 0;
    for (uint32_t i = 0; i < s->path_count; ++i) {
        if (s->paths[i].first_camera != cameras || s->paths[i].camera_count > s->camera_count - cameras) return "camera paths that do not follow each other";
        cameras += s->paths[i].camera_count;
    }
    if (cameras != s->camera_count) return "cameras of no path";
    for (uint32_t i = 0; i < s->camera_count; ++i)
        if (camera_fault(&s->cameras[i])) return "a camera that sees nothing";
    return NULL;
}

static const char *check_solids(const scene *s)
{
    uint32_t planes = 0;
    for (uint32_t i = 0; i < s->solid_count; ++i) {
        const scene_solid *solid = &s->solids[i];
        if (solid->first_plane != planes || solid->plane_count > s->solid_plane_count - planes) return "solids whose planes do not follow each other";
        planes += solid->plane_count;
        if (!check_finite(solid->min, 3) || !check_finite(solid->max, 3)) return "a solid with a number that is not finite";
        for (int k = 0; k < 3; ++k)
            if (solid->min[k] > solid->max[k]) return "a solid whose box is inside out";
    }
    for (uint32_t i = 0; i < s->solid_plane_count; ++i)
        if (!check_unit(s->solid_planes[i].normal) || !isfinite(s->solid_planes[i].distance)) return "a solid's plane without a unit normal";
    return planes == s->solid_plane_count ? NULL : "planes of no solid";
}

const char *check_motion(const scene *s)
{
    static const char *(*const checks[])(const scene *) = {check_movers, check_lights, check_paths, check_solids};
    const char *fault = NULL;
    for (size_t i = 0; i < sizeof checks / sizeof *checks && !fault; ++i) fault = checks[i](s);
    return fault;
}
