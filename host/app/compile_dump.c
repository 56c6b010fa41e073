// Dumps of the compiler's stages: see compile_dump.h. This file: brushes to merged polygons, and the scene's items.
// SPDX-License-Identifier: MIT
#include "compile_dump.h"

#include "../compile/csg.h"
#include "../compile/plane_table.h"

#include <string.h>

// ---- Pieces of a line ----

const char *dump_material(const compile_input *in, uint32_t material)
{
    return material == COMPILE_NOTHING ? "-" : in->materials[material].name;
}

// All 128 bits, in decimal.
static void print_wide(FILE *to, cull_wide v)
{
    enum { DIGITS_MOST = 48 };
    char text[DIGITS_MOST];
    size_t at = sizeof text - 1;
    const int is_negative = v.high >> 63 != 0;
    if (is_negative) {
        v.low = ~v.low + 1;
        v.high = ~v.high + (v.low == 0);
    }
    uint32_t parts[4] = {(uint32_t)(v.high >> 32), (uint32_t)v.high, (uint32_t)(v.low >> 32), (uint32_t)v.low};
    text[at] = 0;
    do {
        uint64_t rest = 0;
        for (int i = 0; i < 4; ++i) {
            rest = rest << 32 | parts[i];
            parts[i] = (uint32_t)(rest / 10);
            rest %= 10;
        }
        text[--at] = (char)('0' + (int)rest);
    } while (parts[0] | parts[1] | parts[2] | parts[3]);
    fprintf(to, "%s%s", is_negative ? "-" : "", text + at);
}

void dump_plane(FILE *to, const compile_input *in, plane_ref ref)
{
    const cull_wide_plane p = plane_table_get(in->planes, ref);
    fprintf(to, "plane %lld %lld %lld ", (long long)p.normal[0], (long long)p.normal[1], (long long)p.normal[2]);
    print_wide(to, p.offset);
}

void dump_point(FILE *to, const double at[3])
{
    fprintf(to, " (%.17g %.17g %.17g)", at[0] + 0.0, at[1] + 0.0, at[2] + 0.0); // no -0
}

void dump_loop(FILE *to, const compile_mesh *m, uint32_t first, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) dump_point(to, m->vertices[m->loop[first + i]].position);
    fputc('\n', to);
}

void dump_polygon(FILE *to, const compile_input *in, const compile_mesh *m, uint32_t polygon)
{
    const compile_polygon *p = &m->polygons[polygon];
    fprintf(to, "polygon %u brush %u %s ", polygon, p->brush, dump_material(in, p->material));
    dump_plane(to, in, p->plane);
    dump_loop(to, m, p->first_vertex, p->vertex_count);
}

// ---- Stages ----

static void dump_input(FILE *to, const compile_input *in)
{
    static const char *const roles[] = {"structure", "liquid", "entity", "portal"};
    for (uint32_t b = 0; b < in->brush_count; ++b) {
        const compile_brush *brush = &in->brushes[b];
        fprintf(to, "brush %u entity %u %s %s box %d %d %d %d %d %d\n", b, brush->entity, brush->kind == BRUSH_ADD ? "add" : "subtract", roles[brush->role],
                (int)brush->min[0], (int)brush->min[1], (int)brush->min[2], (int)brush->max[0], (int)brush->max[1], (int)brush->max[2]);
        for (uint32_t f = brush->first_face; f < brush->first_face + brush->face_count; ++f) {
            fprintf(to, "  face line %u %s ", in->faces[f].line, dump_material(in, in->faces[f].material));
            dump_plane(to, in, in->faces[f].plane);
            fputc('\n', to);
        }
    }
    for (uint32_t e = 0; e < in->entity_count; ++e) {
        const compile_entity *entity = &in->entities[e];
        fprintf(to, "entity %u line %u %s brushes %u\n", e, entity->line, entity->class_name, entity->brush_count);
    }
    static const char *const kinds[] = {"plane", "point", "corner", "turn"}; // as weld_kind
    for (uint32_t i = 0; i < in->weld_moves; ++i) {
        const weld_change *c = &in->changes[i];
        fprintf(to, "weld %s brush %u line %u move %.9g from ", kinds[c->kind], c->brush, c->line, c->move);
        dump_plane(to, in, c->from);
        fputs(" to ", to);
        dump_plane(to, in, c->to);
        fputc('\n', to);
    }
}

static void dump_relations(FILE *to, const relation_table *t)
{
    static const char *const names[] = {"apart", "touching", "crossing", "contains", "inside"};
    for (uint32_t i = 0; i < t->pair_count; ++i) fprintf(to, "brush %u %s brush %u\n", t->pairs[i].a, names[t->pairs[i].relation], t->pairs[i].b);
}

static void dump_soup_head(FILE *to, const compile_input *in, uint32_t number, const body_polygon *p)
{
    fprintf(to, "polygon %u brush %u %s ", number, p->brush, dump_material(in, in->faces[p->face].material));
    dump_plane(to, in, p->shape.plane);
}

static void dump_csg(FILE *to, const compile_input *in, const polygon_soup *s)
{
    const body_polygon *polygons = s->polygons.items;
    for (uint32_t i = 0; i < s->polygons.count; ++i) {
        const polygon_edge *edges = (const polygon_edge *)s->edges.items + polygons[i].shape.first;
        dump_soup_head(to, in, i, &polygons[i]);
        for (uint32_t k = 0; k < polygons[i].shape.count; ++k) dump_point(to, edges[k].start);
        fputc('\n', to);
    }
}

static void dump_weld(FILE *to, const compile_view *v)
{
    const body_polygon *polygons = v->soup->polygons.items;
    for (uint32_t i = 0; i < v->vertex_count; ++i) {
        fprintf(to, "vertex %u", i);
        dump_point(to, v->vertices[i].position);
        for (int k = 0; k < 3; ++k) {
            fputc(' ', to);
            dump_plane(to, v->in, v->vertices[i].planes[k]);
        }
        fputc('\n', to);
    }
    for (uint32_t i = 0; i < v->soup->polygons.count; ++i) {
        const polygon_edge *edges = (const polygon_edge *)v->soup->edges.items + polygons[i].shape.first;
        dump_soup_head(to, v->in, i, &polygons[i]);
        fputs(" vertices", to);
        for (uint32_t k = 0; k < polygons[i].shape.count; ++k) fprintf(to, " %u", edges[k].vertex);
        fputc('\n', to);
    }
}

static void dump_merge(FILE *to, const compile_input *in, const compile_mesh *m)
{
    for (uint32_t i = 0; i < m->polygon_count; ++i) dump_polygon(to, in, m, i);
}

void dump_stage(FILE *to, const compile_view *v)
{
    if (v->stage == STAGE_INPUT) dump_input(to, v->in);
    else if (v->stage == STAGE_RELATIONS) dump_relations(to, v->relations);
    else if (v->stage == STAGE_CSG) dump_csg(to, v->in, v->soup);
    else if (v->stage == STAGE_WELD) dump_weld(to, v);
    else if (v->stage == STAGE_MERGE) dump_merge(to, v->in, v->mesh);
    else if (v->stage == STAGE_PORTALS) dump_portals(to, v);
    else if (v->stage == STAGE_ZONES) dump_zones(to, v);
    else if (v->stage == STAGE_T_JUNCTIONS) dump_t_junctions(to, v);
}

void dump_items(FILE *to, const scene *s)
{
    for (uint32_t i = 0; i < s->item_count + s->mover_count; ++i) {
        const scene_item *item = &s->items[i];
        fprintf(to, "%s %u object %u %s flags %u", i < s->item_count ? "item" : "mover", i, item->object, s->materials[item->material].name, item->flags);
        for (uint32_t k = item->first_index; k < item->first_index + item->index_count; ++k) {
            const cull_vec3 p = s->positions[s->indices[k]];
            fprintf(to, "%s(%.9g %.9g %.9g)", (k - item->first_index) % 3 ? " " : "\n  ", (double)p.x, (double)p.y, (double)p.z);
        }
        fputc('\n', to);
    }
}
