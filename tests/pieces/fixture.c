// See fixture.h.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include "../common/random.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Far apart, so that two that change places show.
static const uint32_t colours[] = {0xff2020ff, 0xff20ff20, 0xffff2020, 0xff20ffff, 0xffff20ff, 0xffffff20, 0xffffffff, 0xff101010};

pane *panes_add(pane_list *l, pane_kind kind, const double middle[3], const double u[3], const double v[3])
{
    static const double signs[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    assert_true(l->count < PANES_MOST);
    pane *p = &l->panes[l->count];
    *p = (pane){.point_count = 4, .kind = kind, .colour = colours[l->count % (sizeof colours / sizeof *colours)]};
    l->count++;
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) p->points[i][k] = middle[k] + signs[i][0] * u[k] + signs[i][1] * v[k];
    return p;
}

void panes_add_box(pane_list *l, const double low[3], const double high[3])
{
    for (int side = 0; side < 6; ++side) {
        const int axis = side / 2, a = (axis + 1) % 3, b = (axis + 2) % 3;
        double middle[3], u[3] = {0}, v[3] = {0};
        for (int k = 0; k < 3; ++k) middle[k] = (low[k] + high[k]) / 2;
        middle[axis] = side % 2 ? high[axis] : low[axis];
        u[a] = (high[a] - low[a]) / 2 * (side % 2 ? 1 : -1);
        v[b] = (high[b] - low[b]) / 2;
        panes_add(l, PANE_GLASS, middle, u, v);
    }
}

// ---- Scenes ----

// Bars of a triangle; each starts before the next and ends behind the one before.
static void add_knot(pane_list *l, double size, double x, double z)
{
    for (int i = 0; i < 3; ++i) {
        const double turn = i * 2.0943951023931953, c = size * cos(turn), s = size * sin(turn);
        const double middle[3] = {x - 0.6 * s, 0.6 * c, z}, u[3] = {1.6 * c, 1.6 * s, 0.5 * size}, v[3] = {-0.35 * s, 0.35 * c, 0};
        panes_add(l, PANE_GLASS, middle, u, v);
    }
}

void panes_cyclic(pane_list *l)
{
    add_knot(l, 1, 0, -4);
}

static void three_knots(pane_list *l) // one behind the other
{
    add_knot(l, 0.7, -0.3, -2.5);
    add_knot(l, 1.6, 0.2, -11);
    add_knot(l, 1.1, 0.4, -6);
}

void panes_crossing(pane_list *l)
{
    const double middle[3] = {0, 0, -4}, tall[3] = {0, 1.2, 0}, a[3] = {1.5, 0, 0.9}, b[3] = {1.5, 0, -0.9};
    panes_add(l, PANE_GLASS, middle, a, tall);
    panes_add(l, PANE_GLASS, middle, b, tall);
}

void panes_boxes(pane_list *l)
{
    for (int i = 0; i < 3; ++i) {
        const double half = 1.6 - 0.45 * i;
        panes_add_box(l, (const double[3]){-half + 0.1 * i, -half, -5 - half}, (const double[3]){half, half - 0.2 * i, -5 + half});
    }
    panes_add_box(l, (const double[3]){1.2, -0.6, -4}, (const double[3]){2.2, 0.6, -2.5}); // half in the largest
}

void panes_random(pane_list *l, uint32_t count, uint64_t seed)
{
    for (uint32_t i = 0; i < count; ++i) {
        double middle[3], u[3], v[3];
        for (int k = 0; k < 3; ++k) {
            middle[k] = random_between(&seed, -2, 2) - (k == 2 ? 5 : 0);
            u[k] = random_between(&seed, -1, 1);
            v[k] = random_between(&seed, -1, 1);
        }
        panes_add(l, PANE_GLASS, middle, u, v);
    }
}

void panes_sliced(pane_list *l)
{
    const double middle[3] = {0, 0, -5}, wide[3] = {2.4, 0.3, 0.8}, tall[3] = {-0.2, 1.9, 0.4};
    uint64_t seed = 7;
    panes_add(l, PANE_GLASS, middle, wide, tall);
    for (int i = 0; i < 24; ++i) {
        const double a = random_between(&seed, -0.9, 0.9), b = random_between(&seed, -0.9, 0.9), turn = random_between(&seed, 0, 6.28);
        double at[3], u[3], v[3] = {0.05, -0.1, 0.35};
        for (int k = 0; k < 3; ++k) {
            at[k] = middle[k] + a * wide[k] + b * tall[k];
            u[k] = 0.12 * (cos(turn) * wide[k] + sin(turn) * tall[k]);
        }
        panes_add(l, PANE_GLASS, at, u, v);
    }
}

static void thirty(pane_list *l)
{
    panes_random(l, 30, 1);
}

static void forty(pane_list *l)
{
    panes_random(l, 40, 2);
}

const pane_scene pane_scenes[] = {{"cyclic", panes_cyclic}, {"three knots", three_knots}, {"crossing", panes_crossing}, {"boxes", panes_boxes},
                                  {"sliced", panes_sliced}, {"thirty at random", thirty}, {"forty at random", forty}};
const uint32_t pane_scene_count = sizeof pane_scenes / sizeof *pane_scenes;

// ---- Rays ----

double pane_hit(const pane *p, const double from[3], const double along[3])
{
    double n[3], facing = 0, height = 0, point[3];
    for (int k = 0; k < 3; ++k) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        n[k] = (p->points[1][a] - p->points[0][a]) * (p->points[2][b] - p->points[0][b]) -
               (p->points[1][b] - p->points[0][b]) * (p->points[2][a] - p->points[0][a]);
    }
    for (int k = 0; k < 3; ++k) {
        facing += n[k] * along[k];
        height += n[k] * (p->points[0][k] - from[k]);
    }
    const double t = height / facing;
    if (facing == 0 || t < 1e-4) return INFINITY;
    for (int k = 0; k < 3; ++k) point[k] = from[k] + t * along[k];
    for (uint32_t i = 0; i < p->point_count; ++i) {
        const double *a = p->points[i], *b = p->points[(i + 1) % p->point_count];
        double inside = 0;
        for (int k = 0; k < 3; ++k) {
            const int u = (k + 1) % 3, v = (k + 2) % 3;
            inside += n[k] * ((b[u] - a[u]) * (point[v] - a[v]) - (b[v] - a[v]) * (point[u] - a[u]));
        }
        if (inside < 0) return INFINITY;
    }
    return t;
}

// ---- A scene of them ----

static void plane_of(const pane *p, double out[4])
{
    double n[3] = {0}, size = 0;
    for (uint32_t i = 2; i < p->point_count; ++i)
        for (int k = 0; k < 3; ++k) {
            const int a = (k + 1) % 3, b = (k + 2) % 3;
            n[k] += (p->points[i - 1][a] - p->points[0][a]) * (p->points[i][b] - p->points[0][b]) -
                    (p->points[i - 1][b] - p->points[0][b]) * (p->points[i][a] - p->points[0][a]);
        }
    for (int k = 0; k < 3; ++k) size += n[k] * n[k];
    size = sqrt(size);
    out[3] = 0;
    for (int k = 0; k < 3; ++k) {
        out[k] = n[k] / size;
        out[3] -= out[k] * p->points[0][k];
    }
}

static void add_pane(scene_builder *b, const pane *p, uint32_t number, pane_materials materials)
{
    const uint32_t translucent = p->kind != PANE_OPAQUE && materials == AS_THEY_ARE ? MATERIAL_TRANSLUCENT : 0;
    builder_vertex vertices[PANE_POINTS_MOST] = {0};
    static const double still[3] = {0, 0, 0};
    uint32_t material, first, indices[3 * PANE_POINTS_MOST], loop[PANE_POINTS_MOST], count = 0;
    char name[32];
    snprintf(name, sizeof name, "pane %u", number);
    assert_int_equal(scene_builder_material(b, name, strlen(name), translucent, &material), RESULT_OK);
    assert_int_equal(scene_builder_material_colour(b, material, p->colour), RESULT_OK);
    for (uint32_t i = 0; i < p->point_count; ++i) memcpy(vertices[i].position, p->points[i], sizeof p->points[i]);
    assert_int_equal(scene_builder_vertices(b, vertices, p->point_count, material, &first), RESULT_OK);
    for (uint32_t i = 0; i < p->point_count; ++i) loop[i] = first + i;
    for (uint32_t i = 2; i < p->point_count; ++i) {
        indices[count++] = first;
        indices[count++] = first + i - 1;
        indices[count++] = first + i;
    }
    const uint32_t triangles = count / 3;
    builder_item item = {.indices = indices, .index_count = count, .polygon_triangles = &triangles, .polygon_count = 1, .loop = loop,
                         .loop_count = p->point_count, .material = material, .flags = CULL_ITEM_WALL};
    plane_of(p, item.plane);
    if (p->kind == PANE_CLUSTER || p->kind == PANE_MOVER) item.flags = 0;
    if (p->kind == PANE_MOVER) assert_int_equal(scene_builder_mover(b, name, still, &item), RESULT_OK);
    else assert_int_equal(scene_builder_item(b, &item), RESULT_OK);
}

scene *panes_build(const pane_list *l, pane_materials materials, const allocator *memory)
{
    scene_builder *b = NULL;
    scene *s = NULL;
    report r = report_to_stderr();
    uint32_t object;
    assert_int_equal(scene_builder_open(memory, &b), RESULT_OK);
    assert_int_equal(scene_builder_object(b, "panes", 5, &object), RESULT_OK);
    for (uint32_t i = 0; i < l->count; ++i) add_pane(b, &l->panes[i], i, materials);
    assert_int_equal(scene_builder_finish(b, "panes", &r, &s), RESULT_OK);
    scene_builder_close(b);
    return s;
}

// ---- Its chain ----

void zone_chain_open(const scene *s, uint32_t zone, const char *spec, zone_chain *out)
{
    const allocator *memory = allocator_heap();
    const char *const folders[] = {getenv("PORTCULLIS_PLUGINS")};
    const loader_options options = {.folders = folders, .folder_count = folders[0] ? 1 : 0};
    memset(out, 0, sizeof *out);
    out->log = report_to_stderr();
    out->texts = arena_make(memory);
    host_services_fill(&out->services, memory, &out->log);
    assert_int_equal(loader_open(&options, memory, &out->log, &out->plugins), RESULT_OK);
    assert_int_equal(chain_parse(spec, &out->texts, &out->log, &out->spec), RESULT_OK);
    assert_int_equal(zone_data_open(&(zone_data_request){s, zone, 0}, memory, &out->zone), RESULT_OK);
    assert_int_equal(chain_build(&(chain_request){&out->spec, &out->zone, out->plugins, &out->services, NULL}, &out->log, &out->chain), RESULT_OK);
    out->lent = chain_pieces(out->chain, &out->log);
}

void zone_chain_close(zone_chain *c)
{
    if (!c->chain) return;
    chain_close(c->chain);
    zone_data_close(&c->zone);
    loader_close(c->plugins);
    arena_free(&c->texts);
}

uint32_t zone_chain_item(const zone_chain *c, uint32_t place)
{
    return c->chain->order ? c->chain->order[place] : place;
}

const char *const piece_chains[] = {"bsp[split=1,choose=balance]", "bsp[split=node,choose=balance]", "bsp[split=1,choose=sah]",
                                    "bsp[split=node,choose=sah]",  "bsp[split=1,choose=first]",      "bsp[split=node,choose=first]"};
const uint32_t piece_chain_count = sizeof piece_chains / sizeof *piece_chains;
