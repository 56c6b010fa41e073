// The eye as two floats keeps 48 bits: gcc 12's straight-line vectorizer once made the lower half 0. Needs no GL.
// SPDX-License-Identifier: MIT
#include "fixture.h"
#include "host/render/gl.h"

#include <math.h>

static void the_eye_keeps_48_bits(void **state)
{
    (void)state;
    uint64_t seed = 0;
    for (int i = 0; i < 1000; ++i) {
        viewpoint v = {.near_m = 0.0625};
        for (int k = 0; k < 3; ++k) {
            seed = seed * 6364136223846793005u + 1442695040888963407u;
            v.eye[k] = ldexp((double)(int64_t)seed, -48); // +-32768 m
        }
        viewpoint_finish(&v);
        for (int k = 0; k < 3; ++k) {
            const double kept = (double)v.eye_high[k] + (double)v.eye_low[k];
            assert_true(fabs(kept - v.eye[k]) <= fabs(v.eye[k]) * 0x1p-48);
            assert_true(v.eye_low[k] != 0 || (double)v.eye_high[k] == v.eye[k]);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_eye_keeps_48_bits)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
