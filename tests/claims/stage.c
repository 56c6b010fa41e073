// Stages: see stage.h.
// SPDX-License-Identifier: MIT
#include "stage.h"

#include "bench/generate.h"
#include "host/import/import.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

tier stage_tier(void)
{
    const char *is_long = getenv("PORTCULLIS_LONG");
    return is_long && *is_long ? TIER_LONG : TIER_SHORT;
}

static void path_load(stage *s, const char *name, camera_path *out)
{
    for (uint32_t i = 0; i < s->scene->path_count; i++) {
        char what[64];
        if (strcmp(s->scene->paths[i].name, name) != 0) continue;
        snprintf(what, sizeof what, "path:%s", name);
        assert_int_equal(camera_path_load(what, s->scene, 16.0 / 9, allocator_heap(), &s->lines.report, out), RESULT_OK);
    }
}

void stage_load(stage *s, const char *file)
{
    static const char *const folders[] = {TEST_PLUGINS, PRODUCT_PLUGINS};
    const loader_options o = {.folders = folders, .folder_count = 2};
    const import_options import = {.doors = DOORS_OPEN};
    memset(s, 0, sizeof *s);
    failing_allocator_init(&s->counted, 0);
    report_lines_init(&s->lines);
    host_services_fill(&s->services, &s->counted.memory, &s->lines.report);
    s->texts = arena_make(allocator_heap());
    if (import_scene(file, &import, allocator_heap(), &s->lines.report, &s->scene) != RESULT_OK) fail_msg("%s", report_lines_only(&s->lines));
    assert_int_equal(loader_open(&o, allocator_heap(), &s->lines.report, &s->plugins), RESULT_OK);
    path_load(s, "walk", &s->walk);
    path_load(s, "tour", &s->tour);
}

void stage_make(stage *s, const char *kind, uint64_t size)
{
    scratch_folder folder;
    char file[512];
    report r = report_to_stderr();
    scratch_folder_make(&folder);
    scratch_folder_name(&folder, "scene.json", file, sizeof file);
    assert_int_equal(generate_scene(kind, size, GENERATE_SEED_OF_KIND, file, allocator_heap(), &r), RESULT_OK);
    stage_load(s, file);
    scratch_folder_remove(&folder);
    assert_true(s->walk.count >= 500 && s->tour.count >= 500);
}

const chain_spec *stage_chain(stage *s, const char *text)
{
    for (uint32_t i = 0; i < s->spec_count; i++)
        if (strcmp(s->specs[i].text, text) == 0) return s->specs[i].spec;
    chain_spec *out = arena_push(&s->texts, 1, sizeof *out);
    const char *copy = arena_text(&s->texts, text, strlen(text));
    assert_true(out && copy && s->spec_count < STAGE_CHAINS_MOST);
    if (chain_parse(text, &s->texts, &s->lines.report, out) != RESULT_OK) fail_msg("'%s' is no chain", text);
    s->specs[s->spec_count++] = (stage_spec){copy, out};
    return out;
}

const chain_spec *stage_chain_of(stage *s, const char *text, uint32_t zone)
{
    const char *own = s->scene->zones[zone].chain;
    if (own && (strstr(own, "imagecache") || strstr(own, "occlusion"))) own = "octree+portal";
    return stage_chain(s, strcmp(text, "scene") != 0 ? text : own ? own : "frustum");
}

void stage_open(stage *s, const stage_world *q)
{
    const world_request w = {.scene = s->scene, .plugins = s->plugins, .services = &s->services, .chains = q->chains,
                             .chain = stage_chain(s, "frustum"), .more_movers = q->more_movers};
    if (world_open(&w, &s->lines.report, &s->world) != RESULT_OK) fail_msg("%s", report_lines_only(&s->lines));
    assert_int_equal(world_view_open(s->world, VIEWER_CHECK_BOUNDS, &s->lines.report, &s->view), RESULT_OK);
}

void stage_shut(stage *s)
{
    world_view_close(s->view);
    world_close(s->world);
    s->view = NULL;
    s->world = NULL;
    assert_true(failing_allocator_is_clean(&s->counted));
}

void stage_free(stage *s)
{
    loader_close(s->plugins);
    camera_path_free(&s->walk, allocator_heap());
    camera_path_free(&s->tour, allocator_heap());
    scene_free(s->scene, allocator_heap());
    arena_free(&s->texts);
}

frame_input stage_input(const camera *c, uint32_t frame)
{
    return (frame_input){.camera = c, .frame = {.width_px = 1280, .height_px = 720, .frame = frame, .purpose = CULL_VIEW_MAIN}};
}
