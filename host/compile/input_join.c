// Weld of corners to the faces of other brushes that they miss by a rounding: planes that were rounded are laid through the
// grid point that was meant, so that what should seal does.
// SPDX-License-Identifier: MIT
// Invariant: a plane of which one face was on the grid as written stays; all brushes of a plane change together or none does;
// no corner goes farther than the weld; the rounds are few.
#include "input_cluster.h"
#include "input_meet.h"
#include "input_order.h"

#include <math.h>
#include <stdlib.h>

enum { ROUNDS_MOST = 4, ANCHORS_MOST = 16, NEAR_PLANES_MOST = 32, REFUSALS_MOST = 8, USERS_MOST = 16 }; // a plane that more brushes share is as meant

static const double ON_PLANE = 1.0 / 1024; // steps: far above a position's error

typedef struct grid_point { int32_t at[3]; } grid_point;

typedef struct near_spot { // where corners and planes nearly meet
    double low[3], high[3], far; // far: of its first corner from the centre
    uint32_t planes[NEAR_PLANES_MOST], plane_count, is_settled;
    grid_point target;
} near_spot;

typedef struct refusal { uint32_t plane; plane_ref to; uint32_t brush; } refusal;

typedef struct plane_user { uint32_t plane, brush; } plane_user;

typedef struct join {
    input_draft *draft;
    place_order place;
    meeting_set meetings;
    buffer order, spots; // uint32_t: meetings apart by place; near_spot
    buffer of_plane;     // uint32_t: spots of one plane
    size_t first_meeting, end_meeting; // of that plane
    buffer own;          // placed: corners of the faces on one plane
    buffer all_users;    // plane_user: by plane, as the round began
    buffer users;        // uint32_t: brushes with that plane
    buffer anchors;      // grid_point
    buffer planes;       // plane_ref: of one brush
    buffer refused;      // refusal: by a brush, not to be tried again
    uint32_t changed;
} join;

// ---- Spots ----

static const brush_corner *corner_of(const join *j, const brush_meeting *m)
{
    return (const brush_corner *)j->meetings.corners.items + m->corner;
}

typedef struct placed { double at[3]; uint32_t meeting; const place_order *order; } placed;

static int compare_placed(const void *left, const void *right)
{
    const placed *a = left, *b = right;
    const int order = compare_places(a->order, a->at, b->at);
    if (order) return order;
    return a->meeting < b->meeting ? -1 : a->meeting > b->meeting;
}

static void spot_add_plane(near_spot *s, uint32_t plane)
{
    for (uint32_t i = 0; i < s->plane_count; ++i)
        if (s->planes[i] == plane) return;
    if (s->plane_count < NEAR_PLANES_MOST) s->planes[s->plane_count++] = plane;
}

// By their planes' places: where brushes stand in the file doesn't matter.
static void sort_planes(const join *j, near_spot *s)
{
    const plane_table *t = j->draft->in->planes;
    for (uint32_t i = 1; i < s->plane_count; ++i) {
        const uint32_t moved = s->planes[i];
        uint32_t at = i;
        for (; at > 0 && compare_plane_places(&j->place, plane_table_canonical(t, 2 * moved), plane_table_canonical(t, 2 * s->planes[at - 1])) < 0; --at)
            s->planes[at] = s->planes[at - 1];
        s->planes[at] = moved;
    }
}

// The corner joins the first spot that stays smaller than the weld with it: complete linkage, never a chain.
static near_spot *spot_for(join *j, const double at[3])
{
    near_spot *spots = j->spots.items;
    const double weld = j->draft->weld, far = place_distance(&j->place, at);
    for (size_t i = j->spots.count; i-- > 0 && spots[i].far >= far - 2 * weld;) { // they come in that order, and a spot is a cube of the weld
        int fits = 1;
        for (int k = 0; k < 3; ++k) fits &= fmax(spots[i].high[k], at[k]) - fmin(spots[i].low[k], at[k]) <= weld;
        if (fits) return &spots[i];
    }
    const near_spot none = {{at[0], at[1], at[2]}, {at[0], at[1], at[2]}, far, {0}, 0, 0, {{0, 0, 0}}};
    return buffer_append(&j->spots, &none, 1);
}

static result find_spots(join *j)
{
    const brush_meeting *all = j->meetings.meetings.items;
    j->order.count = j->spots.count = 0;
    for (uint32_t i = 0; i < j->meetings.meetings.count; ++i) {
        const double *p = corner_of(j, &all[i])->position;
        const placed made = {{p[0], p[1], p[2]}, i, &j->place};
        if (all[i].is_apart && !buffer_append(&j->order, &made, 1)) return RESULT_NO_MEMORY;
    }
    placed *order = j->order.items;
    if (j->order.count) qsort(order, j->order.count, sizeof *order, compare_placed);
    for (size_t i = 0; i < j->order.count; ++i) {
        near_spot *s = spot_for(j, order[i].at);
        if (!s) return RESULT_NO_MEMORY;
        const brush_meeting *m = &all[order[i].meeting];
        for (int k = 0; k < 3; ++k) {
            s->low[k] = fmin(s->low[k], order[i].at[k]);
            s->high[k] = fmax(s->high[k], order[i].at[k]);
            spot_add_plane(s, corner_of(j, m)->planes[k] >> 1);
        }
        spot_add_plane(s, m->plane);
    }
    near_spot *spots = j->spots.items;
    for (size_t i = 0; i < j->spots.count; ++i) sort_planes(j, &spots[i]);
    return RESULT_OK;
}

// ---- Where they are meant to meet ----

// The nearest point whose coordinates are multiples of `step`; 0: it is farther than the weld.
static int rounded_to(const join *j, const double p[3], double step, grid_point *out)
{
    for (int k = 0; k < 3; ++k) {
        const double at = nearbyint(steady(p[k]) / step) * step;
        if (fabs(at - steady(p[k])) > j->draft->weld || fabs(at) > CULL_GRID_MOST) return 0;
        out->at[k] = (int32_t)at;
    }
    return 1;
}

static uint32_t planes_through(const join *j, const near_spot *s, const grid_point *p)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->plane_count; ++i) count += plane_table_side_of_point(j->draft->in->planes, p->at, 2 * s->planes[i]) == 0;
    return count;
}

// Through the most planes as they are; of equal ones the coarsest: whole units, then halves, to a step of the grid.
static void find_target(const join *j, near_spot *s)
{
    const double middle[3] = {(s->low[0] + s->high[0]) / 2, (s->low[1] + s->high[1]) / 2, (s->low[2] + s->high[2]) / 2};
    uint32_t most = 0;
    int found = 0;
    for (uint32_t step = j->draft->grid; step >= 1; step = step % 2 ? step > 1 : step / 2) {
        grid_point p;
        if (!rounded_to(j, middle, step, &p)) continue;
        const uint32_t count = planes_through(j, s, &p);
        if (found && count <= most) continue;
        found = 1;
        most = count;
        s->target = p;
    }
    s->is_settled = !found || most == s->plane_count;
}

// ---- One plane laid anew ----

static int spot_has(const near_spot *s, uint32_t plane)
{
    for (uint32_t i = 0; i < s->plane_count; ++i)
        if (s->planes[i] == plane) return 1;
    return 0;
}

static result gather_spots(join *j, uint32_t plane)
{
    const near_spot *spots = j->spots.items;
    j->of_plane.count = 0;
    for (uint32_t i = 0; i < j->spots.count; ++i)
        if (spot_has(&spots[i], plane) && !buffer_append(&j->of_plane, &i, 1)) return RESULT_NO_MEMORY;
    const brush_meeting *all = j->meetings.meetings.items;
    size_t low = 0, high = j->meetings.meetings.count;
    while (low < high) { // they are in order of planes
        const size_t middle = (low + high) / 2;
        if (all[middle].plane < plane) low = middle + 1;
        else high = middle;
    }
    for (j->first_meeting = low; low < j->meetings.meetings.count && all[low].plane == plane; ++low) continue;
    j->end_meeting = low;
    return RESULT_OK;
}

static int compare_points(const void *left, const void *right)
{
    const placed *a = left, *b = right;
    return compare_places(a->order, a->at, b->at);
}

static int compare_users(const void *left, const void *right)
{
    const plane_user *a = left, *b = right;
    if (a->plane != b->plane) return a->plane < b->plane ? -1 : 1;
    return a->brush < b->brush ? -1 : a->brush > b->brush;
}

static result list_users(join *j)
{
    const compile_brush *brushes = j->draft->brushes.items;
    const compile_face *faces = j->draft->faces.items;
    j->all_users.count = 0;
    for (uint32_t b = 0; b < j->draft->brushes.count; ++b)
        for (uint32_t f = 0; f < brushes[b].face_count; ++f) {
            const plane_user user = {faces[brushes[b].first_face + f].plane >> 1, b};
            if (meeting_set_may_move(&j->meetings, user.plane) && !buffer_append(&j->all_users, &user, 1)) return RESULT_NO_MEMORY;
        }
    if (j->all_users.count) qsort(j->all_users.items, j->all_users.count, sizeof(plane_user), compare_users);
    return RESULT_OK;
}

static int has_plane(const join *j, uint32_t brush, uint32_t plane)
{
    const compile_brush *b = (const compile_brush *)j->draft->brushes.items + brush;
    const compile_face *faces = (const compile_face *)j->draft->faces.items + b->first_face;
    for (uint32_t f = 0; f < b->face_count; ++f)
        if (faces[f].plane >> 1 == plane) return 1;
    return 0;
}

// The brushes that still have the plane, and the corners of their faces on it, as they were when this round began.
static result gather_users(join *j, uint32_t plane)
{
    const plane_user *all = j->all_users.items;
    const brush_corner *c = j->meetings.corners.items;
    const uint32_t *first = j->meetings.first.items;
    size_t low = 0, high = j->all_users.count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (all[middle].plane < plane) low = middle + 1;
        else high = middle;
    }
    j->users.count = j->own.count = 0;
    for (; low < j->all_users.count && all[low].plane == plane; ++low) {
        const uint32_t b = all[low].brush;
        if (!has_plane(j, b, plane)) continue;
        if (!buffer_append(&j->users, &b, 1)) return RESULT_NO_MEMORY;
        for (uint32_t i = first[b]; i < first[b + 1]; ++i) {
            const double *p = c[i].position;
            const placed made = {{p[0], p[1], p[2]}, 0, &j->place};
            if (fabs(plane_height(j->draft->in->planes, 2 * plane, p)) < ON_PLANE && !buffer_append(&j->own, &made, 1)) return RESULT_NO_MEMORY;
        }
    }
    if (j->own.count) qsort(j->own.items, j->own.count, sizeof(placed), compare_points);
    return RESULT_OK;
}

static int add_anchor(join *j, const grid_point *p)
{
    const grid_point *have = j->anchors.items;
    for (size_t i = 0; i < j->anchors.count; ++i)
        if (have[i].at[0] == p->at[0] && have[i].at[1] == p->at[1] && have[i].at[2] == p->at[2]) return 1;
    return j->anchors.count >= ANCHORS_MOST || buffer_append(&j->anchors, p, 1) != NULL;
}

static double far_squared(const double p[3], const int32_t q[3])
{
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += (p[k] - q[k]) * (p[k] - q[k]);
    return sum;
}

// Other spots of the plane first, then its faces' corners, those farthest from the spot first, at the coarsest near point.
static result gather_anchors(join *j, const near_spot *spot)
{
    const near_spot *spots = j->spots.items;
    j->anchors.count = 0;
    const uint32_t *of_plane = j->of_plane.items;
    for (size_t i = 0; i < j->of_plane.count; ++i)
        if (&spots[of_plane[i]] != spot && !add_anchor(j, &spots[of_plane[i]].target)) return RESULT_NO_MEMORY;
    const placed *own = j->own.items;
    double before = INFINITY;
    for (int round = 0; round < ANCHORS_MOST / 2; ++round) {
        size_t best = j->own.count;
        double most = -1;
        for (size_t i = 0; i < j->own.count; ++i) {
            const double far = steady(far_squared(own[i].at, spot->target.at));
            if (far < before - 1 && far > most) {
                most = far;
                best = i;
            }
        }
        if (best == j->own.count) break;
        before = most;
        for (size_t i = 0; i < j->own.count; ++i) { // all that lie as far
            grid_point p;
            if (fabs(steady(far_squared(own[i].at, spot->target.at)) - most) > 1) continue;
            uint32_t step = j->draft->grid;
            while (step > 1 && !rounded_to(j, own[i].at, step, &p)) step = step % 2 ? 1 : step / 2;
            if (rounded_to(j, own[i].at, step, &p) && !add_anchor(j, &p)) return RESULT_NO_MEMORY;
        }
    }
    return RESULT_OK;
}

typedef struct unit_row { double n[3], offset; } unit_row;

static unit_row unit_of(const cull_wide_plane *p)
{
    const double n[3] = {(double)p->normal[0], (double)p->normal[1], (double)p->normal[2]};
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    return (unit_row){{n[0] / length, n[1] / length, n[2] / length}, cull_wide_to_double(p->offset) / length};
}

static double height_of(const unit_row *u, const double p[3])
{
    return fabs(u->n[0] * p[0] + u->n[1] * p[1] + u->n[2] * p[2] + u->offset);
}

static int stays_near(const join *j, const cull_wide_plane *p)
{
    const placed *own = j->own.items;
    const unit_row u = unit_of(p);
    for (size_t i = 0; i < j->own.count; ++i)
        if (steady(height_of(&u, own[i].at)) > j->draft->weld) return 0;
    return 1;
}

// How much meets on the plane: spots of it, and other brushes' corners that lie on it as they are.
static uint32_t score_of(const join *j, const cull_wide_plane *as)
{
    const near_spot *spots = j->spots.items;
    const uint32_t *of_plane = j->of_plane.items;
    const brush_meeting *all = j->meetings.meetings.items;
    const plane_table *t = j->draft->in->planes;
    const unit_row u = unit_of(as);
    uint32_t score = 0;
    for (size_t i = 0; i < j->of_plane.count; ++i) score += cull_side_of_point(as, spots[of_plane[i]].target.at) == 0;
    for (size_t i = j->first_meeting; i < j->end_meeting; ++i) {
        const plane_ref *c = corner_of(j, &all[i])->planes;
        if (!all[i].is_apart && height_of(&u, corner_of(j, &all[i])->position) < ON_PLANE)
            score += cull_side_of_meet(plane_table_canonical(t, c[0]), plane_table_canonical(t, c[1]), plane_table_canonical(t, c[2]), as) == 0;
    }
    return score;
}

static double bits_of(const cull_wide_plane *p)
{
    double bits = log2(1 + fabs(cull_wide_to_double(p->offset)));
    for (int k = 0; k < 3; ++k) bits += log2(1 + (double)cull_magnitude(p->normal[k]));
    return steady(bits);
}

// The plane through the spot's target and two anchors on which the most meets; 0: none is better than what is.
static int find_plane(const join *j, uint32_t plane, const near_spot *spot, cull_wide_plane *out)
{
    const grid_point *a = j->anchors.items;
    uint32_t most = score_of(j, plane_table_canonical(j->draft->in->planes, 2 * plane));
    double least_bits = 0;
    int found = 0;
    for (size_t i = 0; i < j->anchors.count; ++i)
        for (size_t k = i + 1; k < j->anchors.count; ++k) {
            cull_wide_plane made;
            if (!cull_wide_plane_through(spot->target.at, a[i].at, a[k].at, &made) || !stays_near(j, &made)) continue;
            const uint32_t score = score_of(j, &made);
            const double bits = bits_of(&made);
            if (score < most || (score == most && (!found || bits > least_bits))) continue;
            if (score == most && bits == least_bits && compare_plane_places(&j->place, &made, out) >= 0) continue;
            found = 1;
            most = score;
            least_bits = bits;
            *out = made;
        }
    return found;
}

// ---- All brushes of the plane ----

static result replace_in(join *j, uint32_t brush, uint32_t plane, plane_ref to, result (*how)(input_draft *, const plane_replacement *, replace_verdict *),
                         replace_verdict *out)
{
    const compile_brush *b = (const compile_brush *)j->draft->brushes.items + brush;
    const compile_face *faces = (const compile_face *)j->draft->faces.items + b->first_face;
    const cull_wide_plane before = plane_table_get(j->draft->in->planes, 2 * plane), after = plane_table_get(j->draft->in->planes, to);
    const uint32_t turn = cull_normals_dot_sign(&before, &after) < 0;
    j->planes.count = 0;
    plane_ref *planes = buffer_push(&j->planes, b->face_count);
    if (!planes) return RESULT_NO_MEMORY;
    for (uint32_t f = 0; f < b->face_count; ++f) planes[f] = faces[f].plane >> 1 == plane ? to ^ turn ^ (faces[f].plane & 1) : faces[f].plane;
    const plane_replacement r = {brush, planes, WELD_CORNER};
    const result done = input_cut_brush(j->draft, brush);
    return done == RESULT_OK ? how(j->draft, &r, out) : done;
}

static int was_refused(const join *j, uint32_t plane, plane_ref to)
{
    const refusal *r = j->refused.items;
    for (size_t i = 0; i < j->refused.count; ++i)
        if (r[i].plane == plane && r[i].to == to) return 1;
    return 0;
}

// A brush of the plane has refused so often that it is let be.
static int is_stubborn(const join *j)
{
    const refusal *r = j->refused.items;
    const uint32_t *users = j->users.items;
    for (size_t u = 0; u < j->users.count; ++u) {
        uint32_t count = 0;
        for (size_t i = 0; i < j->refused.count; ++i) count += r[i].brush == users[u];
        if (count >= REFUSALS_MOST) return 1;
    }
    return 0;
}

// Tried in all brushes before it is done in any.
static result replace_in_all(join *j, uint32_t plane, plane_ref to)
{
    const uint32_t *users = j->users.items;
    replace_verdict verdict = REPLACE_DONE;
    result done = RESULT_OK;
    uint32_t refusals = 0; // of all brushes, so that their order leaves no trace
    for (size_t i = 0; i < j->users.count && done == RESULT_OK; ++i) {
        done = replace_in(j, users[i], plane, to, input_try_planes, &verdict);
        const refusal again = {plane, to, users[i]};
        if (done != RESULT_OK || verdict == REPLACE_DONE) continue;
        if (!buffer_append(&j->refused, &again, 1)) return RESULT_NO_MEMORY;
        refusals++;
    }
    if (done != RESULT_OK || refusals) return done;
    for (size_t i = 0; i < j->users.count && done == RESULT_OK; ++i) done = replace_in(j, users[i], plane, to, input_replace_planes, &verdict);
    j->changed += done == RESULT_OK;
    return done;
}

static result lay_plane(join *j, uint32_t plane, const near_spot *spot)
{
    cull_wide_plane made;
    result done = gather_users(j, plane);
    if (done != RESULT_OK || j->users.count == 0 || j->users.count > USERS_MOST || is_stubborn(j)) return done;
    done = gather_spots(j, plane);
    if (done == RESULT_OK) done = gather_anchors(j, spot);
    if (done != RESULT_OK || !find_plane(j, plane, spot, &made)) return done;
    const plane_ref to = plane_table_add(j->draft->in->planes, &made);
    if (to == PLANE_NONE) return RESULT_NO_MEMORY;
    return was_refused(j, plane, to) ? RESULT_OK : replace_in_all(j, plane, to);
}

// ---- Rounds ----

static result join_once(join *j)
{
    uint32_t apart;
    j->changed = 0;
    j->place = place_order_of(j->draft->brushes.items, j->draft->brushes.count);
    result done = meeting_set_find(&j->meetings, &apart);
    if (done != RESULT_OK || apart == 0) return done;
    done = find_spots(j);
    if (done == RESULT_OK) done = list_users(j);
    if (done != RESULT_OK) return done;
    near_spot *spots = j->spots.items;
    for (size_t i = 0; i < j->spots.count; ++i) find_target(j, &spots[i]);
    for (size_t i = 0; i < j->spots.count && done == RESULT_OK; ++i)
        for (uint32_t k = 0; k < spots[i].plane_count && done == RESULT_OK && !spots[i].is_settled; ++k) {
            const uint32_t plane = spots[i].planes[k];
            if (!meeting_set_may_move(&j->meetings, plane) || plane_table_side_of_point(j->draft->in->planes, spots[i].target.at, 2 * plane) == 0) continue;
            done = lay_plane(j, plane, &spots[i]);
        }
    return done;
}

result input_join_corners(input_draft *d)
{
    const allocator *memory = d->faces.memory;
    join j = {.draft = d,
              .meetings = meeting_set_make(d),
              .order = buffer_make(memory, sizeof(placed)),
              .spots = buffer_make(memory, sizeof(near_spot)),
              .of_plane = buffer_make(memory, sizeof(uint32_t)),
              .own = buffer_make(memory, sizeof(placed)),
              .all_users = buffer_make(memory, sizeof(plane_user)),
              .users = buffer_make(memory, sizeof(uint32_t)),
              .anchors = buffer_make(memory, sizeof(grid_point)),
              .planes = buffer_make(memory, sizeof(plane_ref)),
              .refused = buffer_make(memory, sizeof(refusal))};
    const uint32_t errors = d->report->errors;
    result done = RESULT_OK;
    for (int i = 0; i < ROUNDS_MOST && done == RESULT_OK && (i == 0 || j.changed); ++i) done = join_once(&j);
    buffer *const all[] = {&j.order, &j.spots, &j.of_plane, &j.own, &j.all_users, &j.users, &j.anchors, &j.planes, &j.refused};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) buffer_free(all[i]);
    meeting_set_free(&j.meetings);
    return done != RESULT_OK && d->report->errors == errors ? report_no_memory(d->report, d->path) : done;
}
