// The index that `frustum` keeps in a scene file: what is loaded is what would be built, and nothing else is used.
// SPDX-License-Identifier: MIT
#include "bake_stand.h"
#include "tests/common/failing_allocator.h"

#include <string.h>

static const char CHAIN[] = "frustum";
enum { HEAD_BYTES = 24 }; // of its blob, in front of the order: magic, byte order, count, check

static char *baked_file(const scene *s, size_t *out_size)
{
    stand t;
    baked_zones baked = {0};
    if (stand_open(&t, s, CHAIN, 0) != RESULT_OK) fail_msg("%s", t.heard.text);
    assert_int_equal(baked_zones_make(t.world, allocator_heap(), &t.report, &baked), RESULT_OK);
    char *file = encoded(&(pcs_request){.scene = s, .bakes = baked.bakes, .bake_count = baked.count}, out_size);
    baked_zones_free(&baked);
    stand_close(&t);
    return file;
}

static void drop(char *file, size_t size)
{
    memory_free(allocator_heap(), file, size, 1);
}

static void expect_same_indices(const scene *a, const scene *b)
{
    stand s, t;
    baked_zones of_a = {0}, of_b = {0};
    assert_int_equal(stand_open(&s, a, CHAIN, 0), RESULT_OK);
    assert_int_equal(stand_open(&t, b, CHAIN, 0), RESULT_OK);
    assert_int_equal(t.report.warnings, 0);
    assert_int_equal(baked_zones_make(s.world, allocator_heap(), &s.report, &of_a), RESULT_OK);
    assert_int_equal(baked_zones_make(t.world, allocator_heap(), &t.report, &of_b), RESULT_OK);
    assert_int_equal(of_a.count, of_b.count);
    for (uint32_t i = 0; i < of_a.count; ++i) {
        assert_int_equal(of_a.bakes[i].size, of_b.bakes[i].size);
        assert_memory_equal(of_a.bakes[i].bytes, of_b.bakes[i].bytes, of_a.bakes[i].size);
        assert_int_equal(of_a.bakes[i].options_hash, of_b.bakes[i].options_hash);
        assert_int_equal(of_a.bakes[i].zone_hash, of_b.bakes[i].zone_hash);
    }
    baked_zones_free(&of_a);
    baked_zones_free(&of_b);
    stand_close(&s);
    stand_close(&t);
}

static uint32_t lent(const stand *t, const scene *s) // zones whose culler was lent a blob, and kept it
{
    uint32_t count = 0;
    for (uint32_t z = 0; z < s->zone_count; ++z) {
        const chain *c = world_chain(t->world, z);
        count += c && c->stages[0].blob.bytes;
    }
    return count;
}

static void an_index_loaded_is_the_index_built(void **state)
{
    (void)state;
    scene *s = everything_scene();
    size_t size = 0;
    char *file = baked_file(s, &size);
    scene *back = opened(file, size);
    stand t;
    assert_true(back->bake_count > 1);
    assert_int_equal(stand_open(&t, back, CHAIN, 0), RESULT_OK);
    assert_int_equal(lent(&t, back), back->bake_count);
    stand_close(&t);
    expect_same_indices(s, back);
    free_heap_scene(back);
    free_heap_scene(s);
    drop(file, size);
}

// The check that the plugin writes over the order, once more: a forged order with the right check tells whether it is used.
static void put_check(char *blob, uint32_t count)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t word;
        memcpy(&word, blob + HEAD_BYTES + 4 * (size_t)i, 4);
        hash = (hash ^ word) * 0x100000001b3u;
    }
    memcpy(blob + HEAD_BYTES - 8, &hash, 8);
}

static char *blob_of(char *file, uint64_t bake, pcs_bake *out)
{
    memcpy(out, section_of(file, PCS_BAKES) + bake * sizeof *out, sizeof *out);
    return section_of(file, PCS_BLOBS) + out->offset;
}

static void the_order_comes_from_the_file(void **state)
{
    (void)state;
    scene *s = everything_scene();
    size_t size = 0;
    char *file = baked_file(s, &size);
    pcs_bake bake;
    char *blob = blob_of(file, 0, &bake);
    const uint32_t count = (uint32_t)((bake.size - HEAD_BYTES) / 4);
    uint32_t first, second;
    assert_true(count >= 2);
    memcpy(&first, blob + HEAD_BYTES, 4);
    memcpy(&second, blob + HEAD_BYTES + 4, 4);
    memcpy(blob + HEAD_BYTES, &second, 4);
    memcpy(blob + HEAD_BYTES + 4, &first, 4);
    put_check(blob, count);
    sign(file, size);
    scene *back = opened(file, size);
    stand t;
    assert_int_equal(stand_open(&t, back, CHAIN, 0), RESULT_OK);
    assert_int_equal(t.report.warnings, 0);
    const chain *c = world_chain(t.world, bake.zone);
    assert_int_equal(c->order[0], second); // nothing was sorted
    assert_int_equal(c->order[1], first);
    stand_close(&t);
    free_heap_scene(back);
    free_heap_scene(s);
    drop(file, size);
}

static void expect_built_anew(char *file, size_t size, const scene *as)
{
    sign(file, size);
    scene *back = opened(file, size);
    stand t;
    assert_int_equal(stand_open(&t, back, CHAIN, 0), RESULT_OK);
    assert_int_equal(t.report.warnings, 1);
    assert_int_equal(lent(&t, back), back->bake_count - 1);
    assert_non_null(strstr(t.heard.text, "the culler refused it; it is built anew"));
    stand s;
    assert_int_equal(stand_open(&s, as, CHAIN, 0), RESULT_OK);
    for (uint32_t z = 0; z < as->zone_count; ++z) {
        const chain *have = world_chain(t.world, z), *want = world_chain(s.world, z);
        if (want) assert_memory_equal(have->order, want->order, want->zone.item_count * sizeof *want->order);
    }
    stand_close(&s);
    stand_close(&t);
    free_heap_scene(back);
}

static void any_wrong_byte_is_refused_and_the_index_built_anew(void **state)
{
    (void)state;
    scene *s = everything_scene();
    size_t size = 0;
    char *file = baked_file(s, &size);
    pcs_bake bake;
    char *blob = blob_of(file, 1, &bake);
    for (uint64_t at = 0; at < bake.size; ++at) {
        blob[at] ^= 0x10;
        expect_built_anew(file, size, s);
        blob[at] ^= 0x10;
    }
    free_heap_scene(s);
    drop(file, size);
}

static void an_order_that_is_none_is_refused_for_all_its_right_check(void **state)
{
    (void)state;
    scene *s = everything_scene();
    size_t size = 0;
    char *file = baked_file(s, &size);
    pcs_bake bake;
    char *blob = blob_of(file, 0, &bake);
    const uint32_t count = (uint32_t)((bake.size - HEAD_BYTES) / 4), wrong[] = {count, UINT32_MAX};
    uint32_t kept, twice;
    memcpy(&kept, blob + HEAD_BYTES, 4);
    memcpy(&twice, blob + HEAD_BYTES + 4, 4);
    for (int i = 0; i < 3; ++i) {
        memcpy(blob + HEAD_BYTES, i < 2 ? &wrong[i] : &twice, 4);
        put_check(blob, count);
        expect_built_anew(file, size, s);
    }
    free_heap_scene(s);
    drop(file, size);
}

static result open_short_of_memory(const stand *t, const scene *s, failing_allocator *a)
{
    arena texts = arena_make(allocator_heap());
    heard h;
    report r = hear(&h);
    host_services services;
    chain_spec spec;
    world *w = NULL;
    host_services_fill(&services, &a->memory, &r);
    assert_int_equal(chain_parse(CHAIN, &texts, &r, &spec), RESULT_OK);
    const result done = world_open(&(world_request){.scene = s, .plugins = t->plugins, .services = &services, .chain = &spec}, &r, &w);
    assert_int_equal(done == RESULT_OK, w != NULL);
    world_close(w);
    arena_free(&texts);
    return done;
}

static void loading_and_building_anew_survive_each_failed_allocation(void **state)
{
    (void)state;
    scene *s = everything_scene();
    size_t size = 0;
    char *file = baked_file(s, &size);
    pcs_bake bake;
    blob_of(file, 1, &bake)[HEAD_BYTES] ^= 1; // one is refused, the others are loaded
    sign(file, size);
    scene *back = opened(file, size);
    stand t;
    assert_int_equal(stand_open(&t, back, CHAIN, 0), RESULT_OK);
    result done = RESULT_NO_MEMORY;
    uint64_t tries = 0;
    while (done != RESULT_OK) {
        failing_allocator a;
        failing_allocator_init(&a, ++tries);
        done = open_short_of_memory(&t, back, &a);
        assert_true(done == RESULT_OK || done == RESULT_NO_MEMORY);
        assert_true(failing_allocator_is_clean(&a));
        assert_true(tries < 10000);
    }
    assert_true(tries > 20);
    stand_close(&t);
    free_heap_scene(back);
    free_heap_scene(s);
    drop(file, size);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_index_loaded_is_the_index_built),
        cmocka_unit_test(the_order_comes_from_the_file),
        cmocka_unit_test(any_wrong_byte_is_refused_and_the_index_built_anew),
        cmocka_unit_test(an_order_that_is_none_is_refused_for_all_its_right_check),
        cmocka_unit_test(loading_and_building_anew_survive_each_failed_allocation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
