// Stress: its table for people and its JSON.
// SPDX-License-Identifier: MIT
#include "json_text.h"
#include "stress.h"

#include <jansson.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CELL_BYTES = 24 };

static int put(buffer *text, const char *format, ...)
{
    char line[512];
    va_list values;
    va_start(values, format);
    const int length = vsnprintf(line, sizeof line, format, values);
    va_end(values);
    if (length < 0) return 0;
    return buffer_append(text, line, (size_t)length < sizeof line ? (size_t)length : sizeof line - 1) != NULL;
}

static const char *cell_of(double magnitude, char out[CELL_BYTES])
{
    if (isnan(magnitude)) snprintf(out, CELL_BYTES, "-");
    else snprintf(out, CELL_BYTES, "%g", magnitude);
    return out;
}

// The most extreme magnitude up to which nothing is missed and nothing refused. NAN: none.
static double holds_to(const stress_series *s)
{
    double to = NAN;
    for (uint32_t i = 0; i < s->family->magnitude_count; ++i) {
        const stress_point *p = &s->points[i];
        if (p->missed_pixels || p->missed_items || p->refused[0]) break;
        to = p->magnitude;
    }
    return to;
}

static const char *first_refusal(const stress_series *s)
{
    for (uint32_t i = 0; i < s->family->magnitude_count; ++i)
        if (s->points[i].refused[0]) return s->points[i].refused;
    return NULL;
}

static int put_series(buffer *text, const stress_series *s)
{
    char to[CELL_BYTES], missed[CELL_BYTES], pictures[CELL_BYTES], drawn[CELL_BYTES], zones[CELL_BYTES], refused[CELL_BYTES];
    const stress_firsts f = stress_first(s);
    const char *reason = first_refusal(s);
    const int is_own = s->family->compare == STRESS_OWN;
    return put(text, "  %-9s %-8s %10s %10s %10s %10s %10s  ", s->family->name, s->family->unit, cell_of(holds_to(s), to), cell_of(f.missed, missed),
               is_own ? "" : cell_of(f.pictures, pictures), is_own ? "" : cell_of(f.drawn, drawn), is_own ? "" : cell_of(f.zones, zones)) &&
           (reason ? put(text, "%s refused: %s\n", cell_of(f.refused, refused), reason) : put(text, "-\n"));
}

static int put_strategy(buffer *text, const stress_request *q, const stress_result *s, uint32_t k)
{
    const stress_series *first = &s->series[(size_t)k * q->family_count];
    const stress_point *home = &first->home;
    int good = put(text, "%s: %.0f polygons a view; as it is %llu pixels missed\n", q->bench->strategies[k].name, home->polygons_drawn,
                   (unsigned long long)home->missed_pixels);
    good = good && put(text, "  %-9s %-8s %10s %10s %10s %10s %10s  %s\n", "family", "unit", "holds to", "missed", "pictures", "drawn", "zones", "refused");
    for (uint32_t f = 0; f < q->family_count && good; ++f) good = put_series(text, first + f);
    return good;
}

static result take_text(const stress_request *q, buffer *text, bench_text *out)
{
    char *copy = memory_alloc(q->bench->services->memory, text->count + 1, 1);
    if (copy) {
        memcpy(copy, text->items, text->count);
        copy[text->count] = 0;
        *out = (bench_text){copy, text->count};
    }
    return copy ? RESULT_OK : RESULT_NO_MEMORY;
}

result stress_table(const stress_request *q, const stress_result *s, bench_text *out)
{
    buffer text = buffer_make(q->bench->services->memory, 1);
    int good = 1;
    for (uint32_t k = 0; k < q->bench->strategy_count && good; ++k) good = (k == 0 || put(&text, "\n")) && put_strategy(&text, q, s, k);
    good = good && put(&text, "\nholds to: nothing missed up to there. missed, pictures (over 1 pixel in 10,000 of another item), drawn (items), zones (reached):\n"
                              "the first magnitude at which it differs from the scene as it is; -: at none.\n");
    const result done = good ? take_text(q, &text, out) : RESULT_NO_MEMORY;
    buffer_free(&text);
    return done;
}

// ---- JSON ----

static json_t *number_of(double value)
{
    return isfinite(value) ? json_real(value) : isinf(value) ? json_string("inf") : json_null();
}

static json_t *point_json(const stress_point *p, stress_compare compare)
{
    if (p->refused[0]) return json_pack("{s:o, s:o}", "magnitude", number_of(p->magnitude), "refused", json_text(p->refused));
    json_t *o = json_pack("{s:o, s:I, s:I, s:I, s:I, s:I, s:f}", "magnitude", number_of(p->magnitude), "missed_pixels", (json_int_t)p->missed_pixels,
                          "missed_items", (json_int_t)p->missed_items, "broken_items", (json_int_t)p->broken_items, "pixels", (json_int_t)p->pixels,
                          "items_drawn", (json_int_t)p->items_drawn, "polygons_drawn", p->polygons_drawn);
    if (o && compare == STRESS_SAME)
        json_object_update_new(o, json_pack("{s:I, s:I, s:I}", "pixels_differ", (json_int_t)p->pixels_differ, "drawn_differ", (json_int_t)p->drawn_differ,
                                            "zones_differ", (json_int_t)p->zones_differ));
    return o;
}

static json_t *series_json(const stress_request *q, const stress_series *s)
{
    const stress_firsts f = stress_first(s);
    json_t *points = json_array();
    for (uint32_t i = 0; i < s->family->magnitude_count; ++i) json_array_append_new(points, point_json(&s->points[i], s->family->compare));
    return json_pack("{s:o, s:s, s:s, s:o, s:{s:o, s:o, s:o, s:o, s:o}, s:o, s:o}", "culler", json_text(q->bench->strategies[s->strategy].name), "family",
                     s->family->name, "unit", s->family->unit, "holds_to", number_of(holds_to(s)), "first", "missed", number_of(f.missed), "pictures",
                     number_of(f.pictures), "drawn", number_of(f.drawn), "zones", number_of(f.zones), "refused", number_of(f.refused), "home",
                     point_json(&s->home, STRESS_OWN), "points", points);
}

result stress_json(const stress_request *q, const stress_result *s, const bench_labels *labels, bench_text *out)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < s->series_count; ++i) json_array_append_new(list, series_json(q, &s->series[i]));
    json_t *root = json_pack("{s:o, s:o, s:i, s:i, s:i, s:I, s:o}", "scene", json_text(labels->scene), "path", json_text(labels->path), "views",
                             (int)q->bench->path->count, "width_px", (int)q->bench->width_px, "height_px", (int)q->bench->height_px, "seed",
                             (json_int_t)q->seed, "series", list);
    char *text = root && json_array_size(list) == s->series_count ? json_dumps(root, JSON_INDENT(2)) : NULL;
    json_decref(root);
    if (!text) return RESULT_NO_MEMORY;
    buffer bytes = buffer_make(q->bench->services->memory, 1);
    const int good = buffer_append(&bytes, text, strlen(text)) && buffer_append(&bytes, "\n", 1);
    free(text);
    const result done = good ? take_text(q, &bytes, out) : RESULT_NO_MEMORY;
    buffer_free(&bytes);
    return done;
}
