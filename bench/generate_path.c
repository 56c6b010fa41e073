// Camera paths of generated scenes: see generate_path.h.
// SPDX-License-Identifier: MIT
#include "generate_path.h"

#include <math.h>

enum { DIRECTION_DECIMALS = 6, DIRECTION_UNIT = 1000000, TOUR_KEY = 0x746f7572, WANDER_KEY = 0x77616c6b, TRIES = 64 };

static const double AHEAD_M = 2.5;  // what a walker looks at
static const double ROUND_M = 0.35; // how far a corner is cut

path_line path_open(const allocator *memory)
{
    return (path_line){.points = buffer_make(memory, sizeof(place))};
}

void path_free(path_line *l)
{
    buffer_free(&l->points);
}

void path_to(path_line *l, place p)
{
    if (l->failed || !buffer_append(&l->points, &p, 1)) l->failed = 1;
}

static double distance_m(place a, place b)
{
    const double x = (double)b.x - a.x, y = (double)b.y - a.y, z = (double)b.z - a.z;
    return sqrt(x * x + y * y + z * z) / METRE;
}

double path_length(const path_line *l)
{
    const place *points = l->points.items;
    double sum = 0;
    for (size_t i = 1; i < l->points.count; ++i) sum += distance_m(points[i - 1], points[i]);
    return sum;
}

// Walks on along the line: `at` only grows between calls with the same cursor.
typedef struct cursor { size_t leg; double passed; } cursor;

static spot line_at(const path_line *l, cursor *c, double at)
{
    const place *points = l->points.items;
    const size_t legs = l->points.count - 1;
    for (;;) {
        const place a = points[c->leg], b = points[c->leg + 1];
        const double length = distance_m(a, b);
        if (at <= c->passed + length || c->leg + 1 >= legs) {
            double t = length > 0 ? (at - c->passed) / length : 0;
            t = t < 0 ? 0 : t > 1 ? 1 : t;
            return (spot){a.x + t * ((double)b.x - a.x), a.y + t * ((double)b.y - a.y), a.z + t * ((double)b.z - a.z)};
        }
        c->passed += length;
        c->leg++;
    }
}

static void direction_write(text_file *out, spot d)
{
    const double length = sqrt(d.x * d.x + d.y * d.y + d.z * d.z), by = DIRECTION_UNIT / length;
    const double part[3] = {d.x * by, d.y * by, d.z * by};
    for (int k = 0; k < 3; ++k) {
        text_add(out, k ? ", " : "[");
        text_decimal(out, (int64_t)floor(part[k] + 0.5), DIRECTION_DECIMALS);
    }
    text_add(out, "]");
}

static void view_write(json_writer *j, place eye, spot direction)
{
    json_item(j);
    text_add(j->out, "{\"eye\": ");
    json_place(j->out, eye);
    text_add(j->out, ", \"forward\": ");
    direction_write(j->out, direction);
    text_add(j->out, "}");
}

static spot turned(spot d, double turns) // about y
{
    const double c = turn_cosine(turns), s = turn_sine(turns);
    return (spot){d.x * c - d.z * s, d.y, d.x * s + d.z * c};
}

void path_write_walk(json_writer *j, const path_line *l, uint32_t views)
{
    if (l->failed) j->out->failed = 1;
    if (j->out->failed || l->points.count < 2) return;
    const double span = path_length(l), sway = 0.06;
    cursor behind = {0}, here = {0}, before = {0}, ahead = {0};
    spot last = {0, 0, 1};
    for (uint32_t i = 0; i < views; ++i) {
        const double at = views > 1 ? span * i / (views - 1) : 0;
        const double round = fmin(ROUND_M, fmin(at, span - at));
        const spot a = line_at(l, &behind, at - round), b = line_at(l, &here, at), c = line_at(l, &before, at + round);
        const spot to = line_at(l, &ahead, fmin(at + AHEAD_M, span));
        const spot eye = {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3, (a.z + b.z + c.z) / 3};
        const spot forward = {to.x - eye.x, to.y - eye.y, to.z - eye.z};
        if (forward.x * forward.x + forward.z * forward.z > (double)METRE * METRE / 4) last = forward;
        view_write(j, (place){(int32_t)floor(eye.x + 0.5), (int32_t)floor(eye.y + 0.5), (int32_t)floor(eye.z + 0.5)},
                   turned(last, sway * turn_sine(i / 97.0)));
    }
}

// ---- Wandering through a plan ----

static uint32_t way_on(const plan *p, uint32_t room, uint32_t from, random_stream *r)
{
    uint32_t count, choices = 0, chosen = from;
    const uint32_t *ways = plan_ways(p, room, &count);
    for (uint32_t i = 0; i < count; ++i) {
        const plan_hole *h = plan_hole_at(p, ways[i] / 2);
        if (ways[i] == from || plan_behind(p, ways[i]) == PLAN_OUTSIDE || h->door == PLAN_DOOR_SHUT) continue;
        if (random_below(r, ++choices) == 0) chosen = ways[i];
    }
    return chosen;
}

void path_wander(path_line *l, const wander_request *q)
{
    random_stream r = random_make(q->seed, WANDER_KEY);
    uint32_t room = q->room, from = PLAN_OUTSIDE;
    double length = 0;
    while (!l->failed) {
        const uint32_t to = way_on(q->plan, room, from, &r);
        const size_t first = l->points.count;
        if (to == PLAN_OUTSIDE || length >= q->length_m) break;
        q->route(l, q->plan, room, from, to);
        if (l->failed) return;
        const place *points = l->points.items;
        for (size_t i = first ? first : 1; i < l->points.count; ++i) length += distance_m(points[i - 1], points[i]);
        from = to ^ 1u;
        room = plan_behind(q->plan, to);
    }
    q->route(l, q->plan, room, from, PLAN_OUTSIDE);
}

// ---- Tour ----

void path_write_eye(json_writer *j, place eye, random_stream *r)
{
    const double turns = random_unit(r), up = random_unit(r) - 0.5; // most look about level, some steeply
    view_write(j, eye, (spot){turn_cosine(turns), 4 * up * up * up, turn_sine(turns)});
}

static int32_t between(random_stream *r, int32_t from, int32_t to, int32_t margin)
{
    return to - from <= 2 * margin ? (from + to) / 2 : random_between(r, from + margin, to - margin);
}

static int in_an_obstacle(const plan *p, place e)
{
    const block *b = p->obstacles.items;
    const int32_t margin = METRE / 10;
    for (size_t i = 0; i < p->obstacles.count; ++i)
        if (e.x > b[i].min.x - margin && e.x < b[i].max.x + margin && e.y > b[i].min.y - margin && e.y < b[i].max.y + margin &&
            e.z > b[i].min.z - margin && e.z < b[i].max.z + margin)
            return 1;
    return 0;
}

static place eye_in_room(const tour_request *q, random_stream *r)
{
    const int32_t margin = METRE / 4;
    place eye = {0, 0, 0};
    for (int i = 0; i < TRIES; ++i) {
        const block *air = &plan_room_at(q->plan, random_below(r, plan_room_count(q->plan)))->air;
        eye.x = between(r, air->min.x, air->max.x, margin); // one draw a statement: compilers differ in the order within one
        eye.y = air->min.y + random_between(r, q->low, q->high);
        eye.z = between(r, air->min.z, air->max.z, margin);
        if (!in_an_obstacle(q->plan, eye)) break;
    }
    return eye;
}

static place eye_in_hole(const tour_request *q, random_stream *r, int on_the_plane)
{
    const int32_t margin = 2 * METRE / 10;
    place eye = {0, 0, 0};
    for (int i = 0; i < TRIES; ++i) {
        plan_hole h = *plan_hole_at(q->plan, random_below(r, plan_hole_count(q->plan)));
        const int32_t off = random_between(r, -METRE / 5, METRE / 5);
        if (!on_the_plane) h.plane += off;
        const int32_t u = between(r, h.opening.u0, h.opening.u1, margin), v = between(r, h.opening.v0, h.opening.v1, margin);
        eye = plan_hole_place(&h, u, v);
        if (h.door != PLAN_DOOR_SHUT && !in_an_obstacle(q->plan, eye)) break;
    }
    return eye;
}

void path_write_tour(json_writer *j, const tour_request *q)
{
    random_stream r = random_make(q->seed, TOUR_KEY);
    for (int i = 0; i < PATH_VIEWS && !j->out->failed; ++i) {
        const int in_hole = i % 10 == 7 && plan_hole_count(q->plan);
        const place eye = in_hole ? eye_in_hole(q, &r, i % 20 == 7) : eye_in_room(q, &r);
        path_write_eye(j, eye, &r);
    }
}
