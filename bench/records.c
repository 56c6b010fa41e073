// Records of views and the rows they add up to: see records.h.
// SPDX-License-Identifier: MIT
#include "records.h"

#include "similarity.h"
#include "statistics.h"

#include <math.h>

uint32_t records_passes(const bench_request *q)
{
    return q->repeat + (q->truth == BENCH_NO_TRUTH);
}

uint32_t records_counting_pass(const bench_request *q)
{
    return q->truth == BENCH_NO_TRUTH ? q->repeat : 0;
}

result records_open(const bench_request *q, uint32_t first, uint32_t count, records *out)
{
    const allocator *memory = q->services->memory;
    const size_t views = (size_t)q->strategy_count * count;
    *out = (records){.memory = memory, .strategies = q->strategy_count, .passes = records_passes(q), .first = first, .count = count};
    out->counted = memory_alloc_zeroed(memory, views, sizeof *out->counted);
    out->timed = memory_alloc_zeroed(memory, views * out->passes, sizeof *out->timed);
    out->pictures = memory_alloc_zeroed(memory, views, sizeof *out->pictures);
    out->has_pictures = memory_alloc_zeroed(memory, q->strategy_count, 1);
    if (out->counted && out->timed && out->pictures && out->has_pictures) return RESULT_OK;
    records_close(out);
    return RESULT_NO_MEMORY;
}

void records_close(records *r)
{
    if (!r->memory) return;
    const size_t views = (size_t)r->strategies * r->count;
    memory_free(r->memory, r->counted, views, sizeof *r->counted);
    memory_free(r->memory, r->timed, views * r->passes, sizeof *r->timed);
    memory_free(r->memory, r->pictures, views, sizeof *r->pictures);
    memory_free(r->memory, r->has_pictures, r->strategies, 1);
    *r = (records){0};
}

counted_record *records_counted(const records *r, uint32_t strategy, uint32_t view)
{
    return &r->counted[(size_t)strategy * r->count + view - r->first];
}

pass_record *records_pass(const records *r, uint32_t strategy, uint32_t pass, uint32_t view)
{
    return &r->timed[((size_t)strategy * r->passes + pass) * r->count + view - r->first];
}

picture_record *records_picture(const records *r, uint32_t strategy, uint32_t view)
{
    return &r->pictures[(size_t)strategy * r->count + view - r->first];
}

// ---- Counters ----

static void add_counts(bench_row *row, const counted_record *c)
{
    row->polygons_drawn += (double)c->polygons;
    row->triangles_drawn += (double)c->triangles;
    row->items_drawn += (double)c->items;
    row->runs += (double)c->runs;
    row->movers_drawn += (double)c->mover_polygons;
    row->zones += c->zones;
    row->volumes += c->volumes;
    row->crossings += c->crossings;
    row->queries += c->queries;
    row->steps += c->steps;
    row->draw_calls += c->draw_calls;
    row->state_changes += c->state_changes;
    row->refreshes += c->captures;
    if (c->picture_bytes > row->picture_bytes) row->picture_bytes = c->picture_bytes;
    row->portal_merges += c->portal_merges;
    row->limits_hit += c->limits_hit;
    row->stalls += c->stalls;
}

static void add_truth(bench_row *row, const counted_record *c)
{
    if (c->polygons_visible >= BENCH_HARD_POLYGONS) {
        row->hard_views++;
        row->hard_drawn += (double)c->polygons;
        row->hard_visible += (double)c->polygons_visible;
    }
    row->polygons_visible += (double)c->polygons_visible;
    row->polygons_items += (double)c->polygons_items;
    row->items_visible += (double)c->items_visible;
    row->floor += (double)c->floor_items;
    row->movers_visible += (double)c->mover_polygons_visible;
}

// Sums over the path become means.
static void fill_counts(const records *r, uint32_t strategy, bench_row *row)
{
    for (uint32_t v = r->first; v < r->first + r->count; ++v) {
        add_counts(row, records_counted(r, strategy, v));
        add_truth(row, records_counted(r, strategy, v));
    }
    row->excess = row->polygons_visible > 0 ? row->polygons_drawn / row->polygons_visible : 0;
    row->excess_items = row->polygons_items > 0 ? row->polygons_drawn / row->polygons_items : 0;
    row->hard_excess = row->hard_visible > 0 ? row->hard_drawn / row->hard_visible : 0;
    double *const means[] = {&row->polygons_drawn, &row->polygons_visible, &row->polygons_items, &row->triangles_drawn, &row->items_drawn,
                             &row->items_visible,  &row->runs, &row->floor, &row->movers_drawn, &row->movers_visible, &row->queries,
                             &row->steps, &row->draw_calls, &row->state_changes, &row->refreshes, &row->zones, &row->volumes, &row->crossings};
    for (size_t i = 0; i < sizeof means / sizeof *means; ++i) *means[i] /= r->count;
}

// Missed pixels are the worst pass of each view; items and faults the worst pass of the whole path.
static void fill_misses(const records *r, uint32_t strategy, bench_row *row)
{
    for (uint32_t v = r->first; v < r->first + r->count; ++v) {
        uint64_t missed = 0;
        for (uint32_t p = 0; p < r->passes; ++p)
            if (records_pass(r, strategy, p, v)->missed_pixels > missed) missed = records_pass(r, strategy, p, v)->missed_pixels;
        row->missed_pixels += missed;
        if (missed <= row->missed_pixels_max) continue;
        row->missed_pixels_max = missed;
        row->worst_view = v;
    }
    for (uint32_t p = 0; p < r->passes; ++p) {
        uint64_t items = 0, broken = 0, faults = 0;
        for (uint32_t v = r->first; v < r->first + r->count; ++v) {
            const pass_record *of = records_pass(r, strategy, p, v);
            items += of->missed_items;
            broken += of->broken_items;
            faults += of->faults;
            row->picture_differs += of->picture_differs;
            row->pictures_compared += of->compared;
            row->swaps += of->swaps;
        }
        if (items > row->missed_items) row->missed_items = items;
        if (broken > row->broken_items) row->broken_items = broken;
        if (faults > row->faults) row->faults = faults;
    }
}

// ---- Times ----

double records_time(const records *r, const bench_request *q, uint32_t strategy, uint32_t view, time_weights w, double *scratch)
{
    for (uint32_t p = 0; p < q->repeat; ++p) {
        const pass_record *of = records_pass(r, strategy, p, view);
        scratch[p] = of->cull_ns * w.cull + of->gl_ms * w.gl;
    }
    return percentile(scratch, q->repeat, 0.5);
}

// Each view's median over the passes into scratch; warm-up left out.
static double *medians_of_views(const records *r, const bench_request *q, uint32_t strategy, time_weights w, double *scratch)
{
    const uint32_t warmup = bench_warmup_views(q->path);
    for (uint32_t v = warmup; v < r->count; ++v) scratch[v - warmup] = records_time(r, q, strategy, v, w, scratch + r->count);
    return scratch;
}

static void fill_least(const records *r, const bench_request *q, uint32_t strategy, bench_row *row)
{
    const uint32_t warmup = bench_warmup_views(q->path);
    for (uint32_t v = warmup; v < r->count; ++v) {
        double cull_ns = INFINITY, total_ns = INFINITY;
        for (uint32_t p = 0; p < q->repeat; ++p) {
            const pass_record *of = records_pass(r, strategy, p, v);
            cull_ns = fmin(cull_ns, of->cull_ns);
            total_ns = fmin(total_ns, of->cull_ns + of->gl_ms * 1e6);
        }
        row->least_cull_ns[v - warmup] = cull_ns;
        row->least_total_ns[v - warmup] = total_ns;
    }
}

static void fill_moves(const records *r, uint32_t strategy, bench_row *row)
{
    double mover_ns = 0, swap_ns = 0;
    uint64_t movers = 0, swaps = 0;
    for (uint32_t p = 0; p < r->passes; ++p)
        for (uint32_t v = r->first; v < r->first + r->count; ++v) {
            const pass_record *of = records_pass(r, strategy, p, v);
            mover_ns += of->mover_ns;
            swap_ns += of->swap_ns;
            movers += of->movers;
            swaps += of->swaps;
        }
    row->mover_update_ns = movers ? mover_ns / (double)movers : 0;
    row->swap_ms = swaps ? swap_ns * 1e-6 / (double)swaps : 0;
}

static void fill_times(const records *r, const bench_request *q, uint32_t strategy, bench_row *row, double *scratch)
{
    const uint32_t views = r->count - bench_warmup_views(q->path);
    double *cull_ns = medians_of_views(r, q, strategy, (time_weights){1, 0}, scratch);
    row->cull_ns_mean = mean(cull_ns, views);
    row->cull_ns_p95 = percentile(cull_ns, views, 0.95);
    row->cull_ns_p99 = percentile(cull_ns, views, 0.99);
    row->cull_ns = percentile(cull_ns, views, 0.5);
    row->gl_ms = percentile(medians_of_views(r, q, strategy, (time_weights){0, 1}, scratch), views, 0.5);
    double *total_ms = medians_of_views(r, q, strategy, (time_weights){1e-6, 1}, scratch);
    row->total_ms_mean = mean(total_ms, views);
    row->total_ms = percentile(total_ms, views, 0.5);
    row->total_ms_p95 = percentile(total_ms, views, 0.95);
    row->total_ms_p99 = percentile(total_ms, views, 0.99);
    fill_least(r, q, strategy, row);
    fill_moves(r, strategy, row);
}

// ---- Pictures ----

static void add_worst(bench_row *row, const picture_record *p, uint32_t view)
{
    if (p->holes + p->spills > row->crack_pixels_max) {
        row->crack_pixels_max = p->holes + p->spills;
        row->crack_view = view;
    }
    if (p->is_measured && (row->pictures_measured == 0 || p->flip > row->flip_max)) {
        row->flip_max = p->flip;
        row->flip_view = view;
    }
    if (p->has_popping && (row->popping_views == 0 || p->popping > row->popping_max)) {
        row->popping_max = p->popping;
        row->popping_view = view;
    }
}

// flips, poppings: of as many views as there are.
static void add_pictures(const records *r, uint32_t strategy, bench_row *row, double *flips, double *poppings)
{
    double squared_error = 0, ssim = 0;
    for (uint32_t v = r->first; v < r->first + r->count; ++v) {
        const picture_record *p = records_picture(r, strategy, v);
        add_worst(row, p, v);
        row->crack_pixels += p->holes + p->spills;
        row->crack_inner += p->inner;
        row->crack_spills += p->spills;
        row->mover_pixels += p->mover_pixels;
        row->mover_pixels_wrong += p->mover_wrong;
        row->mover_pixels_wrong_far += p->mover_wrong_far;
        row->faults += p->faults;
        row->swaps += p->swaps;
        if (p->has_popping) poppings[row->popping_views++] = p->popping;
        if (!p->is_measured) continue;
        squared_error += p->squared_error;
        ssim += p->ssim;
        row->has_ssim = p->has_ssim;
        flips[row->pictures_measured++] = p->flip;
    }
    if (!row->pictures_measured) return;
    row->psnr = similarity_psnr_db(squared_error / row->pictures_measured);
    row->ssim = ssim / row->pictures_measured;
    row->flip = mean(flips, row->pictures_measured);
    row->flip_p99 = percentile(flips, row->pictures_measured, 0.99);
    if (row->popping_views) row->popping = mean(poppings, row->popping_views);
    if (row->popping_views) row->popping_p99 = percentile(poppings, row->popping_views, 0.99);
}

result records_fill_pictures(const records *r, uint32_t strategy, const allocator *memory, bench_row *row)
{
    if (!r->has_pictures[strategy]) return RESULT_OK;
    double *scratch = memory_alloc(memory, (size_t)r->count * 2, sizeof *scratch);
    if (!scratch) return RESULT_NO_MEMORY;
    add_pictures(r, strategy, row, scratch, scratch + r->count);
    memory_free(memory, scratch, (size_t)r->count * 2, sizeof *scratch);
    return RESULT_OK;
}

result records_fill(const records *r, const bench_request *q, bench_result *out)
{
    const allocator *memory = q->services->memory;
    const size_t scratch_count = (size_t)r->count + q->repeat;
    double *scratch = memory_alloc(memory, scratch_count, sizeof *scratch);
    result done = scratch ? RESULT_OK : RESULT_NO_MEMORY;
    for (uint32_t k = 0; k < r->strategies && done == RESULT_OK; ++k) {
        fill_counts(r, k, &out->rows[k]);
        fill_misses(r, k, &out->rows[k]);
        fill_times(r, q, k, &out->rows[k], scratch);
        done = records_fill_pictures(r, k, memory, &out->rows[k]);
    }
    memory_free(memory, scratch, scratch_count, sizeof *scratch);
    return done;
}
