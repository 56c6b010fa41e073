// The scenes of the checks, each of one kind of hardship: see scene.h.
// SPDX-License-Identifier: MIT
#include "scene_builder.h"

#include <math.h>
#include <string.h>

static const char *const names[SCENE_KINDS] = {"spread", "city", "room", "mesh", "panes", "grid", "tiny", "flat", "far", "one", "empty"};

const char *made_scene_name(scene_kind kind)
{
    return names[kind];
}

static cull_box box_at(const double at[3], const double size[3])
{
    cull_box box;
    for (int i = 0; i < 3; ++i) {
        (&box.min.x)[i] = (float)at[i];
        (&box.max.x)[i] = (float)(at[i] + size[i]);
    }
    return box;
}

static void spread(check_run *r, scene_builder *b, const double middle[3])
{
    for (int i = 0; i < 260; ++i) {
        double at[3], size[3];
        for (int k = 0; k < 3; ++k) at[k] = middle[k] + run_between(r, -50, 50), size[k] = run_below(r, 5) ? run_between(r, 0, 4) : run_between(r, 2, 15);
        builder_box(b, box_at(at, size));
    }
}

static void city(check_run *r, scene_builder *b)
{
    const cull_vec3 ground[4] = {{-64, 0, -64}, {-64, 0, 64}, {64, 0, 64}, {64, 0, -64}};
    b->is_exact = 1;
    builder_wall(b, ground, 4, 0);
    for (int x = -48; x < 48; x += 16)
        for (int z = -48; z < 48; z += 16) {
            const double at[3] = {x + (double)run_below(r, 4), 0, z + (double)run_below(r, 4)};
            const double size[3] = {3 + (double)run_below(r, 7), 1 + (double)run_below(r, 14), 3 + (double)run_below(r, 7)};
            builder_walls(b, box_at(at, size), FACE_OUT, run_below(r, 4) ? 0 : CULL_ITEM_TWO_SIDED);
        }
}

static void room(check_run *r, scene_builder *b)
{
    b->is_exact = 1;
    builder_walls(b, (cull_box){{-20, 0, -16}, {20, 8, 16}}, FACE_IN, 0);
    for (int i = 0; i < 14; ++i) {
        const double at[3] = {-18 + (double)run_below(r, 34), 0, -14 + (double)run_below(r, 26)};
        const double size[3] = {1 + (double)run_below(r, 3), run_below(r, 3) ? 8 : 3, 1 + (double)run_below(r, 3)};
        builder_walls(b, box_at(at, size), FACE_OUT, 0);
    }
    for (int i = 0; i < 8; ++i) {
        const float x = (float)run_below(r, 30) - 15, z = (float)run_below(r, 24) - 12, wide = 1 + (float)run_below(r, 4);
        const cull_vec3 pane[4] = {{x, 1, z}, {x + wide, 1, z}, {x + wide, 3, z}, {x, 3, z}};
        builder_wall(b, pane, 4, i % 2 ? CULL_ITEM_SEE_THROUGH | CULL_ITEM_TWO_SIDED : CULL_ITEM_CUT_OUT | CULL_ITEM_TWO_SIDED);
    }
}

static void mesh(check_run *r, scene_builder *b)
{
    enum { TRIANGLES = 6 };
    for (int i = 0; i < 220; ++i) {
        cull_vec3 points[3 * TRIANGLES];
        const double x = run_between(r, -60, 60), z = run_between(r, -60, 60), wide = run_between(r, 0.5, 6);
        for (int k = 0; k < 3 * TRIANGLES; ++k)
            points[k] = (cull_vec3){(float)(x + run_between(r, 0, wide)), (float)run_between(r, 0, wide), (float)(z + run_between(r, 0, wide))};
        builder_triangles(b, points, TRIANGLES, run_below(r, 12) ? 0 : CULL_ITEM_CUT_OUT);
    }
}

// Each in a direction of its own (a spiral on the sphere), smaller than the gaps, so that each is seen whole from the middle.
static void panes(check_run *r, scene_builder *b)
{
    enum { COUNT = 3000 };
    for (int i = 0; i < COUNT; ++i) {
        const double y = 1 - (2 * i + 1) / (double)COUNT, across = sqrt(1 - y * y), turn = i * 2.39996322972865332;
        const double d[3] = {across * cos(turn), y, across * sin(turn)}, far = run_between(r, 20, 60), half = 0.008 * far; // gaps are 0.06 of the distance
        const double u[3] = {-sin(turn), 0, cos(turn)}, v[3] = {-y * cos(turn), across, -y * sin(turn)};
        cull_vec3 points[6];
        static const int corner[6][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, -1}, {1, 1}, {-1, 1}};
        for (int k = 0; k < 6; ++k)
            for (int a = 0; a < 3; ++a) (&points[k].x)[a] = (float)(far * d[a] + half * (corner[k][0] * u[a] + corner[k][1] * v[a]));
        builder_triangles(b, points, 2, CULL_ITEM_TWO_SIDED);
    }
}

static void grid(check_run *r, scene_builder *b)
{
    b->is_exact = 1;
    for (int x = -3; x < 3; ++x)
        for (int y = -2; y < 2; ++y)
            for (int z = -3; z < 3; ++z) {
                const double at[3] = {4.0 * x, 4.0 * y, 4.0 * z}, size[3] = {4, 4, 4};
                if (run_below(r, 3) == 0) builder_box(b, box_at(at, size));
                else if (run_below(r, 6) == 0) builder_walls(b, box_at(at, size), run_below(r, 2) ? FACE_IN : FACE_OUT, 0);
            }
}

static void tiny(check_run *r, scene_builder *b)
{
    const cull_vec3 wall[4] = {{-80, -80, -80}, {80, -80, -80}, {80, 80, -80}, {-80, 80, -80}};
    builder_wall(b, wall, 4, CULL_ITEM_TWO_SIDED);
    for (int i = 0; i < 300; ++i) {
        const double fine = pow(10, run_between(r, -4, -1.5));
        double at[3], size[3];
        for (int k = 0; k < 3; ++k) at[k] = run_between(r, -60, 60), size[k] = fine * run_between(r, 0.5, 1);
        builder_box(b, box_at(at, size));
    }
}

static void flat(check_run *r, scene_builder *b)
{
    for (int i = 0; i < 160; ++i) {
        double at[3], size[3];
        for (int k = 0; k < 3; ++k) at[k] = (double)run_below(r, 30) - 15, size[k] = run_below(r, 2) ? 0 : 1 + (double)run_below(r, 4);
        builder_box(b, box_at(at, size));
        if (i % 20 == 0)
            for (int copy = 0; copy < 3; ++copy) builder_box(b, box_at(at, size));
    }
    for (int i = 0; i < 40; ++i) { // triangles of no area among others
        cull_vec3 p[6];
        for (int k = 0; k < 6; ++k) p[k] = (cull_vec3){(float)run_below(r, 30) - 15, (float)run_below(r, 30) - 15, (float)run_below(r, 30) - 15};
        if (i % 2) p[1] = p[0], p[2] = (cull_vec3){2 * p[0].x, 2 * p[0].y, 2 * p[0].z};
        builder_triangles(b, p, 2, 0);
    }
}

void made_scene_make(check_run *r, scene_kind kind, made_scene *out)
{
    scene_builder *b = builder_open();
    static const double sizes[SCENE_KINDS] = {50, 60, 18, 55, 0, 12, 40, 18, 50, 5, 5};
    *out = (made_scene){.kind = kind, .size = sizes[kind]};
    if (kind == SCENE_FAR)
        for (int k = 0; k < 3; ++k) out->middle[k] = k == 1 ? 0 : (run_below(r, 2) ? 1e6 : -1e6);
    switch (kind) {
    case SCENE_SPREAD:
    case SCENE_FAR: spread(r, b, out->middle); break;
    case SCENE_CITY: city(r, b); break;
    case SCENE_ROOM: room(r, b); break;
    case SCENE_MESH: mesh(r, b); break;
    case SCENE_PANES: panes(r, b); break;
    case SCENE_GRID: grid(r, b); break;
    case SCENE_TINY: tiny(r, b); break;
    case SCENE_FLAT: flat(r, b); break;
    case SCENE_ONE: builder_box(b, (cull_box){{-1, -1, -1}, {1, 1, 1}}); break;
    default: break;
    }
    if (kind == SCENE_CITY || kind == SCENE_ROOM) out->middle[1] = 2;
    builder_end(b, out);
}

// In the sides of the zone's box, which is where portals are.
void made_scene_portals(check_run *r, made_scene *s)
{
    static const char *const name = "memory behind zone.portals";
    cull_portal portals[SCENE_PORTALS_MOST];
    const cull_box box = s->zone.box;
    for (uint32_t i = 0; i < SCENE_PORTALS_MOST; ++i) {
        const int axis = i % 2 ? 0 : 2, high = i / 2 % 2, u = axis == 0 ? 2 : 0;
        const float *low = &box.min.x, *top = &box.max.x, side = high ? top[axis] : low[axis];
        const int is_wide = i < 2; // else a hatch
        const float a = low[u] + (top[u] - low[u]) * (float)run_between(r, 0.1, 0.4), y0 = low[1] + (top[1] - low[1]) * (float)run_between(r, 0.1, 0.3);
        const float c = is_wide ? low[u] + (top[u] - low[u]) * (float)run_between(r, 0.6, 0.9) : a + (float)run_between(r, 0.5, 2);
        const float y1 = is_wide ? low[1] + (top[1] - low[1]) * (float)run_between(r, 0.4, 0.9) : y0 + (float)run_between(r, 0.5, 2);
        const float corners[4][2] = {{a, y0}, {c, y0}, {c, y1}, {a, y1}};
        cull_vec3 points[4];
        cull_plane plane = {{0, 0, 0}, 0};
        (&plane.normal.x)[axis] = high ? -1.0f : 1.0f;
        plane.offset = high ? side : -side;
        const int turns = (axis == 2) != (high != 0); // counterclockwise seen from inside, where the plane's normal points
        for (int k = 0; k < 4; ++k) {
            float *p = &points[turns ? k : 3 - k].x;
            p[axis] = side;
            p[u] = corners[k][0];
            p[1] = corners[k][1];
        }
        fence *f = &s->arrays[s->array_count++];
        *f = fence_open(sizeof points, 8, 0, "memory behind a portal's points");
        if (!f->memory) return;
        memcpy(f->memory, points, sizeof points);
        portals[i] = (cull_portal){f->memory, plane, 4, 0};
    }
    fence *f = &s->arrays[s->array_count++];
    *f = fence_open(sizeof portals, 8, 0, name);
    if (!f->memory) return;
    memcpy(f->memory, portals, sizeof portals);
    s->zone.portals = f->memory;
    s->zone.portal_count = SCENE_PORTALS_MOST;
    s->hash = made_scene_hash(s);
}
