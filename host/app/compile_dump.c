// Dumps of the compiler's stages: see compile_dump.h. Planes as exact integers, points as doubles in grid steps.
// SPDX-License-Identifier: MIT
#include "compile_dump.h"

#include "../compile/plane_table.h"

static const char *material_name(const compile_input *in, uint32_t material)
{
    return material == COMPILE_NOTHING ? "-" : in->materials[material].name;
}

static void print_plane(FILE *to, const compile_input *in, plane_ref ref)
{
    const cull_wide_plane p = plane_table_get(in->planes, ref);
    fprintf(to, "plane %lld %lld %lld %.17g", (long long)p.normal[0], (long long)p.normal[1], (long long)p.normal[2], cull_wide_to_double(p.offset));
}

static void print_loop(FILE *to, const compile_mesh *m, uint32_t first, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        const double *p = m->vertices[m->loop[first + i]].position;
        fprintf(to, " (%.17g %.17g %.17g)", p[0], p[1], p[2]);
    }
    fputc('\n', to);
}

void dump_input(FILE *to, const compile_input *in)
{
    static const char *const roles[] = {"structure", "liquid", "entity", "portal"};
    for (uint32_t b = 0; b < in->brush_count; ++b) {
        const compile_brush *brush = &in->brushes[b];
        fprintf(to, "brush %u entity %u %s %s box %d %d %d %d %d %d\n", b, brush->entity, brush->kind == BRUSH_ADD ? "add" : "subtract", roles[brush->role],
                (int)brush->min[0], (int)brush->min[1], (int)brush->min[2], (int)brush->max[0], (int)brush->max[1], (int)brush->max[2]);
        for (uint32_t f = brush->first_face; f < brush->first_face + brush->face_count; ++f) {
            fprintf(to, "  face line %u %s ", in->faces[f].line, material_name(in, in->faces[f].material));
            print_plane(to, in, in->faces[f].plane);
            fputc('\n', to);
        }
    }
    for (uint32_t i = 0; i < in->weld_moves; ++i)
        fprintf(to, "weld %s brush %u line %u move %.9g\n", in->changes[i].kind == WELD_PLANE ? "plane" : "point", in->changes[i].brush, in->changes[i].line,
                in->changes[i].move);
}

static void print_polygon(FILE *to, const compile_input *in, const compile_mesh *m, uint32_t polygon)
{
    const compile_polygon *p = &m->polygons[polygon];
    fprintf(to, "polygon %u brush %u %s ", polygon, p->brush, material_name(in, p->material));
    print_plane(to, in, p->plane);
    print_loop(to, m, p->first_vertex, p->vertex_count);
}

void dump_csg(FILE *to, const compile_input *in, const compile_mesh *m)
{
    for (uint32_t i = 0; i < m->polygon_count; ++i) print_polygon(to, in, m, i);
}

void dump_zones(FILE *to, const compile_input *in, const compiled_zones *z)
{
    for (uint32_t i = 0; i < z->zone_count; ++i)
        fprintf(to, "zone %u %s entities %u chain %s\n", i, z->zones[i].name, z->zones[i].entity_count, z->zones[i].chain ? z->zones[i].chain : "-");
    for (uint32_t i = 0; i < z->portal_count; ++i) {
        const compiled_portal *p = &z->portals[i];
        fprintf(to, "portal %u zones %u %u entity %u ", i, p->zones[0], p->zones[1], p->entity);
        print_plane(to, in, p->plane);
        print_loop(to, z->mesh, p->first_vertex, p->vertex_count);
    }
    for (uint32_t i = 0; i < z->leak_line_count; ++i) fprintf(to, "leak %.9g %.9g %.9g\n", z->leak_line[i][0], z->leak_line[i][1], z->leak_line[i][2]);
    for (uint32_t i = 0; i < z->mesh->polygon_count; ++i) {
        if (z->polygon_zone[i] == UINT32_MAX) fprintf(to, "void ");
        else fprintf(to, "zone %u ", z->polygon_zone[i]);
        print_polygon(to, in, z->mesh, i);
    }
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
