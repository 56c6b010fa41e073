// Values of a JSON file, checked as they are read: see json_node.h.
// SPDX-License-Identifier: MIT
#include "json_node.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { STEPS_MOST = 32, POINTER_BYTES = 192, PLACE_BYTES = 512, WHAT_BYTES = 640, TEXT_BYTES_MOST = 1023, WORD_MOST = 32 };
static const double NUMBER_MOST = 1e9; // the scene's own limit for metres; no angle or direction needs more

json_node node_root(const json_file *f)
{
    return (json_node){.file = f, .value = f->root};
}

json_node node_item(const json_node *array, size_t index)
{
    return (json_node){.file = array->file, .value = json_array_get(array->value, index), .above = array, .index = index};
}

int node_find(const json_node *object, const char *key, json_node *out)
{
    const json_t *value = json_object_get(object->value, key);
    if (value) *out = (json_node){.file = object->file, .value = value, .above = object, .key = key};
    return value != NULL;
}

// ---- Telling ----

static size_t steps_to(const json_node *n, json_step steps[STEPS_MOST])
{
    size_t count = 0;
    for (const json_node *at = n; at->above; at = at->above) count++;
    if (count > STEPS_MOST) return 0; // deeper than any reader goes
    size_t i = count;
    for (const json_node *at = n; at->above; at = at->above) steps[--i] = (json_step){at->key, at->index};
    return count;
}

static void write_pointer(const json_step *steps, size_t count, char out[POINTER_BYTES])
{
    size_t used = 0;
    out[0] = 0;
    for (size_t i = 0; i < count && used < POINTER_BYTES; ++i) {
        const char *key = steps[i].key;
        const int length = key ? snprintf(out + used, POINTER_BYTES - used, "/%s", key) : snprintf(out + used, POINTER_BYTES - used, "/%zu", steps[i].index);
        used += length > 0 ? (size_t)length : 0;
    }
}

typedef struct telling { char place[PLACE_BYTES], pointer[POINTER_BYTES], what[WHAT_BYTES]; size_t column; } telling;

static void tell(const json_node *n, json_place_kind kind, const char *format, va_list values, telling *out)
{
    json_step steps[STEPS_MOST] = {{0}};
    const size_t count = steps_to(n, steps);
    const json_place p = json_place_find(n->file->text, n->file->size, steps, count, kind);
    snprintf(out->place, sizeof out->place, "%.480s:%zu", n->file->path, p.line);
    write_pointer(steps, count, out->pointer);
    vsnprintf(out->what, sizeof out->what, format, values);
    out->column = p.column;
}

result node_fault(const json_node *n, const char *format, ...)
{
    telling t;
    va_list values;
    va_start(values, format);
    tell(n, PLACE_OF_VALUE, format, values, &t);
    va_end(values);
    return report_error(n->file->report, t.place, t.column, "%s%s%s", t.pointer, *t.pointer ? ": " : "", t.what);
}

static result key_fault(const json_node *n, const char *format, ...)
{
    telling t;
    va_list values;
    va_start(values, format);
    tell(n, PLACE_OF_KEY, format, values, &t);
    va_end(values);
    return report_error(n->file->report, t.place, t.column, "%s: %s", t.pointer, t.what);
}

// ---- Words ----

// Levenshtein's distance: letters put in, left out or changed.
static size_t difference_of(const char *a, const char *b)
{
    const size_t m = strlen(a), n = strlen(b);
    size_t row[WORD_MOST + 1];
    if (m > WORD_MOST || n > WORD_MOST) return SIZE_MAX;
    for (size_t k = 0; k <= n; ++k) row[k] = k;
    for (size_t i = 1; i <= m; ++i) {
        size_t corner = row[0];
        row[0] = i;
        for (size_t k = 1; k <= n; ++k) {
            const size_t changed = corner + (a[i - 1] != b[k - 1]);
            corner = row[k];
            const size_t shorter = (row[k] < row[k - 1] ? row[k] : row[k - 1]) + 1;
            row[k] = changed < shorter ? changed : shorter;
        }
    }
    return row[n];
}

void nearest_word_try(nearest_word *n, const char *word)
{
    const size_t difference = difference_of(n->to, word), enough = (strlen(n->to) + 1) / 3;
    if (difference > enough || (n->word && difference >= n->difference)) return;
    n->word = word;
    n->difference = difference;
}

static void join_words(const char *const *words, const char *between, char *out, size_t size)
{
    size_t used = 0;
    out[0] = 0;
    for (; *words && used < size; ++words) {
        const int length = snprintf(out + used, size - used, "%s%s", used ? between : "", *words);
        used += length > 0 ? (size_t)length : 0;
    }
}

static result unknown_key(const json_node *object, const char *key, const char *const *known)
{
    char all[WHAT_BYTES / 2];
    const json_node child = {.file = object->file, .above = object, .key = key};
    nearest_word nearest = {.to = key};
    for (const char *const *k = known; *k; ++k) nearest_word_try(&nearest, *k);
    join_words(known, ", ", all, sizeof all);
    if (nearest.word) return key_fault(&child, "this key is unknown here; did you mean '%s'? Known: %s", nearest.word, all);
    return key_fault(&child, "this key is unknown here; known: %s", all);
}

// ---- Values ----

static result wrong_kind(const json_node *n, const char *wanted)
{
    static const char *const kinds[] = {"an object", "an array", "a text", "a number", "a number", "true", "false", "null"};
    return node_fault(n, "%s, where %s belongs", kinds[json_typeof(n->value)], wanted);
}

result node_object(const json_node *n, const char *const *known_keys)
{
    if (!json_is_object(n->value)) return wrong_kind(n, "an object { }");
    for (void *at = json_object_iter((json_t *)n->value); at; at = json_object_iter_next((json_t *)n->value, at)) {
        const char *key = json_object_iter_key(at);
        int is_known = strcmp(key, "note") == 0;
        for (const char *const *k = known_keys; *k && !is_known; ++k) is_known = strcmp(key, *k) == 0;
        if (!is_known) return unknown_key(n, key, known_keys);
    }
    return RESULT_OK;
}

result node_need(const json_node *object, const char *key, json_node *out)
{
    return node_find(object, key, out) ? RESULT_OK : node_fault(object, "'%s' is missing; add it", key);
}

result node_array(const json_node *n, size_t least, size_t most, size_t *out_count)
{
    if (!json_is_array(n->value)) return wrong_kind(n, "an array [ ]");
    *out_count = json_array_size(n->value);
    if (*out_count < least) return node_fault(n, "%zu values; write at least %zu", *out_count, least);
    if (*out_count > most) return node_fault(n, "%zu values; write at most %zu", *out_count, most);
    return RESULT_OK;
}

result node_text(const json_node *n, const char **out)
{
    if (!json_is_string(n->value)) return wrong_kind(n, "a text \"...\"");
    const size_t length = json_string_length(n->value);
    if (length == 0) return node_fault(n, "an empty text; write something or leave the key out");
    if (length > TEXT_BYTES_MOST) return node_fault(n, "a text of %zu bytes; shorten it to %d", length, TEXT_BYTES_MOST);
    *out = json_string_value(n->value);
    return RESULT_OK;
}

result node_number(const json_node *n, double least, double most, double *out)
{
    if (!json_is_number(n->value)) return wrong_kind(n, "a number");
    const double value = json_number_value(n->value);
    if (!(value >= least && value <= most)) return node_fault(n, "%.10g is not within %g to %g; correct it", value, least, most);
    *out = value;
    return RESULT_OK;
}

result node_count(const json_node *n, uint32_t least, uint32_t most, uint32_t *out)
{
    double value = 0;
    const result done = node_number(n, least, most, &value);
    if (done != RESULT_OK) return done;
    if (value != floor(value)) return node_fault(n, "%g is not a whole number; correct it", value);
    *out = (uint32_t)value;
    return RESULT_OK;
}

result node_numbers(const json_node *n, size_t count, double *out)
{
    if (!json_is_array(n->value)) return wrong_kind(n, "an array of numbers");
    if (json_array_size(n->value) != count) return node_fault(n, "%zu values; write %zu numbers", json_array_size(n->value), count);
    for (size_t i = 0; i < count; ++i) {
        const json_node item = node_item(n, i);
        const result done = node_number(&item, -NUMBER_MOST, NUMBER_MOST, &out[i]);
        if (done != RESULT_OK) return done;
    }
    return RESULT_OK;
}

result node_choice(const json_node *n, const char *const *words, size_t *out)
{
    const char *text;
    char all[WHAT_BYTES / 2];
    const result done = node_text(n, &text);
    if (done != RESULT_OK) return done;
    for (size_t i = 0; words[i]; ++i)
        if (strcmp(words[i], text) == 0) {
            *out = i;
            return RESULT_OK;
        }
    join_words(words, ", ", all, sizeof all);
    return node_fault(n, "'%s' is none of: %s", text, all);
}

result node_truth(const json_node *n, int *out)
{
    if (!json_is_boolean(n->value)) return wrong_kind(n, "true or false");
    *out = json_is_true(n->value);
    return RESULT_OK;
}

result node_maybe_text(const json_node *object, const char *key, const char **out)
{
    json_node n;
    return node_find(object, key, &n) ? node_text(&n, out) : RESULT_OK;
}

result node_maybe_number(const json_node *object, const char *key, double least, double most, double *out)
{
    json_node n;
    return node_find(object, key, &n) ? node_number(&n, least, most, out) : RESULT_OK;
}

result node_maybe_vector(const json_node *object, const char *key, double out[3])
{
    json_node n;
    return node_find(object, key, &n) ? node_numbers(&n, 3, out) : RESULT_OK;
}

result node_maybe_truth(const json_node *object, const char *key, int *out)
{
    json_node n;
    return node_find(object, key, &n) ? node_truth(&n, out) : RESULT_OK;
}
