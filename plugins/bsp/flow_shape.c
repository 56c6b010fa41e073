// Polygons seen from the eye: into view space, their edges as lines of the picture, and what of a window passes them.
// SPDX-License-Identifier: MIT
//
// Invariant: see flow.c for the guard. A line is never moved but here.
#include "flow.h"
#include "pairs.h"

flow_ball flow_ball_of(const flow *f, const flow_word *face)
{
    const double px = (double)face[FACE_BALL].f, py = (double)face[FACE_BALL + 1].f, pz = (double)face[FACE_BALL + 2].f;
    const double *r = f->axes[0], *u = f->axes[1], *w = f->axes[2];
    flow_ball b = {((r[0] * px + r[1] * py) + r[2] * pz) + r[3], ((u[0] * px + u[1] * py) + u[2] * pz) + u[3], ((w[0] * px + w[1] * py) + w[2] * pz) + w[3],
                   (double)face[FACE_BALL + 3].f, 0};
    b.size = ((fabs(b.x) + fabs(b.y)) + fabs(b.z)) + b.radius;
    return b;
}

double flow_ball_distance(const flow_ball *b)
{
    return sqrt((b->x * b->x + b->y * b->y) + b->z * b->z) - b->radius;
}

// Along an axis, of two points.
static pair places_along(const double axis[4], pair x, pair y, pair z)
{
    const pair sum = pair_add(pair_mul(pair_of(axis[0]), x), pair_mul(pair_of(axis[1]), y));
    return pair_add(pair_add(sum, pair_mul(pair_of(axis[2]), z)), pair_of(axis[3]));
}

void flow_shape_of(const flow *f, const flow_word *face, const flow_ball *ball, flow_shape *out)
{
    const uint32_t count = face[FACE_BITS].u & FACE_COUNT;
    const flow_word *px = face + FACE_HEAD, *py = px + count, *pz = py + count;
    for (uint32_t i = 0; i < count; i += PAIR) { // the last may read the word behind it: the index has one more than it needs
        const pair x = pair_load_floats(&px[i].f), y = pair_load_floats(&py[i].f), z = pair_load_floats(&pz[i].f);
        pair_store(out->x + i, places_along(f->axes[0], x, y, z));
        pair_store(out->y + i, places_along(f->axes[1], x, y, z));
        pair_store(out->z + i, places_along(f->axes[2], x, y, z));
    }
    out->x[count] = out->x[0];
    out->y[count] = out->y[0];
    out->z[count] = out->z[0];
    out->count = count;
    out->is_bent = (face[FACE_BITS].u & FACE_BENT) != 0;
    out->distance = flow_ball_distance(ball);
    out->size = ball->size;
}

void flow_shape_make(const flow *f, const cull_vec3 *points, uint32_t count, flow_winding winding, flow_shape *out)
{
    double size = 0;
    for (uint32_t i = 0; i <= count; i++) {
        const uint32_t k = i < count ? i : 0;
        const cull_vec3 p = points[winding == FLOW_REVERSED ? count - 1 - k : k];
        double at[3];
        for (int a = 0; a < 3; a++) {
            const double *axis = f->axes[a];
            at[a] = ((axis[0] * (double)p.x + axis[1] * (double)p.y) + axis[2] * (double)p.z) + axis[3];
            size = fabs(at[a]) > size ? fabs(at[a]) : size;
        }
        out->x[i] = at[0];
        out->y[i] = at[1];
        out->z[i] = at[2];
    }
    out->count = count;
    out->is_bent = 0;
    out->size = size;
    out->distance = flow_shape_distance(out);
}

// Until no corner is outside. A shift moves what lies behind the eye the other way: where that leaves a corner outside, the line goes.
static window_line line_widened(const flow_shape *s, window_line l)
{
    double out_by = 0;
    for (uint32_t k = 0; k < s->count; k++) {
        const double at = (l.a * s->x[k] + l.b * s->y[k]) + l.c * s->z[k];
        if (at < 0 && s->z[k] > 0) out_by = -at / s->z[k] > out_by ? -at / s->z[k] : out_by;
    }
    for (uint32_t k = 0; k < s->count; k++)
        if (!(s->z[k] > 0) && !((l.a * s->x[k] + l.b * s->y[k]) + (l.c + out_by) * s->z[k] >= 0)) return (window_line){0, 0, 1};
    return (window_line){l.a, l.b, l.c + out_by};
}

static void bent_edges(const flow_shape *s, flow_margin margin, window_line *lines)
{
    for (uint32_t i = 0; i < s->count; i++) {
        const double a = s->y[i] * s->z[i + 1] - s->z[i] * s->y[i + 1], b = s->z[i] * s->x[i + 1] - s->x[i] * s->z[i + 1];
        const double c = s->x[i] * s->y[i + 1] - s->y[i] * s->x[i + 1];
        const double flat = (margin.tangents + margin.share) * (fabs(a) + fabs(b)), deep = margin.share * fabs(c);
        lines[i] = line_widened(s, (window_line){a, b, c});
        lines[i].c += (flat + deep) + margin.rounding;
    }
}

void flow_shape_edges(const flow_shape *s, flow_margin margin, window_line *lines)
{
    if (s->is_bent) {
        bent_edges(s, margin, lines);
        return;
    }
    const pair share = pair_of(margin.share), flat = pair_of(margin.tangents + margin.share), rounding = pair_of(margin.rounding);
    for (uint32_t i = 0; i < s->count; i += PAIR) { // of an odd count one more, that nobody reads
        const pair x = pair_load(s->x + i), y = pair_load(s->y + i), z = pair_load(s->z + i);
        const pair next_x = pair_load(s->x + i + 1), next_y = pair_load(s->y + i + 1), next_z = pair_load(s->z + i + 1);
        const pair a = pair_subtract(pair_mul(y, next_z), pair_mul(z, next_y)), b = pair_subtract(pair_mul(z, next_x), pair_mul(x, next_z));
        const pair c = pair_subtract(pair_mul(x, next_y), pair_mul(y, next_x));
        const pair out_by = pair_add(pair_add(pair_mul(flat, pair_add(pair_size(a), pair_size(b))), pair_mul(share, pair_size(c))), rounding);
        const pair moved = pair_add(c, out_by);
        lines[i] = (window_line){pair_first(a), pair_first(b), pair_first(moved)};
        lines[i + 1] = (window_line){pair_second(a), pair_second(b), pair_second(moved)};
    }
}

// ---- How far it is ----

static void point_get(const flow_shape *s, uint32_t i, double out[3])
{
    out[0] = s->x[i], out[1] = s->y[i], out[2] = s->z[i];
}

static void cross_of(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++) out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static double dot_of(const double a[3], const double b[3])
{
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

// From the eye, the origin, to the segment; squared.
static double segment_distance(const double a[3], const double b[3])
{
    const double way[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, square = dot_of(way, way);
    double t = square > 0 ? -dot_of(a, way) / square : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    const double p[3] = {a[0] + t * way[0], a[1] + t * way[1], a[2] + t * way[2]};
    return dot_of(p, p);
}

double flow_shape_distance(const flow_shape *s)
{
    double normal[3] = {0, 0, 0}, first[3], a[3], b[3], turn[3], least = 1e300;
    int inside = 1; // the eye stands over the polygon
    point_get(s, 0, first);
    for (uint32_t i = 2; i < s->count; i++) { // relative to the first corner
        point_get(s, i - 1, a);
        point_get(s, i, b);
        for (int k = 0; k < 3; k++) a[k] -= first[k], b[k] -= first[k];
        cross_of(a, b, turn);
        for (int k = 0; k < 3; k++) normal[k] += turn[k];
    }
    for (uint32_t i = 0; i < s->count; i++) {
        point_get(s, i, a);
        point_get(s, i + 1, b);
        const double square = segment_distance(a, b), way[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, back[3] = {-a[0], -a[1], -a[2]};
        least = square < least ? square : least;
        cross_of(way, back, turn);
        inside &= dot_of(turn, normal) >= 0;
    }
    const double size = sqrt(dot_of(normal, normal)), over = size > 0 ? fabs(dot_of(first, normal)) / size : 0;
    return inside ? over : sqrt(least);
}

// Of the eye to the opening; what may lie nearer than `near` is measured.
static double distance_of(const flow *f, const flow_shape *s, double height)
{
    const double size = fabs(height), distance = s->distance > size ? s->distance : size;
    return distance > f->near ? distance : flow_shape_distance(s);
}

// ---- Outside ----

flow_sides flow_sides_of(window_bounds b)
{
    const flow_sides s = {b, {sqrt(1 + b.u0 * b.u0), sqrt(1 + b.u1 * b.u1), sqrt(1 + b.v0 * b.v0), sqrt(1 + b.v1 * b.v1)}};
    return s;
}

// A side u >= u0 is the plane x - u0 z >= 0 through the eye; moved out by the margin, by no more than margin * size at the ball.
int flow_ball_is_outside(const flow *f, const flow_sides *s, const flow_ball *b, double height, double tangents)
{
    const double square = (b->x * b->x + b->y * b->y) + b->z * b->z, apart = 1 + b->radius; // a metre or more away
    double distance = 1;
    if (square < apart * apart) {
        distance = sqrt(square) - b->radius;
        distance = fabs(height) > distance ? fabs(height) : distance;
        if (!(distance > f->near)) return 0;
    }
    const double margin = tangents + (distance < 1 ? f->slack * f->reach * f->reach / (distance - f->slack) : f->slack_wide), more = margin * b->size;
    const double left = b->x - s->bounds.u0 * b->z, right = s->bounds.u1 * b->z - b->x;
    const double below = b->y - s->bounds.v0 * b->z, above = s->bounds.v1 * b->z - b->y;
    return (left < -(b->radius * s->norms[0] + more)) | (right < -(b->radius * s->norms[1] + more)) | (below < -(b->radius * s->norms[2] + more)) |
           (above < -(b->radius * s->norms[3] + more));
}

// ---- Through an opening ----

// Places are off by 2^-50 of the zone's radius and the polygon's size, a product of two by that times the size; (u, v, 1) has no
// coordinate above the reach, and there are three.
double flow_rounding(const flow *f, double size)
{
    return 0x1p-46 * ((f->radius + size) * size) * f->reach;
}

void flow_gate_make(const flow *f, const flow_shape *s, double height, flow_gate *out)
{
    const double distance = distance_of(f, s, height);
    out->count = 0;
    if (!(distance > f->near)) return;
    const flow_margin margin = {f->guard_tangents, f->guard_share + f->slack * f->reach / (distance - f->slack), flow_rounding(f, s->size)};
    flow_shape_edges(s, margin, out->lines);
    out->count = s->count;
}

// The eye all but lies in the plane: edges seen from there have no side. What passes is the plane's own line on the picture, as wide as
// rounding lets a ray stray from it, as long as the polygon: |n . q| <= (|height| + slack) * reach / distance.
void flow_gate_make_grazing(const flow *f, const flow_shape *s, const double normal[3], double height, flow_gate *out)
{
    const double distance = distance_of(f, s, 0);
    out->count = 0;
    if (!(distance > f->near)) return;
    const double stray = (fabs(height) + f->slack) * f->reach / (distance - f->slack);
    const double wide = f->guard_tangents + (f->guard_share + stray) * f->reach;
    double n[3], least_z = 1e300, least_u = 1e300, most_u = -1e300, least_v = 1e300, most_v = -1e300;
    for (int k = 0; k < 3; k++) n[k] = (normal[0] * f->axes[k][0] + normal[1] * f->axes[k][1]) + normal[2] * f->axes[k][2];
    window_line *lines = out->lines;
    lines[out->count++] = (window_line){n[0], n[1], n[2] + wide};
    lines[out->count++] = (window_line){-n[0], -n[1], -n[2] + wide};
    for (uint32_t i = 0; i < s->count; i++) least_z = s->z[i] < least_z ? s->z[i] : least_z;
    if (!(least_z > f->near)) return;
    for (uint32_t i = 0; i < s->count; i++) {
        const double u = s->x[i] / s->z[i], v = s->y[i] / s->z[i];
        least_u = u < least_u ? u : least_u;
        most_u = u > most_u ? u : most_u;
        least_v = v < least_v ? v : least_v;
        most_v = v > most_v ? v : most_v;
    }
    lines[out->count++] = (window_line){1, 0, wide - least_u};
    lines[out->count++] = (window_line){-1, 0, wide + most_u};
    lines[out->count++] = (window_line){0, 1, wide - least_v};
    lines[out->count++] = (window_line){0, -1, wide + most_v};
}
