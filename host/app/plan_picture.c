// Plans: floors filled from above into a picture with a height at each pixel, then edges between zones, then portals' outlines.
// SPDX-License-Identifier: MIT
#include "plan_picture.h"

#include "../render/render.h"

#include <math.h>
#include <string.h>

enum { LONG_SIDE_PX = 1600, MARGIN_PX = 24, PORTAL_WIDTH_PX = 2 };
static const double FLOOR_SLOPE = 0.5;     // least height of a floor's unit normal: steeper is a wall
static const double LEDGE_M = 0.3;         // a step of so much between two pixels is drawn as an edge
static const double EDGE_DIMMED = 0.55;
static const double LOWEST_BRIGHTNESS = 0.45;
static const double HUE_STEP = 0.61803398874989485; // the golden ratio's: neighbours in number are far apart in hue

typedef struct plan {
    const scene *scene;
    double low[3], high[3]; // of the floors
    double px_a_metre;
    uint32_t width, height;
    float *heights;  // by pixel; -INFINITY: no floor
    uint32_t *zones; // by pixel
    uint8_t *rgba;
} plan;

// x to the right, z down.
static void to_picture(const plan *p, const double at[3], double out[2])
{
    out[0] = (at[0] - p->low[0]) * p->px_a_metre + MARGIN_PX;
    out[1] = (at[2] - p->low[2]) * p->px_a_metre + MARGIN_PX;
}

static void corner_at(const scene *s, uint32_t index, double out[3])
{
    const cull_vec3 v = s->positions[s->indices[index]];
    const double at[3] = {(double)v.x, (double)v.y, (double)v.z};
    for (int k = 0; k < 3; ++k) out[k] = s->whole.origin[k] + at[k];
}

static int is_floor(double corners[3][3])
{
    double u[3], v[3];
    for (int k = 0; k < 3; ++k) u[k] = corners[1][k] - corners[0][k], v[k] = corners[2][k] - corners[0][k];
    const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    return n[1] > FLOOR_SLOPE * sqrt((n[0] * n[0] + n[1] * n[1]) + n[2] * n[2]);
}

// ---- Floors ----

typedef void floor_visit(plan *p, uint32_t zone, double corners[3][3]);

static void each_floor(plan *p, floor_visit *visit)
{
    const scene *s = p->scene;
    for (uint32_t z = 0; z < s->zone_count; ++z)
        for (uint32_t i = 0; i < s->zones[z].item_count; ++i) {
            const scene_item *item = &s->items[s->zone_items[s->zones[z].first_item + i]];
            for (uint32_t t = 0; t < item->index_count; t += 3) {
                double corners[3][3];
                for (uint32_t k = 0; k < 3; ++k) corner_at(s, item->first_index + t + k, corners[k]);
                if (is_floor(corners)) visit(p, z, corners);
            }
        }
}

static void measure(plan *p, uint32_t zone, double corners[3][3])
{
    (void)zone;
    for (int c = 0; c < 3; ++c)
        for (int k = 0; k < 3; ++k) {
            p->low[k] = fmin(p->low[k], corners[c][k]);
            p->high[k] = fmax(p->high[k], corners[c][k]);
        }
}

static uint32_t clamp_px(double x, uint32_t most)
{
    return x <= 0 ? 0 : x >= most ? most : (uint32_t)x;
}

static void fill(plan *p, uint32_t zone, double corners[3][3])
{
    double at[3][2], low[2] = {INFINITY, INFINITY}, high[2] = {0, 0};
    for (int c = 0; c < 3; ++c) {
        to_picture(p, corners[c], at[c]);
        for (int k = 0; k < 2; ++k) low[k] = fmin(low[k], at[c][k]), high[k] = fmax(high[k], at[c][k]);
    }
    const double area = (at[1][0] - at[0][0]) * (at[2][1] - at[0][1]) - (at[1][1] - at[0][1]) * (at[2][0] - at[0][0]);
    if (area == 0) return;
    const uint32_t right = clamp_px(high[0] + 1, p->width), below = clamp_px(high[1] + 1, p->height);
    for (uint32_t y = clamp_px(low[1], p->height); y < below; ++y)
        for (uint32_t x = clamp_px(low[0], p->width); x < right; ++x) {
            const double dx = x + 0.5 - at[0][0], dy = y + 0.5 - at[0][1];
            const double b = (dx * (at[2][1] - at[0][1]) - dy * (at[2][0] - at[0][0])) / area, c = (dy * (at[1][0] - at[0][0]) - dx * (at[1][1] - at[0][1])) / area;
            if (b < 0 || c < 0 || b + c > 1) continue;
            const float height = (float)(corners[0][1] + b * (corners[1][1] - corners[0][1]) + c * (corners[2][1] - corners[0][1]));
            const size_t pixel = (size_t)y * p->width + x;
            if (height <= p->heights[pixel]) continue;
            p->heights[pixel] = height;
            p->zones[pixel] = zone;
        }
}

// ---- Colours ----

static void put(plan *p, size_t pixel, const double colour[3])
{
    for (int k = 0; k < 3; ++k) p->rgba[4 * pixel + (size_t)k] = (uint8_t)(fmin(fmax(colour[k], 0), 1) * 255);
    p->rgba[4 * pixel + 3] = 255;
}

static void zone_colour(uint32_t zone, double brightness, double out[3])
{
    const double hue = 6 * fmod(zone * HUE_STEP, 1), pale = 0.3;
    for (int k = 0; k < 3; ++k) {
        const double from = fabs(fmod(hue + 4.0 - 2 * k + 6, 6) - 3) - 1;
        out[k] = brightness * (pale + (1 - pale) * fmin(fmax(from, 0), 1));
    }
}

static int is_edge(const plan *p, size_t pixel, size_t next)
{
    return p->zones[pixel] != p->zones[next] || fabs((double)p->heights[pixel] - (double)p->heights[next]) > LEDGE_M;
}

static void colour_floors(plan *p)
{
    const double tall = fmax(p->high[1] - p->low[1], 1e-6);
    static const double ground[3] = {0.08, 0.08, 0.1};
    for (uint32_t y = 0; y < p->height; ++y)
        for (uint32_t x = 0; x < p->width; ++x) {
            const size_t pixel = (size_t)y * p->width + x;
            put(p, pixel, ground);
            if (p->zones[pixel] == SCENE_NONE) continue;
            const int edge = (x + 1 < p->width && is_edge(p, pixel, pixel + 1)) || (y + 1 < p->height && is_edge(p, pixel, pixel + p->width));
            const double share = ((double)p->heights[pixel] - p->low[1]) / tall;
            double colour[3];
            zone_colour(p->zones[pixel], (LOWEST_BRIGHTNESS + (1 - LOWEST_BRIGHTNESS) * share) * (edge ? EDGE_DIMMED : 1), colour);
            put(p, pixel, colour);
        }
}

// ---- Portals ----

static void line(plan *p, const double from[2], const double to[2], const double colour[3])
{
    const double length = fmax(fabs(to[0] - from[0]), fabs(to[1] - from[1]));
    const uint32_t steps = clamp_px(length, 2 * LONG_SIDE_PX) + 1;
    for (uint32_t i = 0; i <= steps; ++i)
        for (uint32_t w = 0; w < PORTAL_WIDTH_PX * PORTAL_WIDTH_PX; ++w) {
            const uint32_t x = clamp_px(from[0] + (to[0] - from[0]) * i / steps, p->width) + w % PORTAL_WIDTH_PX;
            const uint32_t y = clamp_px(from[1] + (to[1] - from[1]) * i / steps, p->height) + w / PORTAL_WIDTH_PX;
            if (x < p->width && y < p->height) put(p, (size_t)y * p->width + x, colour);
        }
}

static void draw_portals(plan *p)
{
    static const double plain[3] = {1, 1, 1}, door[3] = {1, 0.9, 0.2};
    const scene *s = p->scene;
    for (uint32_t i = 0; i < s->portal_count; ++i) {
        const scene_portal *portal = &s->portals[i];
        for (uint32_t k = 0; k < portal->point_count; ++k) {
            double ends[2][2];
            for (uint32_t e = 0; e < 2; ++e) to_picture(p, s->portal_points[portal->first_point + (k + e) % portal->point_count], ends[e]);
            line(p, ends[0], ends[1], portal->door == SCENE_NONE ? plain : door);
        }
    }
}

// ---- All of it ----

static result draw(plan *p, const char *path, const allocator *memory, report *r)
{
    const size_t pixels = (size_t)p->width * p->height;
    p->heights = memory_alloc(memory, pixels, sizeof *p->heights);
    p->zones = memory_alloc(memory, pixels, sizeof *p->zones);
    p->rgba = memory_alloc(memory, pixels, 4);
    result done = p->heights && p->zones && p->rgba ? RESULT_OK : report_no_memory(r, path);
    for (size_t i = 0; i < pixels && done == RESULT_OK; ++i) {
        p->heights[i] = -INFINITY;
        p->zones[i] = SCENE_NONE;
    }
    if (done == RESULT_OK) {
        each_floor(p, fill);
        colour_floors(p);
        draw_portals(p);
        done = png_write(path, p->rgba, p->width, p->height, r);
    }
    memory_free(memory, p->heights, pixels, sizeof *p->heights);
    memory_free(memory, p->zones, pixels, sizeof *p->zones);
    memory_free(memory, p->rgba, pixels, 4);
    return done;
}

result plan_picture_write(const scene *s, const char *path, const allocator *memory, report *r)
{
    plan p = {.scene = s, .low = {INFINITY, INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY, -INFINITY}};
    each_floor(&p, measure);
    const double wide = p.high[0] - p.low[0], deep = p.high[2] - p.low[2], side = fmax(wide, deep);
    if (!(side > 0)) return report_error(r, path, 0, "a plan shows floors, and the scene has none; leave it out");
    p.px_a_metre = (LONG_SIDE_PX - 2 * MARGIN_PX) / side;
    p.width = (uint32_t)(wide * p.px_a_metre) + 2 * MARGIN_PX + 1;
    p.height = (uint32_t)(deep * p.px_a_metre) + 2 * MARGIN_PX + 1;
    return draw(&p, path, memory, r);
}
