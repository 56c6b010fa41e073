// Pictures of strategies beside full geometry: what is measured of one view of one strategy, beside the thread that draws.
// SPDX-License-Identifier: MIT
// Invariant: jobs are done in order, so sums are the same however threads run.
#include "pictures_parts.h"

#include "popping.h"

#include <string.h>

static void keep_worst(const pictures *p, const picture_job *j, picture_sums *s)
{
    const uint32_t width = p->q->bench->width_px, height = p->q->bench->height_px;
    memcpy(s->worst.truth, j->now->all.rgba, p->pixels * 4);
    memcpy(s->worst.shown, j->shown.rgba, p->pixels * 4);
    flip_heat(p->map, p->pixels, s->worst.heat);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            uint8_t *pixel = s->worst.heat + ((size_t)y * width + x) * 4;
            if (!p->marks[(size_t)(height - 1 - y) * width + x]) continue;
            pixel[0] = 0; // a crack: cyan, which the heat never is
            pixel[1] = pixel[2] = 255;
        }
}

static void count_cracks(const pictures *p, const picture_job *j, picture_record *out)
{
    const bench_request *q = p->q->bench;
    const uint32_t k = j->strategy;
    const float *must = p->q->strategies[k].walls == WALLS_BOTH_SIDES ? j->now->all.depths : j->now->fronts;
    const crack_pictures cracks = {j->now->all.depths, must, j->shown.depths, q->width_px, q->height_px};
    const crack_counts c = cracks_count(&cracks, p->marks);
    out->holes = c.holes;
    out->inner = c.inner;
    out->spills = c.spills;
}

static void count_movers(const pictures *p, const picture_job *j, picture_record *out)
{
    const mover_pictures movers = {j->now->movers, j->now->all.depths, j->shown.depths, p->q->bench->width_px, p->q->bench->height_px};
    const mover_order c = movers_count(&movers);
    out->mover_pixels = c.pixels;
    out->mover_wrong = c.wrong;
    out->mover_wrong_far = c.wrong_far;
}

static void compare(pictures *p, const picture_job *j, picture_record *out)
{
    const flip_pair pair = {j->now->all.rgba, j->shown.rgba};
    picture_sums *s = &p->sums[j->strategy];
    flip_keep_reference(p->flip, (uint64_t)j->view + 1);
    out->flip = flip_compare(p->flip, &pair, p->map);
    out->squared_error = similarity_squared_error(&pair, p->pixels);
    if (p->similarity) out->ssim = similarity_ssim(p->similarity, &pair);
    out->has_ssim = p->similarity != NULL;
    out->is_measured = 1;
    if (s->views++ > 0 && !(out->flip > s->flip_max)) return;
    s->flip_max = out->flip;
    s->flip_view = j->view;
    if (s->worst.heat) keep_worst(p, j, s);
}

static int differ(const pictures *p, const uint8_t *a, const uint8_t *b)
{
    return memcmp(a, b, p->pixels * 4) != 0;
}

static void find_traces(pictures *p, const picture_job *j)
{
    const popping_views views = {{j->before->camera, j->before->all.depths, j->before->movers}, {j->now->camera, j->now->all.depths, j->now->movers},
                                 p->q->bench->width_px, p->q->bench->height_px};
    if (p->from_view == j->view + 1) return;
    popping_trace(&views, p->from);
    p->from_view = j->view + 1;
}

static double popping_of(pictures *p, const picture_job *j)
{
    const picture_sums *s = &p->sums[j->strategy];
    const popping_pictures pictures = {j->before->all.rgba, s->before, j->now->all.rgba, j->shown.rgba, p->from, p->pixels};
    if (!differ(p, pictures.truth, pictures.shown) && !differ(p, pictures.truth_before, pictures.shown_before)) return 0;
    find_traces(p, j);
    popping_expect(&pictures, p->expected);
    flip_keep_reference(p->flip, 0);
    return flip_compare(p->flip, &(flip_pair){p->expected, j->shown.rgba}, NULL);
}

void pictures_compare(void *context, uint64_t job)
{
    pictures *p = context;
    picture_job *j = &p->jobs[job % PICTURES_JOBS];
    picture_sums *s = &p->sums[j->strategy];
    const int is_kept = j->view >= p->q->records->first, counts = is_kept && j->view >= bench_warmup_views(p->q->bench->path);
    if (is_kept) {
        picture_record *out = records_picture(p->q->records, j->strategy, j->view);
        count_cracks(p, j, out);
        if (j->now->movers) count_movers(p, j, out);
        if (counts) compare(p, j, out);
        out->has_popping = counts && j->before;
        if (out->has_popping) out->popping = popping_of(p, j);
    }
    uint8_t *const shown = j->shown.rgba;
    j->shown.rgba = s->before;
    s->before = shown;
}
