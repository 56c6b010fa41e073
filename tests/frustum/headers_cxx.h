// What headers_cxx.cpp offers to the tests in C.
// SPDX-License-Identifier: MIT
#ifndef TESTS_FRUSTUM_HEADERS_CXX_H
#define TESTS_FRUSTUM_HEADERS_CXX_H

#include <portcullis/clip.h>
#include <portcullis/plane.h>

#ifdef __cplusplus
extern "C" {
#endif
cull_plane cxx_guard_plane(const cull_guard *guard, const double normal[3], double distance);
int cxx_volume_touches(const cull_volume *volume, cull_box box);
uint32_t cxx_polygon_clip(const cull_point *in, uint32_t count, cull_cut cut, cull_point *out, uint32_t capacity);
cull_box cxx_box_union(cull_box a, cull_box b);
#ifdef __cplusplus
}
#endif

#endif
