// The application's API, views: what a camera sees, and why. See api/portcullis/scene.h.
// SPDX-License-Identifier: MIT
#include "library.h"

#include <string.h>

enum { PICTURE_MOST_PX = 65536 };

cull_result cull_scene_view_open(cull_scene *s, cull_scene_view **out)
{
    cull_scene_view *v = memory_alloc_zeroed(s->memory, 1, sizeof *v);
    if (!v) return library_refuse(s, CULL_ERR_MEMORY, "out of memory");
    v->owner = s;
    v->next = s->views;
    s->views = v;
    v->zones = memory_alloc_zeroed(s->memory, s->scene->zone_count, sizeof *v->zones);
    result done = v->zones ? world_view_open(s->world, VIEWER_CHECK_BOUNDS, &s->report, &v->view) : report_no_memory(&s->report, s->scene->path);
    if (done != RESULT_OK) {
        cull_scene_view_close(v);
        return library_result(done);
    }
    *out = v;
    return CULL_OK;
}

void cull_scene_view_close(cull_scene_view *v)
{
    if (!v) return;
    cull_scene *s = v->owner;
    cull_scene_view **link = &s->views;
    while (*link != v) link = &(*link)->next;
    *link = v->next;
    world_view_close(v->view);
    memory_free(s->memory, v->zones, s->scene->zone_count, sizeof *v->zones);
    memory_free(s->memory, v, 1, sizeof *v);
}

static const char *take_camera(cull_scene_view *v, const cull_camera *c)
{
    v->camera = (camera){.fovy_deg = c->fovy_deg, .aspect = c->aspect, .near_m = c->near_m, .far_m = c->far_m};
    memcpy(v->camera.eye, c->eye, sizeof c->eye);
    memcpy(v->camera.forward, c->forward, sizeof c->forward);
    memcpy(v->camera.up, c->up, sizeof c->up);
    if (c->struct_size != sizeof *c || c->reserved) return "struct_size is not this library's, or reserved is not 0; build against its scene.h";
    if (c->width_px == 0 || c->height_px == 0 || c->width_px > PICTURE_MOST_PX || c->height_px > PICTURE_MOST_PX)
        return "the picture is not 1 to 65,536 pixels wide and high";
    if (c->flags & ~(uint32_t)CULL_VIEW_CUT) return "an unknown flag";
    if (c->purpose < CULL_VIEW_MAIN || c->purpose > CULL_VIEW_CAPTURE) return "the purpose is none of CULL_VIEW_MAIN .. CULL_VIEW_CAPTURE";
    return camera_fault(&v->camera);
}

static void give_set(cull_scene_view *v, const visible_set *set, const frame_stats *t, cull_visible *out)
{
    for (uint32_t i = 0; i < set->zone_count; ++i) v->zones[i] = (cull_zone_runs){set->zones[i].zone, set->zones[i].run_count, set->zones[i].runs};
    *out = (cull_visible){.struct_size = sizeof *out,
                          .zone_count = set->zone_count,
                          .mover_count = set->mover_count,
                          .zones = v->zones,
                          .movers = set->movers,
                          .cull_ns = t->cull_ns,
                          .items = t->items_drawn,
                          .zones_reached = t->zones,
                          .volumes = t->volumes,
                          .portals_tried = t->crossings,
                          .portal_merges = t->portal_merges,
                          .limits_hit = t->limits_hit,
                          .faults = t->faults,
                          .movers_tested = t->movers_tested,
                          .steps = t->steps};
}

cull_result cull_scene_cull(cull_scene_view *v, const cull_camera *c, cull_visible *out)
{
    if (out->struct_size != sizeof *out)
        return library_refuse(v->owner, CULL_ERR_OPTION, "cull_visible: struct_size %u is not %zu; build against this library's scene.h",
                              out->struct_size, sizeof *out);
    const char *fault = take_camera(v, c);
    *out = (cull_visible){.struct_size = sizeof *out};
    if (fault) return library_refuse(v->owner, CULL_ERR_OPTION, "a camera that can't be used: %s", fault);
    visible_set set;
    frame_stats stats;
    v->input = (frame_input){.camera = &v->camera, .frame = {c->width_px, c->height_px, ++v->frame, c->flags, c->purpose}};
    world_cull(v->view, &v->input, &set, &stats);
    give_set(v, &set, &stats, out);
    return CULL_OK;
}

size_t cull_scene_explain(cull_scene_view *v, uint32_t item, char *text, size_t size)
{
    static const char early[] = "no frame of this view yet\n";
    if (!v->frame) {
        if (size) {
            const size_t count = sizeof early <= size ? sizeof early - 1 : size - 1;
            memcpy(text, early, count);
            text[count] = 0;
        }
        return sizeof early - 1;
    }
    const explain_request q = {.frame = &v->input, .item = item};
    return world_explain(v->view, &q, text, size);
}
