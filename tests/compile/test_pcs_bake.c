// Baked indices: lent where culler, version, options and zone are those that they were made with, nowhere else.
// SPDX-License-Identifier: MIT
#include "bake_stand.h"

#include <string.h>

enum { BUILT = 1000, LOADED = 2000 }; // as plugins/testbake.c tells

// Of every zone that has a chain, its last stage: all the same.
static size_t told(const stand *t, const scene *s)
{
    size_t bytes = 0;
    for (uint32_t z = 0; z < s->zone_count; ++z) {
        const chain *c = world_chain(t->world, z);
        if (!c) continue;
        const size_t here = c->stages[c->stage_count - 1].built.index_bytes;
        assert_true(here == BUILT || here == LOADED);
        assert_true(!bytes || bytes == here);
        bytes = here;
    }
    return bytes;
}

static char *bake(const scene *s, const char *chain, size_t *out_size, uint32_t *out_count)
{
    stand t;
    baked_zones baked = {0};
    if (stand_open(&t, s, chain, 0) != RESULT_OK) fail_msg("%s", t.heard.text);
    assert_int_equal(told(&t, s), BUILT);
    assert_int_equal(baked_zones_make(t.world, allocator_heap(), &t.report, &baked), RESULT_OK);
    char *file = encoded(&(pcs_request){.scene = s, .bakes = baked.bakes, .bake_count = baked.count}, out_size);
    *out_count = baked.count;
    baked_zones_free(&baked);
    stand_close(&t);
    return file;
}

static size_t told_by(const scene *s, const char *chain, uint32_t more_movers)
{
    stand t;
    if (stand_open(&t, s, chain, more_movers) != RESULT_OK) fail_msg("%s", t.heard.text);
    const size_t bytes = told(&t, s);
    stand_close(&t);
    return bytes;
}

static void drop(char *file, size_t size)
{
    memory_free(allocator_heap(), file, size, 1);
}

static void an_index_is_loaded_where_its_key_agrees(void **state)
{
    (void)state;
    scene *s = everything_scene();
    size_t size = 0;
    uint32_t count = 0, zones = 0;
    for (uint32_t z = 0; z < s->zone_count; ++z) zones += s->zones[z].item_count > 0;
    char *file = bake(s, "testbake[value=7]", &size, &count);
    assert_int_equal(count, zones);
    scene *back = opened(file, size);
    assert_scenes_equal(s, back);
    assert_int_equal(back->bake_count, zones);
    assert_int_equal(told_by(back, "testbake[value=7]", 0), LOADED);
    assert_int_equal(told_by(back, "testbake[value=7]", 40), LOADED); // room for movers is the viewer's choice
    assert_int_equal(told_by(back, "testbake[value=8]", 0), BUILT);
    assert_int_equal(told_by(back, "testbake", 0), BUILT);
    assert_int_equal(told_by(back, "none+testbake[value=7]", 0), LOADED); // lent the same zone in the same order
    assert_int_equal(told_by(back, "testorder[hierarchy=0]+testbake[value=7]", 0), BUILT);
    free_heap_scene(back);
    free_heap_scene(s);
    drop(file, size);
}

static void a_filter_is_baked_in_its_selects_order_and_under_its_hierarchy(void **state)
{
    (void)state;
    scene *s = everything_scene();
    size_t size = 0;
    uint32_t count = 0;
    char *file = bake(s, "testorder+testbake", &size, &count);
    scene *back = opened(file, size);
    assert_true(count > 0);
    assert_int_equal(told_by(back, "testorder+testbake", 0), LOADED);
    assert_int_equal(told_by(back, "testorder[hierarchy=0]+testbake", 0), BUILT);
    assert_int_equal(told_by(back, "testbake", 0), BUILT);
    free_heap_scene(back);
    free_heap_scene(s);
    drop(file, size);
}

typedef enum spoilt { SPOILT_ID, SPOILT_VERSION, SPOILT_OPTIONS, SPOILT_ZONE } spoilt;
static void an_index_of_another_culler_version_option_or_zone_is_not_lent(void **state)
{
    (void)state;
    scene *s = everything_scene();
    size_t size = 0;
    uint32_t count = 0;
    char *file = bake(s, "testbake", &size, &count);
    for (spoilt what = SPOILT_ID; what <= SPOILT_ZONE; ++what) {
        scene *back = opened(file, size);
        for (uint32_t i = 0; i < back->bake_count; ++i) {
            if (what == SPOILT_ID) back->bakes[i].id = "testbaked";
            if (what == SPOILT_VERSION) back->bakes[i].version = "2";
            if (what == SPOILT_OPTIONS) back->bakes[i].options_hash++;
            if (what == SPOILT_ZONE) back->bakes[i].zone_hash++;
        }
        stand t;
        assert_int_equal(stand_open(&t, back, "testbake", 0), RESULT_OK);
        assert_int_equal(told(&t, back), BUILT);
        // of another culler or other options: somebody else's; of another version or geometry it is this one's, and of no use
        assert_int_equal(t.report.warnings, what == SPOILT_VERSION || what == SPOILT_ZONE ? back->bake_count : 0);
        if (what == SPOILT_VERSION) assert_non_null(strstr(t.heard.text, ": another version of it made it; it is built anew"));
        if (what == SPOILT_ZONE) assert_non_null(strstr(t.heard.text, ": it is of other geometry, or of another chain; it is built anew"));
        stand_close(&t);
        free_heap_scene(back);
    }
    free_heap_scene(s);
    drop(file, size);
}

static void an_index_that_its_culler_refuses_is_built_anew_and_told(void **state)
{
    (void)state;
    scene *s = everything_scene();
    size_t size = 0;
    uint32_t count = 0;
    char *file = bake(s, "testbake", &size, &count);
    section_of(file, PCS_BLOBS)[0] ^= 1;
    sign(file, size);
    scene *back = opened(file, size);
    stand t;
    assert_int_equal(stand_open(&t, back, "testbake", 0), RESULT_OK);
    assert_int_equal(t.report.warnings, 1);
    assert_non_null(strstr(t.heard.text, "warning: culler 'testbake' cannot use its baked index of zone "));
    assert_non_null(strstr(t.heard.text, ": the culler refused it; it is built anew, compile the scene again to keep it"));
    uint32_t built = 0;
    for (uint32_t z = 0; z < back->zone_count; ++z) {
        const chain *c = world_chain(t.world, z);
        built += c && c->stages[0].built.index_bytes == BUILT;
    }
    assert_int_equal(built, 1); // the others are sound
    stand_close(&t);
    free_heap_scene(back);
    free_heap_scene(s);
    drop(file, size);
}

static void nonsense_about_bakes_is_refused(void **state)
{
    (void)state;
    scene *s = everything_scene();
    size_t size = 0;
    uint32_t count = 0;
    char *file = bake(s, "testbake", &size, &count);
    assert_true(count > 1);
    static const struct { size_t at; uint64_t value; size_t bytes; } lies[] = {
        {offsetof(pcs_bake, offset), 1, 8},          {offsetof(pcs_bake, offset), 64, 8},  {offsetof(pcs_bake, size), UINT64_MAX, 8},
        {offsetof(pcs_bake, size), 0, 8},            {offsetof(pcs_bake, size), 3, 8},     {offsetof(pcs_bake, zone), 3, 4},
        {offsetof(pcs_bake, zone), 77, 4},           {offsetof(pcs_bake, id), 1 << 20, 4}, {offsetof(pcs_bake, reserved), 1, 4},
    };
    for (size_t i = 0; i < sizeof lies / sizeof *lies; ++i) {
        pcs_bake kept;
        char *record = section_of(file, PCS_BAKES);
        memcpy(&kept, record, sizeof kept);
        memcpy(record + lies[i].at, &lies[i].value, lies[i].bytes);
        sign(file, size);
        heard h;
        report r = hear(&h);
        scene *back = NULL;
        if (pcs_open("t.pcs", file, size, allocator_heap(), &r, &back) != RESULT_BAD_INPUT) fail_msg("lie %zu was believed", i);
        memcpy(record, &kept, sizeof kept);
    }
    free_heap_scene(s);
    drop(file, size);
}

static void bakes_out_of_order_are_not_written(void **state)
{
    (void)state;
    scene *s = everything_scene();
    const scene_bake bakes[] = {{"a", "1", 0, 0, "x", 1, 1}, {"a", "1", 0, 0, "x", 1, 0}}, empty = {"a", "1", 0, 0, "x", 0, 0}, far = {"a", "1", 0, 0, "x", 1, 99};
    const pcs_request wrong[] = {{s, bakes, 2}, {s, &empty, 1}, {s, &far, 1}};
    for (int i = 0; i < 3; ++i) {
        heard h;
        report r = hear(&h);
        void *bytes = NULL;
        size_t size = 0;
        assert_int_equal(pcs_encode(&wrong[i], "t.pcs", allocator_heap(), &r, &bytes, &size), RESULT_BAD_INPUT);
        assert_non_null(strstr(h.text, "a baked index of no zone"));
    }
    free_heap_scene(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_index_is_loaded_where_its_key_agrees),
        cmocka_unit_test(a_filter_is_baked_in_its_selects_order_and_under_its_hierarchy),
        cmocka_unit_test(an_index_of_another_culler_version_option_or_zone_is_not_lent),
        cmocka_unit_test(an_index_that_its_culler_refuses_is_built_anew_and_told),
        cmocka_unit_test(nonsense_about_bakes_is_refused),
        cmocka_unit_test(bakes_out_of_order_are_not_written),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
