// Clusters of nearly equal planes. Two join when one plane can stand for all: no corner of any face goes farther than the
// weld, no face is bent by much more, and the faces' middles lie within the weld of each other, so that no chain drifts.
// SPDX-License-Identifier: MIT
// Where a face is on the grid as written, that plane is one of those there were; between rounded ones it may be a new one.
// Invariant: pairs are joined nearest first, then by their planes' places (input_order.h): how the map is written or turned
// doesn't matter.
#include "input_cluster.h"
#include "input_order.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double BEND_MOST = 4.0 / 3; // welds: of a quad through three points each a third of a weld off, the fourth a whole one

typedef struct face_spot {
    uint32_t plane, first, count; // corners
    double middle[3];
} face_spot;

typedef struct member { // of a cluster, by plane
    uint32_t parent, next, last; // next: in its cluster, UINT32_MAX ends; last: of a root
    uint32_t first, count;       // faces
    plane_ref stands;            // of a root: the plane for all
    uint32_t is_rounded;         // of a root: all its faces; none is on the grid as written
} member;

typedef struct clusters {
    input_draft *draft;
    place_order order;
    buffer members;        // member
    buffer faces, corners; // face_spot by plane; double[3]
} clusters;

typedef struct unit_plane { double normal[3], offset; } unit_plane;

static unit_plane unit_of(const cull_wide_plane *p)
{
    const double n[3] = {(double)p->normal[0], (double)p->normal[1], (double)p->normal[2]};
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    return (unit_plane){{n[0] / length, n[1] / length, n[2] / length}, cull_wide_to_double(p->offset) / length};
}

static double height(const unit_plane *u, const double p[3])
{
    return u->normal[0] * p[0] + u->normal[1] * p[1] + u->normal[2] * p[2] + u->offset;
}

static const cull_wide_plane *plane_at(const clusters *c, uint32_t plane)
{
    return plane_table_canonical(c->draft->in->planes, 2 * plane);
}

// ---- Faces by plane ----

static int compare_faces(const void *left, const void *right)
{
    const face_spot *a = left, *b = right;
    if (a->plane != b->plane) return a->plane < b->plane ? -1 : 1;
    for (int k = 0; k < 3; ++k)
        if (a->middle[k] != b->middle[k]) return a->middle[k] < b->middle[k] ? -1 : 1;
    return a->first < b->first ? -1 : a->first > b->first;
}

static result take_face(clusters *c, uint32_t plane, const shape_face *face)
{
    const shape_corner *from = (const shape_corner *)c->draft->shape.corners.items + face->first_corner;
    face_spot made = {plane, (uint32_t)c->corners.count, face->corner_count, {0, 0, 0}};
    for (uint32_t i = 0; i < face->corner_count; ++i) {
        if (!buffer_append(&c->corners, from[i].position, 1)) return RESULT_NO_MEMORY;
        for (int k = 0; k < 3; ++k) made.middle[k] += from[i].position[k] / face->corner_count;
    }
    return buffer_append(&c->faces, &made, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

static result take_brush(clusters *c, uint32_t brush)
{
    const compile_brush *b = (const compile_brush *)c->draft->brushes.items + brush;
    const compile_face *faces = (const compile_face *)c->draft->faces.items + b->first_face;
    member *members = c->members.items;
    uint32_t wanted = 0;
    for (uint32_t f = 0; f < b->face_count; ++f) wanted += members[faces[f].plane >> 1].count;
    if (!wanted || (b->role != BRUSH_STRUCTURE && b->role != BRUSH_LIQUID)) return RESULT_OK;
    result done = input_cut_brush(c->draft, brush);
    const shape_face *shape = c->draft->shape.faces.items;
    for (size_t f = 0; f < c->draft->shape.faces.count && done == RESULT_OK; ++f) {
        const uint32_t plane = faces[shape[f].face].plane >> 1;
        if (!members[plane].count) continue;
        members[plane].is_rounded &= faces[shape[f].face].is_rounded;
        done = take_face(c, plane, &shape[f]);
    }
    return done;
}

static result take_faces(clusters *c, const near_pair *pairs, size_t count)
{
    const uint32_t planes = plane_table_count(c->draft->in->planes);
    member *members = buffer_push(&c->members, planes);
    if (!members) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < planes; ++i) members[i] = (member){i, UINT32_MAX, i, 0, 0, 2 * i, 1};
    for (size_t i = 0; i < count; ++i) members[pairs[i].a].count = members[pairs[i].b].count = 1; // for now: wanted
    for (uint32_t b = 0; b < c->draft->brushes.count; ++b) {
        const result done = take_brush(c, b);
        if (done != RESULT_OK) return done;
    }
    face_spot *faces = c->faces.items;
    if (c->faces.count) qsort(faces, c->faces.count, sizeof *faces, compare_faces);
    for (uint32_t i = 0; i < planes; ++i) members[i].count = 0;
    for (uint32_t i = 0; i < c->faces.count; ++i) {
        member *m = &members[faces[i].plane];
        if (m->count++ == 0) m->first = i;
    }
    return RESULT_OK;
}

// ---- Can it stand for them? ----

typedef struct reach { double low, high; } reach; // of faces' middles

static int stands_for_face(const clusters *c, const face_spot *face, const unit_plane *u)
{
    const double(*corners)[3] = (const double(*)[3])c->corners.items;
    double low = INFINITY, high = -INFINITY;
    for (uint32_t i = face->first; i < face->first + face->count; ++i) {
        const double at = height(u, corners[i]);
        low = fmin(low, at);
        high = fmax(high, at);
    }
    return low >= -c->draft->weld && high <= c->draft->weld && high - low <= BEND_MOST * c->draft->weld;
}

static int stands_for(const clusters *c, uint32_t root, const unit_plane *u, reach *middles)
{
    const member *members = c->members.items;
    for (uint32_t at = root; at != UINT32_MAX; at = members[at].next)
        for (uint32_t f = members[at].first; f < members[at].first + members[at].count; ++f) {
            const face_spot *face = (const face_spot *)c->faces.items + f;
            const double middle = height(u, face->middle);
            middles->low = fmin(middles->low, middle);
            middles->high = fmax(middles->high, middle);
            if (middles->high - middles->low > c->draft->weld) return 0;
            if (!stands_for_face(c, face, u)) return 0;
        }
    return 1;
}

static int stands_for_both(const clusters *c, uint32_t a, uint32_t b, plane_ref plane)
{
    const unit_plane u = unit_of(plane_at(c, plane >> 1));
    reach middles = {INFINITY, -INFINITY};
    return stands_for(c, a, &u, &middles) && stands_for(c, b, &u, &middles);
}

static uint32_t bits_of(const cull_wide_plane *p)
{
    uint32_t bits = 0;
    for (int k = 0; k < 3; ++k)
        for (uint64_t m = cull_magnitude(p->normal[k]); m; m >>= 1) bits++;
    const cull_wide size = cull_wide_magnitude(p->offset);
    for (uint64_t m = size.high; m; m >>= 1) bits++;
    for (uint64_t m = size.low; m; m >>= 1) bits++;
    return bits;
}

static int is_simpler(const clusters *c, const cull_wide_plane *a, const cull_wide_plane *b)
{
    const uint32_t bits = bits_of(a), other = bits_of(b);
    return bits < other || (bits == other && compare_plane_places(&c->order, a, b) < 0);
}

// ---- A plane through the midst of all faces ----

// Least squares of the corners' heights over a plane: sums of places along it and of heights.
typedef struct tilt { double along[2][3], middle[3], ss, st, tt, sh, th, h, count; } tilt;

typedef void (*corner_visit)(const double corner[3], const unit_plane *u, tilt *t);

static void add_middle(const double corner[3], const unit_plane *u, tilt *t)
{
    (void)u;
    for (int k = 0; k < 3; ++k) t->middle[k] += corner[k];
    t->count += 1;
}

static void add_height(const double corner[3], const unit_plane *u, tilt *t)
{
    const double h = height(u, corner);
    double s = 0, r = 0;
    for (int k = 0; k < 3; ++k) {
        s += t->along[0][k] * (corner[k] - t->middle[k]);
        r += t->along[1][k] * (corner[k] - t->middle[k]);
    }
    t->ss += s * s;
    t->st += s * r;
    t->tt += r * r;
    t->sh += s * h;
    t->th += r * h;
    t->h += h;
}

static void visit_corners(const clusters *c, const uint32_t roots[2], const unit_plane *u, corner_visit visit, tilt *t)
{
    const member *members = c->members.items;
    const double(*corners)[3] = (const double(*)[3])c->corners.items;
    for (int r = 0; r < 2; ++r)
        for (uint32_t at = roots[r]; at != UINT32_MAX; at = members[at].next)
            for (uint32_t f = members[at].first; f < members[at].first + members[at].count; ++f) {
                const face_spot *face = (const face_spot *)c->faces.items + f;
                for (uint32_t i = face->first; i < face->first + face->count; ++i) visit(corners[i], u, t);
            }
}

static void set_directions(const unit_plane *u, tilt *t)
{
    int least = 0;
    for (int k = 1; k < 3; ++k)
        if (fabs(u->normal[k]) < fabs(u->normal[least])) least = k;
    const int l = (least + 1) % 3, m = (least + 2) % 3;
    const double length = sqrt(u->normal[l] * u->normal[l] + u->normal[m] * u->normal[m]);
    double *a = t->along[0], *b = t->along[1];
    a[least] = 0;
    a[l] = u->normal[m] / length;
    a[m] = -u->normal[l] / length;
    for (int k = 0; k < 3; ++k) b[k] = u->normal[(k + 1) % 3] * a[(k + 2) % 3] - u->normal[(k + 2) % 3] * a[(k + 1) % 3];
}

// The plane nearest to all corners of the faces, near to parallel to the first cluster's.
static unit_plane midst_of(const clusters *c, const uint32_t roots[2], double middle[3])
{
    unit_plane u = unit_of(plane_at(c, ((const member *)c->members.items)[roots[0]].stands >> 1));
    tilt t = {.count = 0};
    visit_corners(c, roots, &u, add_middle, &t);
    for (int k = 0; k < 3; ++k) t.middle[k] /= t.count;
    set_directions(&u, &t);
    visit_corners(c, roots, &u, add_height, &t);
    const double scale = t.ss * t.tt - t.st * t.st;
    const double a = scale > 1e-6 * t.ss * t.tt ? (t.sh * t.tt - t.th * t.st) / scale : 0; // else they lie on one line
    const double b = scale > 1e-6 * t.ss * t.tt ? (t.th * t.ss - t.sh * t.st) / scale : 0;
    for (int k = 0; k < 3; ++k) u.normal[k] -= a * t.along[0][k] + b * t.along[1][k];
    const double length = sqrt(u.normal[0] * u.normal[0] + u.normal[1] * u.normal[1] + u.normal[2] * u.normal[2]);
    u.offset = 0;
    for (int k = 0; k < 3; ++k) u.normal[k] /= length;
    u.offset = -height(&u, t.middle);
    for (int k = 0; k < 3; ++k) middle[k] = t.middle[k];
    return u;
}

static double square(const double v[3])
{
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

// The corner farthest from a point, and off a line when that has a direction; of equal ones the first by place (input_order.h).
static void farthest(const clusters *c, const uint32_t roots[2], const double from[3], const double along[3], const double **best)
{
    const member *members = c->members.items;
    const double(*corners)[3] = (const double(*)[3])c->corners.items;
    double most = -1;
    for (int r = 0; r < 2; ++r)
        for (uint32_t at = roots[r]; at != UINT32_MAX; at = members[at].next)
            for (uint32_t f = members[at].first; f < members[at].first + members[at].count; ++f) {
                const face_spot *face = (const face_spot *)c->faces.items + f;
                for (uint32_t i = face->first; i < face->first + face->count; ++i) {
                    double v[3], off = 0;
                    for (int k = 0; k < 3; ++k) v[k] = corners[i][k] - from[k];
                    for (int k = 0; k < 3; ++k) off += v[k] * along[k];
                    const double far = steady(sqrt(fmax(square(v) - off * off, 0)));
                    if (far < most || (far == most && compare_places(&c->order, corners[i], *best) >= 0)) continue;
                    most = far;
                    *best = corners[i];
                }
            }
}

// Onto the plane, then to the coarsest multiple of a unit's parts that is near enough.
static void round_onto(const clusters *c, const unit_plane *u, const double p[3], uint32_t coarsest, int32_t out[3])
{
    const double off = height(u, p);
    for (uint32_t step = coarsest;; step = step % 2 ? 1 : step / 2) {
        int near = 1;
        for (int k = 0; k < 3; ++k) {
            const double at = steady(p[k] - off * u->normal[k]), to = nearbyint(at / step) * step;
            near &= fabs(to - at) <= c->draft->weld && fabs(to) <= CULL_GRID_MOST;
            out[k] = (int32_t)fmax(-CULL_GRID_MOST, fmin(CULL_GRID_MOST, to));
        }
        if (near || step == 1) return;
    }
}

// Through three far corners, laid onto the midst and rounded. PLANE_NONE: none.
static result lay_through_midst(clusters *c, const uint32_t roots[2], uint32_t coarsest, plane_ref *out)
{
    static const double nowhere[3] = {0, 0, 0};
    *out = PLANE_NONE;
    double middle[3];
    const unit_plane u = midst_of(c, roots, middle);
    const double *one = NULL, *two = NULL, *three = NULL;
    farthest(c, roots, middle, nowhere, &one);
    if (!one) return RESULT_OK;
    farthest(c, roots, one, nowhere, &two);
    double along[3] = {two[0] - one[0], two[1] - one[1], two[2] - one[2]};
    const double far = sqrt(square(along));
    for (int k = 0; k < 3; ++k) along[k] /= far > 0 ? far : 1;
    farthest(c, roots, one, along, &three);
    int32_t p[3][3];
    round_onto(c, &u, one, coarsest, p[0]);
    round_onto(c, &u, two, coarsest, p[1]);
    round_onto(c, &u, three, coarsest, p[2]);
    cull_wide_plane made;
    if (!cull_wide_plane_through(p[0], p[1], p[2], &made)) return RESULT_OK;
    *out = plane_table_add(c->draft->in->planes, &made);
    return *out == PLANE_NONE ? RESULT_NO_MEMORY : RESULT_OK;
}

// ---- Joining ----

static uint32_t root_of(clusters *c, uint32_t plane)
{
    member *m = c->members.items;
    while (m[plane].parent != plane) plane = m[plane].parent = m[m[plane].parent].parent;
    return plane;
}

// The simpler of the two that stand now, then one through the midst: by simple points, then by near ones.
static result find_common(clusters *c, const uint32_t roots[2], plane_ref *out)
{
    const member *members = c->members.items;
    plane_ref one = members[roots[0]].stands, other = members[roots[1]].stands;
    if (is_simpler(c, plane_at(c, other >> 1), plane_at(c, one >> 1))) {
        const plane_ref swap = one;
        one = other;
        other = swap;
    }
    *out = one;
    if (stands_for_both(c, roots[0], roots[1], one)) return RESULT_OK;
    *out = other;
    if (stands_for_both(c, roots[0], roots[1], other)) return RESULT_OK;
    const uint32_t coarsest[2] = {c->draft->grid, 1};
    const int may_be_new = members[roots[0]].is_rounded && members[roots[1]].is_rounded;
    for (int i = 0; i < 2 && may_be_new; ++i) {
        const result done = lay_through_midst(c, roots, coarsest[i], out);
        if (done != RESULT_OK || (*out != PLANE_NONE && stands_for_both(c, roots[0], roots[1], *out))) return done;
    }
    *out = PLANE_NONE;
    return RESULT_OK;
}

typedef struct link { // a pair to be linked, with what it is ordered by
    double apart;
    cull_wide_plane low, high;
    uint32_t a, b;
    const place_order *order;
} link;

static int compare_links(const void *left, const void *right)
{
    const link *a = left, *b = right;
    if (a->apart != b->apart) return a->apart < b->apart ? -1 : 1;
    const int low = compare_plane_places(a->order, &a->low, &b->low);
    return low ? low : compare_plane_places(a->order, &a->high, &b->high);
}

static result join(clusters *c, const link *l)
{
    uint32_t roots[2] = {root_of(c, l->a), root_of(c, l->b)};
    if (roots[0] == roots[1]) return RESULT_OK;
    if (compare_plane_places(&c->order, plane_at(c, roots[1]), plane_at(c, roots[0])) < 0) {
        const uint32_t swap = roots[0];
        roots[0] = roots[1];
        roots[1] = swap;
    }
    plane_ref common;
    const result done = find_common(c, roots, &common);
    if (done != RESULT_OK || common == PLANE_NONE) return done;
    member *m = c->members.items;
    m[roots[1]].parent = roots[0];
    m[m[roots[0]].last].next = roots[1];
    m[roots[0]].last = m[roots[1]].last;
    m[roots[0]].stands = common & ~1u;
    m[roots[0]].is_rounded &= m[roots[1]].is_rounded;
    return RESULT_OK;
}

static result join_all(clusters *c, const near_pair *pairs, size_t count)
{
    buffer links = buffer_make(c->members.memory, sizeof(link));
    link *l = buffer_push(&links, count);
    result done = l ? RESULT_OK : RESULT_NO_MEMORY;
    for (size_t i = 0; i < count && done == RESULT_OK; ++i) {
        const cull_wide_plane *a = plane_at(c, pairs[i].a), *b = plane_at(c, pairs[i].b);
        const int forward = compare_plane_places(&c->order, a, b) < 0;
        l[i] = (link){steady(pairs[i].apart), forward ? *a : *b, forward ? *b : *a, pairs[i].a, pairs[i].b, &c->order};
    }
    if (done == RESULT_OK) qsort(l, count, sizeof *l, compare_links);
    for (size_t i = 0; i < count && done == RESULT_OK; ++i) done = join(c, &l[i]);
    buffer_free(&links);
    return done;
}

result plane_clusters_find(input_draft *d, const near_pair *pairs, size_t count, buffer *to)
{
    const allocator *memory = d->faces.memory;
    clusters c = {.draft = d,
                  .order = place_order_of(d->brushes.items, d->brushes.count),
                  .members = buffer_make(memory, sizeof(member)),
                  .faces = buffer_make(memory, sizeof(face_spot)),
                  .corners = buffer_make(memory, sizeof(double[3]))};
    result done = take_faces(&c, pairs, count);
    if (done == RESULT_OK) done = join_all(&c, pairs, count);
    const uint32_t planes = (uint32_t)c.members.count;
    to->count = 0;
    plane_ref *out = done == RESULT_OK ? buffer_push(to, planes) : NULL;
    if (done == RESULT_OK && !out) done = RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < planes && done == RESULT_OK; ++i) {
        const plane_ref stands = ((const member *)c.members.items)[root_of(&c, i)].stands;
        out[i] = stands >> 1 == i ? PLANE_NONE : stands;
    }
    buffer_free(&c.members);
    buffer_free(&c.faces);
    buffer_free(&c.corners);
    return done;
}
