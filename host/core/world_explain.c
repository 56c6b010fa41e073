// Why an item or a mover was drawn or not in a view's last frame: zones, portals on the way, door, plane, culler or limit.
// SPDX-License-Identifier: MIT
#include "world_parts.h"

#include <portcullis/plane.h>

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

enum { WAY_MOST = 64 }; // portals on one way that are named; a longer way loses its middle

typedef struct writer {
    char *text;
    size_t size, length; // length: of the whole text, as snprintf counts
} writer;

typedef struct explanation {
    world_view *v;
    const world *w;
    flow_request flow; // of the last frame
    writer *out;
} explanation;

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void say(writer *w, const char *format, ...)
{
    va_list arguments;
    const size_t left = w->length < w->size ? w->size - w->length : 0;
    va_start(arguments, format);
    const int length = vsnprintf(left ? w->text + w->length : NULL, left, format, arguments);
    va_end(arguments);
    if (length > 0) w->length += (size_t)length;
}

static const char *zone_name(const explanation *e, uint32_t zone)
{
    return e->w->scene->zones[zone].name;
}

// ---- Ways ----

static void say_door(const explanation *e, uint32_t portal)
{
    const uint32_t door = e->w->scene->portals[portal].door;
    if (door != SCENE_NONE) say(e->out, " (door '%s' %s)", e->w->scene->doors[door].name, e->v->open[portal] ? "open" : "shut");
}

// From the zone that the eye is in to the volume.
static void say_way(const explanation *e, uint32_t volume)
{
    const flow_result *f = &e->v->reached;
    uint32_t way[WAY_MOST], count = 0, at = volume;
    for (; f->volumes[at].parent != SCENE_NONE && count < WAY_MOST; at = f->volumes[at].parent) way[count++] = at;
    const flow_volume *start = &f->volumes[at];
    if (f->is_everything) say(e->out, "    the eye is in no zone: all zones are seen whole\n");
    else if (start->parent != SCENE_NONE) say(e->out, "    the eye -> ... -> '%s'", zone_name(e, start->zone));
    else if (e->w->scene->zones[start->zone].flags & ZONE_STRAY) say(e->out, "    looked at in every view: '%s'", zone_name(e, start->zone));
    else say(e->out, start->is_merged ? "    volumes merged in '%s'" : "    eye in '%s'", zone_name(e, start->zone));
    if (f->is_everything) return;
    while (count-- > 0) {
        const flow_volume *v = &f->volumes[way[count]];
        if (v->way != SCENE_NONE) {
            say(e->out, " -> portal '%s'", e->w->scene->portals[v->way / 2].name);
            say_door(e, v->way / 2);
        }
        say(e->out, " -> '%s'", zone_name(e, v->zone));
    }
    say(e->out, "\n");
}

static void say_fate(const explanation *e, uint32_t portal, uint32_t side)
{
    const scene_portal *p = &e->w->scene->portals[portal];
    const char *from = zone_name(e, p->zones[side]);
    const uint32_t door = p->door;
    switch (flow_fate_of(e->v->flow, &e->flow, 2 * portal + side)) {
    case FLOW_SHUT: say(e->out, "    portal '%s' from '%s' is shut by door '%s'\n", p->name, from, door == SCENE_NONE ? "?" : e->w->scene->doors[door].name); break;
    case FLOW_BEHIND: say(e->out, "    portal '%s' from '%s' shows only its back to the eye\n", p->name, from); break;
    case FLOW_OUTSIDE: say(e->out, "    portal '%s' from '%s' is outside of all that is seen of '%s'\n", p->name, from, from); break;
    case FLOW_UNREACHED: say(e->out, "    portal '%s' from '%s': '%s' is not reached itself\n", p->name, from, from); break;
    case FLOW_CROSSED: say(e->out, "    portal '%s' from '%s' was crossed\n", p->name, from); break;
    }
}

static void say_unreached(const explanation *e, uint32_t zone)
{
    const scene *s = e->w->scene;
    uint32_t portals = 0;
    say(e->out, "  zone '%s' was not reached:\n", zone_name(e, zone));
    for (uint32_t i = 0; i < s->portal_count; ++i)
        for (uint32_t side = 0; side < 2; ++side)
            if (s->portals[i].zones[!side] == zone) {
                say_fate(e, i, side);
                ++portals;
            }
    if (!portals) say(e->out, "    no portal leads into it, and the eye is not in it\n");
}

// ---- Volumes ----

static const flow_zone *reached_zone(const explanation *e, uint32_t zone)
{
    for (uint32_t i = 0; i < e->v->reached.zone_count; ++i)
        if (e->v->reached.zones[i].zone == zone) return &e->v->reached.zones[i];
    return NULL;
}

typedef struct verdict {
    uint32_t volume; // of the flow: the one that comes nearest to keeping the box
    uint32_t plane;
    float height; // metres of its farthest corner above its worst plane: below 0, outside
} verdict;

static verdict judge(const explanation *e, const flow_zone *z, cull_box box)
{
    verdict best = {SCENE_NONE, 0, -INFINITY};
    for (uint32_t i = 0; i < z->count; ++i) {
        const uint32_t number = e->v->reached.by_zone[z->first + i];
        const cull_volume *volume = &e->v->reached.volumes[number].volume;
        verdict now = {number, 0, INFINITY};
        for (uint32_t k = 0; k < volume->plane_count; ++k) {
            const float height = cull_plane_height(volume->planes[k], cull_box_corner(box, volume->planes[k].normal));
            if (height < now.height) now = (verdict){number, k, height};
        }
        if (best.volume == SCENE_NONE || now.height > best.height) best = now;
    }
    return best;
}

// 1: some volume of the zone touches the box.
static int say_volumes(const explanation *e, const flow_zone *z, cull_box box)
{
    const verdict best = judge(e, z, box);
    say(e->out, "  zone '%s' was reached, seen through %u volume%s:\n", zone_name(e, z->zone), (unsigned)z->count, z->count == 1 ? "" : "s");
    if (best.volume == SCENE_NONE) return 0;
    say_way(e, best.volume);
    if (best.height >= 0) return 1;
    const cull_plane p = e->v->reached.volumes[best.volume].volume.planes[best.plane];
    say(e->out, "    its box lies %.3g m outside plane %u of that volume (normal %.3g %.3g %.3g)", (double)-best.height, (unsigned)best.plane,
        (double)p.normal.x, (double)p.normal.y, (double)p.normal.z);
    say(e->out, z->count > 1 ? ", and outside every other volume\n" : "\n");
    return 0;
}

// ---- Cullers ----

static int runs_hold(const cull_run *runs, uint32_t count, uint32_t place)
{
    for (uint32_t i = 0; i < count; ++i)
        if (place - runs[i].first < runs[i].count) return 1; // also where place is below: it wraps
    return 0;
}

static void say_culler_s_own(const explanation *e, viewer *zone, uint32_t stage, uint32_t place)
{
    const chain_stage *s = &zone->chain->stages[stage];
    const cull_explain *own = s->plugin->get_extension(s->culler, CULL_EXT_EXPLAIN);
    char text[400];
    if (!own || !own->item) return;
    cull_visit visit = zone->visit;
    visit.scratch = zone->room->scratch;
    visit.step = visit.answer_count = 0;
    if (s->role == ROLE_SELECT) {
        visit.candidates = NULL;
        visit.candidate_count = 0;
    }
    text[0] = 0;
    (void)own->item(zone->stages[stage].query, &visit, place, text, sizeof text);
    text[sizeof text - 1] = 0;
    if (text[0]) say(e->out, "    '%s' says: %s\n", s->plugin->descriptor->id, text);
}

static uint32_t stage_after(const viewer *zone, uint32_t stage)
{
    while (++stage < zone->last && zone->chain->stages[stage].role == ROLE_CROSS) {}
    return stage;
}

static int stands_in_a_picture(const viewer *zone, uint32_t place)
{
    const uint32_t kept = zone->last > 0 ? zone->visit.picture_count : 0;
    for (uint32_t i = 0; i < kept; ++i)
        if (runs_hold(zone->visit.pictures[i].runs, zone->visit.pictures[i].run_count, place)) return 1;
    for (uint32_t i = 0; i < zone->batch.picture_count; ++i)
        if (runs_hold(zone->batch.pictures[i].runs, zone->batch.pictures[i].run_count, place)) return 1;
    return 0;
}

static const shared_stamp *stamp_of(const explanation *e, const viewer *zone, uint32_t place)
{
    for (uint32_t i = 0; i < zone->chain->data->shared_count; ++i)
        if (zone->shared[i].place == place) return &e->v->stamps[zone->shared[i].number];
    return NULL;
}

static void say_stages(const explanation *e, viewer *zone, uint32_t place)
{
    for (uint32_t i = zone->first; i < zone->last; i = stage_after(zone, i)) {
        const char *id = zone->chain->stages[i].plugin->descriptor->id;
        const int kept = runs_hold(zone->stages[i].runs.items, zone->stages[i].run_count, place);
        say(e->out, "    culler '%s' %s it\n", id, kept ? "kept" : "dropped");
        say_culler_s_own(e, zone, i, place);
        if (!kept) return;
    }
    const char *id = zone->chain->stages[zone->last].plugin->descriptor->id;
    const shared_stamp *stamp = stamp_of(e, zone, place);
    const int kept = runs_hold(zone->batch.runs, zone->batch.run_count, place);
    if (runs_hold(zone->out, zone->out_count, place)) say(e->out, "    culler '%s' kept it: drawn\n", id);
    else if (kept && stamp && stamp->serial == e->v->serial) say(e->out, "    culler '%s' kept it, but zone '%s' has drawn it already\n", id, zone_name(e, stamp->zone));
    else if (stands_in_a_picture(zone, place)) say(e->out, "    culler '%s' shows a picture in its place\n", id);
    else say(e->out, "    culler '%s' dropped it\n", id);
    say_culler_s_own(e, zone, zone->last, place);
}

static void say_zone_of_item(const explanation *e, const flow_zone *z, uint32_t zone_place)
{
    viewer *zone = e->v->zones[z->zone];
    (void)say_volumes(e, z, cull_box_at(&e->w->data[z->zone].zone.boxes, zone_place));
    if (!zone || zone->serial != e->v->serial) {
        say(e->out, "    its chain was swapped since\n");
        return;
    }
    const chain *c = zone->chain;
    uint32_t place = zone_place;
    for (uint32_t i = 0; c->order && i < c->zone.item_count; ++i)
        if (c->order[i] == zone_place) place = i;
    if (zone->state == VIEWER_FAULTY) say(e->out, "    a culler of its chain misbehaved: the zone is drawn whole\n");
    else say_stages(e, zone, place);
}

// ---- Items ----

static uint32_t place_of(const zone_data *data, uint32_t item)
{
    uint32_t low = 0, high = data->zone.item_count;
    if (!data->items) return item < high ? item : SCENE_NONE;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (data->items[middle] < item) low = middle + 1;
        else high = middle;
    }
    return low < data->zone.item_count && data->items[low] == item ? low : SCENE_NONE;
}

// The zone that drew it, or SCENE_NONE.
static uint32_t drawn_in(const explanation *e, uint32_t item)
{
    for (uint32_t i = 0; i < e->v->set.zone_count; ++i) {
        const visible_zone *z = &e->v->set.zones[i];
        const chain *c = e->v->zones[z->zone]->chain;
        if (e->v->zones[z->zone]->serial != e->v->serial) continue; // swapped since: its runs are gone
        for (uint32_t r = 0; r < z->run_count; ++r)
            for (uint32_t k = z->runs[r].first; k < z->runs[r].first + z->runs[r].count; ++k) {
                const uint32_t place = c->order ? c->order[k] : k;
                if ((c->data->items ? c->data->items[place] : place) == item) return z->zone;
            }
    }
    return SCENE_NONE;
}

static void explain_item_of(const explanation *e, uint32_t item)
{
    const scene *s = e->w->scene;
    const uint32_t drawn = drawn_in(e, item);
    say(e->out, "item %u of object '%s' is %s", (unsigned)item, s->objects[s->items[item].object].name, drawn == SCENE_NONE ? "not drawn\n" : "drawn");
    if (drawn != SCENE_NONE) say(e->out, " in zone '%s'\n", zone_name(e, drawn));
    for (uint32_t i = 0; i < s->zone_count; ++i) {
        const uint32_t place = place_of(&e->w->data[i], item);
        if (place == SCENE_NONE) continue;
        const flow_zone *z = reached_zone(e, i);
        if (z) say_zone_of_item(e, z, place);
        else say_unreached(e, i);
    }
}

// ---- Movers ----

static int mover_is_drawn(const explanation *e, uint32_t mover)
{
    return e->v->marks.stamps[mover] == e->v->serial;
}

static int mover_box_in(const explanation *e, uint32_t mover, uint32_t zone, cull_box *out)
{
    for (const mover_block *b = movers_of_zone(e->w->movers, zone); b; b = movers_next(e->w->movers, b))
        for (uint32_t i = 0; i < b->count; ++i)
            if (b->mover[i] == mover) {
                *out = (cull_box){{b->min_x[i], b->min_y[i], b->min_z[i]}, {b->max_x[i], b->max_y[i], b->max_z[i]}};
                return 1;
            }
    return 0;
}

static void say_zone_of_mover(const explanation *e, const flow_zone *z, uint32_t mover)
{
    const viewer *zone = e->v->zones[z->zone];
    cull_box box;
    if (!mover_box_in(e, mover, z->zone, &box) || !say_volumes(e, z, box)) return;
    if (!zone || !viewer_takes_movers(zone)) say(e->out, "    no culler of the zone decides about movers: drawn\n");
    else if (zone->state == VIEWER_FAULTY) say(e->out, "    a culler of its chain misbehaved: all its movers are drawn\n");
    else say(e->out, "    culler '%s' decides about movers here\n", zone->chain->stages[zone->last].plugin->descriptor->id);
}

static void explain_mover_of(const explanation *e, uint32_t mover)
{
    const scene *s = e->w->scene;
    const uint32_t *zones;
    double min[3], max[3];
    say(e->out, "mover %u", (unsigned)mover);
    if (mover < s->mover_count) say(e->out, " '%s'", s->movers[mover].name);
    if (!movers_box(e->w->movers, mover, min, max)) {
        say(e->out, " does not exist\n");
        return;
    }
    say(e->out, mover_is_drawn(e, mover) ? " is drawn\n" : " is not drawn\n");
    const uint32_t count = movers_zones(e->w->movers, mover, &zones);
    if (!count) say(e->out, "  it stands in no zone or in more than %d, and is tested against the whole picture\n", MOVER_ZONES_MOST);
    for (uint32_t i = 0; i < count; ++i) {
        const flow_zone *z = reached_zone(e, zones[i]);
        if (z) say_zone_of_mover(e, z, mover);
        else say_unreached(e, zones[i]);
    }
}

size_t world_explain(world_view *v, const explain_request *q, char *text, size_t size)
{
    const world *w = v->world;
    writer out = {text, size, 0};
    const explanation e = {v, w, {.camera = q->frame->camera, .frame = q->frame->frame, .open = v->open, .crosser = {v, world_view_cross, world_view_sight, world_view_is_by_entry}}, &out};
    if (size) text[0] = 0;
    if (!v->serial) say(&out, "the view has not been culled yet\n");
    else if (q->item < w->scene->item_count) explain_item_of(&e, q->item);
    else if (q->item - w->scene->item_count < w->mover_numbers) explain_mover_of(&e, q->item - w->scene->item_count);
    else say(&out, "there is no item %u; the scene has %u, and room for %u movers behind them\n", (unsigned)q->item, (unsigned)w->scene->item_count, (unsigned)w->mover_numbers);
    return out.length;
}
