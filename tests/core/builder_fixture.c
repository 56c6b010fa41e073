// A scene builder for tests: see builder_fixture.h.
// SPDX-License-Identifier: MIT
#include "builder_fixture.h"

#include "tests/common/test.h"

#include <stdlib.h>

static int start(builder_fixture *f)
{
    failing_allocator_init(&f->memory, 0);
    report_lines_init(&f->lines);
    f->scene = NULL;
    uint32_t id;
    if (scene_builder_open(&f->memory.memory, &f->builder) != RESULT_OK) return 1;
    if (scene_builder_material(f->builder, "stone", 5, 0, &id) != RESULT_OK) return 1;
    return scene_builder_object(f->builder, "world", 5, &id) == RESULT_OK ? 0 : 1;
}

static int stop(builder_fixture *f)
{
    scene_builder_close(f->builder);
    scene_free(f->scene, &f->memory.memory);
    return failing_allocator_is_clean(&f->memory) ? 0 : 1;
}

int builder_fixture_set_up(void **state)
{
    *state = calloc(1, sizeof(builder_fixture));
    return *state ? start(*state) : 1;
}

int builder_fixture_tear_down(void **state)
{
    const int left = stop(*state);
    free(*state);
    return left;
}

void builder_fixture_restart(builder_fixture *f)
{
    assert_int_equal(stop(f), 0);
    assert_int_equal(start(f), 0);
}

uint32_t builder_fixture_vertex(builder_fixture *f, double x, double y, double z)
{
    const builder_vertex v = {.position = {x, y, z}};
    uint32_t first;
    assert_int_equal(scene_builder_vertices(f->builder, &v, 1, 0, &first), RESULT_OK);
    return first;
}

void builder_fixture_triangle(builder_fixture *f, const double at[3], double size)
{
    const uint32_t first = builder_fixture_vertex(f, at[0], at[1], at[2]);
    builder_fixture_vertex(f, at[0] + size, at[1], at[2]);
    builder_fixture_vertex(f, at[0], at[1] + size, at[2]);
    const uint32_t indices[3] = {first, first + 1, first + 2};
    const builder_item item = {.indices = indices, .index_count = 3, .polygon_count = 1};
    assert_int_equal(scene_builder_item(f->builder, &item), RESULT_OK);
}

result builder_fixture_finish(builder_fixture *f)
{
    return scene_builder_finish(f->builder, "test.scene", &f->lines.report, &f->scene);
}
