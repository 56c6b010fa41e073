// FLIP: the published values, the oracle of plain convolutions, and what must hold for any two pictures.
// SPDX-License-Identifier: MIT
#include "bench/flip_parts.h"
#include "flip_oracle.h"
#include "picture_pairs.h"

#include <png.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDE = 92, HIGH = 73 }; // more than a tile, and no multiple of one
static const picture_size SIZE = {WIDE, HIGH};
static uint8_t one[WIDE * HIGH * 4], two[WIDE * HIGH * 4];
static float map[WIDE * HIGH], other_map[WIDE * HIGH];

static double compare_at(double pixels_per_degree, const uint8_t *reference, const uint8_t *test, float *out)
{
    flip *f = flip_open(&(flip_request){WIDE, HIGH, pixels_per_degree}, allocator_heap());
    assert_non_null(f);
    const double mean = flip_compare(f, &(flip_pair){reference, test}, out);
    flip_close(f);
    return mean;
}

static double compare(const uint8_t *reference, const uint8_t *test, float *out)
{
    return compare_at(FLIP_PIXELS_PER_DEGREE, reference, test, out);
}

static uint8_t *read_picture(const char *name, uint32_t *wide, uint32_t *high)
{
    char path[1024];
    png_image image = {.version = PNG_IMAGE_VERSION};
    snprintf(path, sizeof path, "%s/flip/%s", getenv("PORTCULLIS_SCENES") ? getenv("PORTCULLIS_SCENES") : "", name);
    if (!png_image_begin_read_from_file(&image, path)) return NULL;
    image.format = PNG_FORMAT_RGBA;
    uint8_t *rgba = test_malloc(PNG_IMAGE_SIZE(image));
    assert_true(png_image_finish_read(&image, NULL, rgba, 0, NULL));
    *wide = image.width;
    *high = image.height;
    return rgba;
}

// As the pictures' README tells of the authors' own program.
static void the_published_means_are_met_to_a_ten_thousandth(void **state)
{
    (void)state;
    static const struct { const char *name; double mean; } published[] = {{"blurred.png", 0.137896}, {"coarse.png", 0.136887}};
    uint32_t wide, high;
    uint8_t *reference = read_picture("reference.png", &wide, &high);
    if (!reference) {
        fprintf(stderr, "SKIPPED: the pictures of the metric are not there\n");
        skip();
    }
    flip *f = flip_open(&(flip_request){wide, high, FLIP_PIXELS_PER_DEGREE}, allocator_heap());
    for (int i = 0; i < 2; ++i) {
        uint8_t *test = read_picture(published[i].name, &wide, &high);
        assert_non_null(test);
        assert_near(flip_compare(f, &(flip_pair){reference, test}, NULL), published[i].mean, 1e-4);
        test_free(test);
    }
    flip_close(f);
    test_free(reference);
}

static void check_against_oracle(double pixels_per_degree)
{
    enum { PART_WIDE = 70, PART_HIGH = 20 };
    static uint8_t parts[2][PART_WIDE * PART_HIGH * 4];
    static double truth[PART_WIDE * PART_HIGH];
    for (int y = 0; y < PART_HIGH; ++y)
        for (int i = 0; i < 2; ++i) memcpy(parts[i] + y * PART_WIDE * 4, (i ? two : one) + y * WIDE * 4, PART_WIDE * 4);
    flip *f = flip_open(&(flip_request){PART_WIDE, PART_HIGH, pixels_per_degree}, allocator_heap());
    const double mean = flip_compare(f, &(flip_pair){parts[0], parts[1]}, map);
    const double expected = flip_oracle(&(oracle_request){parts[0], parts[1], PART_WIDE, PART_HIGH, pixels_per_degree}, truth);
    flip_close(f);
    assert_near(mean, expected, 1e-5);
    for (int i = 0; i < PART_WIDE * PART_HIGH; ++i) assert_near(map[i], truth[i], 2e-3); // where all but equal, 0.7th powers magnify rounding
}

static void every_pixel_is_the_plain_convolution_s(void **state)
{
    (void)state;
    fill_waves(one, &SIZE, 0);
    fill_waves(two, &SIZE, 1.5);
    check_against_oracle(21);
    fill_noise(two, &SIZE, 5);
    check_against_oracle(35);
    check_against_oracle(FLIP_PIXELS_PER_DEGREE);
}

static void equal_pictures_differ_by_exactly_nothing(void **state)
{
    (void)state;
    fill_noise(one, &SIZE, 1);
    memcpy(two, one, sizeof two);
    memset(map, 1, sizeof map);
    assert_true(compare(one, two, map) == 0);
    for (int i = 0; i < WIDE * HIGH; ++i) assert_true(map[i] == 0);
    for (int i = 3; i < WIDE * HIGH * 4; i += 4) two[i] = 7; // alpha is not looked at
    assert_true(compare(one, two, map) == 0);
}

static void one_pixel_is_seen_as_far_as_the_filters_reach_and_no_farther(void **state)
{
    (void)state;
    static const int places[][2] = {{63, 40}, {64, 64}, {0, 0}, {WIDE - 1, HIGH - 1}, {30, 63}};
    fill_waves(one, &SIZE, 0);
    for (size_t p = 0; p < sizeof places / sizeof *places; ++p) {
        memcpy(two, one, sizeof two);
        uint8_t *pixel = two + 4 * (places[p][1] * WIDE + places[p][0]);
        pixel[0] = pixel[1] = pixel[2] = 255;
        assert_true(compare(one, two, map) > 0);
        assert_true(map[places[p][1] * WIDE + places[p][0]] > 0.1f);
        for (int i = 0; i < WIDE * HIGH; ++i)
            if (abs(i % WIDE - places[p][0]) > 10 || abs(i / WIDE - places[p][1]) > 10) assert_true(map[i] == 0);
    }
}

static void neither_of_two_pictures_is_the_reference(void **state)
{
    (void)state;
    fill_waves(one, &SIZE, 0);
    fill_waves(two, &SIZE, 2);
    assert_true(compare(one, two, map) == compare(two, one, other_map));
    assert_memory_equal(map, other_map, sizeof map);
}

static void a_reference_that_is_kept_changes_no_bit(void **state)
{
    (void)state;
    static float kept_map[WIDE * HIGH];
    flip *f = flip_open(&(flip_request){WIDE, HIGH, FLIP_PIXELS_PER_DEGREE}, allocator_heap());
    fill_waves(one, &SIZE, 0);
    for (uint32_t seed = 1; seed <= 4; ++seed) {
        fill_waves(two, &SIZE, seed * 0.3);
        if (seed == 3) fill_noise(one, &SIZE, 3); // another reference, another number
        flip_keep_reference(f, seed < 3 ? 7 : 8);
        const double kept = flip_compare(f, &(flip_pair){one, two}, kept_map);
        assert_true(kept == compare(one, two, map));
        assert_memory_equal(kept_map, map, sizeof map);
    }
    flip_keep_reference(f, 0);
    fill_noise(one, &SIZE, 4);
    assert_true(flip_compare(f, &(flip_pair){one, two}, NULL) == compare(one, two, NULL));
    fill_noise(one, &SIZE, 5);
    assert_true(flip_compare(f, &(flip_pair){one, two}, NULL) == compare(one, two, NULL));
    flip_close(f);
}

static double compare_with(const flip_kernel *kernel, float *out)
{
    flip *f = flip_open(&(flip_request){WIDE, HIGH, FLIP_PIXELS_PER_DEGREE}, allocator_heap());
    assert_non_null(f);
    f->kernel = kernel;
    const double mean = flip_compare(f, &(flip_pair){one, two}, out);
    flip_close(f);
    return mean;
}

static void every_instruction_set_gives_the_same_bits(void **state)
{
    (void)state;
    const flip_kernel *others[2] = {NULL, NULL};
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) others[0] = &flip_kernel_avx2;
    if (__builtin_cpu_supports("avx512f")) others[1] = &flip_kernel_avx512;
#endif
    for (uint32_t seed = 1; seed <= 3; ++seed) {
        fill_noise(one, &SIZE, seed);
        fill_waves(two, &SIZE, seed * 0.4);
        const double plain = compare_with(&flip_kernel_plain, map);
        assert_true(plain > 0);
        for (int i = 0; i < 2; ++i) {
            if (!others[i]) continue;
            assert_true(compare_with(others[i], other_map) == plain);
            assert_memory_equal(other_map, map, sizeof map);
        }
    }
}

static void what_is_kept_stays_when_others_are_compared_between(void **state)
{
    (void)state;
    static float kept_map[WIDE * HIGH];
    static uint8_t three[WIDE * HIGH * 4];
    flip *f = flip_open(&(flip_request){WIDE, HIGH, FLIP_PIXELS_PER_DEGREE}, allocator_heap());
    assert_non_null(f);
    fill_waves(one, &SIZE, 0);
    fill_noise(two, &SIZE, 2);
    fill_waves(three, &SIZE, 2);
    flip_keep_reference(f, 1);
    const double first = flip_compare(f, &(flip_pair){one, three}, NULL);
    flip_keep_reference(f, 0);
    (void)flip_compare(f, &(flip_pair){two, three}, NULL);
    flip_keep_reference(f, 1);
    assert_true(flip_compare(f, &(flip_pair){one, three}, kept_map) == first);
    assert_true(compare(one, three, map) == first);
    assert_memory_equal(kept_map, map, sizeof map);
    flip_close(f);
}

static void mirror(uint8_t *rgba)
{
    for (int y = 0; y < HIGH; ++y)
        for (int x = 0; x < WIDE / 2; ++x) {
            uint8_t kept[4], *a = rgba + 4 * (y * WIDE + x), *b = rgba + 4 * (y * WIDE + WIDE - 1 - x);
            memcpy(kept, a, 4);
            memcpy(a, b, 4);
            memcpy(b, kept, 4);
        }
}

static void mirrored_pictures_have_a_mirrored_map(void **state)
{
    (void)state;
    fill_waves(one, &SIZE, 0);
    fill_waves(two, &SIZE, 0.7);
    compare(one, two, map);
    mirror(one);
    mirror(two);
    compare(one, two, other_map);
    for (int i = 0; i < WIDE * HIGH; ++i) assert_true(map[i] == other_map[i / WIDE * WIDE + WIDE - 1 - i % WIDE]);
}

static void the_most_is_one_and_more_of_an_error_is_more(void **state)
{
    (void)state;
    double last = 0;
    fill_colour(one, &SIZE, (const uint8_t[3]){0, 255, 0});
    fill_colour(two, &SIZE, (const uint8_t[3]){0, 0, 255});
    assert_near(compare(one, two, map), 1, 1e-5);
    fill_noise(one, &SIZE, 2);
    fill_noise(two, &SIZE, 3);
    compare(one, two, map);
    for (int i = 0; i < WIDE * HIGH; ++i) assert_true(map[i] >= 0 && map[i] <= 1);
    fill_waves(one, &SIZE, 0);
    for (int step = 1; step <= 4; ++step) {
        fill_waves(two, &SIZE, step * 0.5);
        const double mean = compare(one, two, NULL);
        assert_true(mean > last);
        last = mean;
    }
}

static void noise_fades_when_pixels_are_seen_from_afar(void **state)
{
    (void)state;
    fill_colour(one, &SIZE, (const uint8_t[3]){120, 120, 120});
    memcpy(two, one, sizeof two);
    for (int i = 0; i < WIDE * HIGH; ++i) memset(two + 4 * i, (i % WIDE / 4 + i / WIDE / 4) % 2 ? 140 : 100, 3);
    assert_true(compare_at(134, one, two, NULL) < compare_at(67, one, two, NULL));
    assert_true(compare_at(67, one, two, NULL) < compare_at(33, one, two, NULL));
}

static void what_can_t_be_opened_is_refused(void **state)
{
    (void)state;
    static const flip_request bad[] = {{0, 9, 67}, {9, 0, 67}, {9, 9, 0.5}, {9, 9, 401}, {9, 9, (double)NAN}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) assert_null(flip_open(&bad[i], allocator_heap()));
    flip *widest = flip_open(&(flip_request){9, 9, 400}, allocator_heap());
    assert_non_null(widest);
    fill_noise(one, &SIZE, 8);
    fill_noise(two, &SIZE, 9);
    const double mean = flip_compare(widest, &(flip_pair){one, two}, NULL);
    assert_true(mean > 0 && mean < 1);
    flip_close(widest);
    flip_close(NULL);
}

static void a_heat_map_goes_from_black_to_bright(void **state)
{
    (void)state;
    const float values[] = {0, 0.25f, 0.5f, 0.75f, 1};
    uint8_t rgba[20];
    int last = -1;
    flip_heat(values, 5, rgba);
    assert_int_equal(rgba[0] + rgba[1] + rgba[2], 0);
    for (int i = 0; i < 5; ++i) {
        const int sum = rgba[4 * i] + rgba[4 * i + 1] + rgba[4 * i + 2];
        assert_true(sum > last);
        assert_int_equal(rgba[4 * i + 3], 255);
        last = sum;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_published_means_are_met_to_a_ten_thousandth),
        cmocka_unit_test(every_pixel_is_the_plain_convolution_s),
        cmocka_unit_test(equal_pictures_differ_by_exactly_nothing),
        cmocka_unit_test(one_pixel_is_seen_as_far_as_the_filters_reach_and_no_farther),
        cmocka_unit_test(neither_of_two_pictures_is_the_reference),
        cmocka_unit_test(a_reference_that_is_kept_changes_no_bit),
        cmocka_unit_test(what_is_kept_stays_when_others_are_compared_between),
        cmocka_unit_test(every_instruction_set_gives_the_same_bits),
        cmocka_unit_test(mirrored_pictures_have_a_mirrored_map),
        cmocka_unit_test(the_most_is_one_and_more_of_an_error_is_more),
        cmocka_unit_test(noise_fades_when_pixels_are_seen_from_afar),
        cmocka_unit_test(what_can_t_be_opened_is_refused),
        cmocka_unit_test(a_heat_map_goes_from_black_to_bright),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
