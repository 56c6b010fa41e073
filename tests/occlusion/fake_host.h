// A host for tests of occlusion: it casts a ray a pixel at the boxes of a zone, draws what a culler says into a depth of its own,
// and answers box tests from that: at once, late, in part, in disorder.
// SPDX-License-Identifier: MIT
#ifndef TESTS_OCCLUSION_FAKE_HOST_H
#define TESTS_OCCLUSION_FAKE_HOST_H

#include "tests/common/culler_host.h"
#include "tests/common/hand_zone.h"
#include "tests/common/random.h"
#include "tests/frustum/fixture.h"

enum { FAKE_PICTURES_MOST = 64 };
enum { FAKE_WIDTH = 64, FAKE_HEIGHT = 36, FAKE_PIXELS = FAKE_WIDTH * FAKE_HEIGHT, FAKE_MOVERS_MOST = 32 };

typedef struct fake_view {
    cull_view view;
    cull_plane planes[2][5]; // the picture's sides; of its two halves when it is seen through two volumes
    cull_volume volumes[2];
    uint32_t volume_count;
    double rays[FAKE_PIXELS][3];
} fake_view;
// Looks along (sin yaw, pitch, cos yaw), roughly.
void fake_view_make(fake_view *v, cull_vec3 eye, double yaw, double pitch);
void fake_view_halve(fake_view *v); // the same picture through two volumes, left and right

typedef enum fake_answers { ANSWERS_ALL, ANSWERS_SOME_LOST, ANSWERS_NONE, ANSWERS_SHUFFLED } fake_answers;
typedef enum fake_chain { CHAIN_SELECT, CHAIN_LENT, CHAIN_CANDIDATES } fake_chain;

typedef struct fake_culler { // one culler and the zone it was built for
    const cull_plugin *plugin;
    const hand_zone *zone;
    culler_host host;
    cull_culler *culler;
    cull_built built;
    cull_hierarchy lent;
    cull_node *nodes;
    fake_chain chain;
} fake_culler;
// method: the option's value, or "METHOD KEY=VALUE ...". Returns what create or build said; then there is nothing to close.
cull_result fake_culler_open(fake_culler *c, const hand_zone *zone, const char *method, fake_chain chain, uint64_t fail_at);
void fake_culler_close(fake_culler *c);

typedef struct fake_late { cull_answer answer; uint32_t asked_frame, ready_frame, ready_clock; } fake_late;
typedef struct fake_viewer { // one query
    fake_culler *c;
    cull_query *query;
    cull_run *runs;
    cull_test *tests;
    cull_answer *answers;
    fake_late *late;
    uint8_t *drawn;    // by the zone's item, then movers
    uint8_t *allowed;  // the candidates; all where the chain has none
    const cull_clipped *clipped; // of the culler before
    uint32_t clipped_count;
    const cull_picture *pictures; // of the culler before, too, as captures are
    const cull_capture *captures;
    uint32_t picture_count, capture_count;
    uint8_t keep_pictures[FAKE_PICTURES_MOST], keep_captures[FAKE_PICTURES_MOST], keep_clipped[FAKE_PICTURES_MOST]; // what the frame left of them
    void *scratch;
    cull_mover movers[FAKE_MOVERS_MOST];
    double depth[FAKE_PIXELS];
    uint32_t mover_count, late_count, frame, steps, tests_asked, drawn_count, waits, late_frames, late_steps, clock; // late_frames: of tests not waited for; late_steps: of those given with CULL_MORE; clock: steps
    fake_answers how;
    uint64_t random;
} fake_viewer;
void fake_viewer_open(fake_viewer *v, fake_culler *c); // aborts without memory
void fake_viewer_close(fake_viewer *v);
// Runs a frame. NULL, or what is wrong with what the culler gave.
const char *fake_frame(fake_viewer *v, const fake_view *view, uint32_t flags);
// steps_most: breaks the frame off after so many.
const char *fake_frame_cut(fake_viewer *v, const fake_view *view, uint32_t flags, uint32_t steps_most);

// visible[item, then mover] = 1 when it owns a pixel of a picture of everything allowed.
void fake_truth(const fake_viewer *v, const fake_view *view, uint8_t *visible);

#endif
