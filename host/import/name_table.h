// Names to numbers: what a file calls a thing, and the number that the scene builder gave it.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_IMPORT_NAME_TABLE_H
#define PORTCULLIS_IMPORT_NAME_TABLE_H

#include "../core/memory.h"
#include "../core/report.h"

typedef struct named { const char *name; uint32_t number; } named;
typedef struct name_table {
    buffer entries; // named, in order of addition
    buffer slots;   // uint32_t: open addressing, entry + 1
} name_table;

name_table name_table_make(const allocator *memory);
void name_table_free(name_table *t);
const named *name_table_find(const name_table *t, const char *name); // NULL: unknown
named *name_table_change(name_table *t, const char *name); // the same, to give it another number
result name_table_add(name_table *t, const char *name, uint32_t number); // keeps the pointer; BAD_INPUT, unreported: known already
const char *name_table_nearest(const name_table *t, const char *name); // to suggest; NULL: none is like it

#endif
