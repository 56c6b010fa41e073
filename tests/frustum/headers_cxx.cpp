// The shared mathematics compiled as C++17: the same answers as in C, see test_math.c.
// SPDX-License-Identifier: MIT
#include "headers_cxx.h"

#include <portcullis/box.h>
#include <portcullis/clip.h>
#include <portcullis/culler.h>
#include <portcullis/plane.h>

extern "C" cull_plane cxx_guard_plane(const cull_guard *guard, const double normal[3], double distance)
{
    return cull_guard_plane(guard, normal, distance);
}

extern "C" int cxx_volume_touches(const cull_volume *volume, cull_box box)
{
    return cull_volume_touches(volume, box) ? 1 : 0;
}

extern "C" uint32_t cxx_polygon_clip(const cull_point *in, uint32_t count, cull_cut cut, cull_point *out, uint32_t capacity)
{
    return cull_polygon_clip(in, count, cut, out, capacity);
}

extern "C" cull_box cxx_box_union(cull_box a, cull_box b)
{
    return cull_box_union(a, b);
}
