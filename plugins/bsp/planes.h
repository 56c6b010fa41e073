// The planes of a zone's walls as whole numbers, each once, and how far the walls' rounded vertices lie off them.
// SPDX-License-Identifier: MIT
// Invariant: planes are reduced, so equal planes are equal numbers; a plane and its turned self know each other as twins.
#ifndef PORTCULLIS_BSP_PLANES_H
#define PORTCULLIS_BSP_PLANES_H

#include "tree.h"
#include "vector.h"

typedef struct plane_table {
    bsp_vector planes;     // bsp_plane
    bsp_vector twins;      // uint32_t a plane: the same plane that faces the other way, or BSP_NONE
    uint32_t *wall_planes; // an item: its plane, or BSP_NONE: no wall, or one without a usable plane
    uint32_t item_count;
    uint32_t boxed_walls;  // of those, walls
    double steps_per_metre, slack;
} plane_table;

// CULL_ERR_MEMORY leaves nothing. bsp_planes_free of zeros is fine.
cull_result bsp_planes_make(const cull_host *host, const cull_zone *zone, plane_table *out);
void bsp_planes_free(const cull_host *host, plane_table *table);

static inline const bsp_plane *plane_at(const plane_table *table, uint32_t plane)
{
    return (const bsp_plane *)table->planes.items + plane;
}

static inline uint32_t plane_twin(const plane_table *table, uint32_t plane)
{
    return ((const uint32_t *)table->twins.items)[plane];
}

static inline double plane_height(const bsp_plane *plane, const double p[3])
{
    return ((plane->normal[0] * p[0] + plane->normal[1] * p[1]) + plane->normal[2] * p[2]) + plane->offset;
}

#endif
