// Walls: see walls.h. Facing is that of the triangles as they are drawn, in double, where positions are exact.
// SPDX-License-Identifier: MIT
#include "walls.h"

#include <string.h>

walls walls_of_chain(const cull_descriptor *d, const chain_spec *spec)
{
    static const char *const key = "backface"; // reserved by culler.h for this
    const chain_stage_spec *first = &spec->stages[0];
    const char *value = "0";
    for (uint32_t i = 0; i < d->option_count; ++i)
        if (strcmp(d->options[i].key, key) == 0) value = d->options[i].fallback;
    for (uint32_t i = 0; i < first->option_count; ++i)
        if (strcmp(first->options[i].key, key) == 0) value = first->options[i].value;
    return strcmp(value, "1") == 0 ? WALLS_FRONT_ONLY : WALLS_BOTH_SIDES;
}

static int triangle_faces(const scene *s, uint32_t first_index, const double eye[3])
{
    const uint32_t *corner = s->indices + first_index;
    const cull_vec3 a = s->positions[corner[0]], b = s->positions[corner[1]], c = s->positions[corner[2]];
    const double u[3] = {(double)b.x - a.x, (double)b.y - a.y, (double)b.z - a.z};
    const double v[3] = {(double)c.x - a.x, (double)c.y - a.y, (double)c.z - a.z};
    const double w[3] = {eye[0] - a.x, eye[1] - a.y, eye[2] - a.z};
    const double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2], z = u[0] * v[1] - u[1] * v[0];
    return x * w[0] + y * w[1] + z * w[2] > 0;
}

static int wall_faces(const scene *s, const scene_item *item, const double eye[3])
{
    for (uint32_t i = 0; i < item->index_count; i += 3)
        if (triangle_faces(s, item->first_index + i, eye)) return 1;
    return 0;
}

void walls_in_front(const scene *s, const camera *c, uint32_t *item_bits)
{
    const double eye[3] = {c->eye[0] - s->whole.origin[0], c->eye[1] - s->whole.origin[1], c->eye[2] - s->whole.origin[2]};
    memset(item_bits, 0xff, (s->item_count + s->mover_count + 31) / 32 * sizeof *item_bits);
    for (uint32_t i = 0; i < s->item_count; ++i) {
        const uint32_t sided = s->items[i].flags & (CULL_ITEM_WALL | CULL_ITEM_TWO_SIDED);
        if (sided == CULL_ITEM_WALL && !wall_faces(s, &s->items[i], eye)) item_bits[i / 32] &= ~(1u << (i % 32));
    }
}
