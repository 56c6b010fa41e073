// Views made for checks: a camera, what a culler is told of it, and the volumes as they are before the guard band.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_CHECK_VIEWS_H
#define PORTCULLIS_HOST_CHECK_VIEWS_H

#include "../core/view.h"
#include "scene.h"

enum { VIEW_VOLUMES_MOST = 6, VIEW_PLANES_MOST = 10, VIEW_WIDTH_PX = 64, VIEW_HEIGHT_PX = 48 };

typedef struct view_wanted { double planes[VIEW_PLANES_MOST][4]; uint32_t plane_count; } view_wanted; // normal, offset: exact

typedef struct made_view {
    camera camera;
    double axes[3][3]; // right, up, forward
    double wide, tall; // half the picture at distance 1
    cull_view view;
    cull_plane planes[VIEW_VOLUMES_MOST][CULL_MAX_PLANES];
    cull_volume volumes[VIEW_VOLUMES_MOST];
    view_wanted wanted[VIEW_VOLUMES_MOST];
    uint32_t volume_count;
} made_view;

typedef enum view_how {
    VIEW_FREE,    // anywhere, looking anywhere
    VIEW_TOUCHES, // the eye exactly in a plane, on an edge or on a corner of something
    VIEW_WINDOWS, // through several convex windows
    VIEW_SLABS,   // volumes that end exactly at sides of boxes
    VIEW_NARROW,  // a telescope
    VIEW_WIDE,    // nearly half of everything
    VIEW_FAR_OFF, // from outside, the whole scene some pixels wide
    VIEW_HOWS
} view_how;
const char *view_name(view_how how);

void view_make(check_run *r, const made_scene *s, view_how how, made_view *out);
// From the same eye as another view.
void view_make_from(check_run *r, const made_scene *s, view_how how, const double *eye, made_view *out);
// Of the picture, -1 to 1: where the box may show, a pixel wider. Low above high: nowhere.
typedef struct view_rect { double low[2], high[2]; } view_rect;
view_rect view_rect_of(const made_view *v, const cull_box *box);

int view_wants(const made_view *v, const double p[3]); // strictly within a volume, and in the picture

#endif
