// A ray off each shell: crossing its own shell an odd number of times it started inside it.
// SPDX-License-Identifier: MIT
#include "islands.h"

#include <math.h>

typedef struct face_size { double area; uint32_t face; } face_size;

typedef struct island_build {
    ray_space *rays;
    region_set *out;
    uint32_t *first;  // of each shell's faces; shell_count + 1
    face_size *faces; // by shell
} island_build;

// Only to choose where a ray starts.
static double area_of(const surface *s, const surface_polygon *p)
{
    const surface_corner *c = surface_corners(s, p);
    const double *o = surface_vertex_at(s, c[0].vertex)->position;
    double sum[3] = {0, 0, 0};
    for (uint32_t i = 1; i + 1 < p->count; ++i) {
        const double *a = surface_vertex_at(s, c[i].vertex)->position, *b = surface_vertex_at(s, c[i + 1].vertex)->position;
        for (int k = 0; k < 3; ++k) {
            const int m = (k + 1) % 3, n = (k + 2) % 3;
            sum[k] += (a[m] - o[m]) * (b[n] - o[n]) - (a[n] - o[n]) * (b[m] - o[m]);
        }
    }
    return sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
}

static void group_faces(island_build *b)
{
    const shell_set *shells = b->rays->shells;
    for (uint32_t f = 0; f < shells->face_count; ++f)
        if (shells->shell_of[f] != SHELL_NONE) b->first[shells->shell_of[f] + 1]++;
    for (uint32_t i = 0; i < shells->shell_count; ++i) b->first[i + 1] += b->first[i];
    for (uint32_t f = shells->face_count; f-- > 0;) {
        if (shells->shell_of[f] == SHELL_NONE) continue;
        const face_size made = {area_of(b->rays->s, surface_polygon_at(b->rays->s, f >> 1)), f};
        b->faces[--b->first[shells->shell_of[f] + 1]] = made;
    }
    for (uint32_t i = 0; i < shells->shell_count; ++i) b->first[i] = b->first[i + 1];
    uint32_t total = 0;
    for (uint32_t f = 0; f < shells->face_count; ++f) total += shells->shell_of[f] != SHELL_NONE;
    b->first[shells->shell_count] = total;
}

// The largest face of the shell that comes after `last` in falling size; the last one again when there is none.
static uint32_t next_face(const island_build *b, uint32_t shell, const face_size *last, face_size *out)
{
    const face_size *best = NULL;
    for (uint32_t i = b->first[shell]; i < b->first[shell + 1]; ++i) {
        const face_size *f = &b->faces[i];
        if (last && (f->area > last->area || (f->area == last->area && f->face <= last->face))) continue;
        if (!best || f->area > best->area || (f->area == best->area && f->face < best->face)) best = f;
    }
    if (best) *out = *best;
    return best != NULL;
}

// A ray from the shell into its air that meets no edge.
static result clear_ray(island_build *b, uint32_t shell, ray_end *end)
{
    face_size at;
    *end = RAY_UNCLEAR;
    for (uint32_t attempt = 0; attempt < RAY_ATTEMPTS && *end != RAY_DONE; ++attempt) {
        if (attempt % 4 == 0 && !next_face(b, shell, attempt ? &at : NULL, &at)) break;
        const result r = ray_from_face(b->rays, at.face, attempt, end);
        if (r != RESULT_OK) return r;
    }
    if (*end != RAY_DONE) b->out->unclear++;
    return RESULT_OK;
}

static result find_outer(island_build *b)
{
    for (uint32_t i = 0; i < b->out->shell_count; ++i) {
        ray_end end;
        const result r = clear_ray(b, i, &end);
        if (r != RESULT_OK) return r;
        b->out->is_outer[i] = end == RAY_DONE && (ray_crossings(b->rays, i) & 1);
        b->out->region_of[i] = b->out->is_outer[i] ? b->out->region_count++ : REGION_VOID;
    }
    return RESULT_OK;
}

static result place_islands(island_build *b)
{
    for (uint32_t i = 0; i < b->out->shell_count; ++i) {
        if (b->out->is_outer[i]) continue;
        ray_end end;
        const result r = clear_ray(b, i, &end);
        if (r != RESULT_OK) return r;
        const uint32_t owner = end == RAY_DONE ? ray_innermost(b->rays, b->out->is_outer) : SHELL_NONE;
        b->out->region_of[i] = owner == SHELL_NONE ? REGION_VOID : b->out->region_of[owner];
    }
    return RESULT_OK;
}

result region_set_make(ray_space *rays, const allocator *memory, region_set *out)
{
    const uint32_t count = rays->shells->shell_count, faces = rays->shells->face_count;
    region_set set = {.memory = memory, .shell_count = count};
    set.region_of = memory_alloc(memory, count, sizeof(uint32_t));
    set.is_outer = memory_alloc_zeroed(memory, count, 1);
    island_build b = {rays, &set, memory_alloc_zeroed(memory, (size_t)count + 1, sizeof(uint32_t)), memory_alloc(memory, faces, sizeof(face_size))};
    result r = set.region_of && set.is_outer && b.first && b.faces ? RESULT_OK : RESULT_NO_MEMORY;
    if (r == RESULT_OK) {
        group_faces(&b);
        r = find_outer(&b);
    }
    set.unclear = 0;
    if (r == RESULT_OK) r = place_islands(&b);
    memory_free(memory, b.first, (size_t)count + 1, sizeof(uint32_t));
    memory_free(memory, b.faces, faces, sizeof(face_size));
    if (r == RESULT_OK) *out = set;
    else region_set_free(&set);
    return r;
}

void region_set_free(region_set *r)
{
    memory_free(r->memory, r->region_of, r->shell_count, sizeof(uint32_t));
    memory_free(r->memory, r->is_outer, r->shell_count, 1);
}

static uint32_t region_of_ray(const region_set *r, const ray_space *rays)
{
    const uint32_t shell = ray_innermost(rays, NULL);
    return shell == SHELL_NONE ? REGION_VOID : r->is_outer[shell] ? r->region_of[shell] : REGION_SOLID;
}

result region_of_point(const region_set *r, ray_space *rays, const int32_t point[3], uint32_t *out)
{
    *out = REGION_SOLID;
    for (uint32_t attempt = 0; attempt < RAY_ATTEMPTS; ++attempt) {
        ray_end end;
        const result made = ray_from_point(rays, point, attempt, &end);
        if (made != RESULT_OK) return made;
        if (end == RAY_UNCLEAR) continue;
        if (end == RAY_DONE) *out = region_of_ray(r, rays);
        break;
    }
    return RESULT_OK;
}

result region_of_face(const region_set *r, ray_space *rays, uint32_t face, uint32_t *out)
{
    *out = REGION_SOLID;
    for (uint32_t attempt = 0; attempt < RAY_ATTEMPTS; ++attempt) {
        ray_end end;
        const result made = ray_from_face(rays, face, attempt, &end);
        if (made != RESULT_OK) return made;
        if (end != RAY_DONE) continue;
        *out = region_of_ray(r, rays);
        break;
    }
    return RESULT_OK;
}
