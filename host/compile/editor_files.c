// .prt and .pts: see editor_files.h. Formats: Valve's developer wiki, "Portal file" and "PTS"; TrenchBroom's issue 1157.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "editor_files.h"

#include "../core/file.h"
#include "plane_table.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

static const double UNITS_PER_METRE = 32;
static const double POINT_GAP = 16; // map units: a game shows the points alone, about a step of the player apart

typedef struct text_out {
    buffer text;
    int failed; // out of memory
} text_out;

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void put(text_out *t, const char *format, ...)
{
    char piece[160];
    va_list list;
    va_start(list, format);
    const int length = vsnprintf(piece, sizeof piece, format, list);
    va_end(list);
    if (length < 0 || (size_t)length >= sizeof piece || !buffer_append(&t->text, piece, (size_t)length)) t->failed = 1;
}

static result finish(text_out *t, const char *path, report *r)
{
    const result done = t->failed ? report_no_memory(r, path) : file_write(path, t->text.items, t->text.count, r);
    buffer_free(&t->text);
    return done;
}

static void to_map(const double scene[3], double per_unit, double out[3])
{
    out[0] = scene[0] / per_unit + 0.0; // no -0
    out[1] = -scene[2] / per_unit + 0.0;
    out[2] = scene[1] / per_unit + 0.0;
}

// ---- .prt ----

// 1 where the loop turns at that corner: vertices that stand in a straight line mislead who takes the plane of three.
static int turns(const compile_input *in, const compile_mesh *m, const compiled_portal *p, uint32_t place)
{
    const uint32_t before = place ? place - 1 : p->vertex_count - 1, after = place + 1 < p->vertex_count ? place + 1 : 0;
    const plane_ref edge = m->edge_planes[p->first_vertex + before];
    const compile_vertex *v = &m->vertices[m->loop[p->first_vertex + after]];
    return edge != m->edge_planes[p->first_vertex + place] && plane_table_side_at(in->planes, v->planes, v->position, edge) != 0;
}

static void put_portal(text_out *t, const compile_input *in, const compile_mesh *m, const compiled_portal *p)
{
    const double per_unit = in->steps_per_metre / UNITS_PER_METRE;
    uint32_t corners = 0;
    for (uint32_t i = 0; i < p->vertex_count; ++i) corners += (uint32_t)turns(in, m, p, i);
    put(t, "%u %u %u ", corners, p->zones[0], p->zones[1]);
    for (uint32_t i = p->vertex_count; i-- > 0;) { // ours are counterclockwise seen from zones[0]
        double at[3];
        if (!turns(in, m, p, i)) continue;
        to_map(m->vertices[m->loop[p->first_vertex + i]].position, per_unit, at);
        put(t, "(%.12g %.12g %.12g ) ", at[0], at[1], at[2]);
    }
    put(t, "\n");
}

result editor_prt_write(const compile_input *in, const compiled_zones *z, const char *path, const allocator *memory, report *r)
{
    text_out t = {.text = buffer_make(memory, 1)};
    put(&t, "PRT1\n%u\n%u\n", z->zone_count, z->portal_count);
    for (uint32_t i = 0; i < z->portal_count; ++i) put_portal(&t, in, z->mesh, &z->portals[i]);
    return finish(&t, path, r);
}

// ---- .pts ----

static void put_point(text_out *t, const double p[3])
{
    put(t, "%.9g %.9g %.9g\n", p[0], p[1], p[2]);
}

static void put_way(text_out *t, const double from[3], const double to[3])
{
    const double d[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    const double steps = ceil(sqrt((d[0] * d[0] + d[1] * d[1]) + d[2] * d[2]) / POINT_GAP);
    for (double i = 1; i < steps; ++i) put_point(t, (double[3]){from[0] + d[0] * i / steps, from[1] + d[1] * i / steps, from[2] + d[2] * i / steps});
    put_point(t, to);
}

static result write_points(const compiled_zones *z, const char *path, const allocator *memory, report *r)
{
    text_out t = {.text = buffer_make(memory, 1)};
    double from[3], to[3];
    for (uint32_t i = 0; i < z->leak_line_count; ++i) {
        to_map(z->leak_line[i], 1 / UNITS_PER_METRE, to);
        if (i == 0) put_point(&t, to);
        else put_way(&t, from, to);
        memcpy(from, to, sizeof from);
    }
    return finish(&t, path, r);
}

// Somebody's file of another kind is not ours to remove.
static int is_points(const char *path)
{
    char line[256];
    double p[3];
    FILE *file = fopen(path, "r");
    if (!file) return 0;
    const int good = !fgets(line, sizeof line, file) || sscanf(line, "%lf %lf %lf", &p[0], &p[1], &p[2]) == 3;
    fclose(file);
    return good;
}

static int is_file(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISREG(status.st_mode);
}

result editor_pts_check(const char *path, report *r)
{
    if (!is_file(path) || is_points(path)) return RESULT_OK;
    return report_error(r, path, 0, "what stands there is no .pts file, and is kept; name another file");
}

static result remove_points(const char *path, report *r)
{
    if (!is_file(path)) return RESULT_OK; // a device stays
    if (remove(path) != 0) return report_error(r, path, 0, "no leak, and the old .pts file cannot be removed: %s; remove it", strerror(errno));
    report_note(r, "no leak: the old %s is removed", path);
    return RESULT_OK;
}

result editor_pts_write(const compiled_zones *z, const char *path, const allocator *memory, report *r)
{
    const result ours = editor_pts_check(path, r);
    if (ours != RESULT_OK) return ours;
    return z->leak ? write_points(z, path, memory, r) : remove_points(path, r);
}
