// portcullis compile: brushes to zones, items and a scene file, stage by stage.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "../compile/bake_zones.h"
#include "../compile/editor_files.h"
#include "../compile/pcs_write.h"
#include "../core/file.h"
#include "app.h"
#include "compile_arguments.h"
#include "compile_dump.h"
#include "compile_report.h"
#include "plan_picture.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>

// ---- Memory and time ----

typedef struct meter { // of one thread
    const allocator *under;
    size_t now, peak;
} meter;

static void *meter_alloc(void *user, size_t size, size_t align)
{
    meter *m = user;
    void *memory = m->under->alloc(m->under->user, size, align);
    if (!memory) return NULL;
    m->now += size;
    if (m->now > m->peak) m->peak = m->now;
    return memory;
}

static void meter_free(void *user, void *memory, size_t size)
{
    meter *m = user;
    if (memory) m->now -= size;
    m->under->free(m->under->user, memory, size);
}

static double cpu_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec / 1e6;
}

typedef struct compilation {
    const compile_arguments *asked;
    meter meter;
    allocator memory;
    report report;
    compile_input *input;
    compile_watch watch;
    compiled_zones *zones;
    scene *scene;
    app app; // plugins, only to bake
    world *world;
    baked_zones baked;
    csg_counts counts;
    compile_checks checks;
    double since_ms, stage_ms[STAGE_COUNT];
    result dumped; // RESULT_OK until a dump fails
} compilation;

// ---- Dumps ----

// Into memory first, so that a file is whole or not there.
static result write_dump(compilation *c, const compile_view *made, const char *path)
{
    char *text = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&text, &size);
    if (!to) return report_no_memory(&c->report, path);
    if (made->stage == STAGE_ITEMS) dump_items(to, c->scene);
    else dump_stage(to, made);
    const int failed = ferror(to) | fclose(to);
    result done = failed ? report_no_memory(&c->report, path) : RESULT_OK;
    if (done == RESULT_OK && *path) done = file_write(path, text, size, &c->report);
    else if (done == RESULT_OK && (fwrite(text, 1, size, stdout) != size || fflush(stdout) != 0)) // before anything else is written
        done = report_error(&c->report, "stdout", 0, "cannot write the dump: %s", strerror(errno));
    free(text);
    return done;
}

static void stage_ended(void *user, const compile_view *made)
{
    compilation *c = user;
    c->stage_ms[made->stage] = cpu_ms() - c->since_ms;
    const char *path = made->stage < (compile_stage)STAGES_DUMPED ? c->asked->dump_files[made->stage] : NULL;
    if (path && c->dumped == RESULT_OK) c->dumped = write_dump(c, made, path);
    c->since_ms = cpu_ms();
}

static result end_stage(compilation *c, compile_stage s, result done)
{
    if (done == RESULT_OK) stage_ended(c, &(compile_view){.stage = s, .in = c->input});
    return done == RESULT_OK ? c->dumped : done;
}

// ---- Stages ----

static result stage_input(compilation *c)
{
    const result done = compile_input_open(c->asked->input, &c->asked->options, &c->memory, &c->report, &c->input);
    if (done != RESULT_OK) return done;
    c->watch = (compile_watch){c, stage_ended};
    c->input->watch = &c->watch;
    return end_stage(c, STAGE_INPUT, done);
}

// Told of each stage by the watch.
static result stages_of_surface(compilation *c)
{
    compile_mesh *mesh = NULL;
    const result done = compile_csg(c->input, &c->report, &c->memory, &mesh, &c->counts);
    if (done != RESULT_OK) return done;
    if (c->dumped != RESULT_OK) {
        compile_mesh_free(mesh);
        return c->dumped;
    }
    const result zoned = compile_zones_with(c->input, mesh, &c->asked->zones, &c->report, &c->memory, &c->zones);
    return zoned == RESULT_OK ? c->dumped : zoned;
}

static result stage_bake(compilation *c)
{
    if (!c->asked->bake) return RESULT_OK;
    chain_spec spec;
    const world_request q = {.scene = c->scene, .plugins = c->app.plugins, .services = &c->app.services, .chain = &spec};
    result done = chain_parse(c->asked->bake, &c->app.texts, &c->report, &spec);
    if (done == RESULT_OK) done = world_open(&q, &c->report, &c->world);
    if (done == RESULT_OK) done = baked_zones_make(c->world, &c->memory, &c->report, &c->baked);
    if (done == RESULT_OK && c->baked.count == 0)
        report_warning(&c->report, c->asked->input, 0, "no culler of '%s' keeps an index: nothing is baked", c->asked->bake);
    return done;
}

static result stage_write(compilation *c)
{
    const pcs_request q = {c->scene, c->baked.bakes, c->baked.count};
    result done = RESULT_OK;
    if (c->asked->prt) done = editor_prt_write(c->input, c->zones, c->asked->prt, &c->memory, &c->report);
    if (done == RESULT_OK && c->asked->pts) done = editor_pts_write(c->zones, c->asked->pts, &c->memory, &c->report);
    if (done == RESULT_OK && c->asked->plan) done = plan_picture_write(c->scene, c->asked->plan, &c->memory, &c->report);
    return done == RESULT_OK ? pcs_write(&q, c->asked->out, &c->memory, &c->report) : done;
}

// A chain that cannot be baked is told before long work, not behind it.
static result open_plugins(compilation *c)
{
    chain_spec spec;
    if (!c->asked->bake) return RESULT_OK;
    result done = app_open(&c->app, NULL);
    if (done == RESULT_OK) done = chain_parse(c->asked->bake, &c->app.texts, &c->report, &spec);
    for (uint32_t i = 0; done == RESULT_OK && i < spec.stage_count; ++i) {
        const cull_plugin *found;
        done = loader_find(c->app.plugins, spec.stages[i].id, &c->report, &found);
    }
    return done;
}

static result run_stages(compilation *c)
{
    c->since_ms = cpu_ms();
    result done = stage_input(c);
    if (done == RESULT_OK) done = stages_of_surface(c);
    if (done == RESULT_OK) done = compile_items(c->input, c->zones, &c->report, &c->memory, &c->scene, &c->checks);
    done = end_stage(c, STAGE_ITEMS, done);
    if (done == RESULT_OK) done = end_stage(c, STAGE_BAKE, stage_bake(c));
    if (done == RESULT_OK) done = end_stage(c, STAGE_WRITE, stage_write(c));
    return done;
}

static void print_report(const compilation *c)
{
    const compile_facts facts = {c->input, c->zones, &c->counts, &c->checks, c->scene, c->stage_ms, c->meter.peak, c->baked.bytes, c->baked.count};
    compile_report_print(&facts, c->asked->json ? REPORT_JSON : REPORT_TEXT);
}

int command_compile(int argc, char **argv)
{
    compile_arguments q;
    compile_arguments_parse(argc, argv, &q);
    compilation c = {.asked = &q, .meter = {.under = allocator_heap()}, .report = report_to_stderr(), .dumped = RESULT_OK};
    c.memory = (allocator){meter_alloc, meter_free, &c.meter};
    result done = compile_arguments_check(&q, &c.report);
    if (done == RESULT_OK) done = open_plugins(&c);
    if (done == RESULT_OK) done = run_stages(&c);
    if (done == RESULT_OK) print_report(&c);
    baked_zones_free(&c.baked);
    world_close(c.world);
    if (c.app.memory) app_close(&c.app);
    scene_free(c.scene, &c.memory);
    compiled_zones_free(c.zones);
    compile_input_free(c.input);
    return app_exit_code(done);
}
