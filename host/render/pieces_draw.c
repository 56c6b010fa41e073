// See-through things of a picture in their exact order: zone by zone from the farthest, in each whole items, and knots of them in
// pieces as its culler says.
// SPDX-License-Identifier: MIT
// Invariant: what a culler writes is used only when it is a permutation of what it was asked about, else the zone goes by
// distance for good; an item whose pieces all come together is drawn whole, by its own triangles, bit for bit as ever.
#include "pieces.h"

#include <math.h>
#include <string.h>

typedef struct sequence { // things as they come, farthest first, written as indices
    renderer *g;
    render_layout *l;
    layout_pieces *p;
    const translucent_item *movers; // farthest first
    uint32_t mover_count, next_mover;
} sequence;

typedef struct thing {
    const uint32_t *indices;
    uint32_t index_count;
    double distance2;
    const pixel_box *cut;
} thing;

// ---- Writing ----

static int same_cut(const pixel_box *a, const pixel_box *b)
{
    return a->x == b->x && a->y == b->y && a->width == b->width && a->height == b->height;
}

// Room was taken for each thing once, whole and in pieces.
static void stage(sequence *q, const thing *t)
{
    layout_pieces *p = q->p;
    if (!t->index_count || t->index_count > p->staged_room - p->staged_count) return;
    pieces_draw *last = p->draw_count ? &p->draws[p->draw_count - 1] : NULL;
    if (!last || !same_cut(&last->cut, t->cut)) {
        if (p->draw_count == p->draw_room) return;
        last = &p->draws[p->draw_count++];
        *last = (pieces_draw){*t->cut, (uint32_t)p->staged_count, 0};
    }
    memcpy(p->staged + p->staged_count, t->indices, t->index_count * sizeof *t->indices);
    last->count += t->index_count;
    p->staged_count += t->index_count;
}

static thing whole(const sequence *q, const translucent_item *t)
{
    const scene_item *item = &q->g->scene.scene->items[t->item];
    return (thing){q->g->scene.indices + item->first_index, item->index_count, t->distance2, &t->cut};
}

static void write_movers_beyond(sequence *q, double distance2)
{
    while (q->next_mover < q->mover_count && q->movers[q->next_mover].distance2 >= distance2) {
        const thing mover = whole(q, &q->movers[q->next_mover++]);
        stage(q, &mover);
    }
}

static void put(sequence *q, const thing *t)
{
    write_movers_beyond(q, t->distance2);
    stage(q, t);
}

// ---- A zone ----

typedef struct block { // a zone's things, sorted by distance
    pieces_zone *z;    // lent NULL: it lends none
    const translucent_item *items;
    uint32_t count, zone, next_loose;
} block;

static uint32_t place_of(const sequence *q, const translucent_item *t)
{
    return t->place - q->l->zones[t->zone].first_place;
}

static int is_loose(const sequence *q, const block *b, const translucent_item *t)
{
    const uint32_t place = place_of(q, t);
    return !b->z->lent || b->z->item_first[place] == b->z->item_first[place + 1];
}

// Those without pieces that are farther; at the end, all.
static void put_loose(sequence *q, block *b, double beyond2)
{
    for (; b->next_loose < b->count && b->items[b->next_loose].distance2 >= beyond2; b->next_loose++) {
        if (!is_loose(q, b, &b->items[b->next_loose])) continue;
        const thing t = whole(q, &b->items[b->next_loose]);
        put(q, &t);
    }
}

static double piece_distance2(const sequence *q, const block *b, uint32_t number)
{
    const cull_piece *piece = &b->z->lent->pieces[number];
    double offset[3], sum = 0;
    layout_zone_offset(q->g, b->zone, offset);
    for (int k = 0; k < 3; ++k) {
        double middle = 0;
        for (uint32_t i = 0; i < piece->point_count; ++i) middle += b->z->lent->points[piece->first_point + i][k] / piece->point_count;
        const double away = middle + offset[k] - q->g->frame.view.eye[k];
        sum += away * away;
    }
    return sum;
}

// Places of the block's items that have pieces, each once, farthest first.
static uint32_t find_places(const block *b, const sequence *q, uint32_t *places)
{
    pieces_zone *z = b->z;
    uint32_t count = 0;
    for (uint32_t i = 0; z->lent && i < b->count; ++i) {
        const uint32_t place = place_of(q, &b->items[i]), known = z->entries[place];
        if (is_loose(q, b, &b->items[i]) || (known < i && b->items[known].place == b->items[i].place)) continue; // it came twice
        z->entries[place] = i;
        places[count++] = place;
    }
    return count;
}

static void tell_fault(sequence *q, uint32_t zone)
{
    if (q->p->has_faults) return;
    q->p->has_faults = 1;
    report_error(&q->g->sink, q->g->scene.scene->path, 0,
                 "the culler of zone %u orders pieces that it was not asked about; mend the plugin (see-through items go by distance)", zone);
}

static int is_permutation(sequence *q, const block *b, const uint32_t *numbers, uint32_t count)
{
    pieces_zone *z = b->z;
    uint32_t good = 0;
    for (uint32_t i = 0; i < count; ++i) {
        if (numbers[i] >= z->lent->piece_count || !z->wanted[numbers[i]]) continue;
        z->wanted[numbers[i]] = 0;
        good++;
    }
    if (good == count) return 1;
    memset(z->wanted, 0, z->number_room);
    tell_fault(q, b->zone);
    return 0;
}

// The pieces of some items in order. Returns how many; 0: the culler misbehaves.
typedef struct knot { const uint32_t *places; uint32_t count; } knot;
static uint32_t order(sequence *q, const block *b, const knot *of, uint32_t *numbers)
{
    pieces_zone *z = b->z;
    uint32_t count = 0;
    double offset[3];
    for (uint32_t i = 0; i < of->count; ++i)
        for (uint32_t k = z->item_first[of->places[i]]; k < z->item_first[of->places[i] + 1]; ++k) {
            z->wanted[z->numbers[k]] = 1;
            numbers[count++] = z->numbers[k];
        }
    layout_zone_offset(q->g, b->zone, offset);
    const double *eye = q->g->frame.view.eye;
    const cull_piece_request request = {.eye = {eye[0] - offset[0], eye[1] - offset[1], eye[2] - offset[2], 1}, .numbers = numbers,
                                        .scratch = q->p->scratch, .count = count, .depth_order = CULL_FAR_FIRST};
    z->lent->order(z->lent, &request);
    return is_permutation(q, b, numbers, count) ? count : 0;
}

// Puts the first `count` of the places in order, group by group from the farthest, and says where groups end. Returns the groups.
static uint32_t make_groups(const sequence *q, const block *b, uint32_t count)
{
    pieces_zone *z = b->z;
    uint32_t *places = q->p->places, *rows = places + q->p->item_room, *ends = rows + q->p->item_room;
    if (!count) return 0;
    if (!z->whole.rows) { // too many: one knot
        ends[0] = count;
        return 1;
    }
    for (uint32_t i = 0; i < count; ++i) rows[i] = z->rows[places[i]];
    const uint32_t groups = whole_order_run(&z->whole, &(whole_picture){q->g->frame.view.eye, rows, count}, places, ends);
    for (uint32_t i = 0; i < count; ++i) places[i] = z->row_places[places[i]];
    return groups;
}

// Pieces of one item that come together.
static void put_pieces(sequence *q, block *b, const uint32_t *numbers, uint32_t count)
{
    const pieces_zone *z = b->z;
    const uint32_t place = z->lent->pieces[numbers[0]].item;
    const translucent_item *item = &b->items[z->entries[place]];
    const double distance2 = piece_distance2(q, b, numbers[0]);
    put_loose(q, b, distance2);
    if (count == z->item_first[place + 1] - z->item_first[place]) {
        thing t = whole(q, item);
        t.distance2 = distance2;
        put(q, &t);
        return;
    }
    const uint32_t *indices = q->p->indices.items;
    for (uint32_t i = 0; i < count; ++i) {
        const piece_span *span = &z->spans[numbers[i]];
        const thing t = {indices + span->first_index, span->index_count, distance2, &item->cut};
        put(q, &t);
    }
}

// All knots are ordered before anything is staged, so that a culler that misbehaves in one has its whole zone go by distance.
static int order_knots(sequence *q, const block *b, uint32_t groups)
{
    const uint32_t *places = q->p->places, *ends = places + 2 * q->p->item_room;
    uint32_t written = 0;
    for (uint32_t g = 0, first = 0; g < groups; first = ends[g++]) {
        q->p->knots[g] = 0;
        if (ends[g] - first == 1) continue;
        q->p->knots[g] = order(q, b, &(knot){places + first, ends[g] - first}, q->p->numbers + written);
        written += q->p->knots[g];
        if (!q->p->knots[g]) return 0;
    }
    return 1;
}

static void put_knot(sequence *q, block *b, const uint32_t *numbers, uint32_t count)
{
    for (uint32_t i = 0, end; i < count; i = end) {
        const uint32_t item = b->z->lent->pieces[numbers[i]].item;
        for (end = i + 1; end < count && b->z->lent->pieces[numbers[end]].item == item;) ++end;
        put_pieces(q, b, numbers + i, end - i);
    }
}

static void put_whole(sequence *q, block *b, uint32_t place)
{
    const thing t = whole(q, &b->items[b->z->entries[place]]);
    put_loose(q, b, t.distance2);
    put(q, &t);
}

static void put_zone(sequence *q, block *b)
{
    const uint32_t *places = q->p->places, *ends = places + 2 * q->p->item_room;
    uint32_t groups = make_groups(q, b, find_places(b, q, q->p->places));
    if (!order_knots(q, b, groups)) {
        b->z->lent = NULL;
        groups = 0;
    }
    for (uint32_t g = 0, first = 0, from = 0; g < groups; first = ends[g], from += q->p->knots[g++]) {
        if (q->p->knots[g]) put_knot(q, b, q->p->numbers + from, q->p->knots[g]);
        else put_whole(q, b, places[first]);
    }
    put_loose(q, b, -INFINITY);
}

// ---- All zones ----

static void rank_items(renderer *g, const render_layout *l)
{
    frame_state *f = &g->frame;
    const scene *s = g->scene.scene;
    zone_order *o = &l->pieces->order;
    double eye[3];
    for (int k = 0; k < 3; ++k) eye[k] = f->view.eye[k] + s->whole.origin[k];
    for (uint32_t z = 0; z < o->count; ++z) o->keys[z] = INFINITY;
    for (uint32_t i = 0; i < f->translucent_count; ++i) {
        const translucent_item *t = &f->translucent[i];
        if (t->zone != LAYOUT_MOVERS) o->keys[t->zone] = fmin(o->keys[t->zone], t->distance2);
    }
    zone_order_run(o, s, eye);
    for (uint32_t i = 0; i < f->translucent_count; ++i) {
        translucent_item *t = &f->translucent[i];
        t->rank = t->zone == LAYOUT_MOVERS ? UINT32_MAX : UINT32_MAX - 1 - o->ranks[t->zone]; // far zones first, movers apart
    }
}

static void draw_staged(renderer *g, const layout_pieces *p)
{
    if (!p->staged_count) return;
    glNamedBufferSubData(p->elements, 0, (GLsizeiptr)(p->staged_count * sizeof *p->staged), p->staged);
    state_vertices(g, p->vertices);
    for (size_t i = 0; i < p->draw_count; ++i) {
        const pieces_draw *d = &p->draws[i];
        cut_begin(g, &d->cut);
        glDrawElements(GL_TRIANGLES, (GLsizei)d->count, GL_UNSIGNED_INT, (const void *)((uintptr_t)d->first * sizeof *p->staged));
        g->frame.draw_calls++;
        cut_end(g, &d->cut);
    }
}

void pieces_draw_all(renderer *g, render_layout *l)
{
    frame_state *f = &g->frame;
    layout_pieces *p = l->pieces;
    sequence q = {.g = g, .l = l, .p = p};
    uint32_t still = 0;
    p->staged_count = p->draw_count = 0;
    rank_items(g, l);
    translucent_sort(f->translucent, f->translucent_count);
    while (still < f->translucent_count && f->translucent[still].zone != LAYOUT_MOVERS) ++still;
    q.movers = f->translucent + still;
    q.mover_count = f->translucent_count - still;
    for (uint32_t i = 0, end; i < still; i = end) {
        const uint32_t zone = f->translucent[i].zone;
        for (end = i + 1; end < still && f->translucent[end].zone == zone;) ++end;
        block b = {.z = &p->zones[zone], .items = f->translucent + i, .count = end - i, .zone = zone};
        put_zone(&q, &b);
    }
    write_movers_beyond(&q, -INFINITY);
    draw_staged(g, p);
}
