// Names to numbers: see name_table.h.
// SPDX-License-Identifier: MIT
#include "name_table.h"

#include "json_node.h"

#include <string.h>

enum { SLOTS_FIRST = 64 };

static uint32_t hash_of(const char *name) // FNV-1a, with a final mix for the low bits
{
    uint32_t h = 2166136261u;
    for (; *name; ++name) h = (h ^ (unsigned char)*name) * 16777619u;
    return h ^ h >> 15;
}

name_table name_table_make(const allocator *memory)
{
    return (name_table){buffer_make(memory, sizeof(named)), buffer_make(memory, sizeof(uint32_t))};
}

void name_table_free(name_table *t)
{
    buffer_free(&t->entries);
    buffer_free(&t->slots);
}

// The slot of the name, or the free one where it belongs. There are slots, and some are free.
static size_t slot_of(const buffer *slots, const named *entries, const char *name)
{
    const uint32_t *slot = slots->items;
    size_t at = hash_of(name) & (slots->count - 1);
    while (slot[at] && strcmp(entries[slot[at] - 1].name, name) != 0) at = (at + 1) & (slots->count - 1);
    return at;
}

named *name_table_change(name_table *t, const char *name)
{
    if (t->slots.count == 0) return NULL;
    named *entries = t->entries.items;
    const uint32_t entry = ((const uint32_t *)t->slots.items)[slot_of(&t->slots, entries, name)];
    return entry ? &entries[entry - 1] : NULL;
}

const named *name_table_find(const name_table *t, const char *name)
{
    name_table same = *t; // nothing of it is changed
    return name_table_change(&same, name);
}

static result grow(name_table *t)
{
    buffer slots = buffer_make(t->slots.memory, sizeof(uint32_t));
    const size_t count = t->slots.count ? 2 * t->slots.count : SLOTS_FIRST;
    uint32_t *slot = buffer_push(&slots, count);
    if (!slot) return RESULT_NO_MEMORY;
    memset(slot, 0, count * sizeof *slot);
    const named *entries = t->entries.items;
    for (size_t i = 0; i < t->entries.count; ++i) slot[slot_of(&slots, entries, entries[i].name)] = (uint32_t)i + 1;
    buffer_free(&t->slots);
    t->slots = slots;
    return RESULT_OK;
}

result name_table_add(name_table *t, const char *name, uint32_t number)
{
    if (name_table_find(t, name)) return RESULT_BAD_INPUT;
    if (2 * (t->entries.count + 1) > t->slots.count && grow(t) != RESULT_OK) return RESULT_NO_MEMORY;
    const named entry = {name, number};
    const size_t slot = slot_of(&t->slots, t->entries.items, name);
    if (!buffer_append(&t->entries, &entry, 1)) return RESULT_NO_MEMORY;
    ((uint32_t *)t->slots.items)[slot] = (uint32_t)t->entries.count;
    return RESULT_OK;
}

const char *name_table_nearest(const name_table *t, const char *name)
{
    nearest_word nearest = {.to = name};
    const named *entries = t->entries.items;
    for (size_t i = 0; i < t->entries.count; ++i) nearest_word_try(&nearest, entries[i].name);
    return nearest.word;
}
