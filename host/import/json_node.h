// A value of a JSON file together with the way to it, so that whatever is wrong with it is told with line, column and key.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_IMPORT_JSON_NODE_H
#define PORTCULLIS_IMPORT_JSON_NODE_H

#include "../core/report.h"
#include "json_place.h"

#include <jansson.h>

typedef struct json_file {
    const char *path, *text;
    size_t size;
    json_t *root;
    report *report;
} json_file;

typedef struct json_node { // borrows its file and the node above it
    const json_file *file;
    const json_t *value;
    const struct json_node *above; // NULL: the file's whole value
    const char *key;               // in the object above; NULL: index in the array above
    size_t index;
} json_node;

json_node node_root(const json_file *f);
json_node node_item(const json_node *array, size_t index);              // must be there
int node_find(const json_node *object, const char *key, json_node *out); // 1: it is there

// Each of these reports and returns RESULT_BAD_INPUT where the value is of another kind or out of bounds.
result node_object(const json_node *n, const char *const *known_keys); // NULL-ended; any other key is an error. "note" always goes
result node_need(const json_node *object, const char *key, json_node *out);
result node_array(const json_node *n, size_t least, size_t most, size_t *out_count);
result node_text(const json_node *n, const char **out);               // 1 to 1023 bytes; lives as long as the file
result node_number(const json_node *n, double least, double most, double *out);
result node_count(const json_node *n, uint32_t least, uint32_t most, uint32_t *out);
result node_numbers(const json_node *n, size_t count, double *out);   // exactly as many, each within 1e9
result node_choice(const json_node *n, const char *const *words, size_t *out); // NULL-ended
result node_truth(const json_node *n, int *out);

// The keys of an object that may be missing: then *out stays as it is.
result node_maybe_text(const json_node *object, const char *key, const char **out);
result node_maybe_number(const json_node *object, const char *key, double least, double most, double *out);
result node_maybe_vector(const json_node *object, const char *key, double out[3]);
result node_maybe_truth(const json_node *object, const char *key, int *out);

// `file:LINE:COLUMN: error: /way/to/it: what`. Returns RESULT_BAD_INPUT.
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
result node_fault(const json_node *n, const char *format, ...);

// The word of the list that differs by the fewest letters, where that is few enough to be a slip; else NULL.
typedef struct nearest_word { const char *to, *word; size_t difference; } nearest_word;
void nearest_word_try(nearest_word *n, const char *word);

#endif
