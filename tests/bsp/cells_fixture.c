// See cells_fixture.h.
// SPDX-License-Identifier: MIT
#include "cells_fixture.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void give_up(const char *what)
{
    fprintf(stderr, "cells_fixture: %s\n", what);
    abort();
}

static void *some(size_t count, size_t size)
{
    void *p = calloc(count ? count : 1, size);
    if (!p) give_up("no memory");
    return p;
}

// ---- A compiled map ----

static char *file_text(const char *name, size_t *out_size)
{
    const char *folder = getenv("PORTCULLIS_SCENES");
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder ? folder : ".", name);
    FILE *f = fopen(path, "rb");
    if (!f) {
        fprintf(stderr, "SKIPPED: no %s (PORTCULLIS_SCENES)\n", path);
        return NULL;
    }
    fseek(f, 0, SEEK_END);
    const long size = ftell(f);
    rewind(f);
    char *text = some((size_t)size + 1, 1);
    *out_size = fread(text, 1, (size_t)size, f);
    fclose(f);
    return text;
}

int cells_map_open(const char *name, portal_choice portals, cells_map *out)
{
    report silent = {0};
    size_t size = 0;
    char *text = file_text(name, &size);
    memset(out, 0, sizeof *out);
    if (!text) return 0;
    const whole_map m = {text, size, 0, portals};
    if (whole_compile(&m, &silent, allocator_heap(), &out->whole) != RESULT_OK) give_up("the map does not compile");
    const scene *s = out->whole.scene;
    out->zones = some(s->zone_count, sizeof *out->zones);
    for (uint32_t z = 0; z < s->zone_count; z++)
        if (zone_data_open(&(zone_data_request){s, z, 0}, allocator_heap(), &out->zones[z]) != RESULT_OK) give_up("no zone data");
    free(text);
    return 1;
}

void cells_map_close(cells_map *m)
{
    for (uint32_t z = 0; m->zones && z < m->whole.scene->zone_count; z++) zone_data_close(&m->zones[z]);
    free(m->zones);
    whole_free(&m->whole, allocator_heap());
}

const zone_data *cells_map_largest(const cells_map *m)
{
    const zone_data *best = &m->zones[0];
    for (uint32_t z = 1; z < m->whole.scene->zone_count; z++)
        if (m->zones[z].zone.item_count > best->zone.item_count) best = &m->zones[z];
    return best;
}

// ---- Built ----

void cells_built_make(cells_built *b, const cull_zone *zone)
{
    culler_host_init(&b->host, 0);
    if (bsp_tree_build(&b->host.host, &(bsp_source){.zone = zone}, &b->tree) != CULL_OK) give_up("no tree");
    if (bsp_cells_build(&b->host.host, zone, &b->tree, &b->cells) != CULL_OK) give_up("no cells");
}

int cells_built_free(cells_built *b)
{
    bsp_cells_free(&b->host.host, &b->cells);
    bsp_tree_free(&b->host.host, &b->tree);
    return failing_allocator_is_clean(&b->host.memory);
}

static uint64_t hash_on(uint64_t hash, const void *bytes, size_t size) // Fowler, Noll and Vo's 1a
{
    const unsigned char *p = bytes;
    for (size_t i = 0; i < size; i++) hash = (hash ^ p[i]) * 0x100000001b3u;
    return hash;
}

uint64_t cells_hash(const bsp_cells_data *c, const uint32_t *order)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (uint32_t i = 0; i < c->entry_count; i++) {
        const uint32_t entry[4] = {order[c->entries[i].item], c->entries[i].first_point, c->entries[i].point_count, c->entries[i].plane};
        hash = hash_on(hash, entry, sizeof entry);
    }
    hash = hash_on(hash, c->planes, c->plane_count * sizeof *c->planes);
    hash = hash_on(hash, c->nodes, c->node_count * sizeof *c->nodes);
    hash = hash_on(hash, c->cells, c->cell_count * sizeof *c->cells);
    hash = hash_on(hash, c->openings, c->opening_count * sizeof *c->openings);
    hash = hash_on(hash, c->opening_points, c->opening_point_count * sizeof *c->opening_points);
    hash = hash_on(hash, c->entry_points, c->entry_point_count * sizeof *c->entry_points);
    hash = hash_on(hash, c->portal_offsets, (c->portal_count + (size_t)1) * sizeof *c->portal_offsets);
    hash = hash_on(hash, c->stands, c->stand_count * sizeof *c->stands);
    return hash_on(hash, c->stand_points, c->stand_point_count * sizeof *c->stand_points);
}

// ---- Segments ----

static double height_at(const bsp_plane *plane, const double p[3])
{
    return ((plane->normal[0] * p[0] + plane->normal[1] * p[1]) + plane->normal[2] * p[2]) + plane->offset;
}

uint32_t cell_of(const bsp_cells_data *c, const double p[3])
{
    uint32_t at = c->node_count ? 0 : BSP_LEAF;
    while (!(at & BSP_LEAF)) at = c->nodes[at].child[height_at(&c->planes[c->nodes[at].plane], p) < 0];
    return at & ~BSP_LEAF;
}

typedef struct span { uint32_t at; double from, to; uint32_t node, side; } span; // node: whose plane it begins on, BSP_NONE

// Depth first, near before far.
int segment_walk_make(const bsp_cells_data *c, const segment *s, segment_walk *out)
{
    static span stack[CROSSINGS_MOST];
    uint32_t top = 0, last = BSP_NONE;
    out->count = 0;
    stack[top++] = (span){c->node_count ? 0 : BSP_LEAF, 0, 1, BSP_NONE, 0};
    while (top) {
        span now = stack[--top];
        while (!(now.at & BSP_LEAF)) {
            const bsp_node *node = &c->nodes[now.at];
            const double a = height_at(&c->planes[node->plane], s->from), b = height_at(&c->planes[node->plane], s->to);
            const double ha = a + now.from * (b - a), hb = a + now.to * (b - a);
            if (ha >= 0 && hb >= 0) now.at = node->child[0];
            else if (ha < 0 && hb < 0) now.at = node->child[1];
            else {
                const uint32_t near = ha < 0;
                const double cut = a / (a - b);
                if (top == CROSSINGS_MOST) return 0;
                stack[top++] = (span){node->child[!near], cut, now.to, now.at, near};
                now = (span){node->child[near], now.from, cut, now.node, now.side};
            }
        }
        if (now.node != BSP_NONE && last != BSP_NONE) {
            if (out->count == CROSSINGS_MOST) return 0;
            out->crossings[out->count++] = (crossing){now.from, last, now.at & ~BSP_LEAF, now.node, now.side};
        }
        last = now.at & ~BSP_LEAF;
    }
    return 1;
}

double polygon_depth(const cull_point *points, uint32_t count, const double n[3], const double p[3])
{
    double least = DBL_MAX, turn = 0;
    for (uint32_t i = 0; i < count; i++) {
        const cull_point a = points[i], b = points[(i + 1) % count];
        turn += n[0] * (a.y * b.z - a.z * b.y) + n[1] * (a.z * b.x - a.x * b.z) + n[2] * (a.x * b.y - a.y * b.x);
    }
    for (uint32_t i = 0; i < count; i++) {
        const cull_point a = points[i], b = points[(i + 1) % count];
        const double d[3] = {b.x - a.x, b.y - a.y, b.z - a.z}, length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        if (!(length > 0)) continue;
        const double q[3] = {p[0] - a.x, p[1] - a.y, p[2] - a.z};
        const double left = (n[0] * (d[1] * q[2] - d[2] * q[1]) + n[1] * (d[2] * q[0] - d[0] * q[2]) + n[2] * (d[0] * q[1] - d[1] * q[0])) / length;
        const double depth = turn < 0 ? -left : left;
        if (depth < least) least = depth;
    }
    return least;
}

const bsp_opening *opening_of(const bsp_cells_data *c, const crossing *x, const double p[3], double slack)
{
    const bsp_cell *from = &c->cells[x->from];
    for (uint32_t i = 0; i < from->opening_count; i++) {
        const bsp_opening *o = &c->openings[from->first_opening + i];
        if (o->to != x->to || o->plane != c->nodes[x->node].plane || o->side != x->side) continue;
        if (polygon_depth(c->opening_points + o->first_point, o->point_count, c->planes[o->plane].normal, p) >= -slack) return o;
    }
    return NULL;
}
