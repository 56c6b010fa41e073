// A small scene file for the tests of the application's API: a hall and a kitchen joined by a door, in the open.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_LIBRARY_FIXTURE_H
#define PORTCULLIS_TESTS_LIBRARY_FIXTURE_H

#include "tests/common/scratch_folder.h"

#include <portcullis/scene.h>

typedef struct api_bed {
    scratch_folder folder;
    char path[512];
    char log[4096]; // all lines so far
    cull_scene_options options;
    cull_scene *scene;
    cull_scene_view *view;
} api_bed;

int api_bed_open(void **state);  // cmocka's setup and teardown
int api_bed_close(void **state);
cull_camera api_camera(double x, double z, double yaw_deg); // 1.6 m above the floor; yaw 0 looks along -z, 90 along +x
int api_sees_item_at(const api_bed *b, const cull_visible *seen, const double p[3]); // an item whose box holds the point

#endif
