// One collapse: see simplify_star.h. Both surfaces are laid over each other along one direction (Cohen, Manocha, Olano 1997, section 4).
// SPDX-License-Identifier: MIT
#include "simplify_star.h"

#include <math.h>

#define LEAST_COSINE 0.2     // between a triangle and the direction: flatter ones could turn over by rounding
#define LEAST_SHAPE 1e-4     // of a new triangle: its height by its longest edge; thinner ones have no direction in floats
#define LOOK_MOST 0.06       // of a unit normal, at the point that goes: some 2% of the light
#define ROUNDING 0x1p-36     // of the star's size: some 100 operations of 2^-53, where edges cross at 2^-10 or less
#define SHORTER_FIRST 1e-6   // metres a metre: of collapses that move nothing the shortest

// ---- The star ----

int star_has(const star *s, uint32_t place)
{
    for (uint32_t i = 0; i < s->count; ++i)
        if (s->triangles[i].points[0].place == place) return 1;
    return 0;
}

static int sort_round(star *s)
{
    for (uint32_t i = 0; i < s->count; ++i) {
        const uint32_t wanted = s->triangles[i].points[1].place;
        uint32_t at = i + 1;
        if (wanted == s->centre.place || wanted == s->triangles[i].points[0].place) return 0;
        if (i + 1 == s->count) return wanted == s->triangles[0].points[0].place;
        while (at < s->count && s->triangles[at].points[0].place != wanted) ++at;
        if (at == s->count) return 0;
        const star_triangle moved = s->triangles[i + 1];
        s->triangles[i + 1] = s->triangles[at];
        s->triangles[at] = moved;
    }
    return 0;
}

static int is_simple(const star *s)
{
    for (uint32_t i = 0; i < s->count; ++i)
        for (uint32_t j = 0; j < i; ++j)
            if (s->triangles[i].points[0].place == s->triangles[j].points[0].place) return 0;
    return 1;
}

int star_open(star *s)
{
    s->border_count = 0;
    if (s->count < 3 || !sort_round(s) || !is_simple(s)) return 0;
    for (uint32_t i = 0; i < s->count; ++i) {
        const star_triangle *t = &s->triangles[i], *before = &s->triangles[(i + s->count - 1) % s->count];
        if (t->group == before->group && t->wedge == before->wedge && t->vertices[0] == before->vertices[1]) continue;
        if (s->border_count == 2) return 0;
        s->borders[s->border_count++] = i;
    }
    return s->border_count != 1;
}

// ---- Geometry ----

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void subtract(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = a[k] - b[k];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

// The star seen along its direction, from where the centre slid to.
typedef struct overlay {
    double rim[STAR_MOST][3]; // from the centre
    double normal[3];
    double flat[STAR_MOST][3]; // across, across, along the direction
    double size;               // of the star
    uint32_t count, target;
} overlay;

static double area_of(const overlay *o, uint32_t a, uint32_t b, double out[3]) // twice, and its normal
{
    cross(o->rim[a], o->rim[b], out);
    return sqrt(dot(out, out));
}

static int set_direction(overlay *o)
{
    double sum[3] = {0}, part[3];
    for (uint32_t i = 0; i < o->count; ++i) {
        area_of(o, i, (i + 1) % o->count, part);
        for (int k = 0; k < 3; ++k) sum[k] += part[k];
    }
    const double length = sqrt(dot(sum, sum));
    if (!(length > 0)) return 0;
    for (int k = 0; k < 3; ++k) o->normal[k] = sum[k] / length;
    for (uint32_t i = 0; i < o->count; ++i) {
        const double area = area_of(o, i, (i + 1) % o->count, part);
        if (!(dot(part, o->normal) > LEAST_COSINE * area)) return 0;
    }
    return 1;
}

static int new_ones_are_sound(const overlay *o)
{
    const double *v = o->rim[o->target];
    for (uint32_t n = 1; n + 1 < o->count; ++n) {
        const uint32_t a = (o->target + n) % o->count, b = (a + 1) % o->count;
        double to_a[3], to_b[3], along[3], normal[3];
        subtract(o->rim[a], v, to_a);
        subtract(o->rim[b], v, to_b);
        subtract(to_b, to_a, along);
        cross(to_a, to_b, normal);
        const double area = sqrt(dot(normal, normal)), longest = fmax(dot(to_a, to_a), fmax(dot(to_b, to_b), dot(along, along)));
        if (!(area > LEAST_SHAPE * longest) || !(dot(normal, o->normal) > LEAST_COSINE * area)) return 0;
    }
    return 1;
}

static void flatten(overlay *o)
{
    const double *n = o->normal;
    const int least = fabs(n[0]) <= fabs(n[1]) ? (fabs(n[0]) <= fabs(n[2]) ? 0 : 2) : (fabs(n[1]) <= fabs(n[2]) ? 1 : 2);
    double axis[3] = {0}, x[3], y[3];
    axis[least] = 1;
    cross(n, axis, x);
    const double length = sqrt(dot(x, x));
    for (int k = 0; k < 3; ++k) x[k] /= length;
    cross(n, x, y);
    for (uint32_t i = 0; i < o->count; ++i) {
        o->flat[i][0] = dot(o->rim[i], x);
        o->flat[i][1] = dot(o->rim[i], y);
        o->flat[i][2] = dot(o->rim[i], n);
    }
}

static double turn(const double a[2], const double b[2])
{
    return a[0] * b[1] - a[1] * b[0];
}

typedef struct under { uint32_t triangle; double shares[3]; } under; // of the new triangle: its first edge's place on the rim; of target, first, second

// The new triangle that the centre comes to lie in.
static under find_under(const overlay *o)
{
    const double *v = o->flat[o->target];
    under best = {0, {0}};
    double best_least = -INFINITY;
    for (uint32_t n = 1; n + 1 < o->count; ++n) {
        const uint32_t a = (o->target + n) % o->count, b = (a + 1) % o->count;
        const double of_v = turn(o->flat[a], o->flat[b]), of_a = turn(o->flat[b], v), of_b = turn(v, o->flat[a]);
        const double all = of_v + of_a + of_b, least = fmin(of_v, fmin(of_a, of_b)) / all;
        if (!(all > 0) || !(least > best_least)) continue;
        best_least = least;
        best = (under){a, {of_v / all, of_a / all, of_b / all}};
    }
    return best;
}

// Along the direction, where an old edge from the centre crosses a new one from the target.
static double gap_at_crossing(const overlay *o, uint32_t old, uint32_t new)
{
    const double *v = o->flat[o->target], *p = o->flat[old], *q = o->flat[new];
    const double along[2] = {q[0] - v[0], q[1] - v[1]}, slack = 1e-9; // of an edge: a crossing at its end is one
    const double det = turn(p, along);
    if (det == 0) return 0; // one lies along the other: their ends are looked at by themselves
    const double s = turn(v, along) / det, t = turn(v, p) / det;
    if (!(s > -slack && s < 1 + slack && t > -slack && t < 1 + slack)) return 0;
    return fabs(s * p[2] - (v[2] + t * (q[2] - v[2])));
}

static double largest_gap(const overlay *o, const under *at, double enough)
{
    const uint32_t a = at->triangle, b = (a + 1) % o->count;
    double gap = fabs(at->shares[0] * o->flat[o->target][2] + at->shares[1] * o->flat[a][2] + at->shares[2] * o->flat[b][2]);
    for (uint32_t i = 0; i < o->count && gap <= enough; ++i)
        for (uint32_t n = 2; n + 1 < o->count; ++n) {
            const uint32_t j = (o->target + n) % o->count;
            if (i == o->target || i == j) continue;
            gap = fmax(gap, gap_at_crossing(o, i, j));
        }
    return gap;
}

// ---- Looks ----

// Triangles from the target's border up to the other one keep the looks of the target's far side.
static int is_on_first_side(const star *s, uint32_t target, uint32_t triangle)
{
    if (s->border_count == 0) return 1;
    const uint32_t other = s->borders[s->borders[0] == target];
    return (triangle + s->count - target) % s->count < (other + s->count - target) % s->count;
}

static double look_off(const star *s, uint32_t target, uint32_t triangle, const double shares[3])
{
    const star_triangle *t = &s->triangles[triangle], *first = &s->triangles[target], *last = &s->triangles[(target + s->count - 1) % s->count];
    const double *v = is_on_first_side(s, target, triangle) ? first->normals[0] : last->normals[1];
    double off[3];
    for (int k = 0; k < 3; ++k) off[k] = shares[0] * v[k] + shares[1] * t->normals[0][k] + shares[2] * t->normals[1][k] - t->normals[2][k];
    return sqrt(dot(off, off));
}

static int looks_alike(const star *s, const overlay *o, const under *at)
{
    if (s->border_count == 0) return look_off(s, o->target, at->triangle, at->shares) <= LOOK_MOST;
    const uint32_t other = s->borders[s->borders[0] == o->target], before = (other + s->count - 1) % s->count;
    const double *a = o->flat[o->target], *b = o->flat[other];
    const double to_a = sqrt(a[0] * a[0] + a[1] * a[1]), to_b = sqrt(b[0] * b[0] + b[1] * b[1]), share = to_b / (to_a + to_b);
    const double after[3] = {share, 1 - share, 0}, behind[3] = {share, 0, 1 - share};
    return look_off(s, o->target, other, after) <= LOOK_MOST && look_off(s, o->target, before, behind) <= LOOK_MOST;
}

// ---- A collapse ----

// Onto the line between its neighbours along the border. Returns how far.
static double slide(const star *s, uint32_t target, double at[3])
{
    double along[3], off[3];
    for (int k = 0; k < 3; ++k) at[k] = s->centre.at[k];
    if (s->border_count == 0) return 0;
    const double *a = s->triangles[s->borders[0]].points[0].at, *b = s->triangles[s->borders[1]].points[0].at;
    if (target != s->borders[0] && target != s->borders[1]) return INFINITY;
    subtract(b, a, along);
    subtract(at, a, off);
    const double length2 = dot(along, along), share = dot(off, along) / length2;
    if (!(share > 0 && share < 1)) return INFINITY;
    for (int k = 0; k < 3; ++k) at[k] = a[k] + share * along[k];
    subtract(at, s->centre.at, off);
    return sqrt(dot(off, off));
}

static void lay(const star *s, uint32_t target, const double at[3], overlay *o)
{
    o->count = s->count;
    o->target = target;
    o->size = 0;
    for (uint32_t i = 0; i < s->count; ++i) {
        subtract(s->triangles[i].points[0].at, at, o->rim[i]);
        o->size = fmax(o->size, dot(o->rim[i], o->rim[i]));
    }
    o->size = sqrt(o->size);
}

static double error_so_far(const star *s)
{
    double most = 0;
    for (uint32_t i = 0; i < s->count; ++i) most = fmax(most, s->triangles[i].error);
    return most;
}

static void set_wedges(const star *s, uint32_t target, star_collapse *out)
{
    const uint32_t last = (target + s->count - 1) % s->count;
    for (uint32_t i = 0; i < s->count; ++i) {
        const uint32_t wedge = is_on_first_side(s, target, i) ? s->triangles[target].vertices[0] : s->triangles[last].vertices[1];
        out->wedges[i] = i == target || i == last ? STAR_ENDS : wedge;
    }
    out->target = s->triangles[target].points[0].place;
}

int star_try(const star *s, uint32_t i, const star_limits *limits, star_collapse *out)
{
    overlay o;
    double at[3];
    const double slid = slide(s, i, at), before = error_so_far(s), room = fmin(limits->once, limits->sum - before);
    if (!(slid <= room)) return 0;
    lay(s, i, at, &o);
    if (!set_direction(&o) || !new_ones_are_sound(&o)) return 0;
    flatten(&o);
    const under below = find_under(&o);
    const double moved = slid + largest_gap(&o, &below, room) + ROUNDING * o.size;
    if (!(moved <= room) || !looks_alike(s, &o, &below)) return 0;
    out->error = before + moved;
    out->cost = moved + SHORTER_FIRST * sqrt(dot(o.rim[i], o.rim[i]));
    set_wedges(s, i, out);
    return 1;
}
