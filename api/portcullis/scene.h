// scene.h: the API for applications: a scene of zones under management, culled for any number of views. Strict C11, reads
// as C++17. Link with libportcullis; no OpenGL is needed or opened.
// SPDX-License-Identifier: MIT
//
// CULL_SCENE_API 0 promises nothing yet.
// Threads: [main]  one thread, while no cull_scene_cull of the scene runs (debug builds assert it).
//          [any]   any thread at any time.
//          [view]  any thread, one at a time per view; views of one scene run in parallel.
// Space: world coordinates in double, metres, right-handed, Y up.
// Memory: what is lent is read only and lives as its comment says. cull_scene_cull allocates nothing and cannot fail:
// where a limit bites it draws more, and counts it.
#ifndef PORTCULLIS_SCENE_H
#define PORTCULLIS_SCENE_H

#include "culler.h"

#ifdef __cplusplus
extern "C" {
#endif

#define CULL_SCENE_API 0u
#if defined(_WIN32)
#define CULL_API
#else
#define CULL_API __attribute__((visibility("default")))
#endif

typedef struct cull_scene cull_scene;
typedef struct cull_scene_view cull_scene_view;

// Results are cull_result: CULL_OK, CULL_ERR_MEMORY, CULL_ERR_ZONE for bad data and for zones, doors, items and movers that
// are not there, CULL_ERR_OPTION for arguments: a chain or camera that is refused, a struct_size that this library does
// not know, a reserved field or an unknown flag that is not 0. Each failure gives one line to `log` first and changes nothing.
// Pointers are never NULL but where it says so; a NULL scene or view is a bug of the caller's.
// Growth: structs with a struct_size get new fields at their end only; the library takes every size that a released
// header had, reads no more than it is told and leaves the rest at its default. Others never change.
typedef struct cull_scene_options {
    uint32_t struct_size;              // sizeof(cull_scene_options)
    uint32_t more_movers;              // room for movers that cull_scene_mover_add adds
    const char *chain;                 // of zones whose file names none; NULL: "frustum"
    const char *const *plugin_folders; // looked in before the usual ones
    uint32_t plugin_folder_count, reserved;
    // NULL: stderr. Called from whatever thread calls the library, views' and builders' threads too, also inside a frame.
    void (*log)(void *user, cull_log_level level, const char *line);
    void *user;
} cull_scene_options;

// [any] Reads a .json, .map, .obj, .ply, .off, .stl or .boxes file, loads the cullers that it names and builds them.
// Doors stand as the file says, those of a .map open. options NULL: all zero.
CULL_API cull_result cull_scene_open(const char *path, const cull_scene_options *options, cull_scene **out);
CULL_API void cull_scene_close(cull_scene *scene); // [main] its views too, not its swaps: drop those first; NULL is fine

// ---- What is in it [any] ----
typedef struct cull_scene_info {
    uint32_t struct_size; // sizeof(cull_scene_info), set by the caller
    uint32_t zone_count, portal_count, door_count, item_count, mover_count; // mover_count: the scene's own
    uint32_t mover_capacity;
    double min[3], max[3];
} cull_scene_info;
CULL_API cull_result cull_scene_describe(const cull_scene *scene, cull_scene_info *out);
CULL_API const char *cull_scene_zone_name(const cull_scene *scene, uint32_t zone); // as long as the scene; NULL: no such zone
CULL_API const char *cull_scene_door_name(const cull_scene *scene, uint32_t door);
CULL_API uint32_t cull_scene_find_zone(const cull_scene *scene, const char *name); // UINT32_MAX: none
CULL_API uint32_t cull_scene_find_door(const cull_scene *scene, const char *name);
// Zones that a point or box touches. Writes at most capacity, returns how many there are: of NaN, or of min above max, 0.
CULL_API uint32_t cull_scene_zones_at(const cull_scene *scene, const double point[3], uint32_t *zones, uint32_t capacity);
CULL_API uint32_t cull_scene_zones_of_box(const cull_scene *scene, const double min[3], const double max[3], uint32_t *zones, uint32_t capacity);

// ---- Changes [main] ----
// The present chain of the zone serves until the new one is built, and stays when the new one fails.
CULL_API cull_result cull_scene_set_chain(cull_scene *scene, uint32_t zone, const char *chain);
// The same in two steps: building [any], beside views that are being culled; then putting in place [main]. commit takes
// the swap, whatever it returns (CULL_ERR_OPTION: it is another scene's); drop [main] is for one that is not wanted any more.
typedef struct cull_scene_swap cull_scene_swap;
CULL_API cull_result cull_scene_swap_build(const cull_scene *scene, uint32_t zone, const char *chain, cull_scene_swap **out);
CULL_API cull_result cull_scene_swap_commit(cull_scene *scene, cull_scene_swap *swap);
CULL_API void cull_scene_swap_drop(cull_scene_swap *swap);

CULL_API cull_result cull_scene_set_door(cull_scene *scene, uint32_t door, uint32_t is_open); // is_open: 0 or 1
CULL_API cull_result cull_scene_set_time(cull_scene *scene, double time_s); // the scene's own movers along their paths

// Movers are boxes that the application moves; they may stand in many zones, and jump. Numbers may be used again.
CULL_API cull_result cull_scene_mover_add(cull_scene *scene, const double min[3], const double max[3], uint32_t *out_mover);
CULL_API cull_result cull_scene_mover_move(cull_scene *scene, uint32_t mover, const double min[3], const double max[3]);
CULL_API cull_result cull_scene_mover_remove(cull_scene *scene, uint32_t mover);

// ---- Views ----
CULL_API cull_result cull_scene_view_open(cull_scene *scene, cull_scene_view **out); // [main] a viewer with history of its own
CULL_API void cull_scene_view_close(cull_scene_view *view);                         // [main] before its scene; NULL is fine

typedef struct cull_camera {
    uint32_t struct_size, reserved;   // sizeof(cull_camera), 0
    double eye[3], forward[3], up[3]; // forward, up: need not be unit vectors or perpendicular
    double fovy_deg, aspect;          // aspect: width / height
    double near_m, far_m;             // far_m may be infinite
    uint32_t width_px, height_px;     // 1 .. 65,536
    cull_purpose purpose;
    uint32_t flags; // CULL_VIEW_*
} cull_camera;

typedef struct cull_zone_runs { // what is seen of a zone
    uint32_t zone, run_count;
    const cull_run *runs; // places in the zone's order, see cull_scene_order
} cull_zone_runs;

typedef struct cull_visible {
    uint32_t struct_size;        // sizeof(cull_visible), set by the caller
    uint32_t zone_count, mover_count, reserved;
    const cull_zone_runs *zones; // near to far. An item that several zones list is there once.
                                 // Valid until the view's next frame or the next commit of a chain
    const uint32_t *movers;      // numbers, each once
    // Statistics of the frame.
    double cull_ns;
    uint64_t items;
    uint32_t zones_reached, volumes, portals_tried, portal_merges, limits_hit, faults, movers_tested, steps;
} cull_visible;

// [view] Cullers that ask for box tests or pictures get none here: every test counts as seen. CULL_ERR_OPTION: the camera
// can't be used (a line says why), and *out is empty.
CULL_API cull_result cull_scene_cull(cull_scene_view *view, const cull_camera *camera, cull_visible *out);

// [any, but not while the zone's chain is swapped] The item at each place of the zone's order, zone_item_count of them.
// Changes only with the zone's chain.
CULL_API uint32_t cull_scene_zone_item_count(const cull_scene *scene, uint32_t zone);
CULL_API void cull_scene_order(const cull_scene *scene, uint32_t zone, uint32_t *items);
typedef struct cull_scene_item {
    uint32_t struct_size, reserved; // sizeof(cull_scene_item), set by the caller
    double min[3], max[3]; // world
    uint32_t polygon_count, triangle_count, flags, object; // flags: CULL_ITEM_*
    const char *material;
} cull_scene_item;
CULL_API cull_result cull_scene_item_get(const cull_scene *scene, uint32_t item, cull_scene_item *out);

// [view] Why the item (or mover: item_count + number) was drawn or not in the view's last frame: lines of text. Writes at
// most size bytes with the closing zero, returns the whole length, like snprintf.
CULL_API size_t cull_scene_explain(cull_scene_view *view, uint32_t item, char *text, size_t size);

#ifdef __cplusplus
}
#endif
#endif
