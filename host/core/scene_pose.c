// Where movers are: keys of a path, a door's offset, and the box of a mover in a pose.
// SPDX-License-Identifier: MIT
// Invariant: a pose that is not turned has the identity, bit for bit; a pose's box holds every vertex of the mover.
#include "hull.h"

#include <float.h>
#include <math.h>
#include <string.h>

static const double RADIANS_PER_DEGREE = 0.017453292519943295;
// Of the largest number that takes part: three products, five sums and the rounding of a vertex to world, each 2^-53.
static const double BOX_ERROR = 16 * DBL_EPSILON;

static const double IDENTITY[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

double scene_hull_height(const scene *s, uint32_t hull, const double p[3])
{
    const scene_hull *h = &s->hulls[hull];
    return hull_height(s->hull_planes + h->first_plane, h->plane_count, p);
}

// ---- Poses ----

typedef struct circle_point { double cosine, sine; } circle_point;

static circle_point circle_at(double degrees)
{
    const double turned = fmod(degrees, 360);
    if (fmod(turned, 90) == 0) { // quarters exactly
        static const circle_point quarters[4] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
        return quarters[((int)(turned / 90) + 4) % 4];
    }
    return (circle_point){cos(turned * RADIANS_PER_DEGREE), sin(turned * RADIANS_PER_DEGREE)};
}

static void multiply(const double a[9], const double b[9], double out[9])
{
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) out[3 * i + j] = (a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j]) + a[3 * i + 2] * b[6 + j];
}

// About x, then y, then z of the mover's axes.
static void turn_of(const double turn_deg[3], const double axes[9], double out[9])
{
    memcpy(out, IDENTITY, sizeof IDENTITY);
    if (turn_deg[0] == 0 && turn_deg[1] == 0 && turn_deg[2] == 0) return;
    const circle_point x = circle_at(turn_deg[0]), y = circle_at(turn_deg[1]), z = circle_at(turn_deg[2]);
    const double about_x[9] = {1, 0, 0, 0, x.cosine, -x.sine, 0, x.sine, x.cosine};
    const double about_y[9] = {y.cosine, 0, y.sine, 0, 1, 0, -y.sine, 0, y.cosine};
    const double about_z[9] = {z.cosine, -z.sine, 0, z.sine, z.cosine, 0, 0, 0, 1};
    double turned[9], whole[9];
    multiply(about_y, about_x, turned);
    multiply(about_z, turned, whole);
    if (memcmp(axes, IDENTITY, sizeof IDENTITY) == 0) {
        memcpy(out, whole, sizeof whole);
        return;
    }
    const double back[9] = {axes[0], axes[3], axes[6], axes[1], axes[4], axes[7], axes[2], axes[5], axes[8]};
    multiply(axes, whole, turned);
    multiply(turned, back, out);
}

static double time_on_path(const scene_mover *m, const scene_key *keys, double time_s)
{
    const double first = keys[0].time_s, length = keys[m->key_count - 1].time_s - first;
    if (!m->loops || !(length > 0)) return time_s;
    const double into = fmod(time_s - first, length);
    return first + (into < 0 ? into + length : into);
}

static void key_at(const scene_mover *m, const scene_key *keys, double time_s, scene_key *out)
{
    const double t = time_on_path(m, keys, time_s);
    uint32_t low = 0, high = m->key_count; // keys[low] is the last at or before t
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (keys[middle].time_s <= t) low = middle;
        else high = middle;
    }
    *out = keys[low];
    if (!(t > keys[low].time_s) || low + 1 == m->key_count) return;
    const double part = (t - keys[low].time_s) / (keys[low + 1].time_s - keys[low].time_s);
    for (int k = 0; k < 3; ++k) {
        out->offset[k] += part * (keys[low + 1].offset[k] - keys[low].offset[k]);
        out->turn_deg[k] += part * (keys[low + 1].turn_deg[k] - keys[low].turn_deg[k]);
    }
}

void scene_movers_drop(scene *s)
{
    s->mover_count = 0;
    for (uint32_t i = 0; i < s->door_count; ++i) s->doors[i].mover = SCENE_NONE;
}

void scene_pose_at(const scene *s, uint32_t mover, double time_s, door_state door, scene_pose *out)
{
    const scene_mover *m = &s->movers[mover];
    scene_key key = {0};
    if (m->key_count) key_at(m, s->keys + m->first_key, time_s, &key);
    turn_of(key.turn_deg, m->axes, out->rotation);
    memcpy(out->pivot, m->pivot, sizeof out->pivot);
    memcpy(out->offset, key.offset, sizeof out->offset);
    if (m->door == SCENE_NONE || s->doors[m->door].at_rest == door) return;
    for (int k = 0; k < 3; ++k) out->offset[k] += door == DOORS_OPEN ? m->open_offset[k] : -m->open_offset[k];
}

// ---- Boxes ----

// a + b + c, and where it is rounded the next number below it (direction -1) or above it.
static double sum_outward(double a, double b, double c, int direction)
{
    const double ab = a + b, part = ab - a, lost = (a - (ab - part)) + (b - part); // exact, Knuth
    const double sum = ab + c, part2 = sum - ab, lost2 = (ab - (sum - part2)) + (c - part2);
    if (lost == 0 && lost2 == 0) return sum;
    const double away = direction < 0 ? -INFINITY : INFINITY;
    return nextafter(nextafter(sum + lost, away), away);
}

static void box_moved(const scene *s, const cull_boxes *b, uint32_t item, const scene_pose *pose, double min[3], double max[3])
{
    const float *const low[3] = {b->min_x, b->min_y, b->min_z}, *const high[3] = {b->max_x, b->max_y, b->max_z};
    for (int k = 0; k < 3; ++k) {
        min[k] = sum_outward(s->whole.origin[k], (double)low[k][item], pose->offset[k], -1);
        max[k] = sum_outward(s->whole.origin[k], (double)high[k][item], pose->offset[k], 1);
    }
}

static void box_turned(const scene *s, const scene_item *item, const scene_pose *pose, double min[3], double max[3])
{
    double arm[3], most[3] = {0, 0, 0};
    for (int k = 0; k < 3; ++k) {
        min[k] = INFINITY;
        max[k] = -INFINITY;
        arm[k] = s->whole.origin[k] - pose->pivot[k];
    }
    for (uint32_t i = item->first_index; i < item->first_index + item->index_count; ++i) {
        const cull_vec3 p = s->positions[s->indices[i]];
        const double v[3] = {(double)p.x + arm[0], (double)p.y + arm[1], (double)p.z + arm[2]};
        for (int k = 0; k < 3; ++k) {
            const double *row = pose->rotation + 3 * k;
            const double at = (row[0] * v[0] + row[1] * v[1]) + row[2] * v[2];
            min[k] = at < min[k] ? at : min[k];
            max[k] = at > max[k] ? at : max[k];
            most[k] = fmax(most[k], fabs(v[k]));
        }
    }
    const double size = most[0] + most[1] + most[2];
    for (int k = 0; k < 3; ++k) {
        const double all = size + fabs(pose->pivot[k]) + fabs(pose->offset[k]) + fabs(s->whole.origin[k]);
        min[k] = min[k] + pose->pivot[k] + pose->offset[k] - all * BOX_ERROR;
        max[k] = max[k] + pose->pivot[k] + pose->offset[k] + all * BOX_ERROR;
    }
}

void scene_pose_box(const scene *s, uint32_t mover, const scene_pose *pose, double min[3], double max[3])
{
    const uint32_t item = s->item_count + mover;
    int is_turned = 0;
    for (int i = 0; i < 9; ++i) is_turned |= pose->rotation[i] != IDENTITY[i];
    if (is_turned) box_turned(s, &s->items[item], pose, min, max);
    else box_moved(s, &s->boxes, item, pose, min, max);
}
