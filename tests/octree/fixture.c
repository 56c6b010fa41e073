// Scenes of boxes, volumes and sessions: see fixture.h.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <stdlib.h>
#include <string.h>

// ---- Scenes ----

typedef struct spot { double at[3], size[3]; } spot;

static void city_spot(uint64_t *r, uint32_t i, spot *s)
{
    const double block = 60, wide = 1000;
    for (int k = 0; k < 3; k++) s->size[k] = i % 7 < 4 ? random_between(r, 4, 30) : random_between(r, 0.3, 3);
    s->at[0] = floor(random_between(r, -wide, wide) / block) * block + random_between(r, 0, 30);
    s->at[1] = 0;
    s->at[2] = floor(random_between(r, -wide, wide) / block) * block + random_between(r, 0, 30);
}

static void odd_spot(uint64_t *r, scene_kind kind, uint32_t i, uint32_t count, spot *s)
{
    const double turn = i * 2.4, far = 1e4 * pow(0.5, i % 60);
    if (kind == SCENE_GIANT && i != count / 2) return;
    if (kind == SCENE_OUTLIER && i != count / 2) return;
    for (int k = 0; k < 3; k++) {
        if (kind == SCENE_EQUAL) s->at[k] = s->size[k] = 5;
        if (kind == SCENE_GIANT || kind == SCENE_GIANTS) s->size[k] = 200;
        if (kind == SCENE_GIANT) s->at[k] = -100;
        if (kind == SCENE_OUTLIER) s->at[k] = 1e9;
        if (kind == SCENE_LINE && k != 0) s->at[k] = 7, s->size[k] = 0;
        if (kind == SCENE_PLANE && k == 2) s->at[k] = 7, s->size[k] = 0;
        if (kind == SCENE_HUGE) s->at[k] *= 1e28, s->size[k] *= 1e28;
        if (kind == SCENE_SPIRAL) s->at[k] = k == 0 ? far * cos(turn) : k == 1 ? far * sin(turn) : far / 3, s->size[k] = far / 8;
        if (kind == SCENE_NESTED) {
            s->size[k] = random_between(r, 0, 128);
            s->at[k] = -s->size[k] / 2;
        }
    }
}

cull_box *scene_make(uint64_t *r, scene_kind kind, uint32_t count)
{
    cull_box *boxes = calloc((size_t)count + 1, sizeof *boxes);
    assert_non_null(boxes);
    for (uint32_t i = 0; i < count; i++) {
        spot s;
        for (int k = 0; k < 3; k++) {
            s.at[k] = random_between(r, -100, 100);
            s.size[k] = random_unit(r) < 0.2 ? 0 : random_between(r, 0, 4);
            if (kind == SCENE_GRID) s.at[k] = floor(s.at[k] / 10) * 10, s.size[k] = 10;
        }
        if (kind == SCENE_CITY) city_spot(r, i, &s);
        odd_spot(r, kind, i, count, &s);
        for (int k = 0; k < 3; k++) {
            (&boxes[i].min.x)[k] = (float)s.at[k];
            (&boxes[i].max.x)[k] = (float)(s.at[k] + s.size[k]);
        }
    }
    return boxes;
}

// ---- Volumes ----

// Near an item more often than not, so that most cut something.
void volumes_make(uint64_t *r, const cull_box *boxes, uint32_t items, uint32_t count, made_volumes *out)
{
    out->count = count;
    memset(&out->view, 0, sizeof out->view);
    for (uint32_t v = 0; v < count; v++) {
        const uint32_t planes = random_unit(r) < 0.1 ? random_below(r, CULL_MAX_PLANES + 1) : random_below(r, 7);
        const cull_box at = items ? boxes[random_below(r, items)] : cull_box_none();
        const double scale = items ? fmax(1, fabs((double)at.min.x) / 10) : 1;
        double middle[3];
        for (int i = 0; i < 3; i++) middle[i] = items && random_unit(r) < 0.8 ? (double)(&at.min.x)[i] : random_between(r, -100, 100);
        for (uint32_t k = 0; k < planes; k++) {
            double n[3], offset = (random_unit(r) < 0.5 ? random_between(r, 0, 60) : random_between(r, -5, 20)) * scale;
            random_direction(r, n);
            if (random_unit(r) < 0.2) { // along an axis, maybe through box faces
                const int axis = (int)random_below(r, 3);
                for (int i = 0; i < 3; i++) n[i] = i == axis ? (random_unit(r) < 0.5 ? -1 : 1) : 0;
            }
            for (int i = 0; i < 3; i++) offset -= n[i] * middle[i];
            out->planes[v][k] = (cull_plane){{(float)n[0], (float)n[1], (float)n[2]}, (float)offset};
        }
        out->volumes[v] = (cull_volume){planes ? out->planes[v] : NULL, planes, 0};
        for (int i = 0; i < 3; i++) out->view.eye[i] = (float)middle[i];
    }
    out->view.eye[3] = random_unit(r) < 0.1 ? 0.0f : 1.0f;
}

uint32_t loop_set(const cull_box *boxes, uint32_t count, const made_volumes *v, uint8_t *seen)
{
    uint32_t sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        seen[i] = 0;
        for (uint32_t k = 0; k < v->count && !seen[i]; k++) seen[i] = cull_volume_touches(&v->volumes[k], boxes[i]);
        sum += seen[i];
    }
    return sum;
}

// ---- Sessions ----

cull_result octree_open(session *s, culler_host *h, const cull_zone *zone, const octree_values *values)
{
    const char *const list[] = {values->kind, values->loose, values->backface, values->isa};
    const cull_plugin *plugin = plugin_named("octree");
    assert_non_null(plugin);
    assert_int_equal(plugin->descriptor->option_count, 4);
    return session_open(s, h, plugin, zone, list);
}

int octree_has_isa(const char *isa)
{
    culler_host h;
    hand_zone z;
    session s;
    culler_host_init(&h, 0);
    zone_of_boxes(NULL, 0, &z);
    const octree_values values = {"auto", "2", "0", isa};
    const int has = octree_open(&s, &h, &z.zone, &values) == CULL_OK;
    if (has) session_close(&s);
    hand_zone_free(&z);
    return has;
}

const char *octree_set(const session *s, uint8_t *seen)
{
    for (uint32_t i = 1; i < s->run_count; i++)
        if (s->runs[i - 1].first + s->runs[i - 1].count == s->runs[i].first) return "a run that goes on where the one before ends";
    return session_set_any_order(s, seen);
}

void octree_must_be(const session *s, const cull_box *boxes, const made_volumes *v, const char *what)
{
    static uint8_t seen[ITEMS_MOST], wanted[ITEMS_MOST];
    const char *wrong = octree_set(s, seen);
    if (wrong) fail_msg("%s: %s", what, wrong);
    loop_set(boxes, s->item_count, v, wanted);
    for (uint32_t i = 0; i < s->item_count; i++)
        if (seen[i] != wanted[i]) fail_msg("%s: item %u of %u: found %u, wanted %u", what, i, s->item_count, seen[i], wanted[i]);
}

const void *octree_extension(const session *s, const char *id)
{
    const void *found = s->plugin->get_extension(s->culler, id);
    assert_non_null(found);
    return found;
}
