// Chains of a world: built by zone, swapped while it runs.
// SPDX-License-Identifier: MIT
// Invariant: a swap puts all of the new chain in place, in every view, or nothing of it.
#include "world_parts.h"

#include <stdio.h>
#include <string.h>

struct world_swap {
    const world *world;
    uint32_t zone;
    zone_chain made;
};

// ---- Shared items in a chain's order ----

static uint32_t shared_number(const world *w, uint32_t item)
{
    uint32_t low = 0, high = w->shared_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (w->shared_items[middle] < item) low = middle + 1;
        else high = middle;
    }
    return low;
}

static uint32_t item_at(const zone_data *data, uint32_t place)
{
    return data->items ? data->items[place] : place;
}

// numbers: by place of the zone, SCENE_NONE where it is not shared.
static void fill_shared(const zone_chain *c, const zone_data *data, const uint32_t *numbers)
{
    uint32_t count = 0;
    for (uint32_t place = 0; place < data->zone.item_count; ++place) {
        const uint32_t number = numbers[c->chain->order ? c->chain->order[place] : place];
        if (number != SCENE_NONE) c->shared[count++] = (shared_place){place, number};
    }
}

static result make_shared(const world *w, const zone_data *data, zone_chain *c)
{
    if (!data->shared_count) return RESULT_OK;
    const uint32_t count = data->zone.item_count;
    uint32_t *numbers = memory_alloc(w->memory, count, sizeof *numbers);
    c->shared = memory_alloc(w->memory, data->shared_count, sizeof *c->shared);
    if (numbers && c->shared) {
        memset(numbers, 0xFF, count * sizeof *numbers); // SCENE_NONE
        for (uint32_t i = 0; i < data->shared_count; ++i) numbers[data->shared[i]] = shared_number(w, item_at(data, data->shared[i]));
        fill_shared(c, data, numbers);
    }
    memory_free(w->memory, numbers, count, sizeof *numbers);
    return numbers && c->shared ? RESULT_OK : RESULT_NO_MEMORY;
}

// ---- What is wrong with a chain that the scene names ----

typedef struct kept_error { char text[1024]; const report *through; } kept_error;

static void keep_error(void *user, report_level level, const char *text)
{
    kept_error *k = user;
    if (level == REPORT_ERROR) snprintf(k->text, sizeof k->text, "%s", text);
    else if (k->through->line) k->through->line(k->through->user, level, text);
}

static result build_told(const chain_request *build, const char *path, const char *zone, report *r, chain **out)
{
    static const char none[] = "portcullis: error: ";
    kept_error kept = {.through = r};
    report inner = {.line = keep_error, .user = &kept, .warnings = r->warnings};
    const result done = chain_build(build, &inner, out);
    r->warnings = inner.warnings;
    if (done == RESULT_NO_MEMORY) return report_no_memory(r, path);
    if (done == RESULT_OK) return done;
    const size_t skipped = strncmp(kept.text, none, sizeof none - 1) == 0 ? sizeof none - 1 : 0;
    report_error(r, path, 0, "zone '%.200s': %s", zone, kept.text + skipped);
    return done;
}

// A person who did not type the chain is told where it stands.
static result build_chain(const zone_chain_request *q, const chain_request *build, report *r, chain **out)
{
    const scene *s = q->world->scene;
    const scene_zone *zone = &s->zones[q->zone];
    if (!zone->chain || strcmp(zone->chain, q->spec->text) != 0) return chain_build(build, r, out);
    return build_told(build, s->path, zone->name, r, out);
}

result zone_chain_build(const zone_chain_request *q, report *r, zone_chain *out)
{
    const world *w = q->world;
    const zone_data *data = &w->data[q->zone];
    const chain_request build = {q->spec, data, w->plugins, w->services, w->loading};
    zone_chain made = {0};
    const result done = build_chain(q, &build, r, &made.chain);
    if (done != RESULT_OK) return done;
    if (make_shared(w, data, &made) != RESULT_OK) {
        zone_chain_close(&made, w, q->zone);
        return report_no_memory(r, NULL);
    }
    *out = made;
    return RESULT_OK;
}

void zone_chain_close(zone_chain *c, const world *w, uint32_t zone)
{
    chain_close(c->chain);
    memory_free(w->memory, c->shared, w->data[zone].shared_count, sizeof *c->shared);
    *c = (zone_chain){0};
}

// ---- Looking ----

const chain *world_chain(const world *w, uint32_t zone)
{
    return w->chains[zone].chain;
}

void world_order(const world *w, uint32_t zone, uint32_t *out)
{
    const zone_data *data = &w->data[zone];
    const chain *c = w->chains[zone].chain;
    for (uint32_t place = 0; place < data->zone.item_count; ++place) out[place] = item_at(data, c && c->order ? c->order[place] : place);
}

// ---- Swaps ----

result world_swap_build(const world *w, uint32_t zone, const chain_spec *spec, report *r, world_swap **out)
{
    if (zone >= w->scene->zone_count) return report_error(r, NULL, 0, "there is no zone %u; the scene has %u", (unsigned)zone, (unsigned)w->scene->zone_count);
    world_swap *s = memory_alloc_zeroed(w->memory, 1, sizeof *s);
    if (!s) return report_no_memory(r, NULL);
    *s = (world_swap){.world = w, .zone = zone};
    // A zone without items has no chain; the spec is tried all the same where there is anything to cull.
    const result done = w->data[zone].zone.item_count ? zone_chain_build(&(zone_chain_request){w, zone, spec}, r, &s->made) : RESULT_OK;
    if (done != RESULT_OK) {
        memory_free(w->memory, s, 1, sizeof *s);
        return done;
    }
    *out = s;
    return RESULT_OK;
}

void world_swap_drop(world_swap *s)
{
    if (!s) return;
    const world *w = s->world;
    zone_chain_close(&s->made, w, s->zone);
    memory_free(w->memory, s, 1, sizeof *s);
}

// A viewer of the new chain for each view, hung on it until all are there.
typedef struct fresh_viewer { struct fresh_viewer *next; world_view *view; viewer *made; } fresh_viewer;

static void drop_fresh(const world *w, fresh_viewer *list)
{
    while (list) {
        fresh_viewer *next = list->next;
        viewer_close(list->made);
        memory_free(w->memory, list, 1, sizeof *list);
        list = next;
    }
}

static result open_fresh(world *w, const world_swap *s, report *r, fresh_viewer **list)
{
    for (world_view *v = w->views; v; v = v->next) {
        fresh_viewer *f = memory_alloc_zeroed(w->memory, 1, sizeof *f);
        if (!f) return report_no_memory(r, NULL);
        *f = (fresh_viewer){.next = *list, .view = v};
        *list = f;
        const result done = world_view_open_zone(v, s->zone, &s->made, r, &f->made);
        if (done != RESULT_OK) return done;
    }
    return RESULT_OK;
}

result world_swap_commit(world *w, world_swap *s, report *r)
{
    world_assert_still(w);
    assert(s->world == w);
    fresh_viewer *fresh = NULL;
    const result done = s->made.chain ? open_fresh(w, s, r, &fresh) : RESULT_OK;
    if (done == RESULT_OK && s->made.chain) {
        for (fresh_viewer *f = fresh; f; f = f->next) { // the old viewers go with the list
            viewer *old = f->view->zones[s->zone];
            f->view->zones[s->zone] = f->made;
            f->made = old;
        }
        const zone_chain old = w->chains[s->zone];
        w->chains[s->zone] = s->made;
        s->made = old;
    }
    drop_fresh(w, fresh);
    world_swap_drop(s);
    return done;
}

result world_set_chain(world *w, uint32_t zone, const chain_spec *spec, report *r)
{
    world_swap *s = NULL;
    const result done = world_swap_build(w, zone, spec, r, &s);
    return done == RESULT_OK ? world_swap_commit(w, s, r) : done;
}
