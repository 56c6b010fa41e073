// Every allocation of writing, reading and baking fails once: no crash, no leak, no file, RESULT_NO_MEMORY and one line.
// SPDX-License-Identifier: MIT
#include "pcs_fixture.h"

#include "host/compile/bake_zones.h"
#include "host/core/world_parts.h"
#include "tests/common/failing_allocator.h"
#include "tests/common/scratch_folder.h"

#include <string.h>

typedef result (*task)(void *user, const allocator *memory, report *r); // leaves nothing allocated

static uint64_t fail_each(task what, void *user)
{
    for (uint64_t fail_at = 1;; ++fail_at) {
        failing_allocator memory;
        heard h;
        report r = hear(&h);
        failing_allocator_init(&memory, fail_at);
        const result done = what(user, &memory.memory, &r);
        assert_true(failing_allocator_is_clean(&memory));
        if (!memory.failures) {
            assert_int_equal(done, RESULT_OK);
            return fail_at;
        }
        assert_int_equal(done, RESULT_NO_MEMORY);
        assert_int_equal(r.errors, 1);
        assert_non_null(strstr(h.text, "out of memory"));
    }
}

typedef struct round_trip {
    scene *scene;
    char path[512];
    const char *bytes;
    size_t size;
} round_trip;

static result write_it(void *user, const allocator *memory, report *r)
{
    const round_trip *t = user;
    const scene_bake bake = {"some", "1", 2, 3, "bytes", 5, 0};
    return pcs_write(&(pcs_request){t->scene, &bake, 1}, t->path, memory, r);
}

static result read_it(void *user, const allocator *memory, report *r)
{
    const round_trip *t = user;
    scene *s = NULL;
    const result done = import_scene(t->path, &doors_open, memory, r, &s);
    assert_int_equal(done == RESULT_OK, s != NULL);
    scene_free(s, memory);
    return done;
}

static result open_it(void *user, const allocator *memory, report *r)
{
    const round_trip *t = user;
    scene *s = NULL;
    const result done = pcs_open("t.pcs", t->bytes, t->size, memory, r, &s);
    assert_int_equal(done == RESULT_OK, s != NULL);
    scene_free(s, memory);
    return done;
}

static void files_survive_each_failed_allocation(void **state)
{
    (void)state;
    round_trip t = {.scene = everything_scene()};
    scratch_folder folder;
    scratch_folder_make(&folder);
    scratch_folder_name(&folder, "t.pcs", t.path, sizeof t.path);
    assert_true(fail_each(write_it, &t) > 4);
    assert_int_equal(scratch_folder_count(&folder), 1); // of the last try, which had what it wanted
    assert_true(fail_each(read_it, &t) > 4);
    char *bytes = encoded_scene(t.scene, &t.size);
    t.bytes = bytes;
    assert_true(fail_each(open_it, &t) > 4);
    memory_free(allocator_heap(), bytes, t.size, 1);
    free_heap_scene(t.scene);
    scratch_folder_remove(&folder);
}

static result bake_it(void *user, const allocator *memory, report *r)
{
    baked_zones baked = {0};
    const result done = baked_zones_make(user, memory, r, &baked);
    assert_int_equal(done == RESULT_OK, baked.bakes != NULL);
    baked_zones_free(&baked);
    return done;
}

static void baking_survives_each_failed_allocation(void **state)
{
    (void)state;
    static const char *const folders[] = {BAKE_PLUGINS};
    scene *s = everything_scene();
    heard h;
    report r = hear(&h);
    host_services services;
    arena texts = arena_make(allocator_heap());
    loader *plugins = NULL;
    world *w = NULL;
    chain_spec spec;
    host_services_fill(&services, allocator_heap(), &r);
    assert_int_equal(chain_parse("testbake", &texts, &r, &spec), RESULT_OK);
    assert_int_equal(loader_open(&(loader_options){.folders = folders, .folder_count = 1}, allocator_heap(), &r, &plugins), RESULT_OK);
    assert_int_equal(world_open(&(world_request){.scene = s, .plugins = plugins, .services = &services, .chain = &spec}, &r, &w), RESULT_OK);
    assert_true(fail_each(bake_it, w) > 2);
    world_close(w);
    loader_close(plugins);
    arena_free(&texts);
    free_heap_scene(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_survive_each_failed_allocation),
        cmocka_unit_test(baking_survives_each_failed_allocation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
