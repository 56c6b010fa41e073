// A culler on its stand: made and built on a scene, in the role that it has, with a host that lends and a list of what it may
// stand behind. And a sitting: one query of it, stepped frame by frame as a host does.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_CHECK_STAND_H
#define PORTCULLIS_HOST_CHECK_STAND_H

#include "sight.h"

typedef enum stand_role { ROLE_SELECT, ROLE_FILTER, ROLE_CROSS } stand_role;
stand_role stand_role_of(const cull_plugin *p); // select where it selects, else filter, else cross

enum { STAND_OPTIONS_MOST = 256 };
typedef struct stand_values { const char *values[STAND_OPTIONS_MOST]; } stand_values;
void stand_defaults(const cull_plugin *p, stand_values *out);
int stand_backface(const cull_plugin *p, const stand_values *values); // 1: its option is set

typedef struct stand {
    const cull_plugin *plugin;
    made_scene *scene;
    lender lender; // the struct must not move
    cull_hierarchy hierarchy; // lent to a filter, over the scene
    cull_node *nodes;
    stand_role role;
    sight_backs backs;
    cull_culler *culler;
    cull_built built;
    const char *fault; // in what it told after build; NULL: none
    uint32_t *own_order;
} stand;

typedef struct stand_request {
    const cull_plugin *plugin;
    const stand_values *values;
    made_scene *scene;
    uint64_t fail_at;   // 0: no allocation fails
    cull_blob blob;     // a baked index; bytes NULL: none
    lender_tasks tasks;
    unsigned char fill; // of new memory; 0: the usual
} stand_request;
// What create and build said. Always close it.
cull_result stand_open(stand *s, const stand_request *q);
void stand_close(stand *s);
static inline uint32_t stand_item(const stand *s, uint32_t place) // of the scene
{
    return s->own_order && place < s->scene->zone.item_count ? s->own_order[place] : place;
}

// ---- Sittings ----

typedef enum sitting_lists {
    LISTS_ROOMY, // pages behind each list may be written: who writes there is found by the check of bounds alone
    LISTS_TIGHT  // a page behind each list stops him
} sitting_lists;

typedef enum sitting_world { // what the host does with tests and captures
    WORLD_PROMPT,  // every test is answered, every capture carried out
    WORLD_CARELESS // answers come late or never, captures fail, slots are emptied
} sitting_world;

enum { SITTING_MOVERS_MOST = 8 };
typedef struct sitting {
    stand *stand;
    cull_query *query;
    fence runs, pictures, tests, captures, clipped, scratch, keep_pictures, keep_captures, keep_clipped, slots, lent_planes, lent_volumes, lent_candidates;
    cull_answer *answers;
    uint32_t answer_count, answer_capacity, frame, run_capacity;
    sitting_world world;
    uint64_t random;
} sitting;
cull_result sitting_open(sitting *t, stand *s, sitting_lists lists);
void sitting_close(sitting *t);

// A frame's answer: what is drawn, in order.
typedef struct sitting_answer {
    uint8_t *drawn;     // by item of the scene and mover
    uint32_t *order;    // items as given, out-of-range ones left out; room for all
    uint32_t order_count, item_count;
    cull_run *runs;     // of the last frame, as given
    uint32_t run_count;
    cull_plane planes[SCENE_PORTALS_MOST * CULL_MAX_PLANES]; // of a crosser
    cull_crossing crossings[SCENE_PORTALS_MOST];
    uint32_t plane_counts[SCENE_PORTALS_MOST];
    char fault[200];    // the first nonsense in what it wrote; empty: none
    uint32_t steps;
} sitting_answer;
void answer_open(sitting_answer *a, const made_scene *s);
void answer_close(sitting_answer *a);
int answers_equal(const sitting_answer *a, const sitting_answer *b); // the same items in the same order, the same planes

typedef struct sitting_hooks { // round each call of a verb; NULL-able
    void (*before)(void *user);
    void (*after)(void *user);
    void *user;
} sitting_hooks;

typedef struct sitting_frame {
    const made_view *view;
    const cull_mover *movers;
    uint32_t mover_count, flags;
    const sitting_hooks *hooks;
} sitting_frame;
void sitting_step(sitting *t, const sitting_frame *f, sitting_answer *out);

#endif
