// Everything between a chain's text and its frames: see session.h.
// SPDX-License-Identifier: MIT
#include "session.h"

#include "tests/common/test.h"

#include <string.h>

static result open_plugins(session *s)
{
    static const char *const folders[] = {TEST_PLUGINS};
    const loader_options o = {.folders = folders, .folder_count = 1};
    return loader_open(&o, &s->memory.memory, &s->lines.report, &s->plugins);
}

static result open_world(session *s)
{
    chain_spec spec;
    const result done = chain_parse(s->q.chain, &s->texts, &s->lines.report, &spec);
    if (done != RESULT_OK) return done;
    const world_request q = {.scene = s->scene, .plugins = s->plugins, .services = &s->services, .chain = &spec};
    return world_open(&q, &s->lines.report, &s->world);
}

result session_open(session *s, const session_request *q)
{
    memset(s, 0, sizeof *s);
    s->q = *q;
    failing_allocator_init(&s->memory, q->fail_at);
    report_lines_init(&s->lines);
    fake_driver_init(&s->driver);
    host_services_fill(&s->services, &s->memory.memory, &s->lines.report);
    s->texts = arena_make(&s->memory.memory);
    result done = box_scene_make(&q->boxes, &s->memory.memory, &s->lines.report, &s->scene);
    if (done == RESULT_OK) done = open_plugins(s);
    if (done == RESULT_OK) done = open_world(s);
    if (done != RESULT_OK) return done;
    s->chain = world_chain(s->world, 0);
    s->driver.mover_base = s->scene->item_count;
    return world_view_open(s->world, q->checks, &s->lines.report, &s->view);
}

void session_close(session *s)
{
    world_close(s->world); // its views too
    loader_close(s->plugins);
    scene_free(s->scene, &s->memory.memory);
    arena_free(&s->texts);
    assert_true(failing_allocator_is_clean(&s->memory));
}

void session_frame(session *s, const session_view *v)
{
    camera c = box_scene_camera(&s->q.boxes, v->yaw_deg);
    c.eye[0] -= c.forward[2] * v->right_m;
    c.eye[2] += c.forward[0] * v->right_m;
    const frame_input input = {.camera = &c,
                               .frame = {.width_px = 640, .height_px = 360, .frame = v->frame, .purpose = CULL_VIEW_MAIN},
                               .driver = fake_driver_of(&s->driver)};
    fake_driver_new_frame(&s->driver);
    world_cull(s->view, &input, &s->set, &s->stats);
}

static void count_run(const session *s, cull_run run, uint32_t *times)
{
    for (uint32_t i = run.first; i < run.first + run.count; ++i) {
        assert_true(i < s->scene->item_count);
        times[s->chain->order ? s->chain->order[i] : i]++;
    }
}

void session_set_by_item(const session *s, uint32_t *times)
{
    memset(times, 0, FAKE_PLACES_MOST * sizeof *times);
    assert_true(s->set.zone_count <= 1);
    for (uint32_t i = 0; i < s->set.zone_count; ++i)
        for (uint32_t r = 0; r < s->set.zones[i].run_count; ++r) count_run(s, s->set.zones[i].runs[r], times);
    for (uint32_t i = 0; i < s->set.mover_count; ++i) {
        assert_true(s->set.movers[i] < s->scene->mover_count);
        times[s->scene->item_count + s->set.movers[i]]++;
    }
}

void session_assert_whole(const session *s)
{
    uint32_t times[FAKE_PLACES_MOST];
    session_set_by_item(s, times);
    for (uint32_t i = 0; i < s->scene->item_count + s->scene->mover_count; ++i) {
        assert_int_equal(times[i], 1);
        assert_true(s->driver.drawn[i] >= 1);
    }
    assert_int_equal(s->stats.items_drawn, s->scene->item_count);
    assert_int_equal(s->stats.movers_drawn, s->scene->mover_count);
}
