// Automatic views auto:walk:N: a walker that looks ahead along arcs, prefers where it hasn't been, and turns back along
// its own trail at dead ends. auto:street:N: on the ground under the open sky, a view every few steps. auto:drive:N: there in a
// car. auto:turn:N: the walk of one who spins.
// SPDX-License-Identifier: MIT
// Invariant: every step is gait.step_m long; its middle and its end keep gait.clearance_m from all geometry, so no wall,
// however thin, is walked through (the balls at half a step from one another overlap).
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
static const double PITCH_MOST_DEG = 15, PITCH_TURN_DEG = 0.5;
static const uint32_t PITCH_FRAMES = 50;    // a new pitch is wanted this often
static const uint32_t WHIM_FRAMES = 60;     // a new side is preferred this often
static const double STREET_WIDE_M = 40;     // to what stands beside it
static const double STREET_SPREAD_M = 1;    // of heights where a walk in streets may begin
static const double REGION_MOST_M = 32, REGION_LEAST_M = 4; // how far round a model one may walk

typedef struct visit_cell { int32_t x, y, z; uint32_t count; } visit_cell;

typedef struct arc { double turn, slope, score; int free_frames; } arc;

typedef enum gait_ground { IN_AIR, ON_GROUND } gait_ground;
typedef enum gait_back { BACK_TURNED, BACK_REVERSING } gait_back; // where one looks who goes back: that way, or as before

typedef struct gait {
    gait_ground ground;
    gait_back back;
    uint32_t stride;      // steps from view to view
    double step_m, clearance_m;
    double eye_m, rise_m; // over the ground; up or down at most, half a step
    double sharpness;     // of its turns, by a walker's
    double cell_m;        // of the memory of where it has been
    double look_turn_deg, look_part; // most that the view turns a frame; of the way to the heading
    double spin_deg;      // a frame; 0: looks where it goes
} gait;

// A street's views stand 2.4 m apart, short of what the bench calls a jump; its rise is that of stairs.
static const gait WALK = {IN_AIR, BACK_TURNED, 1, AUTO_STEP_M, AUTO_CLEARANCE_M, AUTO_EYE_HEIGHT_M, 0, 1, 1.5, 6, 0.25, 0};
static const gait TURN = {IN_AIR, BACK_TURNED, 1, AUTO_STEP_M, AUTO_CLEARANCE_M, AUTO_EYE_HEIGHT_M, 0, 1, 1.5, 6, 0.25, 15};
static const gait STREET = {ON_GROUND, BACK_TURNED, 8, AUTO_STEP_M, 0.5, AUTO_EYE_HEIGHT_M, 0.3, 1, 1.5, 6, 0.25, 0};
// 1 m a view is 30 m/s at the bench's 30 views a second. Turns of at most 9 degrees a metre: a radius of 6.4 m. A kerb's rise, or a slope of 0.4.
static const gait DRIVE = {ON_GROUND, BACK_REVERSING, 1, AUTO_DRIVE_STEP_M, 0.75, AUTO_CAR_EYE_HEIGHT_M, 0.2, 0.5, 5, 3, 0.2, 0};

typedef struct walker {
    auto_views *a;
    gait gait;
    double low[3], high[3]; // where it may go
    double clearance;       // the gait's, and what rounding takes
    double at[3], heading;  // heading of the last step
    double whim;            // turn that it is in the mood for, -1 to 1
    buffer trail;           // eye: from the start to here, without dead ends
    visit_cell *visits;     // open addressing
    uint32_t visit_slots, going_back;
} walker;

// ---- Where it has been ----

static visit_cell *visit_slot(const walker *w, const double at[3])
{
    const double cell_m = w->gait.cell_m;
    const visit_cell key = {(int32_t)floor(at[0] / cell_m), (int32_t)floor(at[1] / cell_m), (int32_t)floor(at[2] / cell_m), 0};
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
    const double cell_m = w->gait.cell_m;
    visit_cell *v = visit_slot(w, at);
    *v = (visit_cell){(int32_t)floor(at[0] / cell_m), (int32_t)floor(at[1] / cell_m), (int32_t)floor(at[2] / cell_m), v->count + 1};
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
    const gait *g = &w->gait;
    const double from[3] = {at[0], at[1] + g->rise_m, at[2]};
    double drop = free_space_ground(w->a->space, from);
    if (isinf(drop) && !w->a->has_meshes) drop = from[1] - w->a->low[1];
    if (!(fabs(drop - g->rise_m - g->eye_m) <= g->rise_m)) return 0;
    at[1] = from[1] - drop + g->eye_m;
    return 1;
}

static int can_step(const walker *w, const double from[3], double heading, double slope, double to[3])
{
    double middle[3];
    step_from(from, heading, slope, w->gait.step_m / 2, middle);
    step_from(from, heading, slope, w->gait.step_m, to);
    if (w->gait.ground == ON_GROUND && !(is_on_street(w, middle) && is_on_street(w, to))) return 0;
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

static double turn_of(const walker *w, int i)
{
    static const double degrees[TURNS] = {0, 1, -1, 2.5, -2.5, 5, -5, 8, -8, 12, -12, 18, -18};
    return degrees[i] * w->gait.sharpness * (PI / 180);
}

typedef enum grade { GRADE_LEVEL, GRADE_SLOPED } grade;

// The best arc of at least `least` free frames; free_frames 0: there is none.
static arc best_arc(const walker *w, int least, grade g)
{
    arc best = {0};
    for (int s = -1; s <= 1; ++s) {
        if ((s == 0) != (g == GRADE_LEVEL)) continue;
        for (int t = 0; t < TURNS; ++t) {
            const arc found = look_along(w, w->heading, turn_of(w, t), s * SLOPE);
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
    const gait *way = &w->gait;
    const double behind = w->going_back && way->back == BACK_REVERSING ? PI : 0;
    g->yaw = turned_towards(g->yaw, w->heading + behind, way->look_part, way->look_turn_deg * (PI / 180));
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
    step_from(w->at, w->heading, on->along.slope, w->gait.step_m, to);
    if (w->gait.ground == ON_GROUND) is_on_street(w, to);
    on->left--;
    return arrive(w, to);
}

static result walk(walker *w, uint32_t count, camera *cameras)
{
    const uint32_t stride = w->gait.stride;
    gaze g = {.yaw = w->heading};
    way on = {0};
    result done = RESULT_OK;
    for (uint32_t frame = 0; frame < count * stride && done == RESULT_OK; ++frame) {
        turn_gaze(w, &g, frame);
        if (w->gait.spin_deg > 0) g.yaw = remainder(frame * w->gait.spin_deg * (PI / 180), 2 * PI);
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
static eye place_of(walker *w, uint32_t i)
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

static eye start_of(walker *w, uint32_t i)
{
    eye e = place_of(w, i);
    e.at[1] += w->gait.eye_m - AUTO_EYE_HEIGHT_M;
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
        if (w->gait.ground == ON_GROUND) sides += sides_near(w);
    }
    for (uint32_t i = 0; i < w->visit_slots; ++i) cells += w->visits[i].count != 0;
    *out_score = w->gait.ground == ON_GROUND ? (uint32_t)((uint64_t)sides * cells / (frames + 1)) + 1 : cells;
    return done;
}

static int is_start(const walker *w, const eye *e)
{
    double at[3] = {e->at[0], e->at[1], e->at[2]};
    if (!is_free(w, e->at) || (!w->a->scene->is_map && free_space_is_enclosed(w->a->space, e->at))) return 0;
    return w->gait.ground == IN_AIR || (isinf(free_space_along(w->a->space, e->at, (axis_ray){1, 1})) && is_on_street(w, at));
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
    for (uint32_t i = 0; w->gait.ground == ON_GROUND && i < STREET_TRIES; ++i) {
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
    const int on_ground = w->gait.ground == ON_GROUND;
    const uint32_t tries = on_ground ? STREET_TRIES : START_TRIES, wanted = on_ground ? STREETS_WALKED : STARTS_WALKED;
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
    const uint64_t frames = (uint64_t)count * w->gait.stride;
    result done = find_start(w, frames < TRIAL_FRAMES ? (uint32_t)frames : TRIAL_FRAMES, &start, &heading, &score);
    if (done == RESULT_OK && score == 0 && w->gait.ground == ON_GROUND)
        return report_error(w->a->report, w->a->scene->path, 0, "no place on the ground under the open sky has room to %s; use auto:walk:%u",
                            w->gait.back == BACK_REVERSING ? "drive" : "walk", count);
    if (done == RESULT_OK && score == 0) start = start_beside(w);
    if (done == RESULT_OK) done = begin(w, &start, heading);
    return done == RESULT_OK ? walk(w, count, cameras) : done;
}

static result make(auto_views *a, const gait *g, uint32_t count, camera *cameras)
{
    walker w = {.a = a, .gait = *g, .clearance = g->clearance_m + ROUNDING_M, .trail = buffer_make(a->memory, sizeof(eye)), .visit_slots = 1024};
    while (w.visit_slots < 2 * ((uint64_t)count * g->stride + 2)) w.visit_slots *= 2;
    w.visits = memory_alloc_zeroed(a->memory, w.visit_slots, sizeof *w.visits);
    const result done = w.visits ? walk_from_best(&w, count, cameras) : RESULT_NO_MEMORY;
    memory_free(a->memory, w.visits, w.visit_slots, sizeof *w.visits);
    buffer_free(&w.trail);
    return done == RESULT_NO_MEMORY ? report_no_memory(a->report, a->scene->path) : done;
}

result auto_walk_make(auto_views *a, uint32_t count, camera *cameras)
{
    return make(a, &WALK, count, cameras);
}

result auto_street_make(auto_views *a, uint32_t count, camera *cameras)
{
    return make(a, &STREET, count, cameras);
}

result auto_drive_make(auto_views *a, uint32_t count, camera *cameras)
{
    return make(a, &DRIVE, count, cameras);
}

result auto_turn_make(auto_views *a, uint32_t count, camera *cameras)
{
    return make(a, &TURN, count, cameras);
}
