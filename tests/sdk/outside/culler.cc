// A culler in C++ that uses the standard library: its templates must not be among what the plugin shows.
// SPDX-License-Identifier: MIT
#include <portcullis/block.h>
#include <portcullis/clip.h>
#include <portcullis/exact.h>
#include <portcullis/face.h>
#include <portcullis/plane.h>
#include <portcullis/runs.h>
#include <portcullis/segment.h>

#include <memory>
#include <string>
#include <vector>

struct cull_culler {
    const cull_host *host;
    std::vector<cull_box> boxes;
    std::string name;
};
struct cull_query { const cull_culler *culler; };

static cull_result create(const cull_host *host, const char *const *, cull_culler **out)
{
    *out = new cull_culler{host, {}, "outside"};
    return CULL_OK;
}
static void destroy(cull_culler *c) { delete c; }

static cull_result build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *, cull_built *out)
{
    for (uint32_t i = 0; i < zone->item_count; ++i) c->boxes.push_back(cull_box_at(&zone->boxes, i));
    out->max_runs = zone->item_count;
    out->max_steps = 1;
    out->promises = CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS;
    return CULL_OK;
}

static cull_result open(const cull_culler *c, cull_query **out)
{
    *out = std::make_unique<cull_query>(cull_query{c}).release();
    return CULL_OK;
}
static void close(cull_query *q) { delete q; }

static cull_progress select(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    cull_run_writer found{};
    found.runs = batch->runs + batch->run_count;
    found.most = static_cast<uint32_t>(q->culler->boxes.size());
    for (uint32_t i = 0; i < found.most; ++i)
        for (uint32_t v = 0; v < visit->volume_count; ++v)
            if (cull_volume_touches(&visit->volumes[v], q->culler->boxes[i])) {
                cull_run_put(&found, i);
                break;
            }
    batch->run_count += found.count;
    return CULL_DONE;
}
static const void *get_extension(const cull_culler *, const char *) { return nullptr; }

static const cull_descriptor descriptor = {"outside-cc", "1", "a culler in C++", nullptr, 0, CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS};
static const cull_plugin plugin = {&descriptor, create, destroy, build, open, close, select, nullptr, nullptr, get_extension};
static const cull_plugin *const plugins[] = {&plugin};
CULL_ENTRY = {CULL_ABI, 1, plugins};
