// The culler `frustum` a fifth slower: after each select it waits for a fifth of the time that it took. For bench/against.sh, which must notice.
// SPDX-License-Identifier: MIT
#include <portcullis/culler.h>
#undef CULL_ENTRY
#define CULL_ENTRY __attribute__((unused)) static const cull_exports healthy_entry
#include "../../../plugins/frustum/frustum.c"

#include <time.h>

static double now_ns(void)
{
    struct timespec t;
    timespec_get(&t, TIME_UTC); // no call into the system, unlike a thread's clock
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

static cull_progress slow_select(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    const double start_ns = now_ns();
    const cull_progress progress = frustum_select(q, visit, batch);
    const double end_ns = now_ns(), until_ns = end_ns + (end_ns - start_ns) / 5;
    while (now_ns() < until_ns) {}
    return progress;
}

static const cull_plugin slow_plugin = {
    .descriptor = &frustum_descriptor,
    .create = frustum_create,
    .destroy = frustum_destroy,
    .build = frustum_build,
    .open = frustum_open,
    .close = frustum_close,
    .select = slow_select,
    .get_extension = frustum_get_extension,
};

static const cull_plugin *const slow_plugins[] = {&slow_plugin};
CULL_EXPORT const cull_exports cull_entry = {CULL_ABI, 1, slow_plugins};
