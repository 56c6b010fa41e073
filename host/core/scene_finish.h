// What scene_finish.c and scene_zones.c share while a scene is made.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_SCENE_FINISH_H
#define PORTCULLIS_HOST_SCENE_FINISH_H

#include "scene_builder.h"

typedef struct finish {
    scene_builder *b;
    scene *s;
    double low[3], high[3]; // of vertices and portals
    int failed;             // an allocation failed: all later ones give NULL
} finish;

void *finish_take(finish *f, size_t count, size_t item_size); // of the scene's arena
void *finish_copy(finish *f, const buffer *from);
const char *finish_text(finish *f, const char *text);
// Shared with who checks a scene that was made elsewhere.
cull_box finish_item_box(const scene *s, const scene_item *item);
int finish_portal_plane(const double (*points)[3], uint32_t count, double out[4]); // Newell's, from the first point; 0: no area
void finish_zone_origin(const scene *s, uint32_t zone, double out[3]);
double finish_round(double v);       // |v| < 2^51: to the nearest integer, ties to even
double finish_origin(double middle); // to the grid of 1 m: whole moves of a scene change nothing else
// Where a scene of those bounds has its origin, and the step that all its coordinates are rounded to.
typedef struct finish_frame { double origin[3], radius, step; } finish_frame;
finish_frame finish_frame_of(const double low[3], const double high[3]);
// Tangents where a material has a normal map (scene_tangents.c): before the vertices are numbered for good, and at the end.
result finish_part_mirrored(scene_builder *b);
void finish_tangents(finish *f);
// Zones, portals, doors and all that is copied as it is; the scene's geometry is there. Changes the hash where there
// are zones or paths.
result finish_zones(finish *f, const char *path, report *r);
// Which zones list which item. Fills zone_items, listings, first_item and item_count of the zones, and stray_items.
// Room for one more zone stands behind scene.zones: the stray one.
result finish_listings(finish *f, const char *path, report *r);
// Warns of zones side by side that overlap.
result finish_overlaps(finish *f, const char *path, report *r);

#endif
