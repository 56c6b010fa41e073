// Fixture of the CSG's tests: see csg_fixture.h.
// SPDX-License-Identifier: MIT
#include "tests/common/test.h"

#include "csg_fixture.h"
#include "host/core/file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const real_maps[8] = {"quake/dm4.map",           "quake/e1m1.map",          "quake/e1m4.map",            "quake/e3m5.map",
                                  "librequake/lqdm12.map", "librequake/lqdm7.map", "librequake/lq_e0m8.map", "librequake/lq_e3m4.map"};

scene_draft draft_make(void)
{
    const allocator *heap = allocator_heap();
    scene_draft d = {plane_table_make(heap), buffer_make(heap, sizeof(compile_brush)), buffer_make(heap, sizeof(compile_face)),
                     buffer_make(heap, sizeof(compile_material))};
    static const char *const names[4] = {"stone", "brick", "metal", "*water"};
    for (int i = 0; i < 4; ++i) {
        const compile_material m = {.name = names[i]};
        assert_non_null(buffer_append(&d.materials, &m, 1));
    }
    assert_non_null(d.planes);
    return d;
}

void draft_free(scene_draft *d)
{
    plane_table_free(d->planes);
    buffer_free(&d->brushes);
    buffer_free(&d->faces);
    buffer_free(&d->materials);
}

void draft_brush(scene_draft *d, brush_kind kind, brush_role role, uint32_t material)
{
    const compile_brush b = {.first_face = (uint32_t)d->faces.count, .kind = kind, .role = role, .entity = material};
    assert_non_null(buffer_append(&d->brushes, &b, 1));
}

void draft_plane(scene_draft *d, const cull_wide_plane *plane)
{
    compile_brush *b = (compile_brush *)d->brushes.items + d->brushes.count - 1;
    const compile_face f = {.plane = plane_table_add(d->planes, plane), .material = b->entity};
    assert_int_not_equal(f.plane, PLANE_NONE);
    assert_non_null(buffer_append(&d->faces, &f, 1));
    b->face_count++;
}

void draft_box(scene_draft *d, brush_kind kind, const int32_t min[3], const int32_t max[3], uint32_t material)
{
    draft_brush(d, kind, BRUSH_STRUCTURE, material);
    for (int k = 0; k < 3; ++k) {
        cull_wide_plane low = {{0, 0, 0}, cull_wide_from(min[k])}, high = {{0, 0, 0}, cull_wide_from(-max[k])};
        low.normal[k] = -1;
        high.normal[k] = 1;
        draft_plane(d, &low);
        draft_plane(d, &high);
    }
}

compile_input draft_input(scene_draft *d)
{
    return (compile_input){.planes = d->planes,
                           .brushes = d->brushes.items,
                           .faces = d->faces.items,
                           .materials = d->materials.items,
                           .brush_count = (uint32_t)d->brushes.count,
                           .face_count = (uint32_t)d->faces.count,
                           .material_count = (uint32_t)d->materials.count,
                           .steps_per_metre = 8192,
                           .path = "draft"};
}

compile_input *real_map(const char *name, double grid)
{
    const char *folder = getenv("PORTCULLIS_SCENES");
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder ? folder : ".", name);
    FILE *file = fopen(path, "rb");
    if (!file) {
        print_message("SKIPPED: no %s (PORTCULLIS_SCENES)\n", path);
        return NULL;
    }
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    const long size = ftell(file);
    assert_true(size > 0);
    rewind(file);
    char *text = malloc((size_t)size);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, (size_t)size, file), (size_t)size);
    fclose(file);
    report quiet = {0};
    const input_options options = {.grid = grid};
    compile_input *in = NULL;
    assert_int_equal(compile_input_map(path, text, (size_t)size, &options, allocator_heap(), &quiet, &in), RESULT_OK);
    free(text);
    return in;
}

map_turn turn_number(int number)
{
    static const int axes[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    map_turn t = {.scale = 1};
    const int order = number / 4 % 6, odd = order >= 3, mirrored = number >= 24;
    int signs[3] = {number & 1 ? -1 : 1, number & 2 ? -1 : 1, 1};
    signs[2] = signs[0] * signs[1] * (odd ? -1 : 1) * (mirrored ? -1 : 1);
    for (int k = 0; k < 3; ++k) t.turn[k][axes[order][k]] = signs[k];
    return t;
}

static cull_wide_plane turned_plane(const cull_wide_plane *p, const map_turn *by)
{
    cull_wide_plane out = {{0, 0, 0}, cull_wide_scale(p->offset, (int64_t)by->scale * by->scale)};
    for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j) out.normal[k] += by->turn[k][j] * p->normal[j];
    out.offset = cull_wide_subtract(out.offset, cull_wide_dot_point(out.normal, by->move));
    return out;
}

compile_input turned_input(const compile_input *in, const map_turn *by, const uint32_t *order, scene_draft *d)
{
    *d = draft_make();
    for (uint32_t i = 0; i < in->brush_count; ++i) {
        const compile_brush *from = &in->brushes[order ? order[i] : i];
        compile_brush brush = *from;
        brush.first_face = (uint32_t)d->faces.count;
        assert_non_null(buffer_append(&d->brushes, &brush, 1));
        for (uint32_t f = 0; f < from->face_count; ++f) {
            compile_face face = in->faces[from->first_face + f];
            const cull_wide_plane was = plane_table_get(in->planes, face.plane), now = turned_plane(&was, by);
            face.plane = plane_table_add(d->planes, &now);
            assert_int_not_equal(face.plane, PLANE_NONE);
            for (int row = 0; row < 2; ++row)
                for (int k = 0; k < 3; ++k) {
                    double sum = 0;
                    for (int j = 0; j < 3; ++j) sum += by->turn[k][j] * in->faces[from->first_face + f].texture[row][j];
                    face.texture[row][k] = sum / (by->scale * by->scale);
                }
            assert_non_null(buffer_append(&d->faces, &face, 1));
        }
    }
    compile_input out = draft_input(d);
    out.materials = in->materials;
    out.material_count = in->material_count;
    return out;
}

compile_mesh *surface_of(const compile_input *in, csg_counts *counts)
{
    report quiet = {0};
    compile_mesh *mesh = NULL;
    assert_int_equal(compile_csg(in, &quiet, allocator_heap(), &mesh, counts), RESULT_OK);
    assert_non_null(mesh);
    return mesh;
}

// ---- Exact measures ----

static void set_wide(mpz_t out, cull_wide v)
{
    const cull_wide size = cull_wide_magnitude(v);
    mpz_set_ui(out, size.high);
    mpz_mul_2exp(out, out, 64);
    mpz_add_ui(out, out, size.low);
    if (cull_wide_sign(v) < 0) mpz_neg(out, out);
}

static void determinant(mpz_t rows[3][4], const int columns[3], mpz_t out)
{
    static const int terms[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    mpz_t part;
    mpz_init(part);
    mpz_set_ui(out, 0);
    for (int t = 0; t < 6; ++t) {
        mpz_mul(part, rows[0][columns[terms[t][0]]], rows[1][columns[terms[t][1]]]);
        mpz_mul(part, part, rows[2][columns[terms[t][2]]]);
        if (t < 3) mpz_add(out, out, part);
        else mpz_sub(out, out, part);
    }
    mpz_clear(part);
}

void point_of(const compile_input *in, const compile_vertex *v, mpq_t out[3])
{
    mpz_t rows[3][4], w;
    mpz_init(w);
    for (int r = 0; r < 3; ++r) {
        const cull_wide_plane p = plane_table_get(in->planes, v->planes[r]);
        for (int k = 0; k < 3; ++k) mpz_init_set_si(rows[r][k], p.normal[k]);
        mpz_init(rows[r][3]);
        set_wide(rows[r][3], cull_wide_negate(p.offset)); // n . x = -offset
    }
    determinant(rows, (const int[3]){0, 1, 2}, w);
    assert_int_not_equal(mpz_sgn(w), 0);
    static const int replaced[3][3] = {{3, 1, 2}, {0, 3, 2}, {0, 1, 3}};
    for (int k = 0; k < 3; ++k) {
        determinant(rows, replaced[k], mpq_numref(out[k]));
        mpz_set(mpq_denref(out[k]), w);
        mpq_canonicalize(out[k]);
    }
    for (int r = 0; r < 3; ++r)
        for (int k = 0; k < 4; ++k) mpz_clear(rows[r][k]);
    mpz_clear(w);
}

static void cross(mpq_t a[3], mpq_t b[3], mpq_t out[3])
{
    mpq_t part;
    mpq_init(part);
    for (int k = 0; k < 3; ++k) {
        mpq_mul(out[k], a[(k + 1) % 3], b[(k + 2) % 3]);
        mpq_mul(part, a[(k + 2) % 3], b[(k + 1) % 3]);
        mpq_sub(out[k], out[k], part);
    }
    mpq_clear(part);
}

// The sum of p x q over a loop's edges is twice its directed area; its first corner times that is six times its volume to the origin.
static void polygon_measures(const compile_mesh *m, const compile_polygon *p, mpq_t (*points)[3], mpq_t volume, mpq_t area[3])
{
    mpq_t sum[3], part[3];
    for (int k = 0; k < 3; ++k) {
        mpq_init(sum[k]);
        mpq_init(part[k]);
    }
    const uint32_t *loop = m->loop + p->first_vertex;
    for (uint32_t i = 0; i < p->vertex_count; ++i) {
        cross(points[loop[i]], points[loop[i + 1 < p->vertex_count ? i + 1 : 0]], part);
        for (int k = 0; k < 3; ++k) mpq_add(sum[k], sum[k], part[k]);
    }
    for (int k = 0; k < 3; ++k) {
        mpq_add(area[k], area[k], sum[k]);
        mpq_mul(part[k], sum[k], points[loop[0]][k]);
        mpq_add(volume, volume, part[k]);
    }
    for (int k = 0; k < 3; ++k) {
        mpq_clear(sum[k]);
        mpq_clear(part[k]);
    }
}

void mesh_measures(const compile_input *in, const compile_mesh *m, mpq_t volume, mpq_t area[3])
{
    mpq_t(*points)[3] = malloc((m->vertex_count + 1) * sizeof *points);
    assert_non_null(points);
    for (uint32_t v = 0; v < m->vertex_count; ++v) {
        for (int k = 0; k < 3; ++k) mpq_init(points[v][k]);
        point_of(in, &m->vertices[v], points[v]);
    }
    mpq_set_ui(volume, 0, 1);
    for (int k = 0; k < 3; ++k) mpq_set_ui(area[k], 0, 1);
    for (uint32_t p = 0; p < m->polygon_count; ++p)
        if (in->brushes[m->polygons[p].brush].role == BRUSH_STRUCTURE) polygon_measures(m, &m->polygons[p], points, volume, area);
    for (uint32_t v = 0; v < m->vertex_count; ++v)
        for (int k = 0; k < 3; ++k) mpq_clear(points[v][k]);
    free(points);
}

// ---- Prints ----

static uint64_t mix(uint64_t h, uint64_t v)
{
    h = (h ^ v) * 0xbf58476d1ce4e5b9u;
    return h ^ h >> 27;
}

static uint64_t corner_print(const double position[3], const map_turn *back)
{
    uint64_t h = 1;
    for (int k = 0; k < 3; ++k) {
        double at = 0; // the turn's transpose undoes it
        for (int j = 0; j < 3; ++j) at += back->turn[j][k] * (position[j] - back->move[j]);
        h = mix(h, (uint64_t)(int64_t)floor(at / back->scale * 1024 + 0.37));
    }
    return h;
}

static int compare_prints(const void *a, const void *b)
{
    const uint64_t p = *(const uint64_t *)a, q = *(const uint64_t *)b;
    return (p > q) - (p < q);
}

uint64_t *polygon_prints(const compile_mesh *m, const map_turn *back)
{
    uint64_t *prints = malloc((m->polygon_count + 1) * sizeof *prints);
    assert_non_null(prints);
    for (uint32_t p = 0; p < m->polygon_count; ++p) {
        prints[p] = mix(m->polygons[p].material, m->polygons[p].vertex_count);
        for (uint32_t i = 0; i < m->polygons[p].vertex_count; ++i)
            prints[p] += corner_print(m->vertices[m->loop[m->polygons[p].first_vertex + i]].position, back);
    }
    qsort(prints, m->polygon_count, sizeof *prints, compare_prints);
    return prints;
}
