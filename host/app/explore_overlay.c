// What the viewer draws over its picture: frozen volumes as the bodies they are, portals by their state, and counters.
// SPDX-License-Identifier: MIT
#include "explore.h"

#include <portcullis/clip.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LOOP_MOST = 2 * CULL_MAX_PLANES + 16, VOLUMES_DRAWN_MOST = 256 };
static const double VOLUME_REACH_MOST_M = 200; // how far a volume is drawn

static const uint32_t PORTAL_OPEN = 0xff40e040, PORTAL_SHUT = 0xff3030ff, PORTAL_USED = 0xff00ffff, WHITE = 0xffffffff, LOUD = 0xff2020ff,
                      DARK = 0xe0000000;

static uint32_t colour_of(uint32_t number)
{
    static const uint32_t colours[] = {0x00ffc040, 0x0040c0ff, 0x00c060ff, 0x0060ff80, 0x00ff8080, 0x0080ffff, 0x00ff80ff, 0x00c0c0c0};
    return colours[number % (sizeof colours / sizeof *colours)];
}

static void add_vertex(buffer *to, const double eye[3], cull_point p, uint32_t colour)
{
    const overlay_vertex v = {{eye[0] + p.x, eye[1] + p.y, eye[2] + p.z}, colour};
    buffer_append(to, &v, 1); // without memory there is less to see
}

static void add_loop(explore *e, const double eye[3], const cull_point *loop, uint32_t count, uint32_t colour)
{
    for (uint32_t i = 0; i < count; ++i) {
        add_vertex(&e->lines, eye, loop[i], colour | 0xff000000);
        add_vertex(&e->lines, eye, loop[(i + 1) % count], colour | 0xff000000);
        if (i < 1 || i + 1 >= count) continue;
        add_vertex(&e->faces, eye, loop[0], colour | 0x28000000);
        add_vertex(&e->faces, eye, loop[i], colour | 0x28000000);
        add_vertex(&e->faces, eye, loop[i + 1], colour | 0x28000000);
    }
}

// A square on the plane, `reach` wide, about the point of it that is nearest to the eye.
static void square_on(const cull_cut *cut, double reach, cull_point out[4])
{
    const double n[3] = {cut->x, cut->y, cut->z}, most = fmax(fabs(n[0]), fmax(fabs(n[1]), fabs(n[2])));
    const double helper[3] = {fabs(n[0]) < most, fabs(n[0]) >= most, 0};
    double u[3] = {n[1] * helper[2] - n[2] * helper[1], n[2] * helper[0] - n[0] * helper[2], n[0] * helper[1] - n[1] * helper[0]};
    const double length = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    for (int k = 0; k < 3; ++k) u[k] *= reach / length;
    const double v[3] = {n[1] * u[2] - n[2] * u[1], n[2] * u[0] - n[0] * u[2], n[0] * u[1] - n[1] * u[0]};
    static const double corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (int i = 0; i < 4; ++i)
        out[i] = (cull_point){-cut->offset * n[0] + corner[i][0] * u[0] + corner[i][1] * v[0],
                              -cut->offset * n[1] + corner[i][0] * u[1] + corner[i][1] * v[1],
                              -cut->offset * n[2] + corner[i][0] * u[2] + corner[i][1] * v[2]};
}

// The faces of a volume: each plane's square cut by all other planes. Everything is relative to the eye.
static void add_volume(explore *e, const flow_volume *v, double reach)
{
    cull_cut cuts[CULL_MAX_PLANES + 6];
    cull_point loops[2][LOOP_MOST];
    const double *origin = e->a->scene->zones[v->zone].origin, *eye = e->frozen.eye;
    uint32_t count = v->volume.plane_count;
    for (uint32_t i = 0; i < count; ++i) {
        const cull_plane p = v->volume.planes[i];
        const double n[3] = {(double)p.normal.x, (double)p.normal.y, (double)p.normal.z};
        cuts[i] =
            (cull_cut){n[0], n[1], n[2], (double)p.offset + n[0] * (eye[0] - origin[0]) + n[1] * (eye[1] - origin[1]) + n[2] * (eye[2] - origin[2])};
    }
    for (int k = 0; k < 6; ++k)
        cuts[count++] = (cull_cut){k == 0 ? 1 : k == 1 ? -1 : 0, k == 2 ? 1 : k == 3 ? -1 : 0, k == 4 ? 1 : k == 5 ? -1 : 0, reach};
    for (uint32_t i = 0; i + 6 < count; ++i) {
        uint32_t size = 4, now = 0;
        square_on(&cuts[i], 2 * reach, loops[0]);
        for (uint32_t k = 0; k < count && size >= 3; ++k) {
            if (k == i) continue;
            size = cull_polygon_clip(loops[now], size, cuts[k], loops[!now], LOOP_MOST);
            now = !now;
        }
        if (size >= 3) add_loop(e, eye, loops[now], size, colour_of(v->zone));
    }
}

static void add_portals(explore *e)
{
    const scene *s = e->a->scene;
    const flow_result *flow = world_view_flow(e->v);
    for (uint32_t p = 0; p < s->portal_count; ++p) {
        const scene_portal *portal = &s->portals[p];
        uint32_t colour = portal->door != SCENE_NONE && world_door(e->w, portal->door) == DOORS_SHUT ? PORTAL_SHUT : PORTAL_OPEN;
        for (uint32_t i = 0; i < flow->volume_count; ++i)
            if (flow->volumes[i].way != SCENE_NONE && flow->volumes[i].way / 2 == p) colour = PORTAL_USED;
        for (uint32_t i = 0; i < portal->point_count; ++i) {
            overlay_vertex ends[2] = {{.colour = colour}, {.colour = colour}};
            memcpy(ends[0].position, s->portal_points[portal->first_point + i], sizeof ends[0].position);
            memcpy(ends[1].position, s->portal_points[portal->first_point + (i + 1) % portal->point_count], sizeof ends[1].position);
            buffer_append(&e->lines, ends, 2);
        }
    }
}

static int culls_nothing(const explore *e)
{
    const chain *c = e->zone == SCENE_NONE ? NULL : world_chain(e->w, e->zone);
    return c && strcmp(c->stages[0].plugin->descriptor->id, "none") == 0;
}

static void name_chain(const explore *e, char *out, size_t size)
{
    const chain *c = e->zone == SCENE_NONE ? NULL : world_chain(e->w, e->zone);
    size_t length = 0;
    snprintf(out, size, "%s", "-");
    for (uint32_t i = 0; c && i < c->stage_count && length < size; ++i)
        length += (size_t)snprintf(out + length, size - length, "%s%s", i ? "+" : "", c->stages[i].plugin->descriptor->id);
}

// With a shadow, to be read over any picture.
static void write_text(explore *e, const overlay_text *t)
{
    overlay_text dark = *t;
    dark.colour = DARK;
    dark.x_px = t->x_px + t->scale;
    dark.y_px = t->y_px + t->scale;
    renderer_overlay_text(e->g, &dark);
    renderer_overlay_text(e->g, t);
}

static void write_counters(explore *e)
{
    static const char *const modes[] = {"shaded", "items", "zones", "depth", "overdraw"};
    const scene *s = e->a->scene;
    const frame_stats *t = &e->stats;
    char text[EXPLORE_TEXT_BYTES], chain_name[128];
    name_chain(e, chain_name, sizeof chain_name);
    snprintf(text, sizeof text,
             "zone %s   chain %s   mode %s%s\n"
             "zones %u/%u  volumes %u  portals tried %u  merges %u\n"
             "items %llu/%u  polygons %llu/%u  movers %u/%u  draw calls %u\n"
             "cull %.1f us  frame %.1f ms  tests %u  stalls %u  limits %u  faults %u",
             e->zone == SCENE_NONE ? "(outside all)" : s->zones[e->zone].name, chain_name, modes[e->mode],
             e->scissor == SCISSOR_ZONES ? "  scissor" : "", t->zones, s->zone_count, t->volumes, t->crossings, t->portal_merges,
             (unsigned long long)t->items_drawn, s->item_count, (unsigned long long)e->counters.polygons, s->polygon_count, t->movers_drawn,
             movers_counts(world_movers(e->w)).live, e->counters.draw_calls, e->counters.cull_us, e->counters.frame_ms, t->queries, t->stalls,
             t->limits_hit, t->faults);
    write_text(e, &(overlay_text){text, 8, 8, 1, WHITE});
    if (e->freeze != FREEZE_NOT) write_text(e, &(overlay_text){"CULLING FROZEN", 8, 80, 2, LOUD});
    else if (culls_nothing(e)) write_text(e, &(overlay_text){"NO CULLING IN THIS ZONE", 8, 80, 2, LOUD});
    if (*e->message) write_text(e, &(overlay_text){e->message, 8, e->height_px > 24 ? e->height_px - 24 : 0, 1, WHITE});
    if (!e->shows_help) return;
    static const char help[] = "W A S D  fly    E Q  up, down    arrows, mouse  look    shift  faster    + -  speed\n"
                               "C  next culler of this zone    O  door in front    F  freeze culling    B  portals\n"
                               "V  mode    X  scissor    T  time    P  picture    H  help    Esc  leave";
    write_text(e, &(overlay_text){help, 8, 120, 1, WHITE});
}

void explore_overlay(explore *e)
{
    e->lines.count = e->faces.count = 0;
    if (e->shows_portals || e->freeze != FREEZE_NOT) add_portals(e);
    if (e->freeze != FREEZE_NOT) {
        const flow_result *flow = world_view_flow(e->v);
        const double reach = fmin(2 * scene_radius_m(e->a->scene), VOLUME_REACH_MOST_M);
        for (uint32_t i = 0; i < flow->volume_count && i < VOLUMES_DRAWN_MOST; ++i) add_volume(e, &flow->volumes[i], reach);
    }
    renderer_overlay_triangles(e->g, e->faces.items, (uint32_t)e->faces.count, OVERLAY_TESTED);
    renderer_overlay_lines(e->g, e->lines.items, (uint32_t)e->lines.count, e->freeze != FREEZE_NOT ? OVERLAY_ON_TOP : OVERLAY_TESTED);
    write_counters(e);
}
