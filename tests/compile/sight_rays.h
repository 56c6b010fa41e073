// Rays through a compiled scene's air: each ends at the front of a wall that a zone lists to which portals on the way lead.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_COMPILE_SIGHT_RAYS_H
#define PORTCULLIS_TESTS_COMPILE_SIGHT_RAYS_H

#include "host/core/scene.h"

typedef enum sight_fault {
    SIGHT_GOOD,
    SIGHT_NO_ZONE,  // no zone holds the start
    SIGHT_VOID,     // nothing is hit
    SIGHT_BACK,     // as below, and behind the back of a wall: through a hole
    SIGHT_UNLISTED, // none of the zones that the portals on the way lead to lists the wall whose front is hit
    SIGHT_FAULTS
} sight_fault;

typedef struct sight_ray { double from[3], way[3]; } sight_ray; // way: of any length above 0
typedef struct sight_rays sight_rays;

sight_rays *sight_rays_open(const scene *s); // the scene is borrowed; NULL: no memory, or no wall
void sight_rays_close(sight_rays *r);
sight_fault sight_judge(sight_rays *r, const sight_ray *ray);
// `count` random starts off walls, a random ray from each; every other one goes through a portal, and a second one starts
// on that portal. A fault counts where rays right beside it have one too: what slips through a seam of rounding is none.
// found[f]: how many; *last: the last one that is not good. Returns how many are not.
uint32_t sight_rays_cast(sight_rays *r, uint32_t count, uint32_t found[SIGHT_FAULTS], sight_ray *last);

#endif
