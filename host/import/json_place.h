// Where a value stands in JSON text: jansson keeps no places, so the way to the value is walked again in the text.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_IMPORT_JSON_PLACE_H
#define PORTCULLIS_IMPORT_JSON_PLACE_H

#include <stddef.h>

typedef struct json_step { const char *key; size_t index; } json_step; // into an object by key, or (key NULL) into an array
typedef struct json_place { size_t line, column; } json_place;         // from 1; columns count characters, not bytes
typedef enum json_place_kind { PLACE_OF_VALUE, PLACE_OF_KEY } json_place_kind; // of the last step, which then has a key

// The text must be JSON that a parser took. Where the steps lead nowhere, the place where they end. [any thread]
json_place json_place_find(const char *text, size_t size, const json_step *steps, size_t step_count, json_place_kind kind);
// Lines of the items of one list of the whole value, one after the other, in one walk over the text.
typedef struct json_item_lines { const char *at, *end; size_t line; } json_item_lines;
json_item_lines json_item_lines_of(const char *text, size_t size, const char *list_key);
size_t json_item_lines_next(json_item_lines *l);
json_place json_place_at(const char *text, size_t offset); // of a byte

#endif
