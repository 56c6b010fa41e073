// A scene builder for tests, with a material 0 and an object 0 in it, counted and watched.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_BUILDER_FIXTURE_H
#define PORTCULLIS_TESTS_BUILDER_FIXTURE_H

#include "host/core/scene.h"
#include "tests/common/failing_allocator.h"
#include "tests/common/report_lines.h"

typedef struct builder_fixture {
    failing_allocator memory;
    report_lines lines;
    scene_builder *builder;
    scene *scene; // what builder_fixture_finish made
} builder_fixture;

int builder_fixture_set_up(void **state); // *state: a builder_fixture
int builder_fixture_tear_down(void **state); // not 0 when anything is left allocated
void builder_fixture_restart(builder_fixture *f); // a new builder, no scene; asserts that the old ones left nothing

uint32_t builder_fixture_vertex(builder_fixture *f, double x, double y, double z); // the vertex's number
void builder_fixture_triangle(builder_fixture *f, const double at[3], double size); // an item in the plane z = at[2]
result builder_fixture_finish(builder_fixture *f);

#endif
