// PSNR and SSIM: against sums without tiles, rows or columns, and against what formulas say.
// SPDX-License-Identifier: MIT
#include "bench/similarity_parts.h"
#include "picture_pairs.h"

enum { WIDE = 91, HIGH = 78 };
static const picture_size SIZE = {WIDE, HIGH};
static uint8_t one[WIDE * HIGH * 4], two[WIDE * HIGH * 4];

static double ssim(const uint8_t *a, const uint8_t *b)
{
    similarity *s = similarity_open(&(similarity_size){WIDE, HIGH}, allocator_heap());
    assert_non_null(s);
    const double mean = similarity_ssim(s, &(flip_pair){a, b});
    similarity_close(s);
    return mean;
}

static double luminance(const uint8_t *rgba, int x, int y)
{
    const uint8_t *p = rgba + 4 * (y * WIDE + x);
    return 0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2];
}

// One window: mean, variance and covariance as the paper's equations 14 to 16 have them, round the mean.
static double window(const uint8_t *a, const uint8_t *b, int x, int y)
{
    double weights[11][11], sum = 0, mean_a = 0, mean_b = 0, aa = 0, bb = 0, ab = 0;
    for (int j = 0; j < 11; ++j)
        for (int i = 0; i < 11; ++i) sum += weights[j][i] = exp(-((i - 5) * (i - 5) + (j - 5) * (j - 5)) / 4.5);
    for (int j = 0; j < 11; ++j)
        for (int i = 0; i < 11; ++i) {
            mean_a += weights[j][i] / sum * luminance(a, x + i, y + j);
            mean_b += weights[j][i] / sum * luminance(b, x + i, y + j);
        }
    for (int j = 0; j < 11; ++j)
        for (int i = 0; i < 11; ++i) {
            const double from_a = luminance(a, x + i, y + j) - mean_a, from_b = luminance(b, x + i, y + j) - mean_b, w = weights[j][i] / sum;
            aa += w * from_a * from_a;
            bb += w * from_b * from_b;
            ab += w * from_a * from_b;
        }
    const double c1 = 6.5025, c2 = 58.5225;
    return (2 * mean_a * mean_b + c1) * (2 * ab + c2) / ((mean_a * mean_a + mean_b * mean_b + c1) * (aa + bb + c2));
}

static double oracle(const uint8_t *a, const uint8_t *b)
{
    double sum = 0;
    for (int y = 0; y <= HIGH - 11; ++y)
        for (int x = 0; x <= WIDE - 11; ++x) sum += window(a, b, x, y);
    return sum / ((HIGH - 10.0) * (WIDE - 10.0));
}

static void ssim_is_that_of_plain_windows(void **state)
{
    (void)state;
    fill_waves(one, &SIZE, 0);
    fill_waves(two, &SIZE, 1.5);
    assert_near(ssim(one, two), oracle(one, two), 1e-5);
    fill_noise(two, &SIZE, 4);
    assert_near(ssim(one, two), oracle(one, two), 1e-5);
    memcpy(two, one, sizeof two);
    memset(two + 4 * (65 * WIDE + 70), 0, 40); // in the last tiles only
    assert_near(ssim(one, two), oracle(one, two), 1e-5);
}

static double ssim_with(const similarity_kernel *kernel)
{
    similarity *s = similarity_open(&(similarity_size){WIDE, HIGH}, allocator_heap());
    assert_non_null(s);
    s->kernel = kernel;
    const double mean = similarity_ssim(s, &(flip_pair){one, two});
    similarity_close(s);
    return mean;
}

static void every_instruction_set_gives_the_same_bits(void **state)
{
    (void)state;
    fill_waves(one, &SIZE, 0);
    for (uint32_t seed = 1; seed <= 3; ++seed) {
        fill_noise(two, &SIZE, seed);
        const double plain = ssim_with(&similarity_kernel_plain);
        assert_true(plain < 1);
#if defined(__x86_64__)
        if (__builtin_cpu_supports("avx2")) assert_true(ssim_with(&similarity_kernel_avx2) == plain);
        if (__builtin_cpu_supports("avx512f")) assert_true(ssim_with(&similarity_kernel_avx512) == plain);
#endif
    }
}

static void equal_pictures_are_alike_by_one(void **state)
{
    (void)state;
    fill_noise(one, &SIZE, 1);
    memcpy(two, one, sizeof two);
    assert_true(ssim(one, two) == 1);
    assert_true(similarity_squared_error(&(flip_pair){one, two}, WIDE * HIGH) == 0);
    assert_true(similarity_psnr_db(0) == PSNR_MOST_DB);
    assert_true(similarity_psnr_db(1e-30) == PSNR_MOST_DB);
}

static void even_pictures_follow_the_formulas(void **state)
{
    (void)state;
    fill_colour(one, &SIZE, (const uint8_t[3]){100, 100, 100});
    fill_colour(two, &SIZE, (const uint8_t[3]){120, 120, 120});
    assert_near(ssim(one, two), (2 * 100.0 * 120 + 6.5025) / (100.0 * 100 + 120.0 * 120 + 6.5025), 1e-4);
    const double error = similarity_squared_error(&(flip_pair){one, two}, WIDE * HIGH);
    assert_true(error == 400);
    assert_near(similarity_psnr_db(error), 20 * log10(255.0 / 20), 1e-12);
    fill_colour(two, &SIZE, (const uint8_t[3]){100, 103, 96}); // channels count alike
    assert_near(similarity_squared_error(&(flip_pair){one, two}, WIDE * HIGH), 25.0 / 3, 1e-12);
    fill_colour(one, &SIZE, (const uint8_t[3]){0, 0, 0});
    fill_colour(two, &SIZE, (const uint8_t[3]){255, 255, 255});
    assert_near(similarity_psnr_db(similarity_squared_error(&(flip_pair){one, two}, WIDE * HIGH)), 0, 1e-12);
}

static void neither_picture_is_the_first(void **state)
{
    (void)state;
    fill_waves(one, &SIZE, 0);
    fill_waves(two, &SIZE, 3);
    assert_true(ssim(one, two) == ssim(two, one));
    assert_true(similarity_squared_error(&(flip_pair){one, two}, WIDE * HIGH) == similarity_squared_error(&(flip_pair){two, one}, WIDE * HIGH));
    for (int i = 3; i < WIDE * HIGH * 4; i += 4) two[i] = 9;
    assert_true(ssim(one, two) == ssim(two, one));
}

static void a_larger_shift_is_less_alike(void **state)
{
    (void)state;
    double last_ssim = 1, last_error = 0;
    fill_waves(one, &SIZE, 0);
    for (int step = 1; step <= 4; ++step) {
        fill_waves(two, &SIZE, step * 0.4);
        const double s = ssim(one, two), error = similarity_squared_error(&(flip_pair){one, two}, WIDE * HIGH);
        assert_true(s < last_ssim && error > last_error);
        last_ssim = s;
        last_error = error;
    }
}

static void a_picture_smaller_than_a_window_has_no_ssim(void **state)
{
    (void)state;
    assert_null(similarity_open(&(similarity_size){10, 720}, allocator_heap()));
    assert_null(similarity_open(&(similarity_size){1280, 10}, allocator_heap()));
    similarity *s = similarity_open(&(similarity_size){11, 11}, allocator_heap());
    assert_non_null(s);
    fill_noise(one, &SIZE, 6);
    fill_noise(two, &SIZE, 7);
    assert_true(similarity_ssim(s, &(flip_pair){one, two}) < 0.2);
    similarity_close(s);
    similarity_close(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ssim_is_that_of_plain_windows),
        cmocka_unit_test(every_instruction_set_gives_the_same_bits),
        cmocka_unit_test(equal_pictures_are_alike_by_one),
        cmocka_unit_test(even_pictures_follow_the_formulas),
        cmocka_unit_test(neither_picture_is_the_first),
        cmocka_unit_test(a_larger_shift_is_less_alike),
        cmocka_unit_test(a_picture_smaller_than_a_window_has_no_ssim),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
