// What must be drawn, by rays: the oracle. In double, on the oracle's own triangles; a hit that rounding could take away
// obliges nobody.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_CHECK_SIGHT_H
#define PORTCULLIS_HOST_CHECK_SIGHT_H

#include "views.h"

// Which walls are left out of the picture: a select whose `backface` is 1 is judged without those that show only their back.
typedef enum sight_backs { SIGHT_BACKS_SEEN, SIGHT_BACKS_LEFT_OUT } sight_backs;

typedef struct sight_ray {
    double from[3], along[3];
    double near_m, far_m;
    sight_backs backs;
    const view_rect *rects; // of all items; NULL: not asked. Then x and y are its place in the picture
    double x, y;
} sight_ray;
typedef struct sight_hit { uint32_t item; double at; } sight_hit;
enum { SIGHT_HITS_MOST = 8 };
// Items that the ray surely shows: the first that hides what is behind it, and see-through ones before it. Returns how many.
uint32_t sight_cast(const made_scene *s, const sight_ray *ray, sight_hit hits[SIGHT_HITS_MOST]);

// Depth at which the ray surely meets the item first; INFINITY: it doesn't, or not surely.
double sight_depth_of(const made_scene *s, const sight_ray *ray, uint32_t item);

// 1: it may meet something, however doubtfully, that hides.
int sight_meets(const made_scene *s, const sight_ray *ray);

typedef enum sight_rays {
    SIGHT_ANYWHERE, // through any point of the picture: that of any size, and every jitter of it
    SIGHT_SAMPLES   // through the middles of pixels only
} sight_rays;

// must[item] = 1 where a ray shows it; others keep what they had. count: rays, for SIGHT_ANYWHERE beside one aimed at each item.
void sight_mark(check_run *r, const made_scene *s, const made_view *v, sight_backs backs, sight_rays how, uint32_t count, uint8_t *must);

#endif
