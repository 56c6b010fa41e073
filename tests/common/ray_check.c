// See ray_check.h.
// SPDX-License-Identifier: MIT
#include "ray_check.h"

#include "test.h"

#include <portcullis/box.h>

#include <math.h>
#include <string.h>

// Slabs by hand; > 1: it doesn't touch.
static double entry_of(const double from[3], const double to[3], cull_box box)
{
    double in = 0, out = 1;
    for (int k = 0; k < 3; k++) {
        const double low = (double)(&box.min.x)[k], high = (double)(&box.max.x)[k], along = to[k] - from[k];
        if (along == 0) {
            if (from[k] < low || from[k] > high) return 2;
            continue;
        }
        in = fmax(in, fmin((low - from[k]) / along, (high - from[k]) / along));
        out = fmin(out, fmax((low - from[k]) / along, (high - from[k]) / along));
    }
    return in <= out ? in : 2;
}

void segment_must_be_right(const ray_check *c, cull_vec3 a, cull_vec3 b)
{
    static cull_run runs[RAY_CHECK_MOST], first[RAY_CHECK_MOST];
    const double from[3] = {(double)a.x, (double)a.y, (double)a.z}, to[3] = {(double)b.x, (double)b.y, (double)b.z};
    uint8_t seen[RAY_CHECK_MOST] = {0};
    double last = 0;
    assert_in_range(c->zone->item_count, 0, RAY_CHECK_MOST);
    const uint32_t count = c->ray->segment(c->culler, a, b, runs, RAY_CHECK_MOST);
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t place = runs[i].first; place < runs[i].first + runs[i].count; place++) {
            const uint32_t item = c->order[place];
            const double at = entry_of(from, to, cull_box_at(&c->zone->boxes, item));
            assert_int_equal(seen[item]++, 0);
            assert_true(at >= last); // nearest first
            last = at;
        }
    for (uint32_t i = 0; i < c->zone->item_count; i++) assert_int_equal(seen[i], entry_of(from, to, cull_box_at(&c->zone->boxes, i)) <= 1);
    for (uint32_t most = 0; most <= count && most < 6; most++) { // a short list holds the nearest
        first[most] = (cull_run){77, 77};
        assert_int_equal(c->ray->segment(c->culler, a, b, first, most), count);
        if (most) assert_memory_equal(first, runs, most * sizeof *runs);
        assert_int_equal(first[most].first, 77);
    }
}

void box_must_be_right(const ray_check *c, cull_box box)
{
    static cull_run runs[RAY_CHECK_MOST], first[RAY_CHECK_MOST];
    uint8_t seen[RAY_CHECK_MOST] = {0};
    assert_in_range(c->zone->item_count, 0, RAY_CHECK_MOST);
    const uint32_t count = c->ray->box(c->culler, &box, runs, RAY_CHECK_MOST);
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t place = runs[i].first; place < runs[i].first + runs[i].count; place++) assert_int_equal(seen[c->order[place]]++, 0);
    for (uint32_t i = 0; i < c->zone->item_count; i++) assert_int_equal(seen[i], cull_box_touches(box, cull_box_at(&c->zone->boxes, i)));
    first[count / 2] = (cull_run){77, 77};
    assert_int_equal(c->ray->box(c->culler, &box, first, count / 2), count);
    if (count / 2) assert_memory_equal(first, runs, count / 2 * sizeof *runs);
    assert_int_equal(first[count / 2].first, 77);
}
