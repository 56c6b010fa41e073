// The report of `portcullis compile`: one flat list of numbers, as text or JSON; its keys stand in docs/compile.md.
// SPDX-License-Identifier: MIT
#include "compile_report.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct fact { const char *name; json_int_t count; } fact;

// As `info` counts them: without movers.
static json_int_t triangles_of(const scene *s)
{
    json_int_t count = 0;
    for (uint32_t i = 0; i < s->item_count; ++i) count += s->items[i].index_count / 3;
    return count;
}

static json_t *report_of(const compile_facts *f)
{
    const compiled_zones *z = f->zones;
    const fact facts[] = {{"zones", (json_int_t)z->zone_count - z->zones_sealed}, {"zones_sealed", z->zones_sealed}, {"shells", z->shells},
                          {"portals", f->scene->portal_count}, {"items", f->scene->item_count}, {"polygons_in", f->counts->polygons_in},
                          {"polygons_csg", f->counts->polygons_csg}, {"polygons_merged", f->counts->polygons_merged}, {"triangles", triangles_of(f->scene)},
                          {"t_junctions_inserted", z->t_junctions_inserted}, {"t_junctions_left", f->checks->t_junctions_left},
                          {"open_edges", f->checks->open_edges}, {"degenerate_triangles", f->checks->degenerate_triangles}, {"leak", z->leak},
                          {"weld_moves", f->input->weld_moves}, {"brushes_dropped", f->input->brushes_dropped}, {"bakes", f->bakes},
                          {"bake_bytes", (json_int_t)f->bake_bytes}, {"peak_bytes", (json_int_t)f->peak_bytes}};
    json_t *out = json_object(), *stages = json_array();
    double sum = 0;
    char names[128];
    compile_stage_names(STAGE_COUNT, names);
    for (size_t i = 0; i < sizeof facts / sizeof *facts; ++i) json_object_set_new(out, facts[i].name, json_integer(facts[i].count));
    for (int s = 0; s < STAGE_COUNT; ++s) {
        json_array_append_new(stages, json_real(f->stage_ms[s]));
        sum += f->stage_ms[s];
    }
    json_object_set_new(out, "max_move", json_real(f->input->max_move));
    json_object_set_new(out, "max_rounding", json_real(f->input->max_rounding));
    json_object_set_new(out, "cpu_ms", json_real(sum));
    json_object_set_new(out, "stages", json_string(names));
    json_object_set_new(out, "stages_ms", stages);
    return out;
}

void compile_report_print(const compile_facts *f, report_form form)
{
    json_t *out = report_of(f);
    const char *key;
    json_t *value;
    if (form == REPORT_JSON) {
        json_dumpf(out, stdout, JSON_INDENT(2) | JSON_REAL_PRECISION(8));
        printf("\n");
    } else {
        json_object_foreach(out, key, value)
        {
            char *text = json_dumps(value, JSON_ENCODE_ANY | JSON_REAL_PRECISION(6));
            printf("%-22s %s\n", key, text ? text : "?");
            free(text);
        }
    }
    json_decref(out);
}
