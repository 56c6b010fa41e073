// Dumps of the compiler's stages: see compile_dump.h. This file: portals tried, shells and zones, the surface with all its vertices.
// SPDX-License-Identifier: MIT
#include "compile_dump.h"

#include "../compile/zone_trace.h"

static void print_corners(FILE *to, const surface *s, const surface_polygon *p)
{
    for (uint32_t i = 0; i < p->count; ++i) dump_point(to, surface_vertex_at(s, surface_corners(s, p)[i].vertex)->position);
    fputc('\n', to);
}

void dump_portals(FILE *to, const compile_view *v)
{
    const portal_set *set = v->portals;
    const portal_piece *pieces = set->pieces.items;
    for (uint32_t i = 0; i < set->pieces.count; ++i) {
        const surface_polygon *p = surface_polygon_at(&set->s, pieces[i].polygon);
        fprintf(to, "piece %u entity %u %s ", i, pieces[i].entity, pieces[i].is_door ? "door" : "authored");
        dump_plane(to, v->in, p->plane);
        print_corners(to, &set->s, p);
    }
}

// ---- Zones ----

static void print_zone_of(FILE *to, const compile_view *v, uint32_t region)
{
    if (v->zones->leak) fputs("zone 0", to);
    else if (region < v->places->region_count) fprintf(to, "zone %u", v->places->zone_of[region]);
    else fputs(region == REGION_SOLID ? "solid" : "void", to);
}

static void print_zones(FILE *to, const compiled_zones *z)
{
    for (uint32_t i = 0; i < z->zone_count; ++i)
        fprintf(to, "zone %u entities %u chain %s name %s\n", i, z->zones[i].entity_count, z->zones[i].chain ? z->zones[i].chain : "-", z->zones[i].name);
    for (uint32_t i = 0; i < z->leak_line_count; ++i) {
        fputs("leak", to);
        dump_point(to, z->leak_line[i]);
        fputc('\n', to);
    }
}

static void print_places(FILE *to, const compile_view *v)
{
    for (uint32_t e = 0; e < v->places->entity_count; ++e) {
        if (v->places->region_of[e] == REGION_NOT_PLACED) continue;
        fprintf(to, "entity %u %s ", e, v->in->entities[e].class_name);
        print_zone_of(to, v, v->places->region_of[e]);
        fputc('\n', to);
    }
}

void dump_zones(FILE *to, const compile_view *v)
{
    const zone_trace *t = v->trace;
    print_zones(to, v->zones);
    print_places(to, v);
    for (uint32_t i = 0; i < t->shells.shell_count; ++i) {
        fprintf(to, "shell %u %s ", i, t->regions.is_outer[i] ? "outer" : "island");
        print_zone_of(to, v, t->regions.region_of[i]);
        fputc('\n', to);
    }
    static const char *const kinds[] = {"wall", "liquid", "portal", "seal"};
    for (uint32_t i = 0; i < surface_polygon_count(&t->s); ++i) {
        const surface_polygon *p = surface_polygon_at(&t->s, i);
        fprintf(to, "%s %u", kinds[p->kind], i);
        for (uint32_t side = 0; side < (surface_is_two_sided(p->kind) ? 2u : 1u); ++side) {
            const uint32_t shell = t->shells.shell_of[2 * i + side];
            if (shell == SHELL_NONE) fputs(" shell -", to);
            else fprintf(to, " shell %u", shell);
        }
        fputc(' ', to);
        dump_plane(to, v->in, p->plane);
        print_corners(to, &t->s, p);
    }
}

// ---- The surface ----

void dump_t_junctions(FILE *to, const compile_view *v)
{
    const compiled_zones *z = v->zones;
    for (uint32_t i = 0; i < z->portal_count; ++i) {
        const compiled_portal *p = &z->portals[i];
        fprintf(to, "portal %u zones %u %u entity %u ", i, p->zones[0], p->zones[1], p->entity);
        dump_plane(to, v->in, p->plane);
        dump_loop(to, z->mesh, p->first_vertex, p->vertex_count);
    }
    for (uint32_t i = 0; i < z->mesh->polygon_count; ++i) {
        if (z->polygon_zone[i] == UINT32_MAX) fputs("void ", to);
        else fprintf(to, "zone %u ", z->polygon_zone[i]);
        dump_polygon(to, v->in, z->mesh, i);
    }
}
