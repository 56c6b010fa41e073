// Scene builder, the end: tangents of vertices whose material has a normal map, of triangles' texture coordinates (Lengyel's
// sums, 2001), Gram-Schmidt against the vertex's normal, or its face's where shading is flat; the binormal by its sign alone.
// SPDX-License-Identifier: MIT
// Invariant: a vertex's triangles all turn their texture the same way round: those of mirrored halves have vertices apart.
#include "scene_finish.h"

#include <math.h>
#include <string.h>

static const double FLOAT_STEP = 1.0 / (1 << 23); // of a texture coordinate's size: what it is known to
static const double FLAT_SHARE = 1e-12; // squared, of the sums' size: below, a direction is noise
enum { TANGENT_STEPS = 511 };           // a component of 10 bits

static int has_normal_map(const scene_material *materials, uint16_t material)
{
    return (materials[material].flags & MATERIAL_NORMAL_MAP) != 0;
}

static int any_normal_map(const scene_builder *b)
{
    const scene_material *materials = b->materials.items;
    uint32_t flags = 0;
    for (size_t m = 0; m < b->materials.count; ++m) flags |= materials[m].flags;
    return (flags & MATERIAL_NORMAL_MAP) != 0;
}

// ---- Mirrored halves ----

// 1, -1: the way round of the triangle's texture; 0: it has no area there.
static int turn_of(const float (*texcoords)[2], const uint32_t t[3])
{
    const double u1 = (double)texcoords[t[1]][0] - (double)texcoords[t[0]][0], v1 = (double)texcoords[t[1]][1] - (double)texcoords[t[0]][1];
    const double u2 = (double)texcoords[t[2]][0] - (double)texcoords[t[0]][0], v2 = (double)texcoords[t[2]][1] - (double)texcoords[t[0]][1];
    const double area = u1 * v2 - u2 * v1;
    double largest = 0;
    for (int k = 0; k < 6; ++k) largest = fmax(largest, fabs((double)texcoords[t[k / 2]][k % 2]));
    const double error = 2 * FLOAT_STEP * largest * ((fabs(u1) + fabs(v1)) + (fabs(u2) + fabs(v2)));
    return area > error ? 1 : area < -error ? -1 : 0;
}

typedef struct mirror { // of one vertex
    int8_t turn;        // of the first triangle that has one
    uint32_t twin;      // for the others; 0: none yet, 0 itself is nobody's twin
} mirror;

static result copy_vertex(scene_builder *b, uint32_t vertex, uint32_t *out)
{
    buffer *const parts[] = {&b->positions, &b->normals, &b->texcoords, &b->vertex_materials};
    if (b->positions.count >= UINT32_MAX) return RESULT_BAD_INPUT;
    *out = (uint32_t)b->positions.count;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; ++i) {
        char *to = buffer_push(parts[i], 1);
        if (!to) return RESULT_NO_MEMORY;
        memcpy(to, (const char *)parts[i]->items + (size_t)vertex * parts[i]->item_size, parts[i]->item_size);
    }
    return RESULT_OK;
}

static result part_triangle(scene_builder *b, mirror *mirrors, uint32_t t[3])
{
    const int turn = turn_of(b->texcoords.items, t);
    for (int k = 0; k < 3 && turn; ++k) {
        mirror *m = &mirrors[t[k]];
        if (!has_normal_map(b->materials.items, ((const uint16_t *)b->vertex_materials.items)[t[k]])) continue;
        if (!m->turn) m->turn = (int8_t)turn;
        if (m->turn == turn) continue;
        const result done = m->twin ? RESULT_OK : copy_vertex(b, t[k], &m->twin);
        if (done != RESULT_OK) return done;
        t[k] = m->twin;
    }
    return RESULT_OK;
}

result finish_part_mirrored(scene_builder *b)
{
    const size_t count = b->positions.count;
    if (!any_normal_map(b) || count == 0) return RESULT_OK;
    mirror *mirrors = memory_alloc_zeroed(b->memory, count, sizeof *mirrors);
    buffer *const lists[] = {&b->statics.indices, &b->movers.indices};
    result done = mirrors ? RESULT_OK : RESULT_NO_MEMORY;
    for (int l = 0; l < 2; ++l)
        for (size_t i = 0; i + 2 < lists[l]->count && done == RESULT_OK; i += 3) done = part_triangle(b, mirrors, (uint32_t *)lists[l]->items + i);
    memory_free(b->memory, mirrors, count, sizeof *mirrors);
    return done;
}

// ---- Sums ----

typedef struct frame_sum { double tangent[3], normal[3]; int turn; } frame_sum;

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static double dot(const double a[3], const double b[3])
{
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

static void edge_between(cull_vec3 from, cull_vec3 to, double out[3])
{
    out[0] = (double)to.x - (double)from.x;
    out[1] = (double)to.y - (double)from.y;
    out[2] = (double)to.z - (double)from.z;
}

// Weighted by area, in space and in the texture.
static void add_triangle(const scene *s, const float (*texcoords)[2], const uint32_t t[3], const uint32_t *number, frame_sum *sums)
{
    double e1[3], e2[3], normal[3], tangent[3];
    edge_between(s->positions[t[0]], s->positions[t[1]], e1);
    edge_between(s->positions[t[0]], s->positions[t[2]], e2);
    const double v1 = (double)texcoords[t[1]][1] - (double)texcoords[t[0]][1], v2 = (double)texcoords[t[2]][1] - (double)texcoords[t[0]][1];
    const int turn = turn_of(texcoords, t);
    cross(e1, e2, normal);
    for (int k = 0; k < 3; ++k) tangent[k] = turn * (e1[k] * v2 - e2[k] * v1);
    for (int c = 0; c < 3; ++c) {
        if (number[t[c]] == UINT32_MAX) continue;
        frame_sum *sum = &sums[number[t[c]]];
        for (int k = 0; k < 3; ++k) {
            sum->tangent[k] += tangent[k];
            sum->normal[k] += normal[k];
        }
        if (turn) sum->turn = turn;
    }
}

// ---- Packing ----

static void normal_of(uint32_t packed, const double face[3], double out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = packed ? (double)(int8_t)(packed >> (8 * k) & 0xff) : face[k];
    const double length = sqrt(dot(out, out));
    for (int k = 0; k < 3; ++k) out[k] = length > 0 ? out[k] / length : k == 1;
}

// Gram-Schmidt; along any axis where nothing of the sum is left.
static void make_upright(const double normal[3], const double sum[3], double out[3])
{
    const double along = dot(normal, sum), size = dot(sum, sum);
    for (int k = 0; k < 3; ++k) out[k] = sum[k] - along * normal[k];
    double square = dot(out, out);
    if (!(square > FLAT_SHARE * size) || !(square > 0)) {
        int axis = 0;
        for (int k = 1; k < 3; ++k)
            if (fabs(normal[k]) < fabs(normal[axis])) axis = k;
        for (int k = 0; k < 3; ++k) out[k] = (k == axis) - normal[axis] * normal[k];
        square = dot(out, out);
    }
    for (int k = 0; k < 3; ++k) out[k] /= sqrt(square);
}

static uint32_t pack(const double tangent[3], int turn)
{
    uint32_t packed = turn < 0 ? 3u << 30 : 1u << 30;
    for (int k = 0; k < 3; ++k) packed |= ((uint32_t)(int32_t)lrint(tangent[k] * TANGENT_STEPS) & 1023u) << (10 * k);
    return packed;
}

void scene_tangent_unpack(uint32_t packed, double tangent[3], int *turn)
{
    for (int k = 0; k < 3; ++k) {
        const int32_t bits = (int32_t)(packed >> (10 * k) & 1023u);
        tangent[k] = (double)(bits < 512 ? bits : bits - 1024) / TANGENT_STEPS;
    }
    *turn = packed >> 30 == 3 ? -1 : packed >> 30 == 1 ? 1 : 0;
}

// ---- All of them ----

static void take_all(scene *s, const float (*texcoords)[2], const uint32_t *number, frame_sum *sums)
{
    for (uint32_t i = 0; i < s->index_count; i += 3) add_triangle(s, texcoords, s->indices + i, number, sums);
    for (uint32_t v = 0; v < s->position_count; ++v) {
        if (number[v] == UINT32_MAX) continue;
        const frame_sum *sum = &sums[number[v]];
        double normal[3], tangent[3];
        normal_of(s->normals[v], sum->normal, normal);
        make_upright(normal, sum->tangent, tangent);
        s->tangents[number[v]] = pack(tangent, sum->turn);
    }
}

// By vertex: its place among those that have a tangent; UINT32_MAX: it has none.
static uint32_t number_vertices(const scene *s, uint32_t *number)
{
    uint32_t count = 0;
    for (uint32_t v = 0; v < s->position_count; ++v) number[v] = has_normal_map(s->materials, s->vertex_materials[v]) ? count++ : UINT32_MAX;
    return count;
}

void finish_tangents(finish *f)
{
    scene *s = f->s;
    const allocator *memory = f->b->memory;
    if (!any_normal_map(f->b)) return;
    uint32_t *number = memory_alloc(memory, s->position_count, sizeof *number);
    const uint32_t count = number ? number_vertices(s, number) : 0;
    frame_sum *sums = memory_alloc_zeroed(memory, count, sizeof *sums);
    if (count) s->tangents = finish_take(f, count, sizeof *s->tangents);
    if (!number || !sums) f->failed = 1;
    if (!f->failed && count) {
        s->tangent_count = count;
        take_all(s, (const float(*)[2])f->b->texcoords.items, number, sums);
    }
    memory_free(memory, sums, count, sizeof *sums);
    memory_free(memory, number, s->position_count, sizeof *number);
}
