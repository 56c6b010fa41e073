// Eyes of all kinds in a scene of zones, for rays: in the air, and where rounding decides, within EYES_ULPS of portals' planes, edges, corners.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_CLAIMS_EYES_H
#define PORTCULLIS_TESTS_CLAIMS_EYES_H

#include "host/core/scene.h"
#include "host/import/views.h"
#include "host/import/views_space.h"

enum { EYES_ULPS = 4 };
#define EYES_BESIDE_M 0.0625
typedef enum eye_kind { EYE_IN_AIR, EYE_ON_PORTAL, EYE_ON_EDGE, EYE_ON_CORNER, EYE_KINDS } eye_kind;
extern const char *const eye_kind_names[EYE_KINDS];

typedef struct eyes {
    const scene *scene;
    const camera_path *walk;
    free_space *space;
    uint64_t random;
} eyes;

// walk: of a scene that tells no solids: eyes in the air are its eyes, and what is up to EYES_BESIDE_M beside them; those on portals keep
// as far from every triangle.
void eyes_open(eyes *e, const scene *s, const camera_path *walk, uint64_t seed);
void eyes_close(eyes *e);
// A view from an eye of that kind into any direction, 60 degrees high, 16:9. Of the kinds on portals half are moved by ulps of float, or
// of double, the coordinates each its own way. 0: no place found.
int eyes_next(eyes *e, eye_kind kind, camera *out);
// Room about the point, world, up to `most`; 0 in what is solid.
double eyes_room(const eyes *e, const double at[3], double most);
// In the air of a zone: in one of its hulls by more than `margin`, and as far from what is solid.
int eyes_is_air(const eyes *e, const double at[3], double margin);
// A point on an edge of some portal, or inside a triangle of some item: to look at.
void eyes_portal_target(eyes *e, double out[3]);
void eyes_item_target(eyes *e, double out[3]);

#endif
