// Pictures of materials: see pictures.h.
// SPDX-License-Identifier: MIT
#include "pictures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double WELDED_M = 1.0 / 1024; // 1/32 unit: how far the compiler's weld moves a corner
static const double DEPTHS_AGREE = 0x1p-20; // of the depth: what the claim allows to faces in one plane

// ---- Names ----

static uint32_t find_name(const scene *s, const char *name)
{
    for (uint32_t m = 0; m < s->material_count; ++m)
        if (strcmp(s->materials[m].name, name) == 0) return m;
    return UINT32_MAX;
}

result picture_pair_open(const scene *raw, const scene *compiled, picture_pair *out)
{
    picture_pair p = {.scenes = {raw, compiled}};
    for (int i = 0; i < 2; ++i) p.material_names[i] = calloc(p.scenes[i]->material_count + 1u, sizeof *p.material_names[i]);
    if (!p.material_names[0] || !p.material_names[1]) {
        picture_pair_free(&p);
        return RESULT_NO_MEMORY;
    }
    for (uint32_t m = 0; m < raw->material_count; ++m) p.material_names[0][m] = m;
    for (uint32_t m = 0; m < compiled->material_count; ++m) {
        const uint32_t same = find_name(raw, compiled->materials[m].name);
        p.material_names[1][m] = same != UINT32_MAX ? same : raw->material_count + m;
    }
    *out = p;
    return RESULT_OK;
}

void picture_pair_free(picture_pair *p)
{
    free(p->material_names[0]);
    free(p->material_names[1]);
    *p = (picture_pair){0};
}

uint32_t picture_material(const scene *s, uint32_t triangle)
{
    return s->vertex_materials[s->indices[3 * (size_t)triangle]];
}

// ---- Pixels ----

static double dot(const double a[3], const double b[3])
{
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

static void corner_of(const scene *s, uint32_t triangle, uint32_t i, double out[3])
{
    const cull_vec3 p = s->positions[s->indices[3 * (size_t)triangle + i]];
    out[0] = s->whole.origin[0] + (double)p.x;
    out[1] = s->whole.origin[1] + (double)p.y;
    out[2] = s->whole.origin[2] + (double)p.z;
}

// Twice as long as the triangle is large.
static void normal_of(const double (*corner)[3], double out[3])
{
    double u[3], v[3];
    for (int k = 0; k < 3; ++k) u[k] = corner[1][k] - corner[0][k], v[k] = corner[2][k] - corner[0][k];
    for (int k = 0; k < 3; ++k) out[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
}

// Where the ray through the pixel's middle meets the triangle's plane.
int picture_point(const scene *s, const pixel_place *at, const camera *c, double out[3], double *distance)
{
    const uint32_t pixel = at->pixel;
    double right[3], up[3], back[3], ray[3], corner[3][3], n[3];
    camera_axes(c, right, up, back);
    const double tall = tan(c->fovy_deg * (3.14159265358979323846 / 360)), wide = tall * c->aspect;
    const double x = ((pixel % PICTURE_WIDTH + 0.5) / PICTURE_WIDTH * 2 - 1) * wide;
    const double y = (((double)(pixel / PICTURE_WIDTH) + 0.5) / PICTURE_HEIGHT * 2 - 1) * tall;
    for (int k = 0; k < 3; ++k) ray[k] = right[k] * x + up[k] * y - back[k];
    for (uint32_t i = 0; i < 3; ++i) {
        corner_of(s, at->triangle, i, corner[i]);
        for (int k = 0; k < 3; ++k) corner[i][k] -= c->eye[k];
    }
    normal_of((const double(*)[3])corner, n);
    *distance = dot(n, corner[0]) / dot(n, ray);
    if (!isfinite(*distance)) return 0;
    for (int k = 0; k < 3; ++k) out[k] = c->eye[k] + ray[k] * *distance;
    return 1;
}

static int depths_agree(double a, double b)
{
    return fabs(a - b) <= DEPTHS_AGREE * fmax(fabs(a), fabs(b));
}

// The depths drawn are moved by up to 1/128 pixel of slope, corners hold some back: where they don't agree the planes may.
static int is_coplanar(const picture_pair *p, const camera *c, const uint32_t triangles[2], const float depths[2], uint32_t pixel)
{
    double at[3], distances[2];
    if (depths_agree((double)depths[0], (double)depths[1])) return 1;
    for (int i = 0; i < 2; ++i)
        if (!picture_point(p->scenes[i], &(pixel_place){triangles[i] - 1, pixel}, c, at, &distances[i])) return 0;
    return depths_agree(distances[0], distances[1]);
}

pixel_verdict picture_pixel(const picture_pair *p, const camera *c, const picture *raw, const picture *compiled, uint32_t pixel)
{
    const uint32_t triangles[2] = {raw->triangles[pixel], compiled->triangles[pixel]};
    const float depths[2] = {raw->depths[pixel], compiled->depths[pixel]};
    if (triangles[0] == 0 && triangles[1] == 0) return PIXEL_SAME;
    if (triangles[0] == 0 || triangles[1] == 0) return PIXEL_BAD;
    uint32_t names[2];
    for (int i = 0; i < 2; ++i) names[i] = p->material_names[i][picture_material(p->scenes[i], triangles[i] - 1)];
    if (names[0] == names[1]) return PIXEL_SAME;
    return is_coplanar(p, c, triangles, depths, pixel) ? PIXEL_COPLANAR : PIXEL_BAD;
}

// ---- What else the raw scene has there ----

static int has_point(const double (*corner)[3], const double p[3], double near)
{
    double n[3], off[3];
    normal_of(corner, n);
    const double length = sqrt(dot(n, n));
    for (int k = 0; k < 3; ++k) off[k] = p[k] - corner[0][k];
    if (!(fabs(dot(n, off)) <= near * length)) return 0;
    for (int i = 0; i < 3; ++i) {
        double edge[3], from[3], out[3];
        for (int k = 0; k < 3; ++k) edge[k] = corner[(i + 1) % 3][k] - corner[i][k], from[k] = p[k] - corner[i][k];
        for (int k = 0; k < 3; ++k) out[k] = edge[(k + 1) % 3] * n[(k + 2) % 3] - edge[(k + 2) % 3] * n[(k + 1) % 3];
        if (dot(out, from) > near * sqrt(dot(out, out))) return 0;
    }
    return 1;
}

int picture_has_both(const picture_pair *p, const camera *c, const pixel_place *compiled)
{
    const scene *raw = p->scenes[0];
    const uint32_t name = p->material_names[1][picture_material(p->scenes[1], compiled->triangle)];
    double at[3], distance;
    if (!picture_point(p->scenes[1], compiled, c, at, &distance)) return 1;
    const double near = WELDED_M + distance / PICTURE_HEIGHT;
    for (uint32_t t = 0; t < raw->index_count / 3; ++t) {
        if (picture_material(raw, t) != name) continue;
        double corner[3][3];
        for (uint32_t i = 0; i < 3; ++i) corner_of(raw, t, i, corner[i]);
        if (has_point((const double(*)[3])corner, at, near)) return 1;
    }
    return 0;
}

// ---- Liquids as walls ----

result scene_opaque_make(const scene *s, scene *out)
{
    *out = *s;
    const size_t items = (size_t)s->item_count + s->mover_count;
    out->materials = malloc((s->material_count + 1u) * sizeof *out->materials);
    out->items = malloc((items + 1) * sizeof *out->items);
    if (!out->materials || !out->items) {
        scene_opaque_free(out);
        return RESULT_NO_MEMORY;
    }
    memcpy(out->materials, s->materials, s->material_count * sizeof *out->materials);
    memcpy(out->items, s->items, items * sizeof *out->items);
    for (uint32_t m = 0; m < s->material_count; ++m) out->materials[m].flags &= ~(uint32_t)MATERIAL_TRANSLUCENT;
    for (size_t i = 0; i < items; ++i) out->items[i].flags &= ~(uint32_t)CULL_ITEM_SEE_THROUGH;
    return RESULT_OK;
}

void scene_opaque_free(scene *s)
{
    free(s->materials);
    free(s->items);
    s->materials = NULL;
    s->items = NULL;
}
