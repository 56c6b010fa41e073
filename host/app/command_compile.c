// portcullis compile: brushes to zones, items and a scene file, stage by stage.
// SPDX-License-Identifier: MIT
#define _GNU_SOURCE
#include "../compile/bake_zones.h"
#include "../compile/compile.h"
#include "../compile/pcs_write.h"
#include "../core/file.h"
#include "app.h"
#include "compile_dump.h"

#include <argp.h>
#include <errno.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>

typedef struct arguments {
    const char *input, *out, *bake, *dump, *dump_file; // dump: a stage's name; dump_file NULL: stdout
    input_options options;
    portal_choice portals;
    int json;
} arguments;

static const struct argp_option options[] = {
    {"output", 'o', "FILE.pcs", 0, "where to; needed", 0},
    {"portals", 'p', "none|authored|doors", 0, "what parts zones: nothing, zone_portal brushes, doors as well (default doors)", 0},
    {"grid", 'g', "G", 0, "grid steps a unit, a whole number (default 256)", 0},
    {"dump", 'd', "STAGE[=FILE]", 0, "what a stage made, as text: input, csg, zones or items (default to stdout)", 0},
    {"bake", 'b', "CHAIN", 0, "keep the indices that this chain builds in the file", 0},
    {"json", 'j', NULL, 0, "one flat JSON object on stdout", 0},
    {0},
};

typedef enum stage { STAGE_INPUT, STAGE_CSG, STAGE_ZONES, STAGE_ITEMS, STAGE_BAKE, STAGE_WRITE, STAGE_COUNT } stage;

static stage stage_of(const char *name) // of those that can be dumped
{
    static const char *const names[] = {"input", "csg", "zones", "items"};
    for (int i = 0; i < 4; ++i)
        if (strcmp(name, names[i]) == 0) return (stage)i;
    return STAGE_COUNT;
}

static int parse_portals(const char *text, portal_choice *out)
{
    static const char *const names[] = {"doors", "none", "authored"}; // as portal_choice
    for (int i = 0; i < 3; ++i) {
        if (strcmp(text, names[i]) != 0) continue;
        *out = (portal_choice)i;
        return 1;
    }
    return 0;
}

static int parse_dump(char *text, arguments *a)
{
    char *file = strchr(text, '=');
    if (file) *file++ = 0;
    a->dump = text;
    a->dump_file = file;
    return stage_of(text) != STAGE_COUNT && (!file || *file);
}

static error_t parse(int key, char *text, struct argp_state *state)
{
    arguments *a = state->input;
    uint32_t grid;
    if (key == 'j') a->json = 1;
    else if (key == 'o') a->out = text;
    else if (key == 'b') a->bake = text;
    else if (key == 'd') {
        if (!parse_dump(text, a)) argp_error(state, "--dump takes input, csg, zones or items, then =FILE or nothing");
    }
    else if (key == 'p') {
        if (!parse_portals(text, &a->portals)) argp_error(state, "--portals takes none, authored or doors, not '%s'", text);
    } else if (key == 'g') {
        if (!parse_count(text, 1, 65536, &grid)) argp_error(state, "--grid takes a whole number from 1 to 65536, not '%s'", text);
        a->options.grid = grid;
    } else if (key == ARGP_KEY_ARG && !a->input) a->input = text;
    else if (key == ARGP_KEY_ARG) argp_error(state, "one INPUT, not also '%s'", text);
    else if (key == ARGP_KEY_END && (!a->input || !a->out)) argp_error(state, "INPUT and -o are needed");
    else if (key == ARGP_KEY_END && a->json && a->dump && !a->dump_file) argp_error(state, "--json has stdout: name a file, --dump %s=FILE", a->dump);
    else return ARGP_ERR_UNKNOWN;
    return 0;
}

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
    const arguments *asked;
    meter meter;
    allocator memory;
    report report;
    char *text;
    size_t size;
    compile_input *input;
    compiled_zones *zones;
    scene *scene;
    app app; // plugins, only to bake
    world *world;
    baked_zones baked;
    csg_counts counts;
    compile_checks checks;
    double started_ms, stage_ms[STAGE_COUNT];
} compilation;

// ---- Stages ----

static result stage_input(compilation *c)
{
    const char *dot = strrchr(c->asked->input, '.');
    if (!dot || strcasecmp(dot, ".map") != 0)
        return report_error(&c->report, c->asked->input, 0, "compile takes a .map of brushes; other scenes need no compiling");
    result done = file_read(c->asked->input, &c->memory, &c->report, &c->text, &c->size);
    if (done == RESULT_OK) done = compile_input_map(c->asked->input, c->text, c->size, &c->asked->options, &c->memory, &c->report, &c->input);
    return done;
}

static result stage_bake(compilation *c)
{
    if (!c->asked->bake) return RESULT_OK;
    chain_spec spec;
    result done = app_open(&c->app, NULL);
    if (done == RESULT_OK) done = chain_parse(c->asked->bake, &c->app.texts, &c->report, &spec);
    const world_request q = {.scene = c->scene, .plugins = c->app.plugins, .services = &c->app.services, .chain = &spec};
    if (done == RESULT_OK) done = world_open(&q, &c->report, &c->world);
    return done == RESULT_OK ? baked_zones_make(c->world, &c->memory, &c->report, &c->baked) : done;
}

static result stage_write(compilation *c)
{
    const pcs_request q = {c->scene, c->baked.bakes, c->baked.count};
    return pcs_write(&q, c->asked->out, &c->memory, &c->report);
}

static void write_dump(const compilation *c, stage s, const compile_mesh *mesh, FILE *to)
{
    if (s == STAGE_INPUT) dump_input(to, c->input);
    else if (s == STAGE_CSG) dump_csg(to, c->input, mesh);
    else if (s == STAGE_ZONES) dump_zones(to, c->input, c->zones);
    else dump_items(to, c->scene);
}

static result dump_stage(compilation *c, stage s, const compile_mesh *mesh)
{
    if (!c->asked->dump || stage_of(c->asked->dump) != s) return RESULT_OK;
    const char *path = c->asked->dump_file;
    FILE *to = path ? fopen(path, "w") : stdout;
    if (!to) return report_error(&c->report, path, 0, "cannot write it: %s", strerror(errno));
    write_dump(c, s, mesh, to);
    if (!path) return RESULT_OK;
    int failed = ferror(to);
    failed |= fclose(to);
    if (!failed) return RESULT_OK;
    remove(path);
    return report_error(&c->report, path, 0, "cannot write it whole; free some space");
}

static result run_stages(compilation *c)
{
    double at = c->started_ms;
    compile_mesh *mesh = NULL;
    result done = RESULT_OK;
    for (int s = 0; s < STAGE_COUNT && done == RESULT_OK; ++s) {
        switch ((stage)s) {
        case STAGE_INPUT: done = stage_input(c); break;
        case STAGE_CSG: done = compile_csg(c->input, &c->report, &c->memory, &mesh, &c->counts); break;
        case STAGE_ZONES: done = compile_zones(c->input, mesh, c->asked->portals, &c->report, &c->memory, &c->zones); break;
        case STAGE_ITEMS: done = compile_items(c->input, c->zones, &c->report, &c->memory, &c->scene, &c->checks); break;
        case STAGE_BAKE: done = stage_bake(c); break;
        case STAGE_WRITE: done = stage_write(c); break;
        case STAGE_COUNT: break;
        }
        c->stage_ms[s] = cpu_ms() - at;
        if (done == RESULT_OK) done = dump_stage(c, (stage)s, mesh);
        if (done != RESULT_OK && s == STAGE_CSG) compile_mesh_free(mesh);
        at = cpu_ms();
    }
    return done;
}

// ---- The report ----

typedef struct fact { const char *name; json_int_t count; } fact;

static json_t *report_of(const compilation *c)
{
    const compiled_zones *z = c->zones;
    const fact facts[] = {{"zones", (json_int_t)z->zone_count - z->zones_sealed}, {"zones_sealed", z->zones_sealed}, {"shells", z->shells},
                          {"portals", z->portal_count}, {"items", c->checks.items}, {"polygons_in", c->counts.polygons_in},
                          {"polygons_csg", c->counts.polygons_csg}, {"polygons_merged", c->counts.polygons_merged}, {"triangles", c->checks.triangles},
                          {"t_junctions_inserted", z->t_junctions_inserted}, {"t_junctions_left", c->checks.t_junctions_left},
                          {"open_edges", c->checks.open_edges}, {"degenerate_triangles", c->checks.degenerate_triangles}, {"leak", z->leak},
                          {"weld_moves", c->input->weld_moves}, {"peak_bytes", (json_int_t)c->meter.peak}};
    json_t *out = json_object(), *stages = json_array();
    double sum = 0;
    for (size_t i = 0; i < sizeof facts / sizeof *facts; ++i) json_object_set_new(out, facts[i].name, json_integer(facts[i].count));
    for (int s = 0; s < STAGE_COUNT; ++s) {
        json_array_append_new(stages, json_real(c->stage_ms[s]));
        sum += c->stage_ms[s];
    }
    json_object_set_new(out, "max_move", json_real(c->input->max_move));
    json_object_set_new(out, "cpu_ms", json_real(sum));
    json_object_set_new(out, "stages", json_string("input csg zones items bake write"));
    json_object_set_new(out, "stages_ms", stages);
    return out;
}

static void print_report(const compilation *c)
{
    json_t *out = report_of(c);
    const char *key;
    json_t *value;
    if (c->asked->json) json_dumpf(out, stdout, JSON_INDENT(2) | JSON_REAL_PRECISION(8));
    else json_object_foreach(out, key, value)
    {
        char *text = json_dumps(value, JSON_ENCODE_ANY | JSON_REAL_PRECISION(6));
        printf("%-22s %s\n", key, text ? text : "?");
        free(text);
    }
    if (c->asked->json) printf("\n");
    json_decref(out);
}

int command_compile(int argc, char **argv)
{
    static const struct argp parser = {options, parse, "INPUT", "Compiles brushes to zones joined by portals: a scene file.", NULL, NULL, NULL};
    arguments q = {.portals = PORTALS_DOORS};
    if (argp_parse(&parser, argc, argv, 0, NULL, &q) != 0) return EXIT_USAGE;
    compilation c = {.asked = &q, .meter = {.under = allocator_heap()}, .report = report_to_stderr(), .started_ms = cpu_ms()};
    c.memory = (allocator){meter_alloc, meter_free, &c.meter};
    result done = file_can_write(q.out, &c.report);
    if (done == RESULT_OK) done = run_stages(&c);
    if (done == RESULT_OK) print_report(&c);
    baked_zones_free(&c.baked);
    world_close(c.world);
    if (c.app.memory) app_close(&c.app);
    scene_free(c.scene, &c.memory);
    compiled_zones_free(c.zones);
    compile_input_free(c.input);
    if (c.text) memory_free(&c.memory, c.text, c.size + 1, 1);
    return app_exit_code(done);
}
