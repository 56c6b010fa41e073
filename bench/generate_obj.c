// Writes .obj: see generate_obj.h.
// SPDX-License-Identifier: MIT
#include "generate_obj.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { FIRST_SLOTS = 1024, CORNERS_MOST = 8 };

obj_writer obj_open(text_file *out, const allocator *memory)
{
    return (obj_writer){.out = out, .memory = memory};
}

void obj_close(obj_writer *w)
{
    memory_free(w->memory, w->slots, w->slot_count, sizeof *w->slots);
    w->slots = NULL;
    w->slot_count = 0;
}

static void object_begin(obj_writer *w)
{
    w->object_count++;
    w->used = 0; // slots of older objects count as empty
    w->material = NULL;
}

void obj_object(obj_writer *w, const char *name)
{
    object_begin(w);
    text_add(w->out, "o ");
    text_add(w->out, name);
    text_add(w->out, "\n");
}

void obj_numbered_object(obj_writer *w, const char *name, uint32_t number)
{
    object_begin(w);
    text_add(w->out, "o ");
    text_add(w->out, name);
    text_add(w->out, "_");
    text_count(w->out, number);
    text_add(w->out, "\n");
}

void obj_material(obj_writer *w, const char *name)
{
    if (w->material && strcmp(w->material, name) == 0) return;
    w->material = name;
    text_add(w->out, "usemtl ");
    text_add(w->out, name);
    text_add(w->out, "\n");
}

static int place_equal(place a, place b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static obj_slot *slot_of(obj_slot *slots, uint32_t count, uint32_t object, place at)
{
    uint64_t hash = (uint64_t)(uint32_t)at.x * 0x9E3779B97F4A7C15u;
    hash = (hash ^ (uint32_t)at.y) * 0xBF58476D1CE4E5B9u;
    hash = (hash ^ (uint32_t)at.z) * 0x94D049BB133111EBu;
    uint32_t i = (uint32_t)(hash >> 32) & (count - 1);
    while (slots[i].object == object && !place_equal(slots[i].at, at)) i = (i + 1) & (count - 1);
    return &slots[i];
}

static int slots_grow(obj_writer *w)
{
    const uint32_t count = w->slot_count ? w->slot_count * 2 : FIRST_SLOTS;
    obj_slot *slots = memory_alloc_zeroed(w->memory, count, sizeof *slots);
    if (!slots) return 0;
    for (uint32_t i = 0; i < w->slot_count; ++i)
        if (w->slots[i].object == w->object_count) *slot_of(slots, count, w->object_count, w->slots[i].at) = w->slots[i];
    memory_free(w->memory, w->slots, w->slot_count, sizeof *slots);
    w->slots = slots;
    w->slot_count = count;
    return 1;
}

static void vertex_write(obj_writer *w, place at)
{
    text_add(w->out, "v ");
    text_decimal(w->out, at.x, PLACE_DECIMALS);
    text_add(w->out, " ");
    text_decimal(w->out, at.y, PLACE_DECIMALS);
    text_add(w->out, " ");
    text_decimal(w->out, at.z, PLACE_DECIMALS);
    text_add(w->out, "\n");
}

static uint32_t vertex_of(obj_writer *w, place at) // 0: out of memory
{
    if (w->used * 2 >= w->slot_count && !slots_grow(w)) {
        w->out->failed = 1;
        return 0;
    }
    obj_slot *slot = slot_of(w->slots, w->slot_count, w->object_count, at);
    if (slot->object != w->object_count) {
        *slot = (obj_slot){.at = at, .vertex = ++w->vertex_count, .object = w->object_count};
        w->used++;
        vertex_write(w, at);
    }
    return slot->vertex;
}

void obj_polygon(obj_writer *w, const place *corners, uint32_t count)
{
    uint32_t vertices[CORNERS_MOST], kept = 0;
    assert(count <= CORNERS_MOST && w->object_count);
    for (uint32_t i = 0; i < count; ++i)
        if (!place_equal(corners[i], corners[(i + 1) % count])) vertices[kept++] = vertex_of(w, corners[i]);
    if (kept < 3 || w->out->failed) return;
    w->triangle_count += kept - 2;
    text_add(w->out, "f");
    for (uint32_t i = 0; i < kept; ++i) {
        text_add(w->out, " ");
        text_count(w->out, vertices[i]);
    }
    text_add(w->out, "\n");
}

double turn_sine(double turns)
{
    const double half = 0.5, quarter = 0.25, radians = 6.283185307179586;
    turns -= floor(turns);
    if (turns > half + quarter) turns -= 1;
    else if (turns > quarter) turns = half - turns;
    const double x = turns * radians, square = x * x; // within a quarter turn: the series ends below 1e-13
    double sum = x, term = x;
    for (int i = 2; i < 20; i += 2) {
        term = -term * square / (i * (i + 1));
        sum += term;
    }
    return sum;
}

double turn_cosine(double turns)
{
    return turn_sine(turns + 0.25);
}
