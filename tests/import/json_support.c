// See json_support.h.
// SPDX-License-Identifier: MIT
#include "json_support.h"

#include <string.h>

static result read_memory_file(void *user, const char *path, const allocator *memory, report *r, char **out_text, size_t *out_size)
{
    for (const memory_file *f = user; f && f->path; ++f) {
        if (strcmp(f->path, path) != 0) continue;
        const size_t size = strlen(f->text);
        char *text = memory_alloc(memory, size + 1, 1);
        if (!text) return report_no_memory(r, path);
        memcpy(text, f->text, size + 1);
        *out_text = text;
        *out_size = size;
        return RESULT_OK;
    }
    return report_error(r, path, 0, "cannot open it: no such file in memory; check the name");
}

import_files memory_files(const memory_file *files)
{
    return (import_files){read_memory_file, (void *)(uintptr_t)files};
}

static scene *import(const char *text, const import_options *options, const memory_file *files)
{
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    const import_files from = memory_files(files);
    if (import_json("t.json", text, strlen(text), options, &from, allocator_heap(), &r, &s) != RESULT_OK) fail_msg("%s", h.text);
    if (r.warnings) fail_msg("%s", h.text);
    return s;
}

scene *json_of(const char *text, const memory_file *files)
{
    return import(text, &doors_open, files);
}

scene *json_with_doors(const char *text, const import_options *options)
{
    return import(text, options, NULL);
}

void expect_json_error(const char *text, const memory_file *files, const char *line)
{
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    const import_files from = memory_files(files);
    assert_int_equal(import_json("t.json", text, strlen(text), &doors_open, &from, allocator_heap(), &r, &s), RESULT_BAD_INPUT);
    assert_null(s);
    assert_string_equal(h.text, line);
    assert_int_equal(r.errors, 1);
}

uint32_t zone_of(const scene *s, const char *name)
{
    for (uint32_t z = 0; z < s->zone_count; ++z)
        if (strcmp(s->zones[z].name, name) == 0) return z;
    fail_msg("no zone %s", name);
    return 0;
}

uint32_t mover_of(const scene *s, const char *name)
{
    for (uint32_t m = 0; m < s->mover_count; ++m)
        if (strcmp(s->movers[m].name, name) == 0) return m;
    fail_msg("no mover %s", name);
    return 0;
}

static void assert_same_movers(const scene *a, const scene *b)
{
    assert_int_equal(a->mover_count, b->mover_count);
    for (uint32_t m = 0; m < a->mover_count; ++m) {
        const scene_mover *x = &a->movers[m], *y = &b->movers[m];
        assert_memory_equal(x->open_offset, y->open_offset, sizeof x->open_offset);
        assert_memory_equal(x->pivot, y->pivot, sizeof x->pivot);
        for (int k = 0; k < 9; ++k) assert_true(x->axes[k] == y->axes[k]);
        assert_int_equal(x->key_count, y->key_count);
        assert_int_equal(x->door, y->door);
    }
}

static void assert_same_zones(const scene *a, const scene *b)
{
    assert_int_equal(a->zone_count, b->zone_count);
    for (uint32_t z = 0; z < a->zone_count; ++z) {
        const scene_zone *x = &a->zones[z], *y = &b->zones[z];
        assert_int_equal(x->hull_count, y->hull_count);
        assert_int_equal(x->parent, y->parent);
        assert_int_equal(x->item_count, y->item_count);
        assert_memory_equal(a->zone_items + x->first_item, b->zone_items + y->first_item, x->item_count * sizeof *a->zone_items);
    }
    assert_int_equal(a->hull_plane_count, b->hull_plane_count);
    assert_memory_equal(a->hull_planes, b->hull_planes, a->hull_plane_count * sizeof *a->hull_planes);
    assert_int_equal(a->portal_count, b->portal_count);
    assert_int_equal(a->portal_point_count, b->portal_point_count);
    assert_memory_equal(a->portal_points, b->portal_points, a->portal_point_count * sizeof *a->portal_points);
}

void assert_same_scene(const scene *a, const scene *b)
{
    assert_int_equal(a->position_count, b->position_count);
    assert_memory_equal(a->whole.origin, b->whole.origin, sizeof a->whole.origin);
    assert_memory_equal(a->positions, b->positions, a->position_count * sizeof *a->positions);
    assert_int_equal(a->index_count, b->index_count);
    assert_memory_equal(a->indices, b->indices, a->index_count * sizeof *a->indices);
    assert_same_zones(a, b);
    assert_same_movers(a, b);
    assert_int_equal(a->key_count, b->key_count);
    if (a->key_count) assert_memory_equal(a->keys, b->keys, a->key_count * sizeof *a->keys);
    assert_int_equal(a->camera_count, b->camera_count);
    if (a->camera_count) assert_memory_equal(a->cameras, b->cameras, a->camera_count * sizeof *a->cameras);
    assert_int_equal(a->door_count, b->door_count);
    assert_int_equal(a->light_count, b->light_count);
}
