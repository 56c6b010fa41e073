// Automatic views auto:walk:N: a walker that looks ahead along arcs, prefers where it hasn't been, and turns back along
// its own trail at dead ends. auto:street:N: on the ground under the open sky, a view every few steps. auto:turn:N: the walk
// of one who spins.
// SPDX-License-Identifier: MIT
// Invariant: every step is AUTO_STEP_M long; its middle and its end keep AUTO_CLEARANCE_M from all geometry, so no wall,
// however thin, is walked through (the balls at 0.15 m from one another overlap).
#include "views_auto.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    LOOK_FRAMES = 16, // 4.8 m ahead
    PLAN_FRAMES = 4,  // walked before looking again
    TURNS = 13,       // arcs tried, straight on first
    START_WAYS = 32,  // headings tried where a walk begins
    START_TRIES = 64, STREET_TRIES = 512, // places tried
    STARTS_WALKED = 8, STREETS_WALKED = 32, // of them, for TRIAL_FRAMES each
    TRIAL_FRAMES = 300,
    LEAVE_FRAMES = 12, // free frames that an arc off the trail must have
    PATIENCE_FRAMES = 40, // of going back until a place seen once more often is good enough to leave for
};
static const double PI = 3.14159265358979323846;
static const double ROUNDING_M = 1e-6;       // a step walked may end an ulp beside the one looked at
static const double SLOPE = 0.5;            // metres up or down a metre ahead, only where no level arc is free
static const double CELL_M = 1.5;           // of the memory of where the walker has been
static const double LOOK_TURN_DEG = 6;      // most that the view turns a frame
static const double LOOK_PART = 0.25;       // of the way to the heading that the view turns a frame
static const double PITCH_MOST_DEG = 15, PITCH_TURN_DEG = 0.5;
static const uint32_t PITCH_FRAMES = 50;    // a new pitch is wanted this often
static const uint32_t WHIM_FRAMES = 60;     // a new side is preferred this often
static const uint32_t STREET_STRIDE = 8;    // steps from view to view: 2.4 m, short of what the bench calls a jump
static const double STREET_CLEARANCE_M = 0.5, STREET_RISE_M = 0.3; // at most, a step: stairs
static const double STREET_WIDE_M = 40;     // to what stands beside it
static const double STREET_SPREAD_M = 1;    // of heights where a walk in streets may begin
static const double SPIN_DEG = 15;          // a frame
static const double REGION_MOST_M = 32, REGION_LEAST_M = 4; // how far round a model one may walk

typedef struct visit_cell { int32_t x, y, z; uint32_t count; } visit_cell;

typedef struct arc { double turn, slope, score; int free_frames; } arc;

typedef enum walk_style { WALK_AIR, WALK_STREET, WALK_TURN } walk_style;

typedef struct walker {
    auto_views *a;
    walk_style style;
    double low[3], high[3]; // where it may go
    double clearance;
    double at[3], heading;  // heading of the last step
    double whim;            // turn that it is in the mood for, -1 to 1
    buffer trail;           // eye: from the start to here, without dead ends
    visit_cell *visits;     // open addressing
    uint32_t visit_slots, going_back;
} walker;

// ---- Where it has been ----

static visit_cell *visit_slot(const walker *w, const double at[3])
{
    const visit_cell key = {(int32_t)floor(at[0] / CELL_M), (int32_t)floor(at[1] / CELL_M), (int32_t)floor(at[2] / CELL_M), 0};
    uint32_t slot = (uint32_t)key.x * 0x9e3779b9u ^ (uint32_t)key.y * 0x85ebca6bu ^ (uint32_t)key.z * 0xc2b2ae35u;
    for (slot &= w->visit_slots - 1;; slot = (slot + 1) & (w->visit_slots - 1)) {
        visit_cell *v = &w->visits[slot];
        if (v->count == 0 || (v->x == key.x && v->y == key.y && v->z == key.z)) return v;
    }
}

static uint32_t visit_count(const walker *w, const double at[3])
{
    return visit_slot(w, at)->count;
}

static void visit(walker *w, const double at[3])
{
    visit_cell *v = visit_slot(w, at);
    *v = (visit_cell){(int32_t)floor(at[0] / CELL_M), (int32_t)floor(at[1] / CELL_M), (int32_t)floor(at[2] / CELL_M), v->count + 1};
}

// ---- Looking ahead ----

static int is_free(const walker *w, const double at[3])
{
    for (int k = 0; k < 3; ++k)
        if (at[k] < w->low[k] || at[k] > w->high[k]) return 0;
    return free_space_clearance(w->a->space, at, w->clearance, SPACE_ALL) >= w->clearance;
}

static void step_from(const double from[3], double heading, double slope, double length, double to[3])
{
    const double level = length / sqrt(1 + slope * slope);
    to[0] = from[0] + level * cos(heading);
    to[1] = from[1] + level * slope;
    to[2] = from[2] + level * sin(heading);
}

// To eye height over the ground near below, which boxes alone have none of but the lowest place.
static int is_on_street(const walker *w, double at[3])
{
    const double from[3] = {at[0], at[1] + STREET_RISE_M, at[2]};
    double drop = free_space_ground(w->a->space, from);
    if (isinf(drop) && !w->a->has_meshes) drop = from[1] - w->a->low[1];
    if (!(fabs(drop - STREET_RISE_M - AUTO_EYE_HEIGHT_M) <= STREET_RISE_M)) return 0;
    at[1] = from[1] - drop + AUTO_EYE_HEIGHT_M;
    return 1;
}

static int can_step(const walker *w, const double from[3], double heading, double slope, double to[3])
{
    double middle[3];
    step_from(from, heading, slope, AUTO_STEP_M / 2, middle);
    step_from(from, heading, slope, AUTO_STEP_M, to);
    if (w->style == WALK_STREET && !(is_on_street(w, middle) && is_on_street(w, to))) return 0;
    return is_free(w, middle) && is_free(w, to);
}

static arc look_along(const walker *w, double heading, double turn, double slope)
{
    arc found = {.turn = turn, .slope = slope};
    double at[3], to[3];
    memcpy(at, w->at, sizeof at);
    for (; found.free_frames < LOOK_FRAMES; ++found.free_frames) {
        heading += turn;
        if (!can_step(w, at, heading, slope, to)) break;
        memcpy(at, to, sizeof at);
    }
    const double seen = visit_count(w, at);
    found.score = (double)found.free_frames / LOOK_FRAMES - 0.6 * seen / (seen + 3) - 0.3 * fabs(turn) + 0.2 * turn * w->whim;
    return found;
}

static double turn_of(int i)
{
    static const double degrees[TURNS] = {0, 1, -1, 2.5, -2.5, 5, -5, 8, -8, 12, -12, 18, -18};
    return degrees[i] * (PI / 180);
}

typedef enum grade { GRADE_LEVEL, GRADE_SLOPED } grade;

// The best arc of at least `least` free frames; free_frames 0: there is none.
static arc best_arc(const walker *w, int least, grade g)
{
    arc best = {0};
    for (int s = -1; s <= 1; ++s) {
        if ((s == 0) != (g == GRADE_LEVEL)) continue;
        for (int t = 0; t < TURNS; ++t) {
            const arc found = look_along(w, w->heading, turn_of(t), s * SLOPE);
            if (found.free_frames < least) continue;
            if (!best.free_frames || found.score > best.score) best = found;
        }
    }
    return best;
}

// ---- Steps ----

static result arrive(walker *w, const double to[3])
{
    eye e;
    memcpy(e.at, to, sizeof e.at);
    memcpy(w->at, to, sizeof w->at);
    if (!buffer_append(&w->trail, &e, 1)) return RESULT_NO_MEMORY;
    visit(w, to);
    return RESULT_OK;
}

static double heading_to(const double from[3], const double to[3], double otherwise)
{
    const double x = to[0] - from[0], z = to[2] - from[2];
    return x * x + z * z > 0 ? atan2(z, x) : otherwise;
}

static void go_back(walker *w)
{
    const eye *trail = w->trail.items;
    const eye to = trail[w->trail.count - 2];
    w->heading = heading_to(w->at, to.at, w->heading);
    memcpy(w->at, to.at, sizeof w->at);
    visit(w, w->at);
    w->trail.count--;
    w->going_back++;
}

static arc choose_start(const walker *w, double *out_heading)
{
    arc best = {0};
    for (int i = 0; i < START_WAYS; ++i) {
        const double heading = w->heading + i * (2 * PI / START_WAYS);
        const arc found = look_along(w, heading, 0, 0);
        if (!found.free_frames || (best.free_frames && found.score <= best.score)) continue;
        best = found;
        *out_heading = heading;
    }
    return best;
}

// Going back, an arc is good when it leads where the walker has been seldom; the longer it goes back the less seldom.
static arc choose_way_off(const walker *w)
{
    const double seen = 3.0 * (w->going_back / PATIENCE_FRAMES);
    for (int g = GRADE_LEVEL; g <= GRADE_SLOPED; ++g) {
        const arc found = best_arc(w, LEAVE_FRAMES, (grade)g);
        const double wanted = (double)found.free_frames / LOOK_FRAMES - 0.6 * seen / (seen + 3) - 0.1;
        if (found.free_frames && found.score >= wanted) return found;
    }
    return (arc){0};
}

static arc choose_way_on(const walker *w)
{
    const arc level = best_arc(w, PLAN_FRAMES, GRADE_LEVEL);
    return level.free_frames ? level : best_arc(w, PLAN_FRAMES, GRADE_SLOPED);
}

// The next arc to walk. free_frames 0: one step back along the trail instead.
static arc plan(walker *w)
{
    if (w->trail.count <= 1) {
        w->going_back = 0;
        arc start = choose_start(w, &w->heading);
        if (!start.free_frames) start.free_frames = 1; // shut in on all sides, which no scene that was tried is: go all the same
        return start;
    }
    const arc found = w->going_back ? choose_way_off(w) : choose_way_on(w);
    if (found.free_frames) w->going_back = 0;
    return found;
}

// ---- Cameras along the way ----

typedef struct gaze { double yaw, pitch, pitch_speed, pitch_wanted; } gaze;

static double turned_towards(double from, double to, double part, double most)
{
    const double way = remainder(to - from, 2 * PI);
    return from + fmax(-most, fmin(most, part * way));
}

static void turn_gaze(walker *w, gaze *g, uint32_t frame)
{
    g->yaw = turned_towards(g->yaw, w->heading, LOOK_PART, LOOK_TURN_DEG * (PI / 180));
    if (frame % PITCH_FRAMES == 0) g->pitch_wanted = random_between(&w->a->random, -PITCH_MOST_DEG, PITCH_MOST_DEG) * (PI / 180);
    if (frame % WHIM_FRAMES == 0) w->whim = random_between(&w->a->random, -1, 1);
    const double wanted = fmax(-1, fmin(1, (g->pitch_wanted - g->pitch) * 4)) * PITCH_TURN_DEG * (PI / 180);
    g->pitch_speed += 0.2 * (wanted - g->pitch_speed);
    const double most = PITCH_MOST_DEG * (PI / 180);
    g->pitch = fmax(-most, fmin(most, g->pitch + g->pitch_speed));
}

typedef struct way { arc along; int left; } way; // frames of it still to walk

static result walk_frame(walker *w, way *on)
{
    if (on->left == 0) {
        on->along = plan(w);
        on->left = on->along.free_frames < PLAN_FRAMES ? on->along.free_frames : PLAN_FRAMES;
    }
    if (on->left == 0) {
        go_back(w);
        return RESULT_OK;
    }
    double to[3];
    w->heading = remainder(w->heading + on->along.turn, 2 * PI);
    step_from(w->at, w->heading, on->along.slope, AUTO_STEP_M, to);
    if (w->style == WALK_STREET) is_on_street(w, to);
    on->left--;
    return arrive(w, to);
}

static uint32_t stride_of(walk_style style)
{
    return style == WALK_STREET ? STREET_STRIDE : 1;
}

static result walk(walker *w, uint32_t count, camera *cameras)
{
    const uint32_t stride = stride_of(w->style);
    gaze g = {.yaw = w->heading};
    way on = {0};
    result done = RESULT_OK;
    for (uint32_t frame = 0; frame < count * stride && done == RESULT_OK; ++frame) {
        turn_gaze(w, &g, frame);
        if (w->style == WALK_TURN) g.yaw = remainder(frame * SPIN_DEG * (PI / 180), 2 * PI);
        if (frame % stride == 0) cameras[frame / stride] = auto_camera(w->a, w->at, g.yaw, g.pitch);
        done = walk_frame(w, &on);
    }
    return done;
}

// ---- Where to begin ----

static void bound_region(walker *w)
{
    const auto_views *a = w->a;
    double widest = 0;
    for (int k = 0; k < 3; ++k) widest = fmax(widest, a->high[k] - a->low[k]);
    const double margin = a->scene->is_map || auto_is_ground(a) ? 0 : fmax(REGION_LEAST_M, fmin(REGION_MOST_M, widest / 4));
    for (int k = 0; k < 3; ++k) {
        w->low[k] = a->low[k] - margin;
        w->high[k] = a->high[k] + margin;
    }
}

// Models: anywhere around, at eye height over the lowest place, or half way up what is lower than a person.
static eye start_of(walker *w, uint32_t i)
{
    auto_views *a = w->a;
    if (a->places.count) return ((const eye *)a->places.items)[i % a->places.count];
    if (a->scene->is_map) return auto_spread_eye(a, i);
    if (auto_is_ground(a)) return auto_spread_eye(a, 0); // on it
    eye e;
    for (int k = 0; k < 3; ++k) e.at[k] = random_between(&a->random, w->low[k], w->high[k]);
    e.at[1] = fmin(a->low[1] + AUTO_EYE_HEIGHT_M, (a->low[1] + a->high[1]) / 2);
    return e;
}

static result begin(walker *w, const eye *e, double heading)
{
    memset(w->visits, 0, w->visit_slots * sizeof *w->visits);
    w->trail.count = 0;
    w->going_back = 0;
    w->heading = heading;
    w->whim = 0;
    return arrive(w, e->at);
}

// Of the four ways along the axes, how many soon end at something; at the edge of all, where one leads out, none counts.
static uint32_t sides_near(const walker *w)
{
    uint32_t sides = 0;
    for (int axis = 0; axis < 3; axis += 2)
        for (int sign = -1; sign <= 1; sign += 2) {
            const double free_m = free_space_along(w->a->space, w->at, (axis_ray){axis, sign});
            if (isinf(free_m)) return 0;
            sides += free_m < STREET_WIDE_M;
        }
    return sides;
}

// How many cells a walk from here would see; in streets how much would stand beside it.
static result try_start(walker *w, const eye *e, double heading, uint32_t frames, uint32_t *out_score)
{
    way on = {0};
    uint32_t sides = 0, cells = 0;
    result done = begin(w, e, heading);
    for (uint32_t frame = 0; frame < frames && done == RESULT_OK; ++frame) {
        done = walk_frame(w, &on);
        if (w->style == WALK_STREET) sides += sides_near(w);
    }
    for (uint32_t i = 0; i < w->visit_slots; ++i) cells += w->visits[i].count != 0;
    *out_score = w->style == WALK_STREET ? (uint32_t)((uint64_t)sides * cells / (frames + 1)) + 1 : cells;
    return done;
}

static int is_start(const walker *w, const eye *e)
{
    double at[3] = {e->at[0], e->at[1], e->at[2]};
    if (!is_free(w, e->at) || (!w->a->scene->is_map && free_space_is_enclosed(w->a->space, e->at))) return 0;
    return w->style != WALK_STREET || (isinf(free_space_along(w->a->space, e->at, (axis_ray){1, 1})) && is_on_street(w, at));
}

static int lower_first(const void *left, const void *right)
{
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

// Roofs are ground, too, with sky over it: a street is low. INFINITY where it does not matter.
static double highest_start(walker *w)
{
    double heights[STREET_TRIES];
    uint32_t count = 0;
    for (uint32_t i = 0; w->style == WALK_STREET && i < STREET_TRIES; ++i) {
        const eye e = start_of(w, i);
        if (is_start(w, &e)) heights[count++] = e.at[1];
    }
    if (!count) return INFINITY;
    qsort(heights, count, sizeof *heights, lower_first);
    return heights[count / 2] + STREET_SPREAD_M;
}

// Of the first good places the one from where most is to be seen: many lie in niches. *out_score 0: no place is free.
static result find_start(walker *w, uint32_t frames, eye *out, double *out_heading, uint32_t *out_score)
{
    const double highest = highest_start(w);
    const uint32_t tries = w->style == WALK_STREET ? STREET_TRIES : START_TRIES, wanted = w->style == WALK_STREET ? STREETS_WALKED : STARTS_WALKED;
    uint32_t good = 0;
    for (uint32_t i = 0; i < tries && good < wanted; ++i) {
        const eye e = start_of(w, i);
        const double heading = random_between(&w->a->random, -PI, PI);
        if (e.at[1] > highest || !is_start(w, &e)) continue;
        uint32_t score;
        const result done = try_start(w, &e, heading, frames, &score);
        if (done != RESULT_OK) return done;
        ++good;
        if (score <= *out_score) continue;
        *out_score = score;
        *out = e;
        *out_heading = heading;
    }
    return RESULT_OK;
}

// No place within is free: beside the scene there is room.
static eye start_beside(walker *w)
{
    const auto_views *a = w->a;
    for (int k = 0; k < 3; ++k) w->low[k] = a->low[k] - REGION_LEAST_M;
    for (int k = 0; k < 3; ++k) w->high[k] = a->high[k] + REGION_LEAST_M;
    report_note(a->report, "%s: no room to walk in; the walk begins beside the scene", a->scene->path);
    return (eye){{a->low[0] - REGION_LEAST_M / 2, (a->low[1] + a->high[1]) / 2, (a->low[2] + a->high[2]) / 2}};
}

static result walk_from_best(walker *w, uint32_t count, camera *cameras)
{
    bound_region(w);
    eye start;
    double heading = 0;
    uint32_t score = 0;
    const uint64_t frames = (uint64_t)count * stride_of(w->style);
    result done = find_start(w, frames < TRIAL_FRAMES ? (uint32_t)frames : TRIAL_FRAMES, &start, &heading, &score);
    if (done == RESULT_OK && score == 0 && w->style == WALK_STREET)
        return report_error(w->a->report, w->a->scene->path, 0, "no place on the ground under the open sky has room to walk; use auto:walk:%u", count);
    if (done == RESULT_OK && score == 0) start = start_beside(w);
    if (done == RESULT_OK) done = begin(w, &start, heading);
    return done == RESULT_OK ? walk(w, count, cameras) : done;
}

static result make(auto_views *a, walk_style style, uint32_t count, camera *cameras)
{
    walker w = {.a = a, .style = style, .clearance = (style == WALK_STREET ? STREET_CLEARANCE_M : AUTO_CLEARANCE_M) + ROUNDING_M,
                .trail = buffer_make(a->memory, sizeof(eye)), .visit_slots = 1024};
    while (w.visit_slots < 2 * ((uint64_t)count * stride_of(style) + 2)) w.visit_slots *= 2;
    w.visits = memory_alloc_zeroed(a->memory, w.visit_slots, sizeof *w.visits);
    const result done = w.visits ? walk_from_best(&w, count, cameras) : RESULT_NO_MEMORY;
    memory_free(a->memory, w.visits, w.visit_slots, sizeof *w.visits);
    buffer_free(&w.trail);
    return done == RESULT_NO_MEMORY ? report_no_memory(a->report, a->scene->path) : done;
}

result auto_walk_make(auto_views *a, uint32_t count, camera *cameras)
{
    return make(a, WALK_AIR, count, cameras);
}

result auto_street_make(auto_views *a, uint32_t count, camera *cameras)
{
    return make(a, WALK_STREET, count, cameras);
}

result auto_turn_make(auto_views *a, uint32_t count, camera *cameras)
{
    return make(a, WALK_TURN, count, cameras);
}
