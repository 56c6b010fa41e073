// For tests of pictures: a host with costs, a camera, and sessions that carry out captures by remembering what they were of.
// SPDX-License-Identifier: MIT
#ifndef TESTS_IMAGECACHE_SHOW_HOST_H
#define TESTS_IMAGECACHE_SHOW_HOST_H

#include "tests/octree/fixture.h"

typedef struct show_values { const char *level, *walk, *order, *show, *tree, *tolerance, *hidden, *budget, *memory_mib; } show_values;

typedef struct show_host {
    culler_host base; // first: the plugin's way back
    cull_costs costs;
} show_host;

// What a host without renderer lends, but for the cost of a polygon.
void show_host_init(show_host *h, double polygon_ns, uint64_t fail_at);

typedef struct show_eye { double at[3], heading, pitch; } show_eye; // radians
// 60 degrees tall, 16:9, 720 rows; the volume's planes are planes[4].
void show_look(show_eye eye, uint32_t frame, cull_view *view, cull_plane *planes);
int show_sees(const cull_plane *planes, const double p[3]);

typedef struct show_session {
    session base;
    const cull_zone *zone; // in its own order, boxes by item
    uint8_t *slots;
    cull_capture *held; // by slot: the capture that filled it
    cull_picture *pictures;
    cull_capture *captures;
    cull_clipped *clipped;
    cull_test *tests;
    cull_answer *answers;
    cull_batch batch; // of the last frame; captures are those of its last step
    uint32_t steps;
} show_session;

typedef enum show_answers { ANSWERS_SEEN, ANSWERS_HIDDEN, ANSWERS_NONE, ANSWERS_OLD } show_answers; // to all tests; old: hidden, of the frame before

cull_result show_open(show_session *s, show_host *h, const cull_zone *zone, const show_values *values);
void show_close(show_session *s);
void show_frame(show_session *s, const cull_view *view, const cull_volume *volume, show_answers answers);

cull_box show_item_box(const show_session *s, uint32_t place);
int show_runs_hold(const cull_run *runs, uint32_t count, uint32_t place);
int show_inside(const cull_plane *planes, uint32_t count, const double p[3], double slack_m);

// Pixels between where a point belongs and where its picture is shown; below 0: neither is in view.
double show_off_px(const cull_view *view, const cull_plane *planes, const cull_capture *taken, const cull_picture *shown, const double p[3]);

#endif
