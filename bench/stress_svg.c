// Stress: the plot. A panel a family; across, its magnitudes in their order; up, the share of pixels, by powers of ten.
// SPDX-License-Identifier: MIT
// Invariant: a share of 0 lies on the bottom line, below the least share that one pixel can be; what is refused is grey.
#include "stress.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { PANEL_WIDE = 300, PANEL_HIGH = 190, PLOT_LEFT = 44, PLOT_TOP = 30, PLOT_WIDE = 240, PLOT_HIGH = 110, COLUMNS = 3, HEAD = 60, KEY_LINE = 18 };
static const double DECADES = 8; // from 1 down to 1e-8 of the pixels; 0 below that

typedef struct drawing {
    buffer text;
    int failed;
} drawing;

static void put(drawing *d, const char *format, ...)
{
    char line[512];
    va_list values;
    va_start(values, format);
    const int length = vsnprintf(line, sizeof line, format, values);
    va_end(values);
    d->failed |= length < 0 || (size_t)length >= sizeof line || !buffer_append(&d->text, line, (size_t)length);
}

static void put_escaped(drawing *d, const char *text)
{
    for (; *text; ++text) {
        if (*text == '<') put(d, "&lt;");
        else if (*text == '&') put(d, "&amp;");
        else if ((unsigned char)*text >= 32) put(d, "%c", *text);
    }
}

static const char *hue_of(uint32_t strategy)
{
    static const char *const hues[] = {"#332288", "#cc6677", "#117733", "#aa7700", "#44aa99", "#882255", "#6699cc", "#555555"};
    return hues[strategy % (sizeof hues / sizeof *hues)];
}

typedef struct panel { double x, y; uint32_t count; } panel;

static double across(const panel *p, uint32_t i)
{
    return p->x + PLOT_LEFT + PLOT_WIDE * (i + 0.5) / p->count;
}

static double up(const panel *p, double share)
{
    const double bottom = p->y + PLOT_TOP + PLOT_HIGH;
    if (!(share > 0)) return bottom;
    const double decade = log10(share) + DECADES;
    return bottom - PLOT_HIGH * (fmax(decade, 0) + 1) / (DECADES + 1);
}

static void draw_axes(drawing *d, const panel *p, const stress_family *f)
{
    put(d, "<text x=\"%.1f\" y=\"%.1f\" font-size=\"13\">%s, %s</text>\n", p->x + PLOT_LEFT, p->y + 20, f->name, f->unit);
    for (int e = 0; e >= -(int)DECADES; e -= 2) {
        const double y = up(p, pow(10, e));
        put(d, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#ddd\"/>\n", p->x + PLOT_LEFT, y, p->x + PLOT_LEFT + PLOT_WIDE, y);
        put(d, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%g</text>\n", p->x + PLOT_LEFT - 4, y + 3, pow(10, e));
    }
    put(d, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">0</text>\n", p->x + PLOT_LEFT - 4, up(p, 0) + 3);
    for (uint32_t i = 0; i < f->magnitude_count; ++i)
        put(d, "<text transform=\"translate(%.1f %.1f) rotate(-45)\" text-anchor=\"end\">%g</text>\n", across(p, i) + 4, up(p, 0) + 12, f->magnitudes[i]);
    put(d, "<rect x=\"%.1f\" y=\"%.1f\" width=\"%d\" height=\"%d\" fill=\"none\" stroke=\"black\"/>\n", p->x + PLOT_LEFT, p->y + PLOT_TOP,
        PLOT_WIDE, PLOT_HIGH);
}

static void draw_refused(drawing *d, const panel *p, const stress_series *s)
{
    const double wide = PLOT_WIDE / (double)p->count;
    for (uint32_t i = 0; i < p->count; ++i)
        if (s->points[i].refused[0])
            put(d, "<rect class=\"refused\" x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%d\" fill=\"#888\" fill-opacity=\"0.25\"/>\n",
                across(p, i) - wide / 2, p->y + PLOT_TOP, wide, PLOT_HIGH);
}

typedef enum measure { MISSED, PICTURES } measure;

static void draw_curve(drawing *d, const panel *p, const stress_series *s, measure what)
{
    double before_x = NAN, before_y = 0;
    const char *hue = hue_of(s->strategy), *dashes = what == MISSED ? "" : " stroke-dasharray=\"4 3\"";
    for (uint32_t i = 0; i < p->count; ++i) {
        const stress_point *at = &s->points[i];
        if (at->refused[0] || !at->pixels) {
            before_x = NAN;
            continue;
        }
        const double x = across(p, i), y = up(p, (double)(what == MISSED ? at->missed_pixels : at->pixels_differ) / (double)at->pixels);
        if (!isnan(before_x)) put(d, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\"%s/>\n", before_x, before_y, x, y, hue, dashes);
        if (what == MISSED) put(d, "<circle class=\"point\" cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>\n", x, y, hue);
        before_x = x;
        before_y = y;
    }
}

static void draw_panel(drawing *d, const stress_request *q, const stress_result *s, uint32_t family)
{
    const stress_family *f = q->families[family];
    const panel p = {20 + (double)PANEL_WIDE * (family % COLUMNS), HEAD + (double)PANEL_HIGH * (family / COLUMNS), f->magnitude_count};
    draw_axes(d, &p, f);
    draw_refused(d, &p, &s->series[family]);
    for (uint32_t k = 0; k < q->bench->strategy_count; ++k) {
        const stress_series *one = &s->series[(size_t)k * q->family_count + family];
        if (f->compare == STRESS_SAME) draw_curve(d, &p, one, PICTURES);
        draw_curve(d, &p, one, MISSED);
    }
}

static void draw_key(drawing *d, const stress_request *q, double y)
{
    for (uint32_t k = 0; k < q->bench->strategy_count; ++k, y += KEY_LINE) {
        put(d, "<circle cx=\"30\" cy=\"%.1f\" r=\"4\" fill=\"%s\"/>\n<text x=\"42\" y=\"%.1f\">", y - 4, hue_of(k), y);
        put_escaped(d, q->bench->strategies[k].name);
        put(d, "</text>\n");
    }
}

result stress_svg(const stress_request *q, const stress_result *s, const bench_labels *labels, bench_text *out)
{
    const allocator *memory = q->bench->services->memory;
    drawing d = {.text = buffer_make(memory, 1)};
    const uint32_t rows = (q->family_count + COLUMNS - 1) / COLUMNS, key_y = HEAD + rows * PANEL_HIGH + KEY_LINE;
    const uint32_t wide = 40 + COLUMNS * PANEL_WIDE, high = key_y + q->bench->strategy_count * KEY_LINE;
    put(&d, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%u\" height=\"%u\" font-family=\"sans-serif\" font-size=\"10\">\n", wide, high);
    put(&d, "<rect width=\"%u\" height=\"%u\" fill=\"white\"/>\n<text x=\"20\" y=\"28\" font-size=\"16\">", wide, high);
    put_escaped(&d, labels->scene);
    put(&d, ", ");
    put_escaped(&d, labels->path);
    put(&d, ": share of pixels against magnitude</text>\n");
    put(&d, "<text x=\"20\" y=\"46\">solid: missed; dashed: owned by another item than in the scene as it is; grey: refused by the host</text>\n");
    for (uint32_t f = 0; f < q->family_count; ++f) draw_panel(&d, q, s, f);
    draw_key(&d, q, key_y);
    put(&d, "</svg>\n");
    char *copy = d.failed ? NULL : memory_alloc(memory, d.text.count + 1, 1);
    if (copy) {
        memcpy(copy, d.text.items, d.text.count);
        copy[d.text.count] = 0;
        *out = (bench_text){copy, d.text.count};
    }
    buffer_free(&d.text);
    return copy ? RESULT_OK : RESULT_NO_MEMORY;
}
