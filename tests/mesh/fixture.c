// What the mesh tests share: see fixture.h.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void capture(void *user, report_level level, const char *text)
{
    captured *c = user;
    if (level == REPORT_NOTE) return;
    const size_t length = strlen(text);
    if (c->used + length + 2 > sizeof c->text) return;
    memcpy(c->text + c->used, text, length);
    c->used += length;
    c->text[c->used++] = '\n';
    c->text[c->used] = 0;
}

void captured_open(captured *c)
{
    memset(c, 0, sizeof *c);
    c->report.line = capture;
    c->report.user = c;
}

static result import_stl_bytes(const char *path, const void *bytes, size_t size, const allocator *memory, report *r, scene **out)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    const result done = import_stl(path, memory, r, out);
    remove(path);
    return done;
}

result import_bytes(const char *path, const void *bytes, size_t size, const allocator *memory, report *r, scene **out)
{
    const char *ending = strrchr(path, '.');
    if (strcmp(ending, ".stl") == 0) return import_stl_bytes(path, bytes, size, memory, r, out);
    char *text = malloc(size + 1); // of the exact size, so that a sanitizer sees a read past it
    assert_non_null(text);
    if (size) memcpy(text, bytes, size);
    text[size] = 0;
    result done;
    if (strcmp(ending, ".obj") == 0) done = import_obj(path, text, size, memory, r, out);
    else if (strcmp(ending, ".ply") == 0) done = import_ply(path, text, size, memory, r, out);
    else done = import_off(path, text, size, memory, r, out);
    free(text);
    return done;
}

scene *import_good(const char *path, const char *text)
{
    captured c;
    scene *s = NULL;
    captured_open(&c);
    const result done = import_bytes(path, text, strlen(text), allocator_heap(), &c.report, &s);
    assert_string_equal(c.text, "");
    assert_int_equal(done, RESULT_OK);
    assert_clusters_are_sound(s);
    return s;
}

void assert_refused(const char *path, const char *text, const char *line)
{
    captured c;
    scene *s = NULL;
    captured_open(&c);
    const result done = import_bytes(path, text, strlen(text), allocator_heap(), &c.report, &s);
    if (done != RESULT_BAD_INPUT || strncmp(c.text, line, strlen(line)) != 0)
        print_error("for:\n%.200s\nexpected: %s...\n     got: %s\n", text, line, c.text);
    assert_int_equal(done, RESULT_BAD_INPUT);
    assert_null(s);
    assert_memory_equal(c.text, line, strlen(line));
}

int has_openmesh(void)
{
#ifdef PORTCULLIS_WITH_OPENMESH
    return 1;
#else
    fprintf(stderr, "SKIPPED: built without OpenMesh\n");
    skip();
    return 0;
#endif
}

char *scene_file(const char *name, size_t *size)
{
    const char *folder = getenv("PORTCULLIS_SCENES");
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder ? folder : "", name);
    FILE *file = folder ? fopen(path, "rb") : NULL;
    if (!file) {
        fprintf(stderr, "SKIPPED: no scene %s (PORTCULLIS_SCENES is %s)\n", name, folder ? folder : "not set");
        skip();
        return NULL;
    }
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    const long length = ftell(file);
    rewind(file);
    char *bytes = malloc((size_t)length + 1);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, (size_t)length, file), length);
    bytes[length] = 0;
    fclose(file);
    *size = (size_t)length;
    return bytes;
}

static double triangle_area(const scene *s, uint32_t first_index)
{
    const cull_vec3 a = s->positions[s->indices[first_index]], b = s->positions[s->indices[first_index + 1]], c = s->positions[s->indices[first_index + 2]];
    const double u[3] = {(double)b.x - (double)a.x, (double)b.y - (double)a.y, (double)b.z - (double)a.z};
    const double v[3] = {(double)c.x - (double)a.x, (double)c.y - (double)a.y, (double)c.z - (double)a.z};
    const double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2], z = u[0] * v[1] - u[1] * v[0];
    return sqrt(x * x + y * y + z * z) / 2;
}

double scene_area(const scene *s)
{
    double area = 0;
    for (uint32_t i = 0; i < s->index_count; i += 3) area += triangle_area(s, i);
    return area;
}

void assert_same_geometry(const scene *a, const scene *b)
{
    assert_int_equal(a->item_count, b->item_count);
    assert_int_equal(a->polygon_count, b->polygon_count);
    assert_int_equal(a->index_count, b->index_count);
    assert_int_equal(a->position_count, b->position_count);
    assert_memory_equal(a->positions, b->positions, a->position_count * sizeof *a->positions);
    assert_memory_equal(a->normals, b->normals, a->position_count * sizeof *a->normals);
    assert_memory_equal(a->indices, b->indices, a->index_count * sizeof *a->indices);
    assert_memory_equal(a->items, b->items, a->item_count * sizeof *a->items);
}

void assert_clusters_are_sound(const scene *s)
{
    uint32_t index = 0, polygon = 0;
    for (uint32_t i = 0; i < s->item_count; ++i) {
        const scene_item *item = &s->items[i];
        assert_int_equal(item->first_index, index);
        assert_int_equal(item->first_polygon, polygon);
        assert_true(item->index_count / 3 <= 128 || item->polygon_count == 1);
        assert_int_equal(item->flags & ~(uint32_t)CULL_ITEM_TWO_SIDED, 0);
        index += item->index_count;
        polygon += item->polygon_count;
        assert_int_equal(s->polygon_first_triangle[polygon] * 3, index);
    }
    assert_int_equal(index, s->index_count);
    assert_int_equal(polygon, s->polygon_count);
}

void remove_scene(scene *s)
{
    scene_free(s, allocator_heap());
}
