// Prints of compiled maps: see map_print.h.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 199309L // clock_gettime
#include "tests/common/test.h"

#include "map_print.h"

#include "host/compile/plane_table.h"
#include "tests/common/report_lines.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

// ---- The field ----

static const uint64_t FIELD = ((uint64_t)1 << 61) - 1;
__extension__ typedef unsigned __int128 product;

static uint64_t reduced(int64_t v)
{
    const int64_t r = v % (int64_t)FIELD;
    return r < 0 ? (uint64_t)(r + (int64_t)FIELD) : (uint64_t)r;
}

static uint64_t plus(uint64_t a, uint64_t b)
{
    return (a + b) % FIELD;
}

static uint64_t minus(uint64_t a, uint64_t b)
{
    return (a + FIELD - b) % FIELD;
}

static uint64_t times(uint64_t a, uint64_t b)
{
    return (uint64_t)((product)a * b % FIELD);
}

static uint64_t inverse(uint64_t a) // a^(p - 2)
{
    uint64_t out = 1;
    for (uint64_t left = FIELD - 2; left; left >>= 1) {
        if (left & 1) out = times(out, a);
        a = times(a, a);
    }
    return out;
}

static uint64_t reduced_wide(cull_wide v)
{
    const cull_wide size = cull_wide_magnitude(v);
    const uint64_t r = plus(times(size.high % FIELD, times((uint64_t)1 << 32, (uint64_t)1 << 32)), size.low % FIELD);
    return cull_wide_sign(v) < 0 ? minus(0, r) : r;
}

static uint64_t determinant(uint64_t rows[3][4], const int c[3])
{
    uint64_t sum = 0;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        sum = plus(sum, times(rows[0][c[i]], minus(times(rows[1][c[j]], rows[2][c[k]]), times(rows[1][c[k]], rows[2][c[j]]))));
    }
    return sum;
}

// ---- Prints of points and loops ----

static uint64_t mix(uint64_t h, uint64_t v)
{
    h = (h ^ v) * 0xbf58476d1ce4e5b9u;
    h = (h ^ h >> 27) * 0x94d049bb133111ebu;
    return h ^ h >> 31;
}

// Where the point was before the map was rewritten, exactly. The scene's axes are the map's x, z, -y.
static uint64_t point_print(const compile_input *in, const compile_vertex *v, const map_rewrite *by)
{
    static const int replaced[4][3] = {{3, 1, 2}, {0, 3, 2}, {0, 1, 3}, {0, 1, 2}};
    uint64_t rows[3][4], scene[3], h = 1;
    for (int r = 0; r < 3; ++r) {
        const cull_wide_plane p = plane_table_get(in->planes, v->planes[r]);
        for (int k = 0; k < 3; ++k) rows[r][k] = reduced(p.normal[k]);
        rows[r][3] = minus(0, reduced_wide(p.offset));
    }
    const uint64_t w = determinant(rows, replaced[3]);
    assert_true(w != 0);
    const uint64_t over_w = inverse(w), over_square = inverse(times(reduced(by->scale), reduced(by->scale)));
    for (int k = 0; k < 3; ++k) scene[k] = times(determinant(rows, replaced[k]), over_w);
    const uint64_t moved[3] = {minus(scene[0], reduced(by->move[0])), minus(minus(0, scene[2]), reduced(by->move[1])), minus(scene[1], reduced(by->move[2]))};
    for (int k = 0; k < 3; ++k) {
        uint64_t sum = 0;
        for (int j = 0; j < 3; ++j) sum = plus(sum, times(reduced(by->turn[j][k]), moved[j]));
        h = mix(h, times(sum, over_square));
    }
    return h;
}

static uint64_t *points_of(const compile_input *in, const compile_mesh *m, const map_rewrite *by)
{
    uint64_t *points = malloc((m->vertex_count + 1) * sizeof *points);
    assert_non_null(points);
    for (uint32_t v = 0; v < m->vertex_count; ++v) points[v] = point_print(in, &m->vertices[v], by);
    return points;
}

typedef enum loop_way { LOOP_FORWARD, LOOP_BACKWARD } loop_way;

static uint64_t loop_print(const uint64_t *points, const uint32_t *loop, uint32_t count, loop_way way)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const uint64_t a = points[loop[i]], b = points[loop[i + 1 < count ? i + 1 : 0]];
        sum += way == LOOP_FORWARD ? mix(a, b) : mix(b, a);
    }
    return sum;
}

static uint64_t text_print(const char *text)
{
    uint64_t h = 3;
    for (; *text; ++text) h = mix(h, (unsigned char)*text);
    return h;
}

static int ascending(const void *a, const void *b)
{
    const uint64_t p = *(const uint64_t *)a, q = *(const uint64_t *)b;
    return (p > q) - (p < q);
}

static print_list list_of(size_t count)
{
    const print_list list = {malloc((count + 1) * sizeof(uint64_t)), count};
    assert_non_null(list.prints);
    return list;
}

static void sort_list(print_list *l)
{
    qsort(l->prints, l->count, sizeof *l->prints, ascending);
}

// ---- Lists ----

static print_list polygon_prints(const compile_input *in, const compile_mesh *m, const map_rewrite *by)
{
    uint64_t *points = points_of(in, m, by);
    print_list list = list_of(m->polygon_count);
    const loop_way way = rewrite_is_mirrored(by) ? LOOP_BACKWARD : LOOP_FORWARD;
    for (uint32_t i = 0; i < m->polygon_count; ++i) {
        const compile_polygon *p = &m->polygons[i];
        const uint64_t material = p->material == COMPILE_NOTHING ? 0 : text_print(in->materials[p->material].name);
        list.prints[i] = mix(loop_print(points, m->loop + p->first_vertex, p->vertex_count, way), material);
    }
    free(points);
    return list;
}

// A zone is what bounds it.
static uint64_t *zone_prints(const compiled_zones *z, const print_list *polygons)
{
    uint64_t *zones = calloc((size_t)z->zone_count + 1, sizeof *zones);
    assert_non_null(zones);
    for (uint32_t i = 0; i < z->zone_count; ++i) zones[i] = z->zones[i].entity_count;
    for (size_t i = 0; i < polygons->count; ++i)
        if (z->polygon_zone[i] < z->zone_count) zones[z->polygon_zone[i]] += polygons->prints[i];
    return zones;
}

static print_list portal_prints(const compile_input *in, const compiled_zones *z, const uint64_t *zones, const map_rewrite *by)
{
    const int mirrored = rewrite_is_mirrored(by);
    uint64_t *points = points_of(in, z->mesh, by);
    print_list list = list_of(z->portal_count);
    for (uint32_t i = 0; i < z->portal_count; ++i) {
        const compiled_portal *p = &z->portals[i];
        list.prints[i] = 0;
        for (int side = 0; side < 2; ++side) {
            const uint64_t loop = loop_print(points, z->mesh->loop + p->first_vertex, p->vertex_count, side == mirrored ? LOOP_FORWARD : LOOP_BACKWARD);
            list.prints[i] += mix(mix(loop, zones[p->zones[side]]), zones[p->zones[!side]]);
        }
    }
    free(points);
    sort_list(&list);
    return list;
}

// Labels that know what is next to them, one step farther each round.
static print_list zone_labels(const compiled_zones *z)
{
    print_list now = list_of(z->zone_count), next = list_of(z->zone_count);
    for (uint32_t i = 0; i < z->zone_count; ++i) now.prints[i] = mix(5, z->zones[i].entity_count);
    for (uint32_t round = 0; round < z->zone_count && round < 64; ++round) {
        for (uint32_t i = 0; i < z->zone_count; ++i) next.prints[i] = mix(now.prints[i], round);
        for (uint32_t i = 0; i < z->portal_count; ++i)
            for (int side = 0; side < 2; ++side) next.prints[z->portals[i].zones[side]] += mix(now.prints[z->portals[i].zones[!side]], 7);
        memcpy(now.prints, next.prints, z->zone_count * sizeof *now.prints);
    }
    free(next.prints);
    sort_list(&now);
    return now;
}

// ---- A map ----

static double cpu_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static void count_all(map_print *p, const compile_input *in, const csg_counts *csg, const compiled_zones *z, const compile_checks *checks)
{
    p->counts = (map_counts){.polygons_in = csg->polygons_in,
                             .polygons_csg = csg->polygons_csg,
                             .polygons_merged = csg->polygons_merged,
                             .polygons_traced = z->mesh->polygon_count,
                             .zones = z->zone_count - z->zones_sealed,
                             .zones_sealed = z->zones_sealed,
                             .shells = z->shells,
                             .portals = z->portal_count,
                             .leak = z->leak,
                             .t_junctions_inserted = z->t_junctions_inserted,
                             .triangles = checks->triangles,
                             .weld_moves = in->weld_moves,
                             .open_edges = checks->open_edges,
                             .t_junctions_left = checks->t_junctions_left,
                             .degenerate_triangles = checks->degenerate_triangles};
    p->max_move = in->max_move;
}

static void require(result done, const report_lines *lines)
{
    if (done != RESULT_OK) fail_msg("%s", report_lines_only(lines));
}

map_print map_print_of(const char *text, size_t size, const map_rewrite *by, portal_choice choice)
{
    const allocator *heap = allocator_heap();
    const input_options options = {.grid = by->points == POINTS_ROUNDED ? 256 : 1};
    report_lines lines;
    report_lines_init(&lines);
    report *r = &lines.report;
    map_print p = {.cpu_ms = -cpu_ms()};
    compile_input *in = NULL;
    compile_mesh *mesh = NULL;
    compiled_zones *z = NULL;
    scene *s = NULL;
    csg_counts csg;
    compile_checks checks;
    require(compile_input_map(by->name, text, size, &options, heap, r, &in), &lines);
    require(compile_csg(in, r, heap, &mesh, &csg), &lines);
    p.cpu_ms += cpu_ms();
    p.merged = polygon_prints(in, mesh, by);
    p.cpu_ms -= cpu_ms();
    require(compile_zones(in, mesh, choice, r, heap, &z), &lines);
    require(compile_items(in, z, r, heap, &s, &checks), &lines);
    p.cpu_ms += cpu_ms();
    count_all(&p, in, &csg, z, &checks);
    p.traced = polygon_prints(in, z->mesh, by);
    uint64_t *zones = zone_prints(z, &p.traced);
    p.portals = portal_prints(in, z, zones, by);
    p.labels = zone_labels(z);
    for (size_t i = 0; i < p.traced.count; ++i)
        if (z->polygon_zone[i] < z->zone_count) p.traced.prints[i] = mix(p.traced.prints[i], zones[z->polygon_zone[i]]);
    sort_list(&p.merged);
    sort_list(&p.traced);
    free(zones);
    scene_free(s, heap);
    compiled_zones_free(z);
    compile_input_free(in);
    return p;
}

void map_print_free(map_print *p)
{
    print_list *const lists[] = {&p->merged, &p->traced, &p->portals, &p->labels};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; ++i) free(lists[i]->prints);
    *p = (map_print){0};
}

// ---- Comparison ----

// Prints that only one of them has.
static size_t apart(const print_list *a, const print_list *b)
{
    size_t i = 0, j = 0, count = 0;
    while (i < a->count || j < b->count) {
        if (i < a->count && j < b->count && a->prints[i] == b->prints[j]) ++i, ++j;
        else if (j == b->count || (i < a->count && a->prints[i] < b->prints[j])) ++i, ++count;
        else ++j, ++count;
    }
    return count;
}

typedef struct difference_list { char *text; size_t size; int count; } difference_list;

static void tell(difference_list *d, const char *what, size_t a, size_t b)
{
    if (a == b) return;
    d->count++;
    if (d->size < DIFFERENCES_BYTES) d->size += (size_t)snprintf(d->text + d->size, DIFFERENCES_BYTES - d->size, " %s %zu/%zu", what, a, b);
}

int map_print_differences(const map_print *a, const map_print *b, print_depth depth, char out[DIFFERENCES_BYTES])
{
    difference_list d = {.text = out};
    const map_counts *p = &a->counts, *q = &b->counts;
    out[0] = 0;
    tell(&d, "open-edges", 0, q->open_edges);
    tell(&d, "t-junctions-left", 0, q->t_junctions_left);
    tell(&d, "degenerate", 0, q->degenerate_triangles);
    if (depth == PRINT_CHECKS) return d.count;
    tell(&d, "leak", p->leak, q->leak);
    tell(&d, "zones", p->zones, q->zones);
    tell(&d, "sealed", p->zones_sealed, q->zones_sealed);
    tell(&d, "portals", p->portals, q->portals);
    tell(&d, "adjacency", 0, apart(&a->labels, &b->labels));
    if (depth == PRINT_ZONES) return d.count;
    tell(&d, "shells", p->shells, q->shells);
    tell(&d, "in", p->polygons_in, q->polygons_in);
    tell(&d, "csg", p->polygons_csg, q->polygons_csg);
    tell(&d, "merged", p->polygons_merged, q->polygons_merged);
    tell(&d, "merged-set", 0, apart(&a->merged, &b->merged));
    tell(&d, "traced", p->polygons_traced, q->polygons_traced);
    tell(&d, "traced-set", 0, apart(&a->traced, &b->traced));
    tell(&d, "portal-set", 0, apart(&a->portals, &b->portals));
    tell(&d, "t-junctions", p->t_junctions_inserted, q->t_junctions_inserted);
    tell(&d, "triangles", p->triangles, q->triangles);
    tell(&d, "weld", p->weld_moves, q->weld_moves);
    return d.count;
}
