// Sessions with pictures: see show_host.h.
// SPDX-License-Identifier: MIT
#include "show_host.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const void *lend_costs(const cull_host *host, const cull_zone *zone, const char *id)
{
    const show_host *h = host->user;
    return !zone && strcmp(id, CULL_EXT_COSTS) == 0 ? &h->costs : NULL;
}

void show_host_init(show_host *h, double polygon_ns, uint64_t fail_at)
{
    culler_host_init(&h->base, fail_at);
    h->base.host.get_extension = lend_costs;
    h->costs = (cull_costs){.polygon_ns = polygon_ns, .pixel_ns = 3, .picture_ns = 1500, .picture_pixel_ns = 6, .picture_depth_pixel_ns = 10,
                            .capture_ns = 25000, .capture_pixel_ns = 9, .picture_bytes = 256u << 20, .pixel_bytes = 4, .depth_pixel_bytes = 8};
}

// ---- A camera ----

static cull_plane side_of(const double eye[3], const double normal[3])
{
    const double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    cull_plane p = {{(float)(normal[0] / length), (float)(normal[1] / length), (float)(normal[2] / length)}, 0};
    p.offset = (float)(1e-3 - ((double)p.normal.x * eye[0] + (double)p.normal.y * eye[1] + (double)p.normal.z * eye[2])); // moved out by a millimetre
    return p;
}

void show_look(show_eye e, uint32_t frame, cull_view *view, cull_plane *planes)
{
    const double tall = tan(30 * 3.14159265358979323846 / 180), wide = tall * 16 / 9, c = cos(e.pitch), s = sin(e.pitch);
    const double forward[3] = {cos(e.heading) * c, s, sin(e.heading) * c}, right[3] = {-sin(e.heading), 0, cos(e.heading)};
    const double up[3] = {right[1] * forward[2] - right[2] * forward[1], right[2] * forward[0] - right[0] * forward[2],
                          right[0] * forward[1] - right[1] * forward[0]};
    double normals[4][3];
    *view = (cull_view){.pixel_tangent = 2 * tall / 720, .reach = sqrt(1 + tall * tall + wide * wide), .pixels_per_tangent = (float)(360 / tall),
                        .near_distance = 0.0625f, .width_px = 1280, .height_px = 720, .purpose = CULL_VIEW_MAIN, .frame = frame};
    for (int k = 0; k < 3; k++) {
        view->eye_exact[k] = e.at[k];
        view->eye[k] = (float)e.at[k];
        view->forward[k] = forward[k];
        view->clip_from_zone[4 * k] = (float)(right[k] / wide);
        normals[0][k] = forward[k] * wide + right[k];
        normals[1][k] = forward[k] * wide - right[k];
        normals[2][k] = forward[k] * tall + up[k];
        normals[3][k] = forward[k] * tall - up[k];
    }
    view->eye_exact[3] = 1;
    view->eye[3] = 1;
    for (int i = 0; i < 4; i++) planes[i] = side_of(e.at, normals[i]);
}

int show_inside(const cull_plane *planes, uint32_t count, const double p[3], double slack_m)
{
    for (uint32_t i = 0; i < count; i++) {
        const cull_plane q = planes[i];
        if ((double)q.normal.x * p[0] + (double)q.normal.y * p[1] + (double)q.normal.z * p[2] + (double)q.offset < -slack_m) return 0;
    }
    return 1;
}

int show_sees(const cull_plane *planes, const double p[3])
{
    return show_inside(planes, 4, p, -2e-3); // within the planes before they were moved out
}

// ---- Sessions ----

static void *room(size_t count, size_t size)
{
    void *memory = calloc(count + 1, size);
    assert_non_null(memory);
    return memory;
}

cull_result show_open(show_session *s, show_host *h, const cull_zone *zone, const show_values *v)
{
    const char *const list[] = {v->level, v->walk, v->order, v->show, v->tree, v->tolerance, v->hidden, v->budget, v->memory_mib, "coarser"};
    const cull_plugin *plugin = plugin_named("imagecache");
    memset(s, 0, sizeof *s);
    assert_non_null(plugin);
    assert_int_equal(plugin->descriptor->option_count, sizeof list / sizeof *list);
    const cull_result result = session_open(&s->base, &h->base, plugin, zone, list);
    if (result != CULL_OK) return result;
    const cull_built *b = &s->base.built;
    s->zone = zone;
    s->slots = room(b->slot_count, 1);
    s->held = room(b->slot_count, sizeof *s->held);
    s->pictures = room(b->max_pictures, sizeof *s->pictures);
    s->captures = room(b->max_captures, sizeof *s->captures);
    s->clipped = room(b->max_clipped, sizeof *s->clipped);
    s->tests = room(b->max_tests, sizeof *s->tests);
    s->answers = room(b->max_tests, sizeof *s->answers);
    return CULL_OK;
}

void show_close(show_session *s)
{
    void *const all[] = {s->slots, s->held, s->pictures, s->captures, s->clipped, s->tests, s->answers};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) free(all[i]);
    session_close(&s->base);
    memset(s, 0, sizeof *s);
}

static void must_fit(const show_session *s)
{
    const cull_built *b = &s->base.built;
    const cull_batch *n = &s->batch;
    assert_true(n->run_count <= b->max_runs && n->picture_count <= b->max_pictures && n->capture_count <= b->max_captures);
    assert_true(n->clipped_count <= b->max_clipped && n->test_count <= b->max_tests);
}

static void carry_out(show_session *s)
{
    for (uint32_t i = 0; i < s->batch.capture_count; i++) {
        const cull_capture *c = &s->batch.captures[i];
        assert_true(c->slot < s->base.built.slot_count && c->width_px > 0 && c->height_px > 0 && c->clip_plane_count <= 4);
        s->held[c->slot] = *c;
        s->slots[c->slot] = 1;
    }
    for (uint32_t i = 0; i < s->batch.picture_count; i++) assert_int_equal(s->slots[s->batch.pictures[i].slot], 1);
}

void show_frame(show_session *s, const cull_view *view, const cull_volume *volume, show_answers answers)
{
    cull_visit visit = {.view = view, .volumes = volume, .volume_count = 1, .slots = s->slots, .scratch = s->base.scratch, .may_step = 1};
    cull_progress progress = CULL_WAIT;
    s->batch = (cull_batch){.runs = s->base.runs, .pictures = s->pictures, .tests = s->tests, .captures = s->captures, .clipped = s->clipped};
    for (s->steps = 0; progress == CULL_WAIT; s->steps++) {
        assert_true(s->steps < s->base.built.max_steps);
        visit.step = s->steps;
        visit.answers = s->answers;
        visit.answer_count = answers == ANSWERS_NONE ? 0 : s->batch.test_count;
        for (uint32_t i = 0; i < visit.answer_count; i++)
            s->answers[i] = (cull_answer){s->tests[i].tag, answers == ANSWERS_SEEN, answers == ANSWERS_OLD};
        s->batch.test_count = s->batch.capture_count = 0;
        progress = s->base.plugin->select(s->base.query, &visit, &s->batch);
        must_fit(s);
        carry_out(s);
    }
    assert_int_equal(progress, CULL_DONE);
    s->base.run_count = s->batch.run_count;
}

cull_box show_item_box(const show_session *s, uint32_t place)
{
    return cull_box_at(&s->zone->boxes, s->base.built.order[place]);
}

int show_runs_hold(const cull_run *runs, uint32_t count, uint32_t place)
{
    for (uint32_t r = 0; r < count; r++)
        if (place - runs[r].first < runs[r].count) return 1;
    return 0;
}

// ---- Where pictures come to stand ----

static void doubles(cull_vec3 v, double out[3])
{
    out[0] = (double)v.x;
    out[1] = (double)v.y;
    out[2] = (double)v.z;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++) out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

// Fractions of right and up where the ray from the capture's eye through the point meets its parallelogram.
static void place_taken(const cull_capture *c, const double p[3], double *u, double *v)
{
    double eye[3], corner[3], right[3], up[3], ray[3], rows[3][3];
    doubles(c->eye, eye);
    doubles(c->corner, corner);
    doubles(c->right, right);
    doubles(c->up, up);
    for (int k = 0; k < 3; k++) ray[k] = p[k] - eye[k], corner[k] -= eye[k];
    cross(up, corner, rows[0]);
    cross(corner, right, rows[1]);
    cross(right, up, rows[2]);
    *u = dot(rows[0], ray) / dot(rows[2], ray);
    *v = dot(rows[1], ray) / dot(rows[2], ray);
}

double show_off_px(const cull_view *view, const cull_plane *planes, const cull_capture *taken, const cull_picture *shown, const double p[3])
{
    double u, v, corner[3], right[3], up[3], q[3], from_p[3], from_q[3], off = 0;
    place_taken(taken, p, &u, &v);
    doubles(shown->place_is_said ? shown->corner : taken->corner, corner);
    doubles(shown->place_is_said ? shown->right : taken->right, right);
    doubles(shown->place_is_said ? shown->up : taken->up, up);
    for (int k = 0; k < 3; k++) {
        q[k] = corner[k] + u * right[k] + v * up[k];
        from_p[k] = p[k] - view->eye_exact[k];
        from_q[k] = q[k] - view->eye_exact[k];
    }
    if (!show_sees(planes, p) && !show_sees(planes, q)) return -1;
    for (int k = 0; k < 3; k++) {
        const double d = from_p[k] / dot(view->forward, from_p) - from_q[k] / dot(view->forward, from_q);
        off += d * d;
    }
    return sqrt(off) * (double)view->pixels_per_tangent;
}
