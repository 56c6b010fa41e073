// portcullis info: what a scene holds, as one flat object or a table.
// SPDX-License-Identifier: MIT
#include "app.h"

#include <argp.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct arguments {
    const char *scene;
    door_state doors;
    int json;
} arguments;

static const struct argp_option options[] = {
    {"json", 'j', NULL, 0, "one flat JSON object on stdout", 0},
    {"doors", 'd', "open|shut", 0, "how doors stand: open as the file says, of a .map all; shut: all (default open)", 0},
    {0},
};

static error_t parse(int key, char *text, struct argp_state *state)
{
    arguments *a = state->input;
    if (key == 'j') a->json = 1;
    else if (key == 'd') {
        if (!parse_doors(text, &a->doors)) argp_error(state, "--doors takes open or shut, not '%s'", text);
    } else if (key == ARGP_KEY_ARG && !a->scene) a->scene = text;
    else if (key == ARGP_KEY_ARG) argp_error(state, "one SCENE, not also '%s'", text);
    else if (key == ARGP_KEY_END && !a->scene) argp_error(state, "SCENE is missing");
    else return ARGP_ERR_UNKNOWN;
    return 0;
}

typedef struct geometry { json_int_t polygons, triangles; } geometry;

// A mover's polygons stand apart: the bench counts them apart too.
static geometry geometry_of_movers(const scene *s)
{
    geometry g = {0, 0};
    for (uint32_t i = s->item_count; i < s->item_count + s->mover_count; ++i) {
        g.polygons += s->items[i].polygon_count;
        g.triangles += s->items[i].index_count / 3;
    }
    return g;
}

static json_int_t listed_by_several(const scene *s)
{
    json_int_t count = 0;
    for (uint32_t i = 0; i < s->item_count; ++i) count += s->listings[i] > 1;
    return count;
}

static json_int_t movers_with_path(const scene *s)
{
    json_int_t count = 0;
    for (uint32_t i = 0; i < s->mover_count; ++i) count += s->movers[i].key_count > 0;
    return count;
}

typedef struct fact { const char *name; json_int_t count; } fact;

// The last three: what a look at a file has no need of, and did not do.
static void add_graph(json_t *info, const scene *s, const loader *plugins)
{
    json_int_t shut = 0, zones_with_chain = 0;
    for (uint32_t i = 0; i < s->door_count; ++i) shut += s->doors[i].at_rest == DOORS_SHUT;
    for (uint32_t i = 0; i < s->zone_count; ++i) zones_with_chain += s->zones[i].chain != NULL;
    const fact facts[] = {{"hulls", s->hull_count}, {"zones_with_chain", zones_with_chain}, {"doors", s->door_count}, {"doors_shut", shut},
                          {"lights", s->light_count}, {"paths", s->path_count}, {"movers_with_path", movers_with_path(s)},
                          {"items_in_several_zones", listed_by_several(s)}, {"stray_items", s->stray_items}, {"zone_items", s->zone_item_count},
                          {"plugins_opened", loader_libraries_open(plugins)}, {"indices_built", 0}, {"gl_used", 0}};
    for (size_t i = 0; i < sizeof facts / sizeof *facts; ++i) json_object_set_new(info, facts[i].name, json_integer(facts[i].count));
}

static json_t *info_of(const scene *s, const loader *plugins)
{
    const double *o = s->whole.origin;
    const cull_box b = s->whole.box;
    const geometry movers = geometry_of_movers(s);
    json_t *bounds = json_pack("[f,f,f,f,f,f]", o[0] + b.min.x, o[1] + b.min.y, o[2] + b.min.z, o[0] + b.max.x, o[1] + b.max.y, o[2] + b.max.z);
    char hash[24];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)s->hash);
    json_t *info =
        json_pack("{s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:o, s:[f,f,f], s:f, s:I, s:I, s:s}", "zones", (json_int_t)s->zone_count,
                  "portals", (json_int_t)s->portal_count, "items", (json_int_t)s->item_count, "objects", (json_int_t)s->object_count, "polygons",
                  (json_int_t)s->polygon_count - movers.polygons, "triangles", (json_int_t)(s->index_count / 3) - movers.triangles, "materials",
                  (json_int_t)s->material_count, "movers", (json_int_t)s->mover_count, "mover_polygons", movers.polygons, "mover_triangles",
                  movers.triangles, "bytes", (json_int_t)(s->memory.bytes + s->file_bytes), "bounds", bounds, "origin", o[0], o[1], o[2], "step",
                  s->step, "flat_triangles", (json_int_t)s->flat_triangles, "places", (json_int_t)s->place_count, "hash", hash);
    add_graph(info, s, plugins);
    return info;
}

static void print_text(const json_t *info)
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)info, key, value)
    {
        char *text = json_dumps(value, JSON_ENCODE_ANY | JSON_REAL_PRECISION(10));
        printf("%-22s %s\n", key, text ? text : "?");
        free(text);
    }
}

int command_info(int argc, char **argv)
{
    static const struct argp parser = {options, parse, "SCENE", "Tells what a scene file holds.", NULL, NULL, NULL};
    arguments q = {.doors = DOORS_OPEN};
    if (argp_parse(&parser, argc, argv, 0, NULL, &q) != 0) return EXIT_USAGE;
    app a;
    result done = app_open(&a, NULL);
    const import_options import = {.doors = q.doors};
    if (done == RESULT_OK) done = import_scene(q.scene, &import, a.memory, &a.report, &a.scene);
    if (done == RESULT_OK) {
        json_t *info = info_of(a.scene, a.plugins);
        if (q.json) {
            json_dumpf(info, stdout, JSON_INDENT(2));
            printf("\n");
        } else print_text(info);
        json_decref(info);
    }
    app_close(&a);
    return app_exit_code(done);
}
