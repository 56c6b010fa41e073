// Looking at worlds for tests: sets, their oracle, and a driver that notes. See site.h.
// SPDX-License-Identifier: MIT
#include "site.h"

#include "tests/common/test.h"

#include <portcullis/plane.h>

#include <math.h>
#include <string.h>

static uint32_t item_of(const site *s, uint32_t zone, uint32_t place)
{
    const zone_data *data = world_zone(s->world, zone);
    const chain *c = world_chain(s->world, zone);
    assert_true(place < data->zone.item_count);
    const uint32_t at = c->order ? c->order[place] : place;
    return data->items ? data->items[at] : at;
}

void site_look(const site *s, world_view *v, const frame_input *q, site_sight *out)
{
    uint64_t items = 0;
    memset(out, 0, sizeof *out);
    world_cull(v, q, &out->set, &out->stats);
    for (uint32_t i = 0; i < out->set.zone_count; i++) {
        const visible_zone *z = &out->set.zones[i];
        assert_true(z->run_count > 0);
        for (uint32_t r = 0; r < z->run_count; r++) {
            assert_true(z->runs[r].count > 0);
            for (uint32_t k = 0; k < z->runs[r].count; k++) out->items[item_of(s, z->zone, z->runs[r].first + k)]++;
            items += z->runs[r].count;
        }
    }
    for (uint32_t i = 0; i < out->set.mover_count; i++) out->movers[out->set.movers[i]]++;
    for (uint32_t i = 0; i < s->scene->item_count; i++) assert_true(out->items[i] <= 1);
    for (uint32_t i = 0; i < SITE_MOVERS_MOST; i++) assert_true(out->movers[i] <= 1);
    assert_int_equal(out->stats.items_drawn, items);
    assert_int_equal(out->stats.movers_drawn, out->set.mover_count);
    assert_int_equal(out->stats.zones, world_view_flow(v)->zone_count);
    assert_true(out->stats.cull_ns >= 0);
}

static int touches_any(const flow_result *f, const flow_zone *z, cull_box box)
{
    for (uint32_t i = 0; i < z->count; i++)
        if (cull_volume_touches(&f->volumes[f->by_zone[z->first + i]].volume, box)) return 1;
    return 0;
}

static int chain_keeps(const char *chain, const flow_result *f, const flow_zone *z, cull_box box)
{
    if (strstr(chain, "keep=right") && box.min.x < 0) return 0;
    return strncmp(chain, "none", 4) == 0 || touches_any(f, z, box);
}

void site_oracle(const site *s, const world_view *v, const char *const *chains, uint8_t *items)
{
    const flow_result *f = world_view_flow(v);
    memset(items, 0, SITE_ITEMS_MOST);
    for (uint32_t i = 0; i < f->zone_count; i++) {
        const flow_zone *z = &f->zones[i];
        const zone_data *data = world_zone(s->world, z->zone);
        for (uint32_t k = 0; k < data->zone.item_count; k++)
            if (chain_keeps(chains[z->zone], f, z, cull_box_at(&data->zone.boxes, k))) items[data->items ? data->items[k] : k] = 1;
    }
}

// A float below or above: the zone's own boxes of movers are rounded outward.
static cull_box box_in_zone(const double min[3], const double max[3], const double origin[3])
{
    float b[6];
    for (int k = 0; k < 3; k++) {
        b[k] = nextafterf((float)(min[k] - origin[k]), -INFINITY);
        b[3 + k] = nextafterf((float)(max[k] - origin[k]), INFINITY);
    }
    return (cull_box){{b[0], b[1], b[2]}, {b[3], b[4], b[5]}};
}

void site_oracle_movers(const site *s, const world_view *v, uint8_t *out)
{
    const flow_result *f = world_view_flow(v);
    const movers *m = world_movers(s->world);
    memset(out, 0, SITE_MOVERS_MOST);
    for (uint32_t n = 0; n < movers_counts(m).capacity; n++) {
        double min[3], max[3];
        uint32_t zones[64];
        if (!movers_box(m, n, min, max)) continue;
        const uint32_t count = graph_zones_of_box(world_graph(s->world), min, max, zones, 64);
        assert_true(count <= 64);
        for (uint32_t i = 0; i < f->zone_count; i++)
            for (uint32_t k = 0; k < count; k++)
                if (f->zones[i].zone == zones[k] && touches_any(f, &f->zones[i], box_in_zone(min, max, s->scene->zones[zones[k]].origin))) out[n] = 1;
    }
}

// ---- The driver ----

static void note(site_driver *d, site_event event, uint32_t zone)
{
    assert_true(d->note_count < SITE_EVENTS_MOST);
    d->notes[d->note_count++] = (site_note){event, zone};
}

static void on_draw(void *user, uint32_t zone, const cull_run *runs, uint32_t count)
{
    site_driver *d = user;
    note(d, SITE_DRAW, zone);
    assert_true(count > 0);
    for (uint32_t r = 0; r < count; r++)
        for (uint32_t k = 0; k < runs[r].count; k++) d->drawn[item_of(d->site, zone, runs[r].first + k)]++;
}

static void on_draw_movers(void *user, const uint32_t *numbers, uint32_t count)
{
    site_driver *d = user;
    note(d, SITE_MOVERS, SCENE_NONE);
    for (uint32_t i = 0; i < count; i++) d->movers[numbers[i]]++;
}

static void on_capture(void *user, uint32_t zone, const cull_capture *captures, uint32_t count)
{
    (void)captures;
    assert_true(count > 0);
    note(user, SITE_CAPTURE, zone);
}

static void on_show(void *user, uint32_t zone, const cull_picture *pictures, uint32_t count)
{
    (void)pictures;
    assert_true(count > 0);
    note(user, SITE_SHOW, zone);
}

static void on_test(void *user, uint32_t zone, const cull_test *tests, uint32_t count, uint32_t frame)
{
    site_driver *d = user;
    note(d, SITE_TEST, zone);
    for (uint32_t i = 0; i < count; i++) {
        assert_true(d->pending_count < SITE_TESTS_MOST);
        d->pixels[d->pending_count] = d->pixels_of ? d->pixels_of(zone, &tests[i]) : 1;
        d->pending[d->pending_count++] = (site_pending){zone, tests[i].tag, frame};
    }
}

static uint32_t on_collect(void *user, uint32_t zone, collect_how how, uint32_t frame, cull_answer *answers, uint32_t capacity, uint32_t *stalled)
{
    site_driver *d = user;
    uint32_t got = 0, left = 0;
    (void)stalled;
    note(d, how == COLLECT_EVERYTHING ? SITE_WAIT : SITE_READY, zone);
    for (uint32_t i = 0; i < d->pending_count; i++) {
        const site_pending p = d->pending[i];
        if (p.zone == zone && got < capacity) answers[got++] = (cull_answer){p.tag, d->pixels[i], frame - p.frame};
        else {
            d->pixels[left] = d->pixels[i];
            d->pending[left++] = p;
        }
    }
    d->pending_count = left;
    return got;
}

void site_driver_init(site_driver *d, const site *s)
{
    memset(d, 0, sizeof *d);
    d->site = s;
}

void site_driver_new_frame(site_driver *d)
{
    d->note_count = 0;
    memset(d->drawn, 0, sizeof d->drawn);
    memset(d->movers, 0, sizeof d->movers);
}

frame_driver site_driver_of(site_driver *d)
{
    return (frame_driver){d, on_draw, on_draw_movers, on_capture, on_show, on_test, on_collect, NULL, NULL, NULL};
}
