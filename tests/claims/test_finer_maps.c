// Beside pictures of 4x4 the size at most one sample in 1e8 is owned by an item that is not drawn, on real maps, for chains of walls' fronts; and each
// such sample is explained: an exact ray through it grazes an edge on its way, or meets first what is drawn. At the size itself there is none.
// SPDX-License-Identifier: MIT
#include "maps.h"
#include "test_rays_oracle.h"

#include "bench/bench.h"
#include "bench/strategy.h"
#include "tests/common/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 1280, HEIGHT = 720, FINER = 4, SHOWN = 6 };
static const double MISSED_MOST = 1e-8; // of the samples

static const char *const chains[] = {
    "frustum[backface=1]",    "frustum[backface=1]+portal",
#if HAS_BSP
    "bsp[backface=1]+portal", "bsp[backface=1,cells=rect]+portal", "bsp[backface=1,cells=hull]+portal", "bsp[backface=1,cells=exact]+portal",
#endif
};
enum { CHAINS = sizeof chains / sizeof *chains };

typedef struct tally {
    uint64_t samples, missed, unexplained;
} tally;

typedef struct sight {
    stage *stage;
    renderer *g;
    report *r;
    ray_oracle *oracle;
    truth truth; // of walls' fronts; its own picture has the scale at hand
    strategy strategies[CHAINS];
    tally tallies[CHAINS];
    const camera_path *path;
} sight;

// ---- One sample ----

typedef struct sample {
    uint32_t view, x, y, item;
} sample;

static void ray_of_sample(const sight *x, const sample *at, ray *out)
{
    const camera *c = &x->path->cameras[at->view];
    double right[3], up[3], back[3], length = 0;
    camera_axes(c, right, up, back);
    const double tall = tan(c->fovy_deg * (3.14159265358979323846 / 360)), wide = tall * c->aspect;
    const double u = ((at->x + 0.5) / x->truth.picture.width_px * 2 - 1) * wide, v = ((at->y + 0.5) / x->truth.picture.height_px * 2 - 1) * tall;
    for (int k = 0; k < 3; ++k) {
        out->from[k] = c->eye[k];
        out->along[k] = u * right[k] + v * up[k] - back[k];
        length += out->along[k] * out->along[k];
    }
    for (int k = 0; k < 3; ++k) out->along[k] /= sqrt(length);
}

static int is_drawn(const strategy *s, uint32_t item)
{
    return (int)(s->drawn_bits[item / 32] >> (item % 32) & 1);
}

static void miss(sight *x, int chain, const sample *at)
{
    ray r;
    ray_hit hits[RAYS_SIDES];
    ray_of_sample(x, at, &r);
    ray_oracle_cast(x->oracle, &r, hits);
    const ray_hit *h = &hits[RAYS_FRONTS];
    const int is_other = h->end == RAY_HITS && is_drawn(&x->strategies[chain], h->item), is_explained = h->end == RAY_GRAZES || is_other;
    tally *t = &x->tallies[chain];
    t->unexplained += !is_explained;
    if (t->missed++ >= SHOWN) return;
    print_message("  %s, view %u, sample %u %u: item %u: %s\n", chains[chain], at->view, at->x, at->y, at->item,
                  h->end == RAY_GRAZES ? "its ray grazes an edge"
                  : is_other           ? "its ray meets first what is drawn"
                                       : "UNEXPLAINED");
}

// ---- A picture ----

static uint32_t item_of(const truth *t, uint32_t owner)
{
    return owner && owner <= t->triangle_count ? t->polygon_item[t->triangle_polygon[owner - 1]] : SCENE_NONE;
}

static void look_at_row(sight *x, uint32_t view, uint32_t y)
{
    const id_picture *p = &x->truth.picture;
    const uint32_t *row = p->triangles + (size_t)y * p->width_px;
    for (uint32_t at = 0; at < p->width_px;) {
        uint32_t end = at + 1;
        while (end < p->width_px && row[end] == row[at]) ++end;
        const uint32_t item = item_of(&x->truth, row[at]);
        for (int c = 0; c < CHAINS && item != SCENE_NONE; ++c)
            for (uint32_t i = at; i < end && !is_drawn(&x->strategies[c], item); ++i) miss(x, c, &(sample){view, i, y, item});
        at = end;
    }
}

static void look(sight *x, uint32_t view)
{
    for (int c = 0; c < CHAINS; ++c) {
        strategy_view seen;
        const strategy_request q = {.view = view, .mode = RENDER_SHADED, .marks = MARK_DRAWN};
        assert_int_equal(strategy_run_view(&x->strategies[c], &q, x->r, &seen), RESULT_OK);
    }
    motion_show(&x->strategies[0].motion, view, x->g);
    const id_request q = {.camera = &x->path->cameras[view]};
    assert_int_equal(truth_draw(&x->truth, x->g, &q, x->r), RESULT_OK);
    for (uint32_t y = 0; y < x->truth.picture.height_px; ++y) look_at_row(x, view, y);
    for (int c = 0; c < CHAINS; ++c) x->tallies[c].samples += (uint64_t)x->truth.picture.width_px * x->truth.picture.height_px;
}

static void look_at_size(sight *x, uint32_t scale)
{
    const truth_request q = {x->stage->scene, WIDTH * scale, HEIGHT * scale, WALLS_FRONT_ONLY};
    memset(x->tallies, 0, sizeof x->tallies);
    assert_int_equal(truth_open(&q, allocator_heap(), x->r, &x->truth), RESULT_OK);
    for (uint32_t v = 0; v < x->path->count; ++v) look(x, v);
    truth_close(&x->truth);
}

// ---- A map ----

static void check_path(sight *x, const char *name, const char *what)
{
    camera_path path;
    bench_strategy_request requests[CHAINS];
    static const door_state open = DOORS_OPEN;
    assert_int_equal(camera_path_load(what, x->stage->scene, 16.0 / 9, allocator_heap(), x->r, &path), RESULT_OK);
    x->path = &path;
    bench_request q = {.scene = x->stage->scene,
                       .path = &path,
                       .strategies = requests,
                       .strategy_count = CHAINS,
                       .doors = &open,
                       .plugins = x->stage->plugins,
                       .services = &x->stage->services,
                       .repeat = 1,
                       .width_px = WIDTH,
                       .height_px = HEIGHT};
    for (int c = 0; c < CHAINS; ++c) {
        requests[c] = (bench_strategy_request){.name = chains[c], .chain = stage_chain(x->stage, chains[c])};
        assert_int_equal(strategy_open(&q, &requests[c], NULL, x->r, &x->strategies[c]), RESULT_OK);
    }
    for (uint32_t scale = 1; scale <= FINER; scale += FINER - 1) {
        look_at_size(x, scale);
        for (int c = 0; c < CHAINS; ++c) {
            const tally *t = &x->tallies[c];
            print_message("%s, %s at %ux%u, %s: %llu of %llu samples missed, %llu unexplained\n", name, what, WIDTH * scale, HEIGHT * scale,
                          chains[c], (unsigned long long)t->missed, (unsigned long long)t->samples, (unsigned long long)t->unexplained);
            assert_int_equal(t->unexplained, 0);
            assert_true((double)t->missed <= (scale == 1 ? 0 : MISSED_MOST * (double)t->samples));
        }
    }
    for (int c = 0; c < CHAINS; ++c) strategy_close(&x->strategies[c]);
    camera_path_free(&path, allocator_heap());
}

static void check_map(const char *name, const char *const what[2])
{
    static stage s;
    const renderer_options options = {.target = RENDERER_HEADLESS, .width_px = WIDTH, .height_px = HEIGHT};
    report r = report_to_stderr();
    static sight x;
    memset(&x, 0, sizeof x);
    if (renderer_open(&options, allocator_heap(), &r, &x.g) != RESULT_OK) {
        fprintf(stderr, "SKIPPED: no OpenGL\n");
        skip();
    }
    map_load(&s, name);
    x.stage = &s;
    x.r = &r;
    x.oracle = ray_oracle_open(s.scene);
    assert_int_equal(renderer_upload(x.g, s.scene, &r), RESULT_OK);
    for (int i = 0; i < 2; i++) check_path(&x, name, what[i]);
    ray_oracle_close(x.oracle);
    renderer_close(x.g);
    stage_free(&s);
}

static void at_16_times_the_samples_of_maps_next_to_nothing_is_missed_and_each_is_explained(void **state)
{
    (void)state;
    static const char *const few[] = {"auto:3", "auto:edges:3"}, *const many[] = {"auto:24", "auto:edges:16"};
    const int is_long = stage_tier() == TIER_LONG;
    maps_need();
    for (int m = 0; m < (is_long ? MAPS : 1); m++) check_map(map_names[m], is_long ? many : few);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(at_16_times_the_samples_of_maps_next_to_nothing_is_missed_and_each_is_explained)};
    return cmocka_run_group_tests_name("claims finer maps", tests, NULL, NULL);
}
