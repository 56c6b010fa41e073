// Real maps: see maps.h.
// SPDX-License-Identifier: MIT
#include "maps.h"

#include "host/compile/compile.h"
#include "host/compile/pcs_write.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <stdlib.h>

const char *const map_names[MAPS] = {"quake/dm4.map",          "quake/e1m1.map",         "quake/e1m4.map",        "quake/e3m5.map",
                                     "librequake/lq_e0m8.map", "librequake/lq_e3m4.map", "librequake/lqdm12.map", "librequake/lqdm7.map"};

static void map_path(const char *name, char *out, size_t size)
{
    const char *scenes = getenv("PORTCULLIS_SCENES");
    snprintf(out, size, "%s/%s", scenes ? scenes : "", name);
}

void maps_need(void)
{
    char path[1024];
    map_path(map_names[0], path, sizeof path);
    FILE *file = getenv("PORTCULLIS_SCENES") ? fopen(path, "r") : NULL;
    if (!file) {
        fprintf(stderr, "SKIPPED: no folder of real scenes; set PORTCULLIS_SCENES\n");
        skip();
    }
    fclose(file);
}

static result map_compile(const char *map, const char *to)
{
    report r = report_to_stderr();
    compile_input *in = NULL;
    compile_mesh *mesh = NULL;
    compiled_zones *zones = NULL;
    scene *s = NULL;
    csg_counts counts;
    compile_checks checks = {0};
    const zone_options options = zone_options_of(PORTALS_AUTO);
    const allocator *heap = allocator_heap();
    result done = compile_input_open(map, NULL, heap, &r, &in);
    if (done == RESULT_OK) done = compile_csg(in, &r, heap, &mesh, &counts);
    if (done == RESULT_OK) done = compile_zones_with(in, mesh, &options, &r, heap, &zones);
    if (done == RESULT_OK) done = compile_items(in, zones, &r, heap, &s, &checks);
    if (done == RESULT_OK) done = pcs_write(&(pcs_request){s, NULL, 0}, to, heap, &r);
    scene_free(s, heap);
    compiled_zones_free(zones);
    compile_input_free(in);
    return done;
}

void map_load_file(stage *s, const char *path)
{
    scratch_folder folder;
    char to[512];
    scratch_folder_make(&folder);
    scratch_folder_name(&folder, "map.pcs", to, sizeof to);
    assert_int_equal(map_compile(path, to), RESULT_OK);
    stage_load(s, to);
    scratch_folder_remove(&folder);
}

void map_load(stage *s, const char *name)
{
    char path[1024];
    map_path(name, path, sizeof path);
    map_load_file(s, path);
}
