// Measures how much method=hiz drops of what the same rectangle test on the finished exact z-buffer drops, as the boxes come and shuffled.
// SPDX-License-Identifier: MIT
// usage: measure_hiz FILE.boxes FILE.views WIDTHxHEIGHT [EVERY [LEAST [PIXELS]]]: each EVERYth view; fails where the share is below LEAST percent, or
// shuffling loses over 3 points. The exact z-buffer holds what a ray in double through each pixel's centre meets first.
#include "hiz_stage.h"
#include "tests/common/measure.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FORMS = 2 }; // as the boxes come; shuffled
#define SHUFFLED_LOSES_MOST 3.0 // points

typedef struct form {
    hand_zone zone;
    hiz_stage stage;
    uint32_t *places; // by box: its item
    uint8_t *seen;
    uint64_t drops, drops_too; // all; of what the exact picture drops
} form;

typedef struct measurement {
    cull_box *boxes, *inside;
    uint32_t *inside_ids, count;
    uint32_t width_px, height_px;
    form forms[FORMS];
    uint64_t touching, exact;
} measurement;

static void form_open(measurement *m, form *f, int shuffles, const char *pixels)
{
    cull_box *boxes = malloc(m->count * sizeof *boxes);
    uint64_t seed = 1;
    f->places = malloc(m->count * sizeof *f->places);
    f->seen = malloc(m->count);
    if (!boxes || !f->places || !f->seen) abort();
    for (uint32_t i = 0; i < m->count; i++) f->places[i] = i;
    for (uint32_t i = m->count - 1; shuffles && i > 0; i--) {
        const uint32_t k = random_below(&seed, i + 1), other = f->places[k];
        f->places[k] = f->places[i];
        f->places[i] = other;
    }
    for (uint32_t i = 0; i < m->count; i++) boxes[f->places[i]] = m->boxes[i];
    zone_of_boxes(boxes, m->count, &f->zone);
    stage_open_pixels(&f->stage, &f->zone.zone, "on", "1", "auto", pixels);
    free(boxes);
}

static void form_close(form *f)
{
    stage_close(&f->stage);
    hand_zone_free(&f->zone);
    free(f->places);
    free(f->seen);
}

static int touches(const hiz_scene_view *v, const cull_box *b)
{
    for (uint32_t i = 0; i < v->sides.plane_count; i++) {
        const cull_plane *p = &v->sides.planes[i];
        const float x = p->normal.x >= 0 ? b->max.x : b->min.x, y = p->normal.y >= 0 ? b->max.y : b->min.y, z = p->normal.z >= 0 ? b->max.z : b->min.z;
        if (p->normal.x * x + p->normal.y * y + p->normal.z * z + p->offset < 0) return 0;
    }
    return 1;
}

// The rectangle of the box and the nearest of its depths, against the finished picture.
static int exact_drops(const oracle_picture *p, const cull_box *box)
{
    int r[4];
    double least;
    if (!oracle_bounds(p->v, box, r, &least)) return 0;
    for (int y = r[1]; y <= r[3]; y++)
        for (int x = r[0]; x <= r[2]; x++)
            if (!(p->nearest[(size_t)y * p->width_px + (size_t)x] < least)) return 0;
    return r[0] <= r[2] && r[1] <= r[3];
}

static void view_measure(measurement *m, const camera *c)
{
    hiz_scene_view v;
    oracle_picture picture;
    uint32_t inside = 0;
    scene_view_make(c, m->width_px, m->height_px, &m->forms[0].zone.zone, &v);
    for (uint32_t i = 0; i < m->count; i++) {
        if (!touches(&v, &m->boxes[i])) continue;
        m->inside_ids[inside] = i;
        m->inside[inside++] = m->boxes[i];
    }
    for (int n = 0; n < FORMS; n++) {
        stage_run(&m->forms[n].stage, &v, NULL, 0);
        stage_set(&m->forms[n].stage, m->forms[n].seen, m->count);
    }
    oracle_open(&picture, &v, m->inside, inside, ORACLE_CENTRES);
    m->touching += inside;
    for (uint32_t i = 0; i < inside; i++) {
        const int drops = exact_drops(&picture, &m->inside[i]);
        m->exact += (uint64_t)drops;
        for (int n = 0; n < FORMS; n++) {
            const form *f = &m->forms[n];
            const int hidden = !f->seen[f->places[m->inside_ids[i]]];
            m->forms[n].drops += (uint64_t)hidden;
            m->forms[n].drops_too += (uint64_t)(hidden && drops);
        }
    }
    oracle_close(&picture);
}

static uint32_t views_measure(measurement *m, const char *path, uint32_t every)
{
    camera c;
    uint32_t lines = 0, views = 0;
    FILE *f = fopen(path, "r");
    if (!f) return 0;
    while (fscanf(f, "%lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf", &c.eye[0], &c.eye[1], &c.eye[2], &c.forward[0], &c.forward[1], &c.forward[2],
                  &c.up[0], &c.up[1], &c.up[2], &c.fovy_deg, &c.aspect, &c.near_m, &c.far_m) == 13) {
        if (lines++ % every) continue;
        view_measure(m, &c);
        views++;
    }
    fclose(f);
    return views;
}

static double percent(uint64_t part, uint64_t whole)
{
    return whole ? 100.0 * (double)part / (double)whole : 100;
}

int main(int argc, char **argv)
{
    static measurement m;
    if (argc < 4 || sscanf(argv[3], "%ux%u", &m.width_px, &m.height_px) != 2) return 2;
    const uint32_t every = argc > 4 && atoi(argv[4]) > 0 ? (uint32_t)atoi(argv[4]) : 1;
    const double least = argc > 5 ? atof(argv[5]) : 0;
    m.boxes = boxes_load(argv[1], &m.count);
    m.inside = malloc(m.count * sizeof *m.inside);
    m.inside_ids = malloc(m.count * sizeof *m.inside_ids);
    if (!m.count || !m.inside || !m.inside_ids) return 2;
    for (int n = 0; n < FORMS; n++) form_open(&m, &m.forms[n], n, argc > 6 ? argv[6] : "auto");
    const uint32_t views = views_measure(&m, argv[2], every);
    if (!views) return 2;
    const double share = percent(m.forms[0].drops_too, m.exact), shuffled = percent(m.forms[1].drops_too, m.exact), of = (double)views;
    const int holds = share >= least && shuffled >= share - SHUFFLED_LOSES_MOST;
    printf("%s %u boxes, %u views of %ux%u, %.1f touch the view: the exact test leaves %.1f, hiz %.1f, shuffled %.1f; of what that drops hiz drops %.3f %%, "
           "shuffled %.3f %%\n", holds ? "PASS" : "FAIL", (unsigned)m.count, (unsigned)views, (unsigned)m.width_px, (unsigned)m.height_px, (double)m.touching / of,
           (double)(m.touching - m.exact) / of, (double)(m.touching - m.forms[0].drops) / of, (double)(m.touching - m.forms[1].drops) / of, share, shuffled);
    for (int n = 0; n < FORMS; n++) form_close(&m.forms[n]);
    free(m.boxes);
    free(m.inside);
    free(m.inside_ids);
    return !holds;
}
